# SPDX-License-Identifier: Apache-2.0
"""Scenes of insertion in orbit: what their numbers rest on, and what native contact does."""

from __future__ import annotations

import importlib.util
import json
import math
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact.running.simulation import to_start

MODELS = Path(__file__).parents[2] / "mjcf_models"


def script(folder: str, name: str) -> ModuleType:
    path = MODELS / folder / f"{name}.py"
    spec = importlib.util.spec_from_file_location(f"{folder}_{name}", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


jamming = script("rpcm_rails", "jamming")
seats = script("acu_insert", "make_meshes")
arm_path = script("canadarm_berth", "path")


@pytest.mark.parametrize("depth", [0.09, 0.12])
def test_card_jams_where_the_closed_form_says_so(depth: float) -> None:
    """Three hundredths inside of l / (2 mu) it slides, as far outside it jams."""
    assert jamming.travel(depth, 0.97 * jamming.limit(depth)) > 1e-3
    assert jamming.jams(depth, 1.03 * jamming.limit(depth))


def test_jammed_card_is_held_for_good() -> None:
    """Bristles do not creep: what it moves is what they give, and the walls."""
    assert jamming.travel(0.09, 1.3 * jamming.limit(0.09)) < 3e-5


def test_under_native_contact_a_jammed_card_creeps() -> None:
    assert jamming.travel(0.09, 1.3 * jamming.limit(0.09), native=True) > 1e-4


def test_mesh_files_of_the_seats_are_what_the_script_writes(tmp_path: Path) -> None:
    seats.write(tmp_path)
    for path in sorted(tmp_path.iterdir()):
        assert path.read_text() == (MODELS / "acu_insert" / "meshes" / path.name).read_text()


def test_cone_and_cup_have_the_volume_of_their_prismoids() -> None:
    """A frustum of n chords has n/2 sin(2 pi/n) / pi of the round one's volume."""
    share = seats.CHORDS / 2 * math.sin(2 * math.pi / seats.CHORDS) / math.pi

    def frustum(r: float, s: float, height: float) -> float:
        return math.pi * height / 3 * (r * r + r * s + s * s)

    cone = vc.Mesh(*seats.turned(seats.CONE)).own_metrics()
    assert cone.volume == pytest.approx(share * frustum(0.025, 0.006, 0.03), rel=1e-12)
    block = math.pi * seats.CUP_RADIUS**2 * (seats.CUP_TOP - seats.CUP_BOTTOM)
    top, floor = seats.wall(seats.CUP_TOP), seats.wall(seats.CUP_FLOOR)
    hole = frustum(top, floor, seats.CUP_TOP - seats.CUP_FLOOR)
    cup = vc.Mesh(*seats.turned(seats.CUP)).own_metrics()
    assert cup.volume == pytest.approx(share * (block - hole), rel=1e-12)


def test_path_of_the_arm_is_what_the_script_writes() -> None:
    """To rounding: the inverse kinematics end where they end."""
    kept = (MODELS / "canadarm_berth" / "path.xml").read_text().replace('"', " ").split()
    made = arm_path.path().replace('"', " ").split()
    assert len(made) == len(kept)
    for one, other in zip(made, kept, strict=True):
        try:
            assert float(one) == pytest.approx(float(other), abs=1e-8)
        except ValueError:
            assert one == other


def test_arm_has_the_masses_of_its_source() -> None:
    model = arm_path.arm()
    masses = [model.body(f"arm_{i}").mass[0] for i in range(1, 9)]
    assert masses == [243.66, 105.98, 105.98, 314.88, 279.2, 105.98, 105.98, 243.66]
    # Shoulder to elbow to wrist, and wrist to the grasp: 7.11 m each, 0.7026 m + 1.3589 m.
    data = mujoco.MjData(model)
    data.qpos[:] = arm_path.SEATED
    mujoco.mj_kinematics(model, data)
    elbow = data.body("arm_5").xpos - data.body("arm_4").xpos
    assert np.linalg.norm(elbow) == pytest.approx(math.hypot(7.11, 0.475))
    assert np.linalg.norm(data.body("arm_6").xpos - data.body("arm_5").xpos) == pytest.approx(7.11)
    assert data.site("grasp").xpos == pytest.approx(arm_path.GRASP, abs=1e-9)


@pytest.mark.parametrize(
    "folder", ["acu_insert", "battery_insert_0g", "canadarm_berth", "rpcm_rails"]
)
def test_check_finds_nothing_wrong(folder: str) -> None:
    """Looking at where the scene starts, not at the seated pose."""
    command = [sys.executable, "-m", "volcontact.cli", "check", "--json"]
    done = subprocess.run(
        [*command, MODELS / folder / "scene.xml"], check=True, capture_output=True, text=True
    )
    assert json.loads(done.stdout)["warnings"] == []


def native_end(folder: str, duration: float) -> tuple[float, float]:
    """Height above the seat [m] and largest force at the grasp [N] under native contact."""
    model = mujoco.MjModel.from_xml_path(str(MODELS / folder / "scene.xml"))
    data = mujoco.MjData(model)
    to_start(model, data)
    largest = 0.0
    for _ in range(round(duration / model.opt.timestep)):
        mujoco.mj_step(model, data)
        largest = max(largest, float(np.linalg.norm(data.sensordata[:3])))
    return float(data.qpos[2]), largest


def test_under_native_contact_the_cup_is_solid() -> None:
    """The unit stops where its cones meet the hulls of cup and slot, and is pushed too hard."""
    height, largest = native_end("acu_insert", 24.0)
    assert 0.015 < height < 0.025
    assert largest > 111.0
