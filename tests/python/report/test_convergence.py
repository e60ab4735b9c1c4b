# SPDX-License-Identifier: Apache-2.0
"""What figures tend to as the step is halved."""

import json
import math

import mujoco
import pytest

import volcontact as vc
from volcontact.cli import main
from volcontact.convergence import estimate
from volcontact.running.simulation import SimulationError

STEPS = tuple(1e-3 / 2**level for level in range(5))
# Pressed in by 1 mm, and let go without weight.
SCENE = """<mujoco><option timestep="4e-3" gravity="0 0 0"><flag energy="enable"/></option>
  <worldbody>
  <geom type="plane" size="1 1 1"/>
  <body pos="0 0 .049"><joint type="slide" axis="0 0 1"/>
    <geom name="block" type="box" size=".05 .05 .05" mass="1"/></body></worldbody></mujoco>"""


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
def test_power_of_the_step_is_found_exactly(order):
    found = estimate("f", "N", [3.0 + 0.2 * (h / 1e-3) ** order for h in STEPS], STEPS)
    assert found.kind == "converges"
    assert found.order == pytest.approx(order, abs=1e-6)
    assert found.limit == pytest.approx(3.0, abs=1e-9)
    assert found.error_of_first == pytest.approx(0.2, abs=1e-9)
    # 0.2 (h / 1 ms)^p = 0.03, among the steps that were run or between them.
    exact = 1e-3 * (0.03 / 0.2) ** (1.0 / order)
    assert found.step == max(h for h in STEPS if h <= exact)


def test_step_that_would_do_is_extrapolated():
    found = estimate("f", "N", [1.0 + 5e3 * h for h in STEPS], STEPS)
    assert found.step == pytest.approx(0.01 / 5e3, rel=1e-6)
    assert found.step < STEPS[-1]


@pytest.mark.parametrize("second", [-0.1, 0.5])
def test_bar_holds_the_truth_where_two_powers_mix(second):
    values = [2.0 + 0.3 * (h / 1e-3) + second * (h / 1e-3) ** 2 for h in STEPS]
    found = estimate("f", "N", values, STEPS)
    assert abs(found.limit - 2.0) <= found.error


def test_chaos_has_a_distribution_and_no_limit():
    found = estimate("f", "N", [1.0, 5.0, 2.0, 7.0, 3.0], STEPS)
    assert (found.kind, found.limit, found.step) == ("erratic", None, None)
    assert found.spread() == (1.0, 3.0, 7.0)


def test_what_hardly_changes_has_settled():
    found = estimate("f", "N", [1.5, 1.001, 1.0, 1.002, 1.001], STEPS)
    assert (found.kind, found.limit) == ("settled", 1.001)
    assert found.error == pytest.approx(2e-3)
    assert found.step == STEPS[1]
    same = estimate("f", "N", [0.0] * 5, STEPS)
    assert (same.kind, same.error, same.step) == ("settled", 0.0, STEPS[0])


def test_nothing_is_nothing_however_it_wavers():
    found = estimate("Speed at the end", "m/s", [1e-17, 3e-16, 1e-18, 2e-15, 1e-16], STEPS)
    assert (found.kind, found.step) == ("settled", STEPS[0])
    assert estimate("angle", "degree", [1e-5, 3e-4, 2e-6, 1e-4, 3e-5], STEPS).kind == "settled"


def test_what_swings_about_has_no_order():
    found = estimate("f", "N", [1.0, 2.0, 1.5, 1.75, 1.625], STEPS, within=0.01)
    assert found.kind == "erratic"


def test_what_some_runs_do_not_have():
    assert estimate("first touch", "s", [0.1, None, 0.1, 0.1, 0.1], STEPS).kind == "none"


# A box of 1 kg that was pressed in by 1 mm flies off with v = h sqrt(k / m), k = k_v A / 2.
def test_scene_tends_to_its_closed_form():
    stiffness = 1e6
    exact = 1e-3 * math.sqrt(0.5 * stiffness * 0.01)
    found = vc.converge(
        SCENE,
        duration=0.2,
        quantities=["speed"],
        material={"stiffness": stiffness, "damping": 0.0, "friction": 0.0},
        options={"implicit": "off"},
    )
    (speed,) = found.estimates
    assert found.steps == tuple(4e-3 / 2**level for level in range(5))
    assert abs(speed.values[0] - exact) > 1e-3 * exact  # the step costs something
    assert speed.kind != "erratic"
    assert abs(speed.limit - exact) <= speed.error + 1e-4 * exact
    assert found.geometry == (pytest.approx(0.0, abs=1e-9),)


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        ({"levels": 2}, "levels = 2 must be 3 or more"),
        ({"within": 1.0}, "within = 1 must be above 0 and below 1"),
        ({"quantities": ["colour"]}, "no figure has 'colour' in its name; there are: First touch"),
    ],
)
def test_wrong_requests(request_, message):
    with pytest.raises(SimulationError, match=message):
        vc.converge(SCENE, duration=0.02, **request_)


def test_program_says_what_the_step_costs(tmp_path, capsys):
    scene = tmp_path / "scene.xml"
    scene.write_text(SCENE)
    out = tmp_path / "convergence.json"
    asked = [str(scene), "--duration", "0.1", "--material", "stiffness=1e6"]
    assert main(["converge", *asked, "--levels", "3", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "Largest contact force" in said and "1 % from" in said
    found = json.loads(out.read_text())
    assert found["steps"] == [4e-3, 2e-3, 1e-3]
    assert {figure["kind"] for figure in found["figures"]} <= {
        "converges",
        "settled",
        "erratic",
        "none",
    }
    assert main(["run", *asked, "--error", "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["error_of_step"]["steps"] == [4e-3, 2e-3, 1e-3]
    forces = [f for f in summary["error_of_step"]["figures"] if f["name"] == "Largest penetration"]
    assert forces[0]["values"][0] == summary["volumetric"]["max_penetration"]


def test_chaos_is_said_in_words(tmp_path, capsys, monkeypatch):
    from volcontact import convergence

    scene = tmp_path / "scene.xml"
    scene.write_text(SCENE)

    def wild(name, unit, values, steps, within):
        return estimate(name, unit, [1.0, 5.0, 1.5], steps, within)

    monkeypatch.setattr(convergence, "estimate", wild)
    assert main(["converge", str(scene), "--duration", "0.02", "--levels", "3"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "Largest contact force has no value that these steps tend to: 1.00 N to 5.00 N" in said


def test_runs_that_blow_up_are_told_and_have_no_figures(tmp_path, capsys):
    scene = tmp_path / "scene.xml"
    scene.write_text(SCENE)
    wild = ["--material", "stiffness=1e300", "--option", "implicit=off"]
    assert main(["converge", str(scene), "--duration", "0.1", "--levels", "3", *wild]) == 3
    assert "volumetric contact: " in capsys.readouterr().err


def test_tolerance_of_the_scene_is_the_one_that_is_divided(monkeypatch):
    from volcontact.running import simulation

    asked = []
    simulate = simulation.simulate

    def watched(*arguments, **rest):
        asked.append((rest["options"] or {}).get("tolerance"))
        return simulate(*arguments, **rest)

    monkeypatch.setattr(simulation, "simulate", watched)
    key = '<custom><numeric name="volcontact/option/tolerance" data="1e-5"/></custom>'
    scene = SCENE.replace("</mujoco>", key + '<size nuserdata="9000"/></mujoco>')
    vc.converge(scene, duration=0.02, levels=3)
    assert asked == [None, None, None, pytest.approx(1e-6)]


def test_model_is_not_changed():
    model = mujoco.MjModel.from_xml_string(SCENE)
    found = vc.converge(model, duration=0.02, levels=3, quantities=["energy"], with_tolerance=False)
    assert model.opt.timestep == 4e-3
    assert found.geometry == ()
