# SPDX-License-Identifier: Apache-2.0
"""Composed solids against manifold3d's exact booleans and closed forms."""

from __future__ import annotations

import math

import manifold3d
import numpy as np
import pytest

import volcontact as vc


def pose(x: float, y: float, z: float, angle: float = 0.0) -> np.ndarray:
    """Turned about z by `angle`, then about x by half of it, at (x, y, z)."""
    c, s, d, t = math.cos(angle), math.sin(angle), math.cos(angle / 2), math.sin(angle / 2)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([[1, 0, 0], [0, d, -t], [0, t, d]]) @ [
        [c, -s, 0],
        [s, c, 0],
        [0, 0, 1],
    ]
    matrix[:3, 3] = x, y, z
    return matrix


def cube(half_sizes: tuple[float, float, float]) -> manifold3d.Manifold:
    return manifold3d.Manifold.cube([2 * h for h in half_sizes], center=True)


def placed(manifold: manifold3d.Manifold, X: np.ndarray) -> manifold3d.Manifold:
    return manifold.transform(X[:3, :])


def test_composed_boxes_equal_the_boolean() -> None:
    rng = np.random.default_rng(5)
    a, b, tool = (0.3, 0.2, 0.1), (0.15, 0.1, 0.08), (0.1, 0.25, 0.2)
    touching = 0
    for _ in range(12):
        X, Y = (pose(*rng.uniform(-0.15, 0.15, 3), rng.uniform(-1, 1)) for _ in range(2))
        for name in ("__add__", "__and__", "__sub__"):
            ours = getattr(vc.Box(a), name)(vc.Box(b).posed(X))
            theirs = getattr(cube(a), {"__and__": "__xor__"}.get(name, name))(placed(cube(b), X))
            assert ours.own_metrics().volume == pytest.approx(theirs.volume(), rel=1e-9, abs=1e-14)
            overlap = (theirs ^ placed(cube(tool), Y)).volume()
            metrics = vc.interference(ours, vc.Box(tool), Y, engine="octree", tolerance=1e-3)
            assert metrics.volume == pytest.approx(overlap, rel=1e-9, abs=1e-13)
            touching += overlap > 0
    assert touching > 12


def test_bored_block_with_a_ball_equals_the_boolean() -> None:
    bored = vc.Box((0.1, 0.1, 0.05)) - vc.Cylinder(0.03, 0.1).posed(pose(0.02, 0, 0))
    block = cube((0.1, 0.1, 0.05)) - placed(
        manifold3d.Manifold.cylinder(0.2, 0.03, circular_segments=1024, center=True),
        pose(0.02, 0, 0),
    )
    ball = manifold3d.Manifold.sphere(0.05, circular_segments=1024)
    X = pose(0.03, 0.01, 0.075)
    overlap = (block ^ placed(ball, X)).volume()
    metrics = vc.interference(bored, vc.Sphere(0.05), X, engine="octree", tolerance=1e-3)
    # Chords of 1024 segments leave 1 - (2 pi / 1024)^2 / 6 of a disc.
    assert metrics.volume == pytest.approx(overlap, rel=1.1e-3)
    assert metrics.volume_error <= 1e-3 * metrics.volume


def test_automatic_engine_agrees_with_the_octree() -> None:
    bored = vc.Box((0.1, 0.1, 0.05)) - vc.Cylinder(0.03, 0.1).posed(pose(0.02, 0, 0))
    X = pose(0.02, 0.0, 0.085)
    auto = vc.interference(bored, vc.Sphere(0.05), X, tolerance=1e-4)
    octree = vc.interference(bored, vc.Sphere(0.05), X, engine="octree", tolerance=1e-5)
    assert auto.volume == pytest.approx(octree.volume, rel=2e-5)
    np.testing.assert_allclose(auto.normal, octree.normal, atol=2e-4)


def test_peg_in_its_bore_touches_nothing() -> None:
    bored = vc.Box((0.1, 0.1, 0.05)) - vc.Cylinder(0.0202, 0.2)
    assert vc.interference(bored, vc.Cylinder(0.02, 0.1)).volume == 0.0
    assert vc.interference(bored, vc.Cylinder(0.0205, 0.1)).volume == pytest.approx(
        math.pi * (0.0205**2 - 0.0202**2) * 0.1, rel=2e-3
    )


def test_operators_nest_and_are_spelled_back() -> None:
    solid = (vc.Box((1, 1, 1)) + vc.Sphere(1.2)) & vc.Cylinder(0.5, 2.0) - vc.Box((0.1, 0.1, 3))
    assert solid.members == 4
    assert repr(solid).startswith("((Box(half_sizes=(1.0, 1.0, 1.0)) + Sphere(radius=1.2)) & ")
    moved = solid.posed(pose(1, 2, 3)).posed(pose(-1, -2, -3))
    assert moved.own_metrics().volume == pytest.approx(solid.own_metrics().volume, rel=1e-8)


def test_half_space_cuts_and_bounds() -> None:
    half = vc.Box((0.1, 0.1, 0.1)) - vc.HalfSpace()
    assert half.own_metrics().volume == pytest.approx(0.004, rel=1e-12)
    ground = vc.HalfSpace() - vc.Cylinder(0.05, 0.05)
    assert not np.isfinite(ground.bounds[0]).any()
    metrics = vc.interference(ground, vc.Box((0.1, 0.1, 0.1)), tolerance=1e-3)
    assert metrics.volume == pytest.approx(0.004 - math.pi * 0.05**3, rel=1e-3)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: vc.Sphere(1.0).posed(2 * np.eye(4)), ValueError, "posed: X: the upper left 3x3"),
        (lambda: vc.Sphere(1.0) - 1.0, TypeError, "unsupported operand"),
        (
            lambda: vc.Csg(),
            TypeError,
            r"Csg is not called to make one: it is made by the operators",
        ),
    ],
)
def test_misuse_is_named(call, error, message) -> None:
    with pytest.raises(error, match=message):
        call()
