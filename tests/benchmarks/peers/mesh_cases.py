# SPDX-License-Identifier: Apache-2.0
"""The pairs of the benchmark of meshes: bumpy balls, primitives, the worst cases, a peg."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import volcontact_timing
from field import assembly

import volcontact as vc

from . import bodies, exact_volumes
from .bodies import Body
from .cases import Case, pose_of, turn

POSES = 8
SUNK = 0.01  # depth by the radius, 1 [-]
SEGMENTS = 4096  # of the prism that stands for a cylinder: 3e-5 of a volume at that depth
FINE = "20k"


def bumpy(levels: int, seed: int, size: float = 1.0) -> Body:
    """A ball of about that radius [m] with bumps, of 20 * 4^levels triangles."""
    points, triangles = volcontact_timing.bumpy_ball(levels, seed)
    return bodies.mesh(size * points, triangles)


def ring(major: float, minor: float, chords: int, sides: int) -> Body:
    """A mesh of a torus, 2 * chords * sides triangles."""
    angles = 2 * np.pi * np.arange(sides) / sides
    profile = np.stack([major + minor * np.cos(angles), minor * np.sin(angles)], axis=1)
    return bodies.turned_mesh(profile, chords)


def sleeve(inner: float, outer: float, half: float, chords: int, rows: int) -> Body:
    """A thick tube whose bore and outside are divided into rows."""
    heights = np.linspace(-half, half, rows + 1)
    bore = np.stack([np.full(rows + 1, inner), heights[::-1]], axis=1)
    outside = np.stack([np.full(rows + 1, outer), heights], axis=1)
    return bodies.turned_mesh(np.concatenate([outside, bore]), chords)


def all_cases() -> Iterator[Case]:
    """Every pair of meshes, and of a mesh with a primitive."""
    for name, levels in (("1.3k", 3), (FINE, 5), ("82k", 6)):
        a, b = bumpy(levels, 1), bumpy(levels, 2)
        yield Case(f"bumpy balls, {name}", a, b, _sunk(a, b))
    yield from _with_primitives()
    yield from _worst()
    yield from _peg()


def _with_primitives() -> Iterator[Case]:
    ball = bumpy(5, 1)
    assert ball.points is not None
    random = np.random.default_rng(1)
    poses = []
    for _ in range(POSES):
        rotation = _rotation(random)
        lowest = (ball.points @ rotation[2]).min()
        poses.append(pose_of(rotation, (*random.uniform(-1, 1, 2), -lowest - SUNK)))
    ground = bodies.half_space()
    yield Case(f"mesh {FINE} - half-space", ground, ball, np.array(poses))

    # On a face: more triangles take part than at an edge or a corner.
    slab = bodies.box(2.0, 2.0, 0.5)
    on_face = np.array([np.linalg.inv(pose) for pose in poses])
    on_face[:, :3, 3] -= 0.5 * on_face[:, :3, 2]
    yield Case(f"mesh {FINE} - box", ball, slab, on_face)

    other = bodies.ball(1.0)
    exact = exact_volumes.ball_in_mesh
    yield Case(f"mesh {FINE} - sphere", ball, other, _sunk(ball, other), exact)
    can = bodies.cylinder(0.5, 0.5)
    yield Case(f"mesh {FINE} - cylinder", ball, can, _sunk(ball, can), _by_prism)


def _worst() -> Iterator[Case]:
    link = ring(1.0, 0.48, 160, 64)
    across = _shift((1.0, 0.0, 0.0)) @ _pose(turn((1, 0, 0), math.pi / 2))
    poses = [across @ _pose(turn((0, 0, 1), 0.7 * k)) for k in range(4)]
    yield Case(f"linked rings, {FINE}, apart", link, link, np.array(poses))

    shell, stone = bumpy(5, 1), bumpy(5, 2, 0.4)
    random = np.random.default_rng(2)
    inside = [pose_of(_rotation(random), random.uniform(-0.2, 0.2, size=3)) for _ in range(POSES)]
    yield Case(f"one inside the other, {FINE}", shell, stone, np.array(inside))

    tube = sleeve(1.0, 2.0, 1.0, 64, 66)
    points, triangles = assembly.pegs.peg(64, 62)
    slim = points / [assembly.pegs.RADIUS, assembly.pegs.RADIUS, assembly.pegs.LENGTH]
    peg = bodies.mesh(slim * [0.97, 0.97, 4.0], triangles)
    tilted = [_pose(turn((0, 0, 1), 0.1 * k) @ turn((0, 1, 0), 0.05)) for k in range(4)]
    yield Case("tilted peg in sleeve, 8k", tube, peg, np.array(tilted))
    yield Case(f"identical meshes, {FINE}", shell, shell, np.eye(4)[None])


def _peg() -> Iterator[Case]:
    """The peg of 8 mm in a plate with a hole of 8.2 mm: free, and leaning on two walls."""
    clearance = assembly.HOLES["8.2"][1]
    plate = bodies.mesh(*assembly.pegs.plate(clearance, 160, 60))
    peg = bodies.mesh(*assembly.pegs.peg(160, 60))
    free, leaning = [], []
    for spin in assembly.SPINS:
        about = assembly.turn(2, spin)
        free.append(_shift((0.0, 0.0, 0.02)) @ about)
        pose = assembly.two_point_pose(clearance, assembly.HOLES["8.2"][2])
        # In a direction in which no corners of peg and hole meet.
        leaning.append(assembly.turn(2, assembly.ANY_DIRECTION + 0.1 * spin) @ pose @ about)
    yield Case(f"peg in hole, {FINE}, aligned", plate, peg, np.array(free))
    yield Case(f"peg in hole, {FINE}, at two points", plate, peg, np.array(leaning))


def _sunk(a: Body, b: Body) -> np.ndarray:
    """B turned at random, and pushed into A by SUNK along a random direction."""
    random = np.random.default_rng(3)
    poses = []
    for _ in range(POSES):
        rotation, direction = _rotation(random), random.normal(size=3)
        direction /= np.linalg.norm(direction)
        apart, together = a.size + b.size, 0.5 * a.size
        for _ in range(40):
            middle = 0.5 * (apart + together)
            touching = _touches(a, b, pose_of(rotation, middle * direction))
            apart, together = (apart, middle) if touching else (middle, together)
        poses.append(pose_of(rotation, (together - SUNK) * direction))
    return np.array(poses)


def _touches(a: Body, b: Body, pose: np.ndarray) -> bool:
    """Whether B overlaps the mesh A; a round B, whether it holds one of its points."""
    if b.kind == "mesh":
        return vc.interference(a.ours, b.ours, pose).volume > 0.0
    points = (a.points - pose[:3, 3]) @ pose[:3, :3]
    if b.kind == "ball":
        return bool((np.linalg.norm(points, axis=1) < b.sizes[0]).any())
    assert b.kind == "cylinder"
    across, along = np.hypot(points[:, 0], points[:, 1]), np.abs(points[:, 2])
    return bool(((across < b.sizes[0]) & (along < b.sizes[1])).any())


def _by_prism(a: Body, b: Body, pose: np.ndarray) -> float:
    """Volume [m^3] with a cylinder that has so many sides that they hardly matter."""
    from .manifold_meshes import mesh_of

    return (mesh_of(a, 0) ^ mesh_of(b, SEGMENTS).transform(pose[:3])).volume()


def _rotation(random: np.random.Generator) -> np.ndarray:
    return turn(random.normal(size=3), random.uniform(0.0, 2 * np.pi))


def _shift(move: tuple[float, float, float]) -> np.ndarray:
    return pose_of(np.eye(3), move)


def _pose(rotation: np.ndarray) -> np.ndarray:
    return pose_of(rotation, (0.0, 0.0, 0.0))
