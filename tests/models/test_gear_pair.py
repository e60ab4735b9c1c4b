# SPDX-License-Identifier: Apache-2.0
"""Gears as meshes transmit angles and torques as gears do."""

from __future__ import annotations

import importlib.util
import math
import sys
from pathlib import Path
from types import ModuleType

import mujoco
import numpy as np
import pytest

import volcontact as vc

FOLDER = Path(__file__).parents[2] / "mjcf_models" / "gear_pair"
CENTER_DISTANCE = 0.03  # [m]
BRAKE = 0.02  # damping of the wheel [N m s]


def script(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"gear_pair_{name}", FOLDER / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its dataclasses look there
    spec.loader.exec_module(module)
    return module


gears = script("make_meshes")
PLAY = gears.BACKLASH / gears.WHEEL.pitch_radius  # of the wheel when the pinion is held [rad]


def test_mesh_files_are_what_the_script_writes(tmp_path: Path) -> None:
    gears.write(tmp_path)
    written = sorted(tmp_path.iterdir())
    assert [path.name for path in written] == sorted(p.name for p in (FOLDER / "meshes").iterdir())
    for path in written:
        assert path.read_text() == (FOLDER / "meshes" / path.name).read_text()


def test_gear_is_as_thick_as_its_outline_says() -> None:
    """Volume = width x (area of the polygons inside and outside), by the shoelace formula."""

    def area(points: np.ndarray) -> float:
        x, y = points.T
        return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))

    outside = gears.outline(gears.PINION)
    inside = gears.PINION.bore * outside / np.linalg.norm(outside, axis=1, keepdims=True)
    volume = vc.Mesh(*gears.mesh(gears.PINION)).own_metrics().volume
    assert volume == pytest.approx(gears.PINION.width * (area(outside) - area(inside)), rel=1e-12)


def test_flanks_are_involutes() -> None:
    """The normal of an involute touches the base circle, wherever it stands."""
    radii, half_angles = gears.flank(gears.WHEEL, 4000)
    flank = radii[:, None] * np.stack([np.cos(half_angles), np.sin(half_angles)], axis=1)
    along = np.diff(flank[1:], axis=0)
    middle = 0.5 * (flank[1:-1] + flank[2:])
    # Distance of the normal from the axis = component of the place along the flank.
    distance = np.abs(np.sum(middle * along, axis=1)) / np.linalg.norm(along, axis=1)
    assert distance == pytest.approx(gears.WHEEL.base_radius, rel=1e-4)


@pytest.mark.parametrize(("points", "excess"), [(10, 0.25e-3), (40, 0.016e-3)])
def test_play_is_the_backlash(points: int, excess: float) -> None:
    """Held pinion: the wheel is free by half the play on either side.

    Inscribed chords make teeth thinner, by c^2 / 8 R in the middle of a chord c: less than 0.25
    mrad with 10 chords a flank and a 16th of that with 40.
    """
    pinion = vc.Mesh(*gears.mesh(gears.PINION, points))
    wheel = vc.Mesh(*gears.mesh(gears.WHEEL, points))

    def overlap(turned: float) -> float:
        angle = math.pi / gears.WHEEL.teeth + turned
        pose = np.eye(4)
        pose[:2, :2] = [
            [math.cos(angle), -math.sin(angle)],
            [math.sin(angle), math.cos(angle)],
        ]
        pose[0, 3] = CENTER_DISTANCE
        return vc.interference(pinion, wheel, pose).volume

    for side in (-1.0, 1.0):
        assert overlap(side * 0.5 * PLAY) == 0.0
        assert overlap(side * (0.5 * PLAY + excess)) > 0.0


class Work:
    """A run of the scene over a whole number of teeth, after the first 30 ms.

    Attributes:
        angles, speeds: of pinion and wheel [rad], [rad/s], shape (n, 2).
        torque: of the motor [N m], shape (n,).
    """

    def __init__(self, friction: float) -> None:
        model = vc.load(FOLDER / "scene.xml")
        model.numeric("volcontact/material/teeth/friction").data[0] = friction
        data = mujoco.MjData(model)
        rows = []
        with vc.attach(model):
            for _ in range(round(0.25 / model.opt.timestep)):
                mujoco.mj_step(model, data)
                rows.append([*data.qpos, *data.qvel, data.actuator_force[0]])
        table = np.array(rows)[round(0.03 / model.opt.timestep) :]
        teeth = 5 * 2 * math.pi / gears.PINION.teeth
        table = table[: np.searchsorted(table[:, 0], table[0, 0] + teeth)]
        self.angles, self.speeds, self.torque = table[:, :2], table[:, 2:4], table[:, 4]

    def efficiency(self) -> float:
        return float(-BRAKE * np.mean(self.speeds[:, 1]) / 2 / np.mean(self.torque))


@pytest.fixture(scope="module")
def work() -> Work:
    return Work(friction=0.1)


def test_angles_have_the_ratio_of_the_teeth(work: Work) -> None:
    """The wheel lags by half the play, the chords' 0.25 mrad and what the teeth give."""
    lag = work.angles[:, 1] + work.angles[:, 0] / 2
    assert lag.min() > 0.5 * PLAY
    assert lag.max() < 0.5 * PLAY + 0.5e-3
    assert work.angles[-1, 0] - work.angles[0, 0] > 1.5


def test_transmission_is_smooth(work: Work) -> None:
    """Within 0.1 mrad, the 2 um of a chord's sagitta on the wheel, and half a per cent of speed."""
    lag = work.angles[:, 1] + work.angles[:, 0] / 2
    assert np.ptp(lag) < 0.2e-3
    for shaft in (0, 1):
        speeds = work.speeds[:, shaft]
        assert np.std(speeds) < 5e-3 * abs(np.mean(speeds))


def test_without_friction_torques_have_the_ratio_of_the_teeth() -> None:
    work = Work(friction=0.0)
    assert work.efficiency() == pytest.approx(1.0, abs=1e-3)
    # Motor 0.05 (10 - w) = brake 0.02 (w / 2) / 2.
    assert np.mean(work.speeds[:, 0]) == pytest.approx(0.5 / 0.055, rel=1e-4)


def test_friction_costs_what_sliding_along_the_line_of_action_costs(work: Work) -> None:
    """Loss factor of Ohlendorf: two pairs of teeth in contact share the load equally."""
    mu, teeth = 0.1, (gears.PINION.teeth, gears.WHEEL.teeth)
    pitch = math.pi * gears.MODULE * math.cos(gears.PRESSURE_ANGLE)  # along the line of action
    parts = []
    for gear in (gears.PINION, gears.WHEEL):
        tip = gear.pitch_radius + gears.ADDENDUM * gears.MODULE
        reach = math.sqrt(tip**2 - gear.base_radius**2)
        parts.append((reach - gear.pitch_radius * math.sin(gears.PRESSURE_ANGLE)) / pitch)
    a, b = parts
    loss = mu * math.pi * (1 / teeth[0] + 1 / teeth[1]) * (1 - a - b + a * a + b * b)
    assert loss == pytest.approx(0.0166, abs=1e-4)
    # Friction is a little less where the teeth hardly slide, at the pitch point.
    assert 1.0 - work.efficiency() == pytest.approx(loss, rel=0.05)


def test_under_native_contact_hulls_overlap_and_gears_slip() -> None:
    """The hulls are discs of 11 and 21 mm on shafts 30 mm apart: they never part."""
    model = mujoco.MjModel.from_xml_path(str(FOLDER / "scene.xml"))
    model.opt.timestep = 1e-4
    data = mujoco.MjData(model)
    slip = 0.0
    for _ in range(500):
        mujoco.mj_step(model, data)
        assert data.ncon > 0
        slip = max(slip, abs(data.qpos[1] + data.qpos[0] / 2))
    mujoco.mj_forward(model, data)
    assert min(contact.dist for contact in data.contact[: data.ncon]) < -1.5e-3
    assert slip > 2 * PLAY
