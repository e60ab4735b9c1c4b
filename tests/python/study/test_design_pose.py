# SPDX-License-Identifier: Apache-2.0
"""The pose that a scene was designed for: read, and judged."""

import dataclasses
import json

import numpy as np
import pytest
from reports import DESIGN, recording, shifted

from volcontact.report.comparison import (
    is_seated,
    offset_from,
)
from volcontact.report.design_pose import read_design_pose, read_peak_limits

EXPECTED = {
    "body": "box",
    "design_position": [1, 2, 3],
    "design_quaternion": [1, 0, 0, 0],
    "position_tolerance": 2e-3,
    "angle_tolerance_degrees": 0.2,
    "speed_tolerance": 3e-3,
}


def test_design_pose_is_read_from_beside_the_scene(tmp_path):
    scene = tmp_path / "scene.xml"
    assert read_design_pose(scene) is None
    assert read_design_pose("<mujoco/>") is None
    content = {"scenes": {"scene.xml": EXPECTED, "other.xml": {"duration": 1.0}}}
    (tmp_path / "expected.json").write_text(json.dumps(content))
    pose = read_design_pose(scene)
    assert pose.body == "box"
    assert pose.position.tolist() == [1.0, 2.0, 3.0]
    assert pose.quaternion.tolist() == [1.0, 0.0, 0.0, 0.0]
    assert (pose.position_tolerance, pose.angle_tolerance) == (2e-3, 0.2)
    assert pose.speed_tolerance == 3e-3
    assert read_design_pose(tmp_path / "other.xml") is None
    assert read_design_pose(tmp_path / "third.xml") is None


def test_peak_limits_are_read_from_beside_the_scene(tmp_path):
    assert read_peak_limits(tmp_path / "scene.xml") == {}
    content = {"scenes": {"scene.xml": {"peak_limits": {"wrist_force": 111}}, "other.xml": {}}}
    (tmp_path / "expected.json").write_text(json.dumps(content))
    assert read_peak_limits(tmp_path / "scene.xml") == {"wrist_force": 111.0}
    assert read_peak_limits(tmp_path / "other.xml") == {}
    content["scenes"]["scene.xml"]["peak_limits"]["wrist_force"] = "little"
    (tmp_path / "expected.json").write_text(json.dumps(content))
    with pytest.raises(ValueError, match=r"expected\.json: cannot be read"):
        read_peak_limits(tmp_path / "scene.xml")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (None, r"expected\.json: cannot be read"),
        ({"design_position": [1, 2]}, r"expected\.json: cannot be read"),
        ({"design_quaternion": "up"}, r"expected\.json: cannot be read"),
    ],
)
def test_unreadable_design_pose_names_its_file(tmp_path, change, message):
    text = "{" if change is None else json.dumps({"scenes": {"scene.xml": {**EXPECTED, **change}}})
    (tmp_path / "expected.json").write_text(text)
    with pytest.raises(ValueError, match=message):
        read_design_pose(tmp_path / "scene.xml")


def test_incomplete_design_pose_names_what_is_missing(tmp_path):
    content = {"scenes": {"scene.xml": {k: v for k, v in EXPECTED.items() if k != "body"}}}
    (tmp_path / "expected.json").write_text(json.dumps(content))
    with pytest.raises(ValueError, match=r"expected\.json: scene\.xml has no 'body'"):
        read_design_pose(tmp_path / "scene.xml")


def test_seated_needs_place_angle_rest_and_a_whole_run():
    run = recording()
    assert is_seated(run, DESIGN)
    assert is_seated(shifted(run, (0.0009, 0.0, 0.0)), DESIGN)
    assert not is_seated(shifted(run, (0.0011, 0.0, 0.0)), DESIGN)
    assert not is_seated(dataclasses.replace(run, speed=run.speed + 0.002), DESIGN)
    assert not is_seated(dataclasses.replace(run, stopped="bad numbers"), DESIGN)
    half = np.radians(0.2) / 2
    tilt = np.tile([np.cos(half), np.sin(half), 0.0, 0.0], (101, 1, 1))
    tilted = dataclasses.replace(run, quaternion=tilt)
    assert not is_seated(tilted, DESIGN)
    assert offset_from(tilted, DESIGN).angle[-1] == pytest.approx(0.2)


def test_design_pose_of_an_unknown_body_names_the_known_ones():
    with pytest.raises(ValueError, match="'lid', the moving bodies are: box"):
        offset_from(recording(), dataclasses.replace(DESIGN, body="lid"))
