# SPDX-License-Identifier: Apache-2.0
"""The first readings of a scene say what is hardly meant: sinking bodies, grasps that creep."""

import re
import warnings

import mujoco
import pytest

import volcontact as vc

SINKS = r"left and cube rest [\d.]+ mm deep in each other, [\d.]+ % of the size of the smaller one"
CREEPS = "what left holds of cube creeps: friction_law regularized_coulomb slides under any load"
GRIPPER = """
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <body name="left" pos="-0.05 0 0.1">
      <joint name="left" type="slide" axis="1 0 0" damping="20"/>
      <geom name="left" type="box" size="0.01 0.01 0.03" mass="0.2"/>
    </body>
    <body name="right" pos="0.05 0 0.1">
      <joint name="right" type="slide" axis="-1 0 0" damping="20"/>
      <geom name="right" type="box" size="0.01 0.01 0.03" mass="0.2"/>
    </body>
    <body name="cube" pos="0 0 0.08">
      <freejoint/>
      <geom name="cube" type="box" size="0.02 0.02 0.02" mass="0.3" friction="0.6"/>
    </body>
    <geom name="table" type="box" size="0.03 0.03 0.03" pos="0 0 0.03"/>
  </worldbody>
  <actuator>
    <motor name="left" joint="left"/>
    <motor name="right" joint="right"/>
  </actuator>
</mujoco>
"""


def warned(material, *, read=lambda contact, data: contact.sites(data), steps=600):
    """What is said while the gripper closes, with a reading after each step."""
    model = vc.load(GRIPPER, material=material)
    data = mujoco.MjData(model)
    data.ctrl[:] = 15.0
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        with vc.attach(model, material=material) as contact:
            for _ in range(steps):
                mujoco.mj_step(model, data)
                read(contact, data)
    assert all(warning.category is RuntimeWarning for warning in said)
    assert all(warning.filename == __file__ for warning in said)
    return [str(warning.message) for warning in said]


def test_fingers_that_sink_are_told_once():
    said = [line for line in warned({"stiffness": 1e7}) if "left and cube" in line]
    assert len(said) == 1 and re.match(SINKS, said[0])


@pytest.mark.parametrize("reading", ["energy", "contact_forces"])
def test_every_reading_looks(reading):
    said = warned({"stiffness": 1e7}, read=lambda c, data: getattr(c, reading)(data))
    assert any("deep in each other" in line for line in said)


def test_a_grasp_that_creeps_is_told_once_a_finger():
    law = {"stiffness": 1e10, "friction_law": "regularized_coulomb"}
    said = warned(law)
    assert sum(line.startswith(CREEPS) for line in said) == 1
    assert len(said) == 2  # and the right finger


def test_a_stiff_grasp_that_sticks_says_nothing():
    assert warned({"stiffness": 1e10}) == []


def test_a_body_that_begins_in_another_is_given_time_to_part():
    """It was put there; that it rests there is not known before it has been seen for a while."""
    assert warned({"stiffness": 1e7}, steps=40) == []


def test_a_run_tells_it_in_its_notes_alone():
    from volcontact.running.driving import Drive
    from volcontact.running.simulation import simulate

    drive = Drive(controls={"left": 15, "right": 15})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = simulate(GRIPPER, duration=1.0, drive=drive, frame_interval=None)
    assert any("deep in each other" in note for note in run.notes)
