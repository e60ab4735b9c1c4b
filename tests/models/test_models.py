# SPDX-License-Identifier: Apache-2.0
"""Every scene of mjcf_models runs without a MuJoCo warning and meets its expected.json."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact._mujoco_views import dense
from volcontact.running.simulation import to_start

MODELS = Path(__file__).parents[2] / "mjcf_models"
SLOW = {"peg_in_hole/scene_tight_mesh.xml-5e-05"}  # as scene_mesh.xml, in a narrower hole


def scenes() -> list[Any]:
    """Scenes at each step length that they give: the shorter ones, and slow ones, once."""
    found = []
    for file in sorted(MODELS.rglob("expected.json")):
        for name, expected in json.loads(file.read_text())["scenes"].items():
            for place, timestep in enumerate(expected["timesteps"]):
                scene = file.parent / name
                label = f"{file.parent.name}/{name}-{timestep}"
                marks = [pytest.mark.once] if place or label in SLOW else []
                found.append(pytest.param(scene, expected, timestep, id=label, marks=marks))
    return found


@dataclass
class Run:
    """What the end of a run looks like."""

    model: mujoco.MjModel
    data: mujoco.MjData
    sites: np.ndarray
    start: np.ndarray  # positions of the bodies [m]
    unaccounted: float  # change of kinetic + potential + elastic + dissipated energy, relative
    peak_sites: int = 0
    peaks: dict[str, float] = field(default_factory=dict)  # of the norms of sensors
    warnings: list[str] = field(default_factory=list)


def run(scene: Path, expected: dict[str, Any], timestep: float) -> Run:
    """`expected` says for how long, and which peaks on the way are of interest."""
    duration = expected["duration"]
    model = vc.load(str(scene))
    model.opt.timestep = timestep
    data = mujoco.MjData(model)
    to_start(model, data)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        start, first = data.xpos.copy(), energies(data, contact)
        asked = expected.get("peak_limits", {})
        groups = {name: at for name, at in sensor_groups(model).items() if name in asked}
        peak, peaks, sensordata = 0, dict.fromkeys(groups, 0.0), data.sensordata
        for step in range(round(duration / timestep)):
            mujoco.mj_step(model, data)
            for name, numbers in groups.items():
                peaks[name] = max(peaks[name], float(np.linalg.norm(sensordata[numbers])))
            if step % 5 == 0 and "minimum_peak_sites" in expected:
                peak = max(peak, len(contact.sites(data)))
        assert data.time == pytest.approx(duration)
        mujoco.mj_forward(model, data)
        last = energies(data, contact)
        turned_over = first[1] + last[1] + abs(last[0] - first[0])
        unaccounted = abs(sum(last) - sum(first)) / turned_over if turned_over > 0.0 else 0.0
        result = Run(model, data, contact.sites(data).copy(), start, unaccounted, peak, peaks)
    for kind in range(len(data.warning)):
        if data.warning[kind].number:
            result.warnings.append(str(mujoco.mjtWarning(kind)))
    return result


def sensor_groups(model: mujoco.MjModel) -> dict[str, list[int]]:
    """Places in sensordata by name; NAME_x, NAME_y and NAME_z are one."""
    groups: dict[str, list[int]] = {}
    for sensor in range(model.nsensor):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_SENSOR, sensor)
        start = int(model.sensor_adr[sensor])
        numbers = range(start, start + int(model.sensor_dim[sensor]))
        groups.setdefault(name.removesuffix("_x").removesuffix("_y").removesuffix("_z"), []).extend(
            numbers
        )
    return groups


def energies(data: mujoco.MjData, contact: vc.Contact) -> tuple[float, float]:
    """Potential energy, and the sum of all others [J]; zeros where the scene asks for none."""
    potential, kinetic = dense(data.energy)
    of_contacts = contact.energy(data)
    return float(potential), float(kinetic) + of_contacts.elastic + of_contacts.dissipated


def tilt_degrees(quaternion: np.ndarray, design: list[float]) -> float:
    return math.degrees(2 * math.acos(min(1.0, abs(float(np.dot(quaternion, design))))))


@pytest.mark.parametrize(("scene", "expected", "timestep"), scenes())
def test_scene_meets_its_numbers(scene: Path, expected: dict[str, Any], timestep: float) -> None:
    result = run(scene, expected, timestep)
    assert result.warnings == []
    assert np.isfinite(result.data.qpos).all()
    assert np.abs(result.data.cvel).max() < expected["speed_tolerance"]
    if "minimum_peak_sites" in expected:
        assert result.peak_sites >= expected["minimum_peak_sites"]
    if "final_sites" in expected:
        assert len(result.sites) == expected["final_sites"]
    if "design_position" in expected:
        check_design_pose(result, expected)
    if "depth" in expected:
        depth = expected["touching_height"] - result.data.body(expected["body"]).xpos[2]
        assert depth == pytest.approx(expected["depth"], rel=expected["depth_relative_tolerance"])
    if "layer_heights" in expected:
        check_layers(result, expected)
    if "displacement" in expected:
        moved = result.data.body(expected["body"]).xpos - result.start[body_id(result, expected)]
        distance = np.linalg.norm(moved - np.array(expected["displacement"]))
        assert distance < expected["displacement_tolerance"]
    if "tilt_degrees" in expected:
        low, high = expected["tilt_degrees"]
        upright = result.data.xmat[body_id(result, expected)][8]
        assert low <= math.degrees(math.acos(np.clip(upright, -1.0, 1.0))) <= high
    if "energy_tolerance" in expected:
        assert result.unaccounted < expected["energy_tolerance"]
    for name, limit in expected.get("peak_limits", {}).items():
        assert 0.0 < result.peaks[name] < limit
    for name, (value, tolerance) in expected.get("final_sensors", {}).items():
        address = int(result.model.sensor(name).adr[0])
        assert result.data.sensordata[address] == pytest.approx(value, abs=tolerance)
    for joint, speed in expected.get("joint_speeds", {}).items():
        found = result.data.joint(joint).qvel[0]
        assert found == pytest.approx(speed, rel=expected["joint_speed_relative_tolerance"])


def body_id(result: Run, expected: dict[str, Any]) -> int:
    return mujoco.mj_name2id(result.model, mujoco.mjtObj.mjOBJ_BODY, expected["body"])


def check_design_pose(result: Run, expected: dict[str, Any]) -> None:
    body = result.data.body(expected["body"])
    offset = body.xpos - np.array(expected["design_position"])
    assert np.linalg.norm(offset) < expected["position_tolerance"]
    assert (
        tilt_degrees(body.xquat, expected["design_quaternion"])
        < (expected["angle_tolerance_degrees"])
    )
    if "rest_drop" not in expected:
        return
    assert -offset[2] == pytest.approx(expected["rest_drop"], abs=expected["rest_drop_tolerance"])
    # Every run within half the spread of the one equilibrium: all agree within the spread, over
    # time steps and MuJoCo releases.
    equilibrium = np.array([0.0, 0.0, -expected["rest_drop"]])
    assert np.linalg.norm(offset - equilibrium) < 0.5 * expected["final_pose_spread"]


def check_layers(result: Run, expected: dict[str, Any]) -> None:
    bodies = range(1, result.model.nbody)
    free = [b for b in bodies if result.model.body_jntnum[b]]
    assert len(free) == expected["bodies"]
    for height in (result.data.xpos[b][2] for b in free):
        nearest = min(abs(height - layer) for layer in expected["layer_heights"])
        assert nearest < expected["layer_height_tolerance"]
    support = mujoco.mj_name2id(result.model, mujoco.mjtObj.mjOBJ_GEOM, expected["support_geom"])
    on_a = result.sites[result.sites["geom_a"] == support]["force"][:, 2].sum()
    on_b = result.sites[result.sites["geom_b"] == support]["force"][:, 2].sum()
    assert on_b - on_a == pytest.approx(
        expected["support_force"], rel=expected["support_force_relative_tolerance"]
    )


def test_every_scene_loads_and_runs_in_plain_mujoco() -> None:
    for scene in sorted(MODELS.rglob("scene*.xml")):
        model = mujoco.MjModel.from_xml_path(str(scene))
        data = mujoco.MjData(model)
        for _ in range(200):
            mujoco.mj_step(model, data)
        assert np.isfinite(data.qpos).all(), scene


def test_every_model_folder_is_complete() -> None:
    table = (MODELS / "README.md").read_text()
    # Those of identification have tests in tests/python/identify; studies vary scenes.
    others = {"identification", "studies"}
    folders = [p for p in MODELS.iterdir() if p.is_dir() and p.name not in others]
    for folder in sorted(folders):
        for name in ("scene.xml", "README.md", "expected.json"):
            assert (folder / name).is_file(), f"{folder.name} lacks {name}"
        assert f"[{folder.name}]" in table, f"mjcf_models/README.md does not list {folder.name}"
