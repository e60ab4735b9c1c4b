# SPDX-License-Identifier: Apache-2.0
"""The volumes that the benchmark judges all libraries by, where school geometry knows them."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from peers import bodies, exact_volumes
from peers.cases import pose_of, turn

EXACT = 1e-12
INTEGRAL = 1e-9  # of the quadratures

GROUND = bodies.half_space()


def tilted(height: float, angle: float = math.pi / 2) -> np.ndarray:
    return pose_of(turn((1.0, 0.0, 0.0), angle), (0.3, -0.2, height))


def test_ball_cut_in_half() -> None:
    volume = exact_volumes.ellipsoid_cap(GROUND, bodies.ball(0.5), tilted(0.0))
    assert volume == pytest.approx(2 / 3 * math.pi * 0.125, rel=EXACT)


def test_ellipsoid_cut_in_half_at_any_tilt() -> None:
    egg = bodies.ellipsoid(0.5, 0.35, 0.2)
    volume = exact_volumes.ellipsoid_cap(GROUND, egg, tilted(0.0, 0.7))
    assert volume == pytest.approx(2 / 3 * math.pi * 0.5 * 0.35 * 0.2, rel=EXACT)


def test_lens_of_balls_a_radius_apart() -> None:
    ball = bodies.ball(1.0)
    volume = exact_volumes.lens(ball, ball, pose_of(np.eye(3), (0.0, 0.0, 1.0)))
    assert volume == pytest.approx(5 / 12 * math.pi, rel=EXACT)


@pytest.mark.parametrize(
    ("body", "volume"),
    [
        (bodies.cylinder(0.3, 0.4), math.pi * 0.09 * 0.8),
        (bodies.capsule(0.3, 0.4), math.pi * 0.09 * 0.8 + 4 / 3 * math.pi * 0.027),
        (bodies.torus(0.4, 0.1), 2 * math.pi**2 * 0.4 * 0.01),
    ],
    ids=["cylinder", "capsule", "torus"],
)
@pytest.mark.parametrize("angle", [0.4, math.pi / 2], ids=["tilted", "lying"])
def test_solid_of_revolution_cut_in_half(body: bodies.Body, volume: float, angle: float) -> None:
    half = exact_volumes.turned_solid(GROUND, body, tilted(0.0, angle))
    assert half == pytest.approx(volume / 2, rel=INTEGRAL)


def test_corner_of_a_box_is_a_tetrahedron() -> None:
    # The diagonal of a cube points down; the plane cuts edges of 0.1.
    down = np.array([[-1, 1, 0], [1, 1, -2], [-1, -1, -1]]) / np.sqrt([[2], [6], [3]])
    assert np.linalg.det(down) == pytest.approx(1.0)
    height = math.sqrt(3) * 0.5 - 0.1 / math.sqrt(3)
    volume = exact_volumes.polytopes(
        GROUND, bodies.box(0.5, 0.5, 0.5), pose_of(down, (0, 0, height))
    )
    assert volume == pytest.approx(0.1**3 / 6, rel=1e-10)  # the height rounds


def test_boxes_overlap_in_a_box_and_gem_in_itself() -> None:
    a, b = bodies.box(0.3, 0.2, 0.1), bodies.box(0.1, 0.2, 0.3)
    volume = exact_volumes.polytopes(a, b, pose_of(np.eye(3), (0.25, 0.1, -0.2)))
    assert volume == pytest.approx(0.15 * 0.3 * 0.2, rel=EXACT)
    gem = bodies.gem(18, 3)
    volume = exact_volumes.polytopes(gem, gem, np.eye(4))
    assert volume == pytest.approx(gem.ours.own_metrics().volume, rel=EXACT)


def test_ball_on_a_rim_is_a_cap_without_the_bore() -> None:
    block, ball = bodies.bored_block((0.03, 0.03, 0.02), 0.01), bodies.ball(0.015)
    above = 0.004
    volume = exact_volumes.ball_on_bore(block, ball, pose_of(np.eye(3), (0, 0, 0.02 + above)))
    # Half the band between the rim's circle and the plane, that is discs less the bore.
    low = math.sqrt(0.015**2 - 0.01**2)

    def area_sum(z: float) -> float:
        return math.pi * ((0.015**2 - 0.01**2) * z - z**3 / 3)

    assert volume == pytest.approx(area_sum(low) - area_sum(above), rel=INTEGRAL)


def test_shifted_peg_sticks_out_by_a_crescent_all_along() -> None:
    block, peg = bodies.bored_block((0.03, 0.03, 0.02), 0.01), bodies.cylinder(0.0097, 0.03)
    shift = 0.0005
    # A hair of tilt: the formula divides by it.
    pose = pose_of(turn((0.0, 1.0, 0.0), 1e-6), (shift, 0.0, 0.0))
    r, s, d = 0.0097, 0.01, shift
    p, q = (d * d + r * r - s * s) / (2 * d * r), (d * d + s * s - r * r) / (2 * d * s)
    lens = r * r * math.acos(p) + s * s * math.acos(q)
    lens -= d * r * math.sqrt(1 - p * p)
    crescent = math.pi * r * r - lens
    assert exact_volumes.peg_in_bore(block, peg, pose) == pytest.approx(0.04 * crescent, rel=1e-5)


def mesh_of_box(half: float) -> bodies.Body:
    points = half * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    around = {0: (0, 1, 3, 2), 1: (0, 4, 5, 1), 2: (0, 2, 6, 4)}
    triangles = []
    for axis, (a, b, c, d) in around.items():
        far = {0: 4, 1: 2, 2: 1}[axis]
        triangles += [
            (a, b, c),
            (a, c, d),
            (a + far, c + far, b + far),
            (a + far, d + far, c + far),
        ]
    return bodies.mesh(points, np.array(triangles))


@pytest.mark.parametrize("height", [-0.3, 0.0, 0.4])
def test_ball_in_the_face_of_a_mesh_is_a_cap(height: float) -> None:
    depth = 0.5 - height
    volume = exact_volumes.ball_in_mesh(
        mesh_of_box(2.0), bodies.ball(0.5), pose_of(np.eye(3), (0.3, -0.2, 2.0 + height))
    )
    assert volume == pytest.approx(math.pi * depth**2 * (1.5 - depth) / 3, rel=EXACT)


@pytest.mark.parametrize(
    ("position", "share"),
    [((0, 0, 0), 1), ((2, 0, 0), 1 / 2), ((2, 2, 0), 1 / 4), ((2, 2, 2), 1 / 8)],
)
def test_ball_on_a_mesh_of_a_box(position: tuple[float, ...], share: float) -> None:
    pose = pose_of(np.eye(3), position)
    volume = exact_volumes.ball_in_mesh(mesh_of_box(2.0), bodies.ball(0.5), pose)
    assert volume == pytest.approx(share * math.pi / 6, rel=EXACT)


def test_mesh_in_a_ball_is_the_mesh() -> None:
    volume = exact_volumes.ball_in_mesh(mesh_of_box(0.2), bodies.ball(0.5), np.eye(4))
    assert volume == pytest.approx(0.4**3, rel=EXACT)


def test_ball_beyond_a_mesh_has_no_overlap() -> None:
    pose = pose_of(np.eye(3), (0.8, 0.1, 0.0))
    volume = exact_volumes.ball_in_mesh(mesh_of_box(0.2), bodies.ball(0.5), pose)
    assert volume == pytest.approx(0.0, abs=1e-15)


def test_a_turned_profile_is_a_ring_of_prisms() -> None:
    """A rectangle turned in 12 steps: the difference of two prisms of 12 sides."""
    profile = np.array([(1.0, -0.2), (1.5, -0.2), (1.5, 0.3), (1.0, 0.3)])
    ring = bodies.turned_mesh(profile, 12)
    area = 12 / 2 * math.sin(2 * math.pi / 12) * (1.5**2 - 1.0**2)
    assert not ring.ours.turned
    assert ring.ours.own_metrics().volume == pytest.approx(0.5 * area, rel=EXACT)
