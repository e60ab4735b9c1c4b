# SPDX-License-Identifier: Apache-2.0
"""The audit: in which step contact made energy, how much and where."""

import json
from pathlib import Path

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact.cli import main
from volcontact.running.simulation import simulate

MODELS = Path(__file__).resolve().parents[3] / "mjcf_models"

# Explicit steps far beyond what they hold: the box leaves with more than it came with.
SCENE = """
<mujoco>
  <option timestep="0.002" gravity="0 0 0"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 .1"/>
    <body pos="0 0 .11"><freejoint/><geom name="block" type="box" size=".1 .1 .1" mass="2"/></body>
    <body pos="1 0 .3"><freejoint/><geom name="far" type="sphere" size=".1" mass="1"/></body>
  </worldbody>
  <keyframe>
    <key name="start" qpos="0 0 .11 1 0 0 0 1 0 .3 1 0 0 0" qvel="0 0 -10 0 0 0 0 0 0 0 0 0"/>
  </keyframe>
</mujoco>
"""
MATERIAL = {"stiffness": 1e9, "damping": 1.0}


def run(implicit):
    return simulate(
        SCENE,
        duration=0.04,
        frame_interval=None,
        material=MATERIAL,
        options={"implicit": implicit},
    )


def test_a_step_that_made_energy_is_named_with_its_geoms():
    recording = run("off")
    audit = recording.audit()
    kinetic = recording.kinetic
    row = int(np.argmax(np.diff(kinetic))) + 1
    assert kinetic[row] > 1.5 * kinetic[0]  # MuJoCo's own figure: energy was made
    assert audit.time == pytest.approx(recording.time[row])
    grown = np.diff(kinetic + recording.elastic)[row - 1]
    assert audit.made == pytest.approx(grown, rel=1e-9)
    assert audit.share == pytest.approx(grown / (kinetic + recording.elastic)[row - 1], rel=1e-9)
    assert [set(pair) for pair in audit.geoms] == [{"floor", "block"}]


def test_safe_steps_make_none():
    recording = run("auto")
    assert recording.audit().made <= 1e-9 * recording.kinetic[0]
    assert recording.kinetic[-1] <= recording.kinetic[0]


def test_the_recorder_says_the_same():
    model = vc.load(SCENE)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    with vc.attach(model, material=MATERIAL, options={"implicit": "off"}) as contact:
        recorder = vc.Recorder(contact)
        recorder.record(data)
        for _ in range(20):
            mujoco.mj_step(model, data)
            recorder.record(data)
        audit = recorder.audit()
    expected = run("off").audit()
    assert audit.geoms == expected.geoms
    assert audit[:3] == pytest.approx(expected[:3], rel=1e-9)


def test_a_recorder_without_rows_has_an_audit():
    model = vc.load(SCENE)
    with vc.attach(model) as contact:
        assert vc.Recorder(contact).audit() == (0.0, 0.0, 0.0, ())


@pytest.mark.parametrize(("implicit", "says"), [("off", "floor"), ("auto", "none")])
def test_run_prints_it_where_it_is_asked_for(implicit, says, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.xml").write_text(SCENE)
    keys = ["--material", "stiffness=1e9", "--material", "damping=1"]
    command = ["run", "scene.xml", "--duration", "0.04", *keys, "--option", f"implicit={implicit}"]
    assert main([*command, "--audit"]) == 0
    line = next(x for x in capsys.readouterr().out.splitlines() if "Most energy made" in x)
    assert says in line
    assert main([*command, "--json"]) == 0
    audit = json.loads(capsys.readouterr().out)["volumetric"]["audit"]
    assert (audit["made"] > 1.0) == (implicit == "off")


def test_books_of_the_demo_close_at_its_step():
    model = vc.load(str(MODELS / "battery_box" / "scene.xml"))
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        for _ in range(1000):
            mujoco.mj_step(model, data)
        energy = contact.energy(data)
    assert model.opt.timestep == 1e-3
    assert energy.work < -500.0
    assert abs(energy.numerical) < 1e-3 * abs(energy.work)  # 2 % were asked; 20 % it was
    spent = energy.dissipated
    assert energy.work + energy.elastic + spent + energy.numerical == pytest.approx(0.0, abs=1e-9)
