# SPDX-License-Identifier: Apache-2.0
"""Trials of a scene: values arrive where they should, and rows say what happened."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from study_files import SCENE, SCENE_STUDY, scene_study

import volcontact as vc
from volcontact.gym import ForceGuided, OruInsertion
from volcontact.gym.oru_insertion import SCENE as ORU_SCENE
from volcontact.gym.oru_insertion import START
from volcontact.gym.scene_files import scene_file
from volcontact.study.file.reading import parse_study, read_study
from volcontact.study.file.settings import Input
from volcontact.study.mjcf import Document
from volcontact.study.targets import LiveNumbers, changed_text, targets_of
from volcontact.study.trial import Runner

LIVE = [
    "volcontact/material/all/friction",
    "geom/block/friction/0",
    "option/gravity/2",
    "option/timestep",
    "general/push/gainprm/0",
    "motor/pull/forcerange/1",
]
ACTUATED = (
    SCENE.replace("<freejoint/>", '<joint name="slide" type="slide" axis="1 0 0"/>')
    .replace(
        "  <custom>",
        """  <actuator>
    <general name="push" joint="slide" gainprm="3" biasprm="0 -2 -1"/>
    <motor name="pull" joint="slide" forcelimited="true" forcerange="-1 1"/>
  </actuator>
  <custom>""",
    )
    .replace('timestep="0.001"', 'timestep="0.001" gravity="0 0 -9.81"')
    .replace('<geom name="block"', '<geom name="block" friction="0.7 0.01 0.001"')
)


def arrays(model: mujoco.MjModel) -> dict[str, bytes]:
    """Every number of a model."""
    buffer = np.zeros(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, buffer)
    return {"model": buffer.tobytes()}


@pytest.mark.parametrize("text", LIVE)
@pytest.mark.parametrize("mode", ["set", "add", "scale"])
def test_numbers_written_live_are_those_of_the_compiler(text, mode, tmp_path):
    """The model with the number written into it is, byte by byte, the one compiled with it."""
    (tmp_path / "scene.xml").write_text(ACTUATED)
    document = Document(tmp_path / "scene.xml")
    given = Input("x", "distribution", "uniform", targets=(text,), mode=mode)
    (target,) = targets_of(given, document)
    assert target.live
    live = mujoco.MjModel.from_xml_string(document.text())
    LiveNumbers(live, [target]).write({"x": 0.5})
    element = {
        "volcontact": "numeric",
        "option": "option",
    }.get(text.split("/")[0], text.split("/")[0])
    changed = document.copy()
    found = changed.root.find("option") if element == "option" else None
    if found is None:
        found = changed.find(element, target.name)
    numbers = [float(word) for word in changed.attribute(found, target.key).split()]
    place = target.index or 0
    numbers[place] = {"set": 0.5, "add": numbers[place] + 0.5, "scale": 0.5 * numbers[place]}[mode]
    found.set(target.key, " ".join(map(repr, numbers)))
    assert arrays(live) == arrays(mujoco.MjModel.from_xml_string(changed.text()))


def test_size_is_compiled_anew_with_its_mass(tmp_path):
    document = Document(scene_study(tmp_path).parent / "scene.xml")
    given = Input("h", "distribution", "uniform", targets=("geom/block/size/2",))
    targets = targets_of(given, document)
    assert not targets[0].live
    model = mujoco.MjModel.from_xml_string(changed_text(document, targets, {"h": 0.03}))
    block = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_GEOM), "block")
    assert model.geom_size[block] == pytest.approx([0.05, 0.05, 0.03])  # the rest by its class
    assert model.body_mass[1] == pytest.approx(1000.0 * 0.1 * 0.1 * 0.06)


def test_minus_adds_the_other_way(tmp_path):
    document = Document(scene_study(tmp_path).parent / "scene.xml")
    given = Input("d", "x", targets=("body/wall/pos/0", "-body/wall/pos/1"), mode="add")
    targets = targets_of(given, document)
    model = mujoco.MjModel.from_xml_string(changed_text(document, targets, {"d": 0.01}))
    assert model.body_pos[2] == pytest.approx([0.31, -0.01, 0.05])


def test_sliding_distance_and_outcomes(tmp_path):
    """A box that slides comes v^2 / (2 mu g) far; rows say where it stopped and what it lost."""
    path = scene_study(tmp_path)
    runner = Runner(read_study(path))
    speed, friction = 0.7, 0.25
    row = runner.run(0, {"friction": friction, "height": 0.02, "speed": speed})
    assert row["outcome"] == "success" and row["success"]
    # Regularised friction gives way below its slip speed.
    assert row["x"] == pytest.approx(speed**2 / (2 * friction * 9.81), rel=0.03)
    mass = 1000.0 * 0.1 * 0.1 * 0.04
    lost = row["dissipated_slide"] + row["dissipated_spin"]
    assert lost == pytest.approx(0.5 * mass * speed**2, rel=0.02)
    assert row["fastest"] == pytest.approx(speed - friction * 9.81 * 0.001, rel=0.01)
    assert row["first_touch"] == pytest.approx(0.001) and row["most_sites"] >= 1
    assert row["distance"] == pytest.approx(abs(row["x"] - 0.1), abs=1e-4)
    assert row["peak_force_floor"] > 0 and row["peak_force_wall"] == 0
    assert row["place"] == "floor"
    fast = runner.run(1, {"friction": 0.1, "height": 0.02, "speed": 1.5})
    assert fast["outcome"] == "timed_out" and fast["peak_force_wall"] > fast["peak_force_floor"]
    again = runner.run(0, {"friction": friction, "height": 0.02, "speed": speed})
    assert again == row  # whatever ran between
    runner.forget()


@pytest.mark.parametrize(
    ("line", "outcome", "reason"),
    [
        ("force_limit = 1.0", "force_limit", "is above its limit 1 N"),
        ('[jammed]\nfor = 0.05\n"speed/block" = [0.0, 10.0]', "jammed", ""),
        ("[jammed]\nsites = [1, 9]\nfor = 0.1", "jammed", ""),
    ],
)
def test_other_ends(line, outcome, reason, tmp_path):
    text = SCENE_STUDY.replace("duration = 0.4", f"duration = 0.4\n{line}")
    runner = Runner(parse_study(text, scene_study(tmp_path).parent))
    row = runner.run(0, {"friction": 0.1, "height": 0.02, "speed": 1.0})
    runner.forget()
    assert row["outcome"] == outcome and not row["success"]
    assert reason in row["reason"]
    assert row["time"] < 0.4


def test_trial_that_diverges_is_a_row(tmp_path):
    text = SCENE_STUDY.replace("high = 1.5", "high = 1e12")
    runner = Runner(parse_study(text, scene_study(tmp_path).parent))
    row = runner.run(4, {"friction": 0.1, "height": 0.02, "speed": 1e11})
    runner.forget()
    assert row["outcome"] == "diverged" and "BADQ" in row["reason"]
    assert math.isnan(row["x"])


def test_functions_of_the_user(tmp_path):
    (tmp_path / "mine.py").write_text(
        "def ready(model, data, values, rng):\n"
        "    data.qvel[0] = values['speed'] + 1e-6 * rng.normal()\n"
        "def upper(model, data):\n"
        "    return data.xpos[1, 2]\n"
        "def far(model, data):\n"
        "    return data.qpos[0] > 0.1\n"
        "class Pushing:\n"
        "    def __init__(self, model, push=0.0):\n"
        "        self.push = push\n"
        "    def __call__(self, data):\n"
        "        data.xfrc_applied[1, 0] = self.push\n"
    )
    text = SCENE_STUDY.replace(
        'name = "slide"', 'name = "slide"\npython = "mine.py"\nprepare = "ready"'
    )
    text = text.replace('target = "qvel/block/0"', "")
    text = text.replace('target = "volcontact/material/all/friction"', 'target = "control/push"')
    text = text.replace("[success]", '[success]\nfunction = "far"')
    text = text.replace('"position/block/x" = [0.08, 0.2]\n"speed/block" = [0.0, 0.01]\n', "")
    text = text.replace("[record]", '[record]\nfunctions = ["upper"]')
    text += '[control]\npolicy = "Pushing"\nperiod = 0.01\n'
    runner = Runner(parse_study(text, scene_study(tmp_path).parent))
    rows = [runner.run(0, {"friction": push, "height": 0.02, "speed": 0.5}) for push in (0.0, 3.0)]
    assert rows[1]["time"] < rows[0]["time"]  # pushed, it is there earlier
    assert [row["outcome"] for row in rows] == ["timed_out", "success"]
    assert rows[0]["upper"] == pytest.approx(0.02, abs=1e-3)


def test_what_prepare_changes_ends_with_its_trial(tmp_path):
    """The model of the next trial is as it was compiled, and is not compiled again."""
    (tmp_path / "mine.py").write_text(
        "def ready(model, data, values, rng):\n"
        "    if values['speed'] < 0.5:\n"
        "        model.opt.gravity[2] = -3.0\n"
        "        model.opt.timestep = 0.002\n"
        "        model.body_mass[:] *= 2.0\n"
        "        model.numeric('volcontact/material/all/friction').data[0] = 0.9\n"
    )
    path = scene_study(tmp_path)
    alone = Runner(read_study(path)).run(1, {"friction": 0.2, "height": 0.02, "speed": 0.7})
    head = 'name = "slide"\npython = "mine.py"\nprepare = "ready"'
    path.write_text(SCENE_STUDY.replace('name = "slide"', head))
    runner = Runner(read_study(path))
    changed = runner.run(0, {"friction": 0.2, "height": 0.02, "speed": 0.4})
    model = runner.scene({"friction": 0.2, "height": 0.02, "speed": 0.7}).model
    after = runner.run(1, {"friction": 0.2, "height": 0.02, "speed": 0.7})
    assert runner.scene({"friction": 0.2, "height": 0.02, "speed": 0.7}).model is model
    runner.forget()
    assert changed["x"] < 0.5 * after["x"] and after == alone


ORU_STUDY = f"""
[study]
scene = "{scene_file(ORU_SCENE)}"
timestep = 0.005
keyframe = "seated"
[vary.z]
distribution = "uniform"
target = ["qpos/carrier_z", "act/carrier_z"]
[vary.x]
distribution = "uniform"
target = ["qpos/carrier_x", "act/carrier_x"]
[vary.turn]
distribution = "uniform"
target = ["qpos/carrier_turn_y", "act/carrier_turn_y"]
[control]
policy = "force_guided"
[pose]
body = "battery_box"
keyframe = "seated"
[end]
watch = 0.01
duration = 4.6
force = ["sensor/carrier_force_x", "sensor/carrier_force_y", "sensor/carrier_force_z"]
torque = ["sensor/carrier_torque_x", "sensor/carrier_torque_y", "sensor/carrier_torque_z"]
[success]
distance = [0, 1e-3]
"""


ENVIRONMENT_STUDY = """
[study]
environment = "volcontact/ORUInsertion-v0"
[vary.x]
distribution = "uniform"
target = ["qpos/carrier_x", "act/carrier_x"]
[vary.turn]
distribution = "uniform"
target = ["qpos/carrier_turn_y", "act/carrier_turn_y"]
[end]
duration = 4.6
"""


@pytest.mark.parametrize("contact", ["volumetric", "native"])
@pytest.mark.parametrize("head", ["scene", "environment"])
def test_study_of_the_scene_is_the_environment(head, contact, tmp_path):
    """A trial with the scripted insertion has the forces of an episode, to the last bit."""
    text = ORU_STUDY.replace("timestep", f'contact = "{contact}"\ntimestep')
    error = np.array([0.004, 0.0, 0.0, 0.0, -0.006, 0.0])
    values = {"x": error[0], "z": START[2], "turn": error[4]}
    if head == "environment":
        text = ENVIRONMENT_STUDY.replace("[vary.x]", f'contact = "{contact}"\n[vary.x]')
        del values["z"]
    runner = Runner(parse_study(text, tmp_path))
    row = runner.run(0, values)
    runner.forget()
    env = OruInsertion(contact=contact)
    observation, _ = env.reset(options={"misalignment": error})
    policy = ForceGuided()
    for _ in range(46):
        observation, *_, info = env.step(policy(observation))
    env.close()
    assert row["outcome"] == "timed_out" and info["peak_force"] > 5.0
    assert (row["peak_force"], row["peak_torque"]) == (info["peak_force"], info["peak_torque"])


def test_an_environment_brings_its_goal(tmp_path):
    """Seated as the episode, which looks whether it is at the end of each action only."""
    runner = Runner(parse_study(ENVIRONMENT_STUDY.replace("duration = 4.6", ""), tmp_path))
    row = runner.run(0, {"x": 0.001, "turn": 0.0})
    runner.forget()
    env = OruInsertion()
    observation, _ = env.reset(options={"misalignment": [0.001, 0, 0, 0, 0, 0]})
    policy = ForceGuided()
    terminated, actions = False, 0
    while not terminated:
        observation, _, terminated, _, info = env.step(policy(observation))
        actions += 1
    env.close()
    assert info["is_success"] and row["outcome"] == "success"
    assert 0.0 <= 0.1 * actions - row["time"] < 0.3


def test_table_names_a_scene_and_its_meshes(tmp_path):
    """A scene with includes and meshes is the same model as text."""
    for name in ("acu_insert/scene.xml", "peg_in_hole/scene_mesh.xml", ORU_SCENE):
        path = scene_file(ORU_SCENE).parents[1] / name
        if path.is_file():
            text = Document(path).text()
            ours, theirs = mujoco.MjModel.from_xml_string(text), vc.load(path)
            for array in ("geom_size", "geom_pos", "mesh_vert", "qpos0", "body_mass"):
                assert np.array_equal(getattr(ours, array), getattr(theirs, array))
