# SPDX-License-Identifier: Apache-2.0
"""The peg falls through its hole, converges with its mesh, and jams where theory says so."""

from __future__ import annotations

import importlib.util
import math
import shutil
import sys
from pathlib import Path
from types import ModuleType

import mujoco
import numpy as np
import pytest

import volcontact as vc

FOLDER = Path(__file__).parents[2] / "mjcf_models" / "peg_in_hole"
WIDE, TIGHT = 0.2e-3, 0.02e-3  # clearances [m]
DEPTH = 0.006  # of the peg in the hole [m]


def script(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"peg_in_hole_{name}", FOLDER / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its dataclasses look there
    spec.loader.exec_module(module)
    return module


meshes = script("make_meshes")
jamming = script("jamming")
falling = script("falling")


def copy_with_meshes(folder: Path, chords: int, rings: int) -> Path:
    """The scenes in a folder of their own: MuJoCo keeps meshes by the names of their files."""
    shutil.copytree(FOLDER, folder, ignore=shutil.ignore_patterns("__pycache__", "meshes"))
    meshes.write(folder / "meshes", chords, rings)
    return folder


@pytest.fixture(scope="module")
def fine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The scenes with meshes of 20 thousand triangles."""
    return copy_with_meshes(tmp_path_factory.mktemp("fine") / "peg_in_hole", 160, 60)


def test_mesh_files_are_what_the_script_writes(tmp_path: Path) -> None:
    meshes.write(tmp_path, 64, 1)
    written = sorted(tmp_path.iterdir())
    assert [path.name for path in written] == sorted(p.name for p in (FOLDER / "meshes").iterdir())
    for path in written:
        assert path.read_text() == (FOLDER / "meshes" / path.name).read_text()


@pytest.mark.parametrize(("chords", "rings"), [(16, 1), (64, 3)])
def test_meshes_have_the_volume_of_their_prisms(chords: int, rings: int) -> None:
    """A regular polygon in a circle of radius R has the area n/2 R^2 sin(2 pi / n)."""
    area = chords / 2 * math.sin(2 * math.pi / chords)
    peg = vc.Mesh(*meshes.peg(chords, rings)).own_metrics()
    assert peg.volume == pytest.approx(area * 0.004**2 * 0.05, rel=1e-12)
    plate = vc.Mesh(*meshes.plate(WIDE, chords, rings)).own_metrics()
    assert plate.volume == pytest.approx((0.04**2 - area * 0.0041**2) * 0.009, rel=1e-12)


def two_point_pose(clearance: float, sink: float) -> np.ndarray:
    """Pose of the peg in the plate: 6 mm deep, leaning, pressed into both walls by `sink` [m]."""
    angle = (clearance + 2 * sink) / DEPTH
    c, s = math.cos(angle), math.sin(angle)
    turned = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    end = [-(0.004 + clearance / 2 + sink) + 0.004 * c, 0.0, 0.0045 - DEPTH]
    pose = np.eye(4)
    spin = 0.3  # of the peg about its axis, so that no edge meets an edge [rad]
    pose[:3, :3] = turned @ [
        [math.cos(spin), -math.sin(spin), 0.0],
        [math.sin(spin), math.cos(spin), 0.0],
        [0.0, 0.0, 1.0],
    ]
    pose[:3, 3] = end + 0.025 * turned[:, 2]
    return pose


@pytest.mark.parametrize(("clearance", "sink"), [(WIDE, 1e-5), (TIGHT, 3e-6)])
def test_mesh_converges_to_the_exact_peg(clearance: float, sink: float) -> None:
    """Chords are off by R (1 - cos(pi/n)), so the error falls with 1/n^2: 16 times in two steps."""
    pose = two_point_pose(clearance, sink)
    bore = vc.Cylinder(radius=0.004 + clearance / 2, half_length=0.01)
    exact = vc.interference(
        vc.Box(meshes.PLATE) - bore, vc.Cylinder(radius=0.004, half_length=0.025), pose
    )
    errors = []
    for chords in (128, 512):
        mesh = vc.interference(
            vc.Mesh(*meshes.plate(clearance, chords)), vc.Mesh(*meshes.peg(chords)), pose
        )
        errors.append(abs(mesh.volume / exact.volume - 1.0))
    assert errors[0] < 0.03
    assert errors[1] < errors[0] / 10.0
    by_end = min(exact.sites, key=lambda site: site.centroid[2])
    low = [site for site in mesh.sites if site.centroid[2] < 0.0]
    assert sum(s.volume for s in low) == pytest.approx(by_end.volume, rel=2e-3)
    assert sum(s.area_vector for s in low) == pytest.approx(
        by_end.area_vector, abs=2e-3 * by_end.area
    )


@pytest.mark.parametrize(
    ("name", "turned", "coarse"), [("scene", True, 64), ("scene_tight", False, 32)]
)
def test_motion_of_the_mesh_converges_to_that_of_the_exact_peg(
    name: str, turned: bool, coarse: int, tmp_path: Path
) -> None:
    """Second order, as the chords are: 16 times nearer with 4 times the chords."""
    exact = falling.fall(FOLDER / f"{name}.xml", turned=turned)
    assert exact.volumes.max() > 0.0
    errors = []
    for chords in (coarse, 4 * coarse):
        folder = copy_with_meshes(tmp_path / str(chords), chords, 1)
        found = falling.fall(folder / f"{name}_mesh.xml", turned=turned)
        errors.append(np.abs(found.positions - exact.positions).max())
    assert errors[0] < 1e-6
    assert errors[1] < errors[0] / 10.0


def test_aligned_peg_of_20000_triangles_falls_freely(fine: Path) -> None:
    """Through the plate and beyond nothing touches: z = z_0 - g t^2 / 2, Euler's sum of it."""
    model = vc.load(fine / "scene_mesh.xml")
    data = mujoco.MjData(model)
    data.qpos[:7] = [3e-5, 2e-5, 0.055, 1.0, 0.0, 0.0, 0.0]
    steps = round(0.075 / model.opt.timestep)
    with vc.attach(model) as contact:
        for _ in range(steps):
            mujoco.mj_step(model, data)
            assert len(contact.sites(data)) == 0
    h = model.opt.timestep
    fallen = 9.81 * h * h * steps * (steps + 1) / 2
    assert fallen > 0.0265  # its end is well below the plate
    assert data.qpos[:3] == pytest.approx([3e-5, 2e-5, 0.055 - fallen], abs=1e-12)
    assert data.qpos[3] == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize("across", [-1.0, 0.0, 1.0])
@pytest.mark.parametrize(("scene", "clearance"), [("scene.xml", WIDE), ("scene_tight.xml", TIGHT)])
def test_peg_jams_where_the_diagram_says_so(scene: str, clearance: float, across: float) -> None:
    """A tenth of lambda inside of the boundary it slides, a tenth outside it jams [Whitney1982]."""
    check_both_sides(FOLDER / scene, clearance, across)


@pytest.mark.parametrize(("scene", "clearance"), [("scene.xml", WIDE), ("scene_tight.xml", TIGHT)])
def test_peg_jams_where_the_statics_of_its_sites_says_so(scene: str, clearance: float) -> None:
    """Nearer to the boundary: three equations of balance, with tilt and centroids as they are.

    Until it is at rest the peg creeps by 0.1 mm, which is worth 1.6 % of lambda.
    """
    across, margin = 0.5, 0.03 * jamming.slenderness()
    moment = jamming.statics(FOLDER / scene, clearance, across)
    assert moment == pytest.approx(jamming.boundary(across), abs=0.1 * jamming.slenderness())
    assert not jamming.press(FOLDER / scene, clearance, across, moment - margin).jammed
    assert jamming.press(FOLDER / scene, clearance, across, moment + margin).jammed


@pytest.mark.parametrize(
    ("scene", "clearance"), [("scene_mesh.xml", WIDE), ("scene_tight_mesh.xml", TIGHT)]
)
def test_peg_of_64_chords_jams_where_the_diagram_says_so(scene: str, clearance: float) -> None:
    check_both_sides(FOLDER / scene, clearance, 0.0)


@pytest.mark.once
def test_peg_of_20000_triangles_jams_where_the_diagram_says_so(fine: Path) -> None:
    """In a direction in which no corners of the polygons meet."""
    check_both_sides(fine / "scene_mesh.xml", WIDE, 0.0, azimuth=0.37)


def test_exact_peg_jams_alike_in_all_directions() -> None:
    """The scene is round but for the outside of the plate."""
    moment = jamming.boundary(0.3) + 0.1 * jamming.slenderness()
    one, other = (
        jamming.press(FOLDER / "scene.xml", WIDE, 0.3, moment, azimuth=azimuth)
        for azimuth in (0.0, 2.0)
    )
    assert other.speed == pytest.approx(one.speed, rel=1e-6)
    assert other.travel == pytest.approx(one.travel, rel=1e-6)


def check_both_sides(scene: Path, clearance: float, across: float, *, azimuth: float = 0.0) -> None:
    tenth = 0.1 * jamming.slenderness()
    inside, outside = (jamming.boundary(across) + side for side in (-tenth, tenth))
    slides = jamming.press(scene, clearance, across, inside, azimuth=azimuth)
    assert slides.speed > 5 * jamming.SLIP_SPEED
    jams = jamming.press(scene, clearance, across, outside, azimuth=azimuth)
    assert jams.jammed and jams.sites >= 2
    # It creeps, steadily: no faster than the slip speed.
    assert jams.travel < jamming.SLIP_SPEED * jamming.DURATION


@pytest.mark.parametrize("name", ["scene.xml", "scene_mesh.xml", "scene_tight_mesh.xml"])
def test_under_native_contact_the_hole_is_solid(name: str) -> None:
    """The peg ends on top of the plate, at 29 mm, instead of on the base."""
    model = mujoco.MjModel.from_xml_path(str(FOLDER / name))
    model.opt.timestep = 5e-4
    data = mujoco.MjData(model)
    lowest = math.inf
    for _ in range(600):
        mujoco.mj_step(model, data)
        axis = data.body("peg").xmat.reshape(3, 3)[:, 2]
        lowest = min(lowest, data.body("peg").xpos[2] - 0.025 * abs(axis[2]))
    assert 0.027 < lowest < 0.0301
