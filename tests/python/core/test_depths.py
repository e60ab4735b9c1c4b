# SPDX-License-Identifier: Apache-2.0
"""Depth and depth moment of overlaps of convex solids against manifold3d: its facets tell how far
an overlap reaches along the normal, and how long each column of it is."""

from __future__ import annotations

import itertools
from typing import Any

import manifold3d
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import volcontact as vc

Array = NDArray[np.float64]

FACETS = 100  # round a turn
LARGEST = 0.06  # size of a solid [m]
SAG = LARGEST * (1.0 - np.cos(np.pi / FACETS))  # of a facet [m]
GRID = 40  # columns across
DEEP = (0.005, 0.04)  # along the normal [m]
CLEAR = 0.1  # flatness of an overlap that has a normal
POSES = 12


def revolved(profile: Array) -> manifold3d.Manifold:
    return manifold3d.CrossSection([profile]).revolve(FACETS)


def capsule(radius: float, half_length: float) -> manifold3d.Manifold:
    angle = np.linspace(-0.5 * np.pi, 0.0, FACETS // 4 + 1)
    low = np.column_stack([np.cos(angle), np.sin(angle)]) * radius - [0.0, half_length]
    low[0, 0] = 0.0
    return revolved(np.vstack([low, low[::-1] * [1.0, -1.0]]))


def solid(rng: np.random.Generator) -> tuple[Any, manifold3d.Manifold]:
    x, y, z = (float(size) for size in rng.uniform(0.02, LARGEST, 3))
    ball = manifold3d.Manifold.sphere(1.0, FACETS)
    cylinder = manifold3d.Manifold.cylinder
    makers = [
        lambda: (vc.Box([x, y, z]), manifold3d.Manifold.cube([2 * x, 2 * y, 2 * z], True)),
        lambda: (vc.Sphere(x), ball.scale([x, x, x])),
        lambda: (vc.Capsule(x, y), capsule(x, y)),
        lambda: (vc.Cylinder(x, y), cylinder(2 * y, x, x, FACETS, True)),
        lambda: (vc.Frustum(x, y, z), cylinder(2 * z, x, y, FACETS, True)),
        lambda: (vc.Ellipsoid([x, y, z]), ball.scale([x, y, z])),
    ]
    return makers[rng.integers(len(makers))]()


def overlapping(rng: np.random.Generator, a: Any, b: Any) -> Array:
    """A pose in which B reaches into A, by up to the size of a solid."""
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_quat(rng.normal(size=4)).as_matrix()
    way = rng.normal(size=3)
    way /= np.linalg.norm(way)
    near, far = 0.0, 6.0 * LARGEST
    for _ in range(20):
        between = 0.5 * (near + far)
        pose[:3, 3] = between * way
        if vc.interference(a, b, pose, tolerance=0.1).volume > 0.0:
            near = between
        else:
            far = between
    pose[:3, 3] = max(0.0, near - LARGEST * 10.0 ** rng.uniform(-1.2, 0.0)) * way
    return pose


class Facets:
    def __init__(self, manifold: manifold3d.Manifold) -> None:
        mesh = manifold.to_mesh64() if hasattr(manifold, "to_mesh64") else manifold.to_mesh()
        self.points = np.asarray(mesh.vert_properties, dtype=float)[:, :3]
        a, b, c = self.points[np.asarray(mesh.tri_verts)].transpose(1, 0, 2)
        normal = np.cross(b - a, c - a)
        length = np.linalg.norm(normal, axis=1)
        real = length > 1e-16
        self.normal = normal[real] / length[real, None]
        self.offset = np.einsum("ij,ij->i", self.normal, a[real])

    def ends(self, places: Array, n: Array) -> tuple[Array, Array]:
        """From where to where the lines along n through the places are behind all facets."""
        rise = self.normal @ n
        gap = self.offset[:, None] - self.normal @ places.T
        up, down = rise > 1e-9, rise < -1e-9
        return (
            np.max(gap[down] / rise[down, None], axis=0),
            np.min(gap[up] / rise[up, None], axis=0),
        )


def depth_moment(overlap: Facets, a: Facets, b: Facets, n: Array) -> tuple[float, float]:
    """int L^2/2 dA over the columns along n, and the same with what A and B reach over their ends
    (docs/theory.md, "Depth moment")."""
    across = np.linalg.svd(n[None, :])[2][1:]
    x = overlap.points @ across.T
    low, size = x.min(axis=0), np.ptp(x, axis=0)
    middles = (np.arange(GRID) + 0.5) / GRID
    places = (
        np.array([low + size * [u, v] for u, v in itertools.product(middles, middles)]) @ across
    )
    bottom, top = overlap.ends(places, n)
    bottom_a, top_a = a.ends(places, n)
    bottom_b, top_b = b.ends(places, n)
    length = np.maximum(top - bottom, 0.0)
    over = np.maximum(top_b - top_a, 0.0) + np.maximum(bottom_b - bottom_a, 0.0)
    area = size.prod() / GRID**2
    plain = 0.5 * length**2
    return float(plain.sum() * area), float((plain + length * over).sum() * area)


@pytest.mark.parametrize("engine", ["lines", "octree", "surface_sweep"])
def test_depth_is_the_extent_along_the_normal_and_its_moment_that_of_columns(engine: str) -> None:
    rng = np.random.default_rng(5)
    poses = moments = 0
    while poses < POSES:
        (a, hull_a), (b, hull_b) = solid(rng), solid(rng)
        X_AB = overlapping(rng, a, b)
        try:
            found = vc.interference(a, b, X_AB, engine=engine)
        except ValueError:  # the engine does not serve the two
            continue
        if found.status != "ok" or found.flatness < CLEAR:
            continue
        placed_b = hull_b.transform(X_AB[:3])
        overlap = Facets(hull_a ^ placed_b)
        n = np.asarray(found.normal)
        extent = float(np.ptp(overlap.points @ n))
        if not DEEP[0] < extent < DEEP[1]:
            continue
        poses += 1
        assert found.depth == pytest.approx(extent, rel=0.01, abs=2 * SAG), (a, b, X_AB)
        plain, whole = depth_moment(overlap, Facets(hull_a), Facets(placed_b), n)
        # The surface sweep leaves out what reaches over the ends.
        if engine == "surface_sweep" and whole > 1.001 * plain:
            continue
        moments += 1
        assert found.depth_moment == pytest.approx(whole, rel=0.04), (a, b, X_AB)
    assert moments > POSES // 2


@pytest.mark.parametrize("engine", ["lines", "octree", "surface_sweep"])
def test_a_capsule_deep_over_the_edge_of_a_box(engine: str) -> None:
    """The rim of the overlap tells little of the normal."""
    X_AB = np.eye(4)
    X_AB[:3, :3] = Rotation.from_euler("y", 17.0, degrees=True).as_matrix()
    X_AB[:3, 3] = [0.03, 0.0, 0.1]
    found = vc.interference(vc.Box([0.05] * 3), vc.Capsule(0.03, 0.08), X_AB, engine=engine)
    overlap = Facets(
        manifold3d.Manifold.cube([0.1] * 3, True) ^ capsule(0.03, 0.08).transform(X_AB[:3])
    )
    extent = float(np.ptp(overlap.points @ np.asarray(found.normal)))
    assert found.depth == pytest.approx(extent, rel=5e-3)


def test_a_disc_that_leans_in_a_face() -> None:
    """The columns stood upright on the end of the frustum, and its rim had no highest place."""
    box, frustum = vc.Box([0.05, 0.03, 0.03]), vc.Frustum(0.02, 0.04, 0.02)
    X_AB = np.eye(4)
    X_AB[:3, :3] = [
        [0.002221499175920516, 0.9999896382269795, 0.003973459460767104],
        [0.0006202130755920687, -0.0039748462965607245, 0.9999919079335893],
        [0.9999973401350389, -0.002219016807888663, -0.0006290367668572439],
    ]
    X_AB[:3, 3] = [0.0, -0.05, -0.01]
    found = vc.interference(box, frustum, X_AB, engine="lines")
    hull_b = manifold3d.Manifold.cylinder(0.04, 0.02, 0.04, 2000, True).transform(X_AB[:3])
    overlap = Facets(manifold3d.Manifold.cube([0.1, 0.06, 0.06], True) ^ hull_b)
    extent = float(np.ptp(overlap.points @ np.asarray(found.normal)))
    assert found.depth == pytest.approx(extent, rel=2e-3)
