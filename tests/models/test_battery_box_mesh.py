# SPDX-License-Identifier: Apache-2.0
"""The battery box as one mesh is the battery box of primitives, and ends where that one ends."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact.meshes.judging import judge
from volcontact.meshes.reading import read_mesh

MODELS = Path(__file__).parents[2] / "mjcf_models"
FOLDER = MODELS / "battery_box_mesh"
PRIMITIVES = MODELS / "battery_box" / "scene.xml"


def script(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"battery_box_{name}", FOLDER / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("body", ["battery_box", "worksite"])
def test_meshes_are_what_the_script_makes(body: str) -> None:
    """The same solid; another release of manifold3d may cut its faces into other triangles."""
    pytest.importorskip("manifold3d")
    kept = read_mesh(FOLDER / "meshes" / f"{body}.obj")
    kept_solid = vc.Mesh(kept.vertices, kept.faces)
    made_solid = vc.Mesh(*script("make_meshes").union(body))
    kept_moments, made_moments = kept_solid.own_metrics(), made_solid.own_metrics()
    assert made_moments.volume == pytest.approx(kept_moments.volume, rel=1e-9)
    assert made_moments.centroid == pytest.approx(kept_moments.centroid, abs=1e-9)
    assert made_moments.inertia == pytest.approx(kept_moments.inertia, abs=1e-9)


@pytest.mark.parametrize("body", ["battery_box", "worksite"])
def test_mesh_is_closed_and_free_of_crossings(body: str) -> None:
    judgement = judge(read_mesh(FOLDER / "meshes" / f"{body}.obj"))
    assert judgement.closed and judgement.oriented and judgement.outward
    assert not judgement.findings


@pytest.mark.parametrize("body", ["battery_box", "worksite"])
def test_points_are_in_the_mesh_when_they_are_in_a_box(body: str) -> None:
    """Of 4000 random points below the round grips; the boxes are read from the primitive scene."""
    model = mujoco.MjModel.from_xml_path(str(PRIMITIVES))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    top = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, body)
    boxes = [
        geom
        for geom in range(model.ngeom)
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_BOX
        and model.geom_bodyid[geom]
        and model.body_rootid[model.geom_bodyid[geom]] == top
    ]
    kept = read_mesh(FOLDER / "meshes" / f"{body}.obj")
    solid = vc.Mesh(kept.vertices, kept.faces)
    low, high = kept.vertices.min(axis=0), kept.vertices.max(axis=0)
    high[2] = min(high[2], 0.22)
    inside = 0
    for point in np.random.default_rng(7).uniform(low, high, (4000, 3)):
        in_world = data.xmat[top].reshape(3, 3) @ point + data.xpos[top]
        in_boxes = any(
            np.all(
                np.abs(data.geom_xmat[g].reshape(3, 3).T @ (in_world - data.geom_xpos[g]))
                < model.geom_size[g]
            )
            for g in boxes
        )
        distance = solid.signed_distance(point)
        assert (distance < 0.0) == in_boxes or abs(distance) < 1e-9
        inside += in_boxes
    assert inside > 100


def final_pose(scene: Path) -> np.ndarray:
    model = vc.load(scene)
    data = mujoco.MjData(model)
    with vc.attach(model):
        for _ in range(round(2.0 / model.opt.timestep)):
            mujoco.mj_step(model, data)
    return data.qpos.copy()


def test_mesh_ends_where_the_primitives_end() -> None:
    """To a ten-thousandth of a millimetre and a microrad; asked is a tenth of a millimetre."""
    primitives, mesh = final_pose(PRIMITIVES), final_pose(FOLDER / "scene.xml")
    assert mesh == pytest.approx(primitives, abs=1e-7)


def test_under_native_contact_the_box_stays_on_top_of_the_hull() -> None:
    model = mujoco.MjModel.from_xml_path(str(FOLDER / "scene.xml"))
    data = mujoco.MjData(model)
    for _ in range(1000):
        mujoco.mj_step(model, data)
    assert data.qpos[2] > 0.24 + 0.2
