# SPDX-License-Identifier: Apache-2.0
"""vc.interference against independent oracles: manifold3d's exact booleans and closed forms."""

from __future__ import annotations

import math

import manifold3d
import numpy as np
import pytest

import volcontact as vc

# Both sides round at 1e-16 of the body; a 1 % overlap of it leaves this relative accuracy.
EXACT = 1e-10
POSES = 60


def random_pose(rng: np.random.Generator, reach: float) -> np.ndarray:
    q = rng.normal(size=4)
    w, x, y, z = q / np.linalg.norm(q)
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    direction = rng.normal(size=3)
    pose[:3, 3] = direction / np.linalg.norm(direction) * rng.uniform(0.0, reach)
    return pose


def placed(manifold: manifold3d.Manifold, pose: np.ndarray) -> manifold3d.Manifold:
    return manifold.transform(pose[:3, :])


def cube(half_sizes: tuple[float, float, float]) -> manifold3d.Manifold:
    return manifold3d.Manifold.cube([2 * h for h in half_sizes], center=True)


def mesh_moments(manifold: manifold3d.Manifold) -> tuple[float, np.ndarray, np.ndarray]:
    """Volume, centroid and inertia of a closed triangle mesh, by signed tetrahedra."""
    mesh = manifold.to_mesh64() if hasattr(manifold, "to_mesh64") else manifold.to_mesh()
    points = np.asarray(mesh.vert_properties, dtype=float)[:, :3]
    origin = points.mean(axis=0)
    corners = (points - origin)[np.asarray(mesh.tri_verts)]
    det = np.linalg.det(corners)
    volume = det.sum() / 6
    sums = corners.sum(axis=1)
    first = (det[:, None] * sums).sum(axis=0) / 24
    second = (
        np.einsum("t,tia,tib->ab", det, corners, corners) + np.einsum("t,ta,tb", det, sums, sums)
    ) / 120
    centroid = first / volume
    second -= volume * np.outer(centroid, centroid)
    return volume, centroid + origin, np.trace(second) * np.eye(3) - second


def test_box_box_equals_the_boolean() -> None:
    rng = np.random.default_rng(1)
    a, b = (0.3, 0.2, 0.1), (0.15, 0.25, 0.2)
    touching = 0
    for _ in range(POSES):
        pose = random_pose(rng, 0.45)
        metrics = vc.interference(vc.Box(a), vc.Box(b), pose)
        overlap = cube(a) ^ placed(cube(b), pose)
        if overlap.is_empty():
            assert metrics.volume < 1e-14
            continue
        touching += 1
        volume, centroid, inertia = mesh_moments(overlap)
        assert metrics.volume == pytest.approx(volume, rel=EXACT, abs=1e-15)
        if volume > 1e-6:
            np.testing.assert_allclose(metrics.centroid, centroid, atol=EXACT)
            np.testing.assert_allclose(metrics.inertia, inertia, atol=EXACT * volume)
    assert touching > POSES // 3


def test_polytope_polytope_equals_the_boolean() -> None:
    rng = np.random.default_rng(2)
    points_a, points_b = rng.normal(size=(24, 3)) * 0.2, rng.normal(size=(16, 3)) * 0.2
    hull_a = manifold3d.Manifold.hull_points(points_a)
    hull_b = manifold3d.Manifold.hull_points(points_b)
    a, b = vc.ConvexPolytope(points_a), vc.ConvexPolytope(points_b)
    assert a.own_metrics().volume == pytest.approx(hull_a.volume(), rel=EXACT)
    for _ in range(POSES // 2):
        pose = random_pose(rng, 0.5)
        metrics = vc.interference(a, b, pose)
        overlap = hull_a ^ placed(hull_b, pose)
        assert metrics.volume == pytest.approx(overlap.volume(), rel=EXACT, abs=1e-13)


def test_octree_of_boxes_brackets_the_boolean() -> None:
    rng = np.random.default_rng(3)
    a, b = (0.3, 0.2, 0.1), (0.15, 0.25, 0.2)
    for _ in range(6):
        pose = random_pose(rng, 0.3)
        exact = (cube(a) ^ placed(cube(b), pose)).volume()
        metrics = vc.interference(vc.Box(a), vc.Box(b), pose, engine="octree", tolerance=1e-2)
        assert abs(metrics.volume - exact) <= metrics.volume_error + 1e-15
        assert abs(metrics.volume - exact) <= 1e-2 * exact


def test_sphere_half_space_is_the_spherical_cap() -> None:
    radius, depth = 0.05, 0.792364e-3
    pose = np.eye(4)
    pose[2, 3] = radius - depth
    metrics = vc.interference(vc.HalfSpace(), vc.Sphere(radius), pose)
    volume = math.pi * depth**2 * (3 * radius - depth) / 3
    assert metrics.volume == pytest.approx(volume, rel=1e-13)
    # Outward normal of the half-space over the cut disc.
    np.testing.assert_allclose(
        metrics.area_vector, [0, 0, math.pi * depth * (2 * radius - depth)], rtol=1e-12
    )
    # int L^2/2 dA of a cap: pi h^3 (4R - h)/12.
    assert metrics.depth_moment == pytest.approx(
        math.pi * depth**3 * (4 * radius - depth) / 12, rel=1e-12
    )


def test_sphere_sphere_is_the_lens() -> None:
    r1, r2, distance = 0.3, 0.2, 0.45
    pose = np.eye(4)
    pose[:3, 3] = distance * np.array([2.0, -1.0, 2.0]) / 3.0
    metrics = vc.interference(vc.Sphere(r1), vc.Sphere(r2), pose)
    overlap = r1 + r2 - distance
    volume = (
        math.pi
        * overlap**2
        * (distance**2 + 2 * distance * (r1 + r2) - 3 * (r1 - r2) ** 2)
        / (12 * distance)
    )
    assert metrics.volume == pytest.approx(volume, rel=1e-12)
    np.testing.assert_allclose(metrics.normal, -pose[:3, 3] / distance, atol=1e-12)


def test_apart_is_a_value_not_an_error() -> None:
    pose = np.eye(4)
    pose[0, 3] = 10.0
    metrics = vc.interference(vc.Sphere(1.0), vc.Cylinder(1.0, 1.0), pose)
    assert not metrics.touching
    assert metrics.volume == 0.0
    assert metrics.sites == []


def test_contained_is_flagged() -> None:
    metrics = vc.interference(vc.Sphere(1.0), vc.Box((0.1, 0.1, 0.1)))
    assert metrics.status == "contained"
    assert metrics.volume == pytest.approx(0.008, rel=1e-12)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: vc.Sphere(-1.0), r"sphere: radius = -1 \[m\] is out of range: must be >= 0"),
        (lambda: vc.Box((1.0, math.nan, 1.0)), r"box: half_sizes = nan"),
        (
            lambda: vc.interference(vc.Sphere(1.0), vc.HalfSpace(), 2 * np.eye(4)),
            "X_AB: the upper left 3x3 block is no rotation",
        ),
        (
            lambda: vc.interference(vc.Sphere(1.0), vc.HalfSpace(), np.full((4, 4), np.nan)),
            "X_AB: the pose has a number that is not finite",
        ),
        (
            lambda: vc.interference(vc.Sphere(1.0), vc.HalfSpace(), engine="octre"),
            r"unknown engine 'octre'.*did you mean 'octree'\?",
        ),
        (
            lambda: vc.interference(vc.Sphere(1.0), vc.Box((1, 1, 1)), engine="clip"),
            "engine clip does not serve the pair sphere - box",
        ),
        (
            lambda: vc.interference(vc.Sphere(1.0), vc.HalfSpace(), tolerance=0.0),
            "tolerance",
        ),
    ],
)
def test_bad_input_is_named(call, message) -> None:
    with pytest.raises(ValueError, match=message):
        call()


def test_unknown_keyword_is_a_type_error() -> None:
    with pytest.raises(TypeError):
        vc.Sphere(radios=1.0)


def test_metrics_print_their_numbers() -> None:
    # a ball, half of it in the half-space: 2/3 pi r^3
    text = repr(vc.interference(vc.HalfSpace(), vc.Sphere(radius=0.1)))
    assert f"volume {2e-3 * np.pi / 3:.6g} m^3" in text and "ok" in text
