# SPDX-License-Identifier: Apache-2.0
"""The pairs of the benchmark: two solids, poses at which they overlap, and their true volumes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

import volcontact as vc

from . import bodies, exact_volumes
from .bodies import Body

POSES = 24


@dataclass(frozen=True)
class Case:
    """A pair at some poses.

    Attributes:
        name: one word; the same in the results and on the page
        a, b: the solids
        poses: poses of B in A, shape (n, 4, 4)
        exact: volume [m^3] at a pose by a formula; None: by the reference integral of the tests
        engine: of volcontact
        tolerance: relative error of V asked of volcontact [-]
    """

    name: str
    a: Body
    b: Body
    poses: np.ndarray
    exact: Callable[[Body, Body, np.ndarray], float] | None = None
    engine: str = "auto"
    tolerance: float = 1e-3


def turn(axis: np.ndarray | tuple[float, float, float], angle: float) -> np.ndarray:
    """Rotation by an angle [rad] about an axis, shape (3, 3)."""
    x, y, z = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


def pose_of(rotation: np.ndarray, position: np.ndarray | tuple[float, float, float]) -> np.ndarray:
    """A pose, shape (4, 4)."""
    pose = np.eye(4)
    pose[:3, :3] = rotation
    pose[:3, 3] = position
    return pose


def _direction(rng: np.random.Generator) -> np.ndarray:
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def _rotation(rng: np.random.Generator) -> np.ndarray:
    return turn(_direction(rng), rng.uniform(0.0, 2 * np.pi))


def _near(pose: np.ndarray, shift: float, angle: float) -> np.ndarray:
    """Poses a little beside one: shifted by up to `shift` [m] an axis, turned by up to `angle`."""
    rng = np.random.default_rng(1)
    return np.array(
        [
            pose_of(
                turn(_direction(rng), rng.uniform(0.0, angle)) @ pose[:3, :3],
                pose[:3, 3] + rng.uniform(-shift, shift, size=3),
            )
            for _ in range(POSES)
        ]
    )


def _sunk(height: Callable[[np.ndarray], float], size: float) -> np.ndarray:
    """Poses at any tilt, sunk into the half-space by 1 to 30 % of `size` [m].

    Args:
        height: of the origin above the lowest point [m], by the upward direction in the body
        size: length by which the depth is chosen [m]
    """
    rng = np.random.default_rng(2)
    poses = []
    for _ in range(POSES):
        rotation = _rotation(rng)
        depth = size * np.exp(rng.uniform(np.log(0.01), np.log(0.3)))
        x, y = rng.uniform(-1.0, 1.0, size=2)
        poses.append(pose_of(rotation, (x, y, height(rotation[2]) - depth)))
    return np.array(poses)


def _found(a: Body, b: Body, far: float, low: float, high: float) -> np.ndarray:
    """Random poses whose overlap is between two volumes [m^3]."""
    rng = np.random.default_rng(3)
    poses: list[np.ndarray] = []
    while len(poses) < POSES:
        pose = pose_of(_rotation(rng), rng.uniform(0.4, 1.0) * far * _direction(rng))
        if low < vc.interference(a.ours, b.ours, pose).volume < high:
            poses.append(pose)
    return np.array(poses)


def all_cases() -> Iterator[Case]:
    """Every pair of the benchmark."""
    yield from _half_space_cases()
    yield from _convex_cases()
    yield from _bored_cases()


def _half_space_cases() -> Iterator[Case]:
    ground = bodies.half_space()
    e = bodies.ball(0.5)
    yield Case(
        "half-space - sphere", ground, e, _sunk(lambda up: 0.5, 0.5), exact_volumes.ellipsoid_cap
    )
    e = bodies.ellipsoid(0.5, 0.35, 0.2)
    poses = _sunk(lambda up: float(np.linalg.norm(up * e.sizes)), 0.2)
    yield Case("half-space - ellipsoid", ground, e, poses, exact_volumes.ellipsoid_cap)

    brick = bodies.box(0.5, 0.4, 0.3)
    poses = _sunk(lambda up: float(np.abs(up) @ brick.sizes), 0.3)
    yield Case("half-space - box", ground, brick, poses, exact_volumes.polytopes)

    can = bodies.cylinder(0.3, 0.4)
    poses = _sunk(lambda up: 0.4 * abs(up[2]) + 0.3 * float(np.hypot(up[0], up[1])), 0.3)
    yield Case("half-space - cylinder", ground, can, poses, exact_volumes.turned_solid)
    pill = bodies.capsule(0.3, 0.4)
    poses = _sunk(lambda up: 0.4 * abs(up[2]) + 0.3, 0.3)
    yield Case("half-space - capsule", ground, pill, poses, exact_volumes.turned_solid)
    ring = bodies.torus(0.4, 0.1)
    poses = _sunk(lambda up: 0.4 * float(np.hypot(up[0], up[1])) + 0.1, 0.1)
    yield Case("half-space - torus", ground, ring, poses, exact_volumes.turned_solid)


def _convex_cases() -> Iterator[Case]:
    rng = np.random.default_rng(4)
    a = bodies.ball(0.5)
    poses = [pose_of(_rotation(rng), rng.uniform(0.95, 0.999) * _direction(rng)) for _ in range(24)]
    yield Case("sphere - sphere", a, a, np.array(poses), exact_volumes.lens)

    plate, brick = bodies.box(2.0, 2.0, 0.1), bodies.box(0.5, 0.4, 0.3)
    at_rest = _near(pose_of(np.eye(3), (0.3, 0.2, 0.398)), 1e-3, 2e-3)
    yield Case("box - box at rest", plate, brick, at_rest, exact_volumes.polytopes)
    poses = _found(brick, brick, 1.2, 1e-7, 1e-3)
    yield Case("box - box", brick, brick, poses, exact_volumes.polytopes)
    stone = bodies.gem(18, 3)
    poses = _found(stone, stone, 2.0, 1e-7, 1e-2)
    yield Case("polytope - polytope", stone, stone, poses, exact_volumes.polytopes)

    block, egg = bodies.box(1.0, 1.0, 0.5), bodies.ellipsoid(0.5, 0.35, 0.2)
    pose = pose_of(turn((1.0, 0.4, 0.3), 0.5), (0.93, 0.1, 0.73))
    yield Case("box - ellipsoid", block, egg, _near(pose, 1e-3, 1e-2))
    can, tilt, depth = bodies.cylinder(0.2, 0.4), 0.35, 0.02
    height = 0.5 + 0.4 * np.sin(tilt) + 0.2 * np.cos(tilt) - depth
    pose = pose_of(turn((0, 1, 0), np.pi / 2 - tilt), (0.1, 0.05, height))
    yield Case("box - cylinder", block, can, _near(pose, 1e-3, 1e-2))


def _bored_cases() -> Iterator[Case]:
    block = bodies.bored_block((0.03, 0.03, 0.02), 0.01)
    pose = pose_of(np.eye(3), (0.0, 0.0, 0.031))
    yield Case(
        "bored block - sphere",
        block,
        bodies.ball(0.015),
        _near(pose, 1e-6, 0.0),
        exact_volumes.ball_on_bore,
    )

    wide, close = bodies.cylinder(0.0097, 0.03), bodies.cylinder(0.00998, 0.03)
    tilted = _near(pose_of(turn((1, 0, 0), 0.03), (0, 0, 0)), 1e-6, 1e-4)
    yield Case("bored block - peg 0.3 mm", block, wide, tilted, exact_volumes.peg_in_bore)
    poses = _near(pose_of(turn((1, 0, 0), 0.002), (0, 0, 0)), 1e-6, 1e-5)
    yield Case("bored block - peg 0.02 mm", block, close, poses, exact_volumes.peg_in_bore)
    # The same by the engine that serves every solid, at fewer poses: it takes its time.
    for name, peg, near in (("0.3 mm", wide, tilted), ("0.02 mm", close, poses)):
        title = f"bored block - peg {name}, octree"
        yield Case(title, block, peg, near[:4], exact_volumes.peg_in_bore, "octree", 1e-2)
