# SPDX-License-Identifier: Apache-2.0
"""The report says what its step costs, and tells impacts from smooth motions."""

import dataclasses
import json
import math
from pathlib import Path

import pytest

import volcontact as vc
from volcontact.cli import main
from volcontact.convergence import blow_of
from volcontact.report import step_error
from volcontact.running.simulation import simulate

ROOT = Path(__file__).parents[3]
# A block on a spring of contact: presses on it and lets go, or lies on it.
SCENE = """<mujoco>
  <option timestep="{step}" gravity="0 0 {gravity}"><flag energy="enable"/></option>
  <worldbody><geom type="plane" size="1 1 1"/>
  <body pos="0 0 {height}"><joint type="slide" axis="0 0 1"/>
    <geom name="block" type="box" size=".05 .05 .05" mass="1"/></body></worldbody></mujoco>"""


def text(step=1e-3, gravity=-9.81, height=0.06):
    return SCENE.format(step=step, gravity=gravity, height=height)


def test_blow_lasts_as_long_as_its_closed_form():
    """A swing about where the block would rest: x = static + swing cos(w t)."""
    stiffness, mass = 0.5 * 1e6 * 0.01, 1.0  # k_v A / 2 [N/m] of a face on two layers
    run = simulate(
        text(1e-5, -9.81, 0.0505),
        contact="volumetric",
        duration=0.1,
        material={"stiffness": 1e6, "damping": 0.0, "friction": 0.0},
        frame_interval=None,
    )
    static, speed = mass * 9.81 / stiffness, math.sqrt(2 * 9.81 * 5e-4)
    swing = math.hypot(static, speed * math.sqrt(mass / stiffness))
    angle = math.acos((0.5 * (static + swing) - static) / swing)
    blow = blow_of(run)
    assert blow.lasts == pytest.approx(2 * angle * math.sqrt(mass / stiffness), abs=3e-5)
    assert blow.force == pytest.approx(stiffness * (static + swing), rel=1e-3)


def test_no_touch_is_no_blow():
    run = simulate(text(height=1.0), contact="volumetric", duration=0.05, frame_interval=None)
    assert blow_of(run) is None


def converged(scene, **given):
    return vc.converge(scene, duration=0.08, levels=3, material={"friction": 0.0, **given})


def test_impacts_and_smooth_motions_have_their_words():
    hard = converged(text(4e-3), stiffness=1e9)
    said = " ".join(step_error.sentences(hard))
    assert said.startswith("Impacts: the hardest blow, ")
    assert "Ruled by impacts:" in said
    assert "Largest contact force" in said
    soft = converged(text(2e-4, height=0.0505), stiffness=1e5)
    said = " ".join(step_error.sentences(soft))
    assert said.startswith("Smooth: the hardest blow, "), said
    fall = converged(text(height=1.0))
    assert step_error.sentences(fall)[0].startswith("Smooth: nothing is hit.")


def test_step_that_would_do_is_named():
    soft = converged(text(2e-4, height=0.0505), stiffness=1e5)
    first = soft.estimates[0]
    made = [
        dataclasses.replace(
            first, name=name, kind="converges", values=(value, 1.0), limit=1.0, step=step
        )
        for name, value, step in (("Peak", 1.2, 1e-5), ("Depth", 1.05, 5e-5))
    ]
    said = step_error.sentences(dataclasses.replace(soft, estimates=tuple(made)))
    assert (
        "The step of 200 µs costs +20 % of peak at most; 10.0 µs would bring all within 1 %."
        in said
    )
    same = [dataclasses.replace(made[0], values=(1.001, 1.0), step=soft.steps[0])]
    said = step_error.sentences(dataclasses.replace(soft, estimates=tuple(same)))
    assert any("is within 1 % at the step of 200 µs" in line for line in said)


def test_report_of_compare_has_the_cost_of_its_step(tmp_path, capsys):
    scene = tmp_path / "scene.xml"
    scene.write_text(text())
    asked = ["compare", str(scene), "--duration", "0.05", "--no-frames"]
    assert main([*asked, "--out", str(tmp_path / "a"), "--error"]) == 0
    page = (tmp_path / "a" / "report.html").read_text()
    assert "What the step costs" in page
    assert "The step of 1.00 ms costs" in page or "is within 1 %" in page
    summary = json.loads((tmp_path / "a" / "summary.json").read_text())
    assert summary["error_of_step"]["steps"] == [1e-3, 5e-4, 2.5e-4]
    assert main([*asked, "--out", str(tmp_path / "b")]) == 0
    assert "What the step costs" not in (tmp_path / "b" / "report.html").read_text()
    capsys.readouterr()


def test_demo_asks_for_it():
    """Two seconds of computing more: `./run demo` stays quick."""
    assert '"compare", scene, "--out", out, "--error"' in (ROOT / "noxfile.py").read_text()
