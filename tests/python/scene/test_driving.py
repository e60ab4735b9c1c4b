# SPDX-License-Identifier: Apache-2.0
"""Runs that start at a keyframe and follow controls, held or out of a table."""

import re

import mujoco
import numpy as np
import pytest

from volcontact.running.control_table import ControlTable, read_controls
from volcontact.running.driving import Drive
from volcontact.running.simulation import simulate

MASS = 2.0
SCENE = f"""
<mujoco>
  <option timestep="0.001" gravity="0 0 0"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="cart" pos="0 0 1">
      <joint name="rail" type="slide" axis="1 0 0"/>
      <geom name="cart" type="box" size="0.1 0.1 0.1" mass="{MASS}"/>
    </body>
  </worldbody>
  <actuator>
    <motor name="push" joint="rail" gear="3" ctrllimited="true" ctrlrange="-2 2"/>
    <motor joint="rail"/>
  </actuator>
  <keyframe>
    <key name="left" qpos="-0.5"/>
    <key qpos="0.25" ctrl="1 0"/>
  </keyframe>
</mujoco>
"""


def run(drive, duration=0.5, scene=SCENE, **rest):
    return simulate(scene, duration=duration, frame_interval=None, drive=drive, **rest)


@pytest.mark.parametrize("contact", ["volumetric", "native"])
def test_held_control_accelerates_by_its_force(contact):
    made = run(Drive(controls={"push": 0.5}), contact=contact)
    acceleration = 3.0 * 0.5 / MASS
    np.testing.assert_allclose(made.qvel[:, 0], acceleration * made.time, atol=1e-12)
    assert made.signals["actuator.push.control"].values.tolist() == [0.5] * 501
    np.testing.assert_allclose(made.signals["actuator.push.force"].values, 0.5)
    np.testing.assert_array_equal(made.signals["joint.rail.position"].values, made.qpos[:, 0])
    assert made.signals["joint.rail.position"].unit == "m"


def test_table_is_linear_between_its_rows_and_stays_beyond_them():
    table = ControlTable(np.array([0.1, 0.3]), {"push": np.array([1.0, -1.0])})
    made = run(Drive(table=table))
    expected = np.clip(1.0 - 10.0 * (made.time - 0.1), -1.0, 1.0)
    control = made.signals["actuator.push.control"].values
    np.testing.assert_allclose(control, expected, atol=1e-12)
    # Semi-implicit Euler: the speed is the sum of the accelerations before it.
    speed = 3.0 / MASS * 1e-3 * np.concatenate([[0.0], np.cumsum(control[:-1])])
    np.testing.assert_allclose(made.qvel[:, 0], speed, atol=1e-12)


@pytest.mark.parametrize("kind", ["csv", "parquet"])
def test_table_of_a_file(kind, tmp_path):
    path = tmp_path / f"controls.{kind}"
    if kind == "csv":
        path.write_text("time, push,actuator 1\n0,0,1\n\n0.5,2,-1e-1\n", encoding="utf-8")
    else:
        pa = pytest.importorskip("pyarrow")
        import pyarrow.parquet as pq

        columns = {"time": [0.0, 0.5], "push": [0, 2], "actuator 1": [1.0, -0.1]}
        pq.write_table(pa.table(columns), path)
    made = run(Drive(table=path))
    np.testing.assert_allclose(made.signals["actuator.push.control"].values, 4.0 * made.time)
    other = made.signals["actuator.actuator 1.control"].values
    np.testing.assert_allclose(other, 1.0 - 2.2 * made.time, atol=1e-12)
    assert made.notes[-1].startswith("starts at the pose of the file")


def test_keyframe_by_name_and_by_number_brings_its_controls():
    assert run(Drive(keyframe="left"), 0.01).qpos[0, 0] == -0.5
    made = run(Drive(keyframe="keyframe 1"), 0.01)
    assert (made.qpos[0, 0], made.signals["actuator.push.control"].values[0]) == (0.25, 1.0)
    assert not any("push" in note for note in made.notes)


def test_notes_say_what_is_left_as_it_is():
    first, second = run(Drive(), 0.01).notes
    assert first == (
        "starts at the pose of the file; keyframes 'left' and 'keyframe 1' are not used: "
        "--keyframe NAME starts at one"
    )
    assert second.startswith("actuators 'push' and 'actuator 1' stay at control 0: --ctrl")
    (taken, _) = run(None, 0.01, SCENE.replace('name="left"', 'name="start"')).notes
    assert taken == "starts at the keyframe 'start', which is taken unasked"
    (cut, _) = run(Drive("left", {"push": 2.5}), 0.01).notes
    assert cut.startswith("control 2.5 of 'push' is outside of its ctrlrange from -2 to 2")
    assert run(Drive("left", {"push": 1.0, "actuator 1": 0.0}), 0.01).notes == ()


def test_many_actuators_are_counted():
    many = "".join(f'<motor name="m{i}" joint="rail"/>' for i in range(9))
    scene = SCENE.replace('<motor joint="rail"/>', many).replace('ctrl="1 0"', "")
    assert "10 actuators stay at control 0" in run(Drive("left"), 0.01, scene).notes[0]


@pytest.mark.parametrize(
    ("drive", "words"),
    [
        (Drive(controls={"psh": 1.0}), "no actuator 'psh'; did you mean 'push'?"),
        (Drive(controls={"push": np.nan}), "control 'push' = nan must be a finite number"),
        (Drive(controls={"push": "1"}), "control 'push' = '1' must be a finite number"),
        (Drive(keyframe="letf"), "no keyframe 'letf'; did you mean 'left'?"),
        (
            Drive(None, {"push": 1.0}, ControlTable(np.zeros(1), {"push": np.zeros(1)})),
            "'push' is driven twice",
        ),
        (
            Drive(table=ControlTable(np.zeros(1), {"pull": np.zeros(1)}, "c.csv")),
            "c.csv: the scene has no actuator 'pull'",
        ),
    ],
)
def test_wrong_drive_is_named(drive, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        run(drive)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time,push\n0,1\n1,two\n", "c.csv:3: 'two' in column 'push': every cell"),
        ("time,push\n0,nan\n", "c.csv:2: 'nan' in column 'push'"),
        ("time,push\n0,1\n0,2\n", "row 2: time 0 s comes after 0 s: times must rise"),
        ("time,push\n1,1\n0,2\n", "row 2: time 0 s comes after 1 s: times must rise"),
        ("t,push\n0,1\n", "has no column 'time', but t, push"),
        ("time,push,push\n0,1,1\n", "has 2 columns named 'push'"),
        ("time,push\n0\n", "c.csv:2: has 1 cells for 2 columns"),
        ("time,push\n", "has no rows"),
        ("time\n0\n", "has no column besides 'time'"),
        ("time,push\n0,inf\n", "row 1 of column 'push' is inf"),
        ("", "has no column 'time', but none"),
    ],
)
def test_wrong_file_says_where(text, words, tmp_path):
    path = tmp_path / "c.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=re.escape(words)) as caught:
        read_controls(path)
    assert "\n" not in str(caught.value)


def test_file_that_is_none(tmp_path):
    with pytest.raises(FileNotFoundError, match="no such file of controls"):
        read_controls(tmp_path / "c.csv")
    (tmp_path / "c.txt").write_text("")
    with pytest.raises(ValueError, match=r"is neither \.csv nor \.parquet"):
        read_controls(tmp_path / "c.txt")
    pytest.importorskip("pyarrow")
    (tmp_path / "c.parquet").write_text("time,push\n0,1\n")
    with pytest.raises(ValueError, match="is no Parquet file"):
        read_controls(tmp_path / "c.parquet")


def test_the_model_given_is_not_changed():
    model = mujoco.MjModel.from_xml_string(SCENE)
    run(Drive("left", {"push": 1.0}), scene=model)
    assert model.key_qpos[0, 0] == -0.5
