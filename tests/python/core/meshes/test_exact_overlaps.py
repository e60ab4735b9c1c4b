# SPDX-License-Identifier: Apache-2.0
"""Overlaps of meshes by the engine `columns` against CGAL's, which are made with exact numbers."""

from __future__ import annotations

import numpy as np
import pytest

import volcontact as vc
from volcontact.meshes import cgal

trimesh = pytest.importorskip("trimesh")

pytestmark = [
    pytest.mark.skipif(cgal.program() is None, reason=cgal.MISSING),
]

EQUAL = 1e-10  # relative


def bumpy(subdivisions):
    ball = trimesh.creation.icosphere(subdivisions=subdivisions, radius=1.0)
    x, y, z = ball.vertices.T
    ball.vertices *= (1.0 + 0.03 * np.sin(5.0 * x) * np.sin(6.0 * y) * np.cos(4.0 * z))[:, None]
    return ball


SOLIDS = {
    "sleeve": trimesh.creation.annulus(r_min=0.5, r_max=0.9, height=1.2, sections=48),
    "peg": trimesh.creation.cylinder(radius=0.48, height=2.0, sections=48),
    "ring": trimesh.creation.torus(0.7, 0.25, major_sections=32, minor_sections=16),
    "box": trimesh.creation.box((1.0, 1.2, 0.8)),
    "ball": bumpy(2),
}


def arrays(mesh):
    return np.asarray(mesh.vertices), np.asarray(mesh.faces, dtype=np.int64)


def compare(a, b, X_AB) -> float:
    """Asserts that both say the same and returns the volume."""
    vertices_a, faces_a = arrays(a)
    vertices_b, faces_b = arrays(b)
    found = vc.interference(vc.Mesh(vertices_a, faces_a), vc.Mesh(vertices_b, faces_b), X_AB)
    moved = vertices_b @ X_AB[:3, :3].T + X_AB[:3, 3]
    exact = cgal.overlap(vertices_a, faces_a, moved, faces_b)
    assert found.engine == "columns"
    # Both round the corners to 1e-16 of the size, which a thin overlap feels through its area.
    rounding = 1e-15 * min(a.area, b.area)
    assert abs(found.volume - exact["volume"]) <= EQUAL * exact["volume"] + rounding
    if exact["volume"] > 1e-6:
        scale = np.cbrt(exact["volume"])
        assert np.abs(found.centroid - exact["centroid"]).max() <= EQUAL * scale
        assert np.abs(found.inertia - exact["inertia"]).max() <= EQUAL * np.max(exact["inertia"])
    return exact["volume"]


@pytest.mark.parametrize("a", SOLIDS)
@pytest.mark.parametrize("b", SOLIDS)
def test_any_pose_of_any_pair(a, b):
    random = np.random.default_rng(len(a) * 10 + len(b))
    touching = 0
    for _ in range(6):
        X_AB = trimesh.transformations.random_rotation_matrix(random.uniform(size=3))
        X_AB[:3, 3] = random.normal(size=3) * random.choice([0.2, 0.6])
        touching += compare(SOLIDS[a], SOLIDS[b], X_AB) > 0.0
    assert touching > 2


@pytest.mark.parametrize("move", [(0, 0, 0), (0.5, 0, 0), (0, 0, 0.4), (1.0, 0, 0), (0.3, 0.2, 0)])
@pytest.mark.parametrize("name", SOLIDS)
def test_a_mesh_and_its_moved_copy(name, move):
    """Many faces lie in one plane with faces of the other, or on them."""
    X_AB = np.eye(4)
    X_AB[:3, 3] = move
    compare(SOLIDS[name], SOLIDS[name], X_AB)


@pytest.mark.parametrize("subdivisions", [3, 5])
def test_bumpy_balls_at_a_hundredth_of_their_size(subdivisions):
    ball = bumpy(subdivisions)
    X_AB = trimesh.transformations.rotation_matrix(0.4, [1.0, 2.0, 3.0])
    X_AB[:3, 3] = 1.98 * np.array([0.61, 0.44, 0.66]) / np.linalg.norm([0.61, 0.44, 0.66])
    assert len(ball.faces) == 20 * 4**subdivisions
    assert compare(ball, ball, X_AB) > 1e-5
