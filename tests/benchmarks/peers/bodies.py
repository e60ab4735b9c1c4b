# SPDX-License-Identifier: Apache-2.0
"""The solids of the benchmark: ours, and the plain numbers from which every peer builds its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import volcontact as vc


@dataclass(frozen=True)
class Body:
    """One solid.

    Attributes:
        kind: what it is
        sizes [m]: its radii and half lengths, in the order of our constructor
        size [m]: radius of a ball about the origin that holds it; infinite for the half-space
        ours: the solid of volcontact
        points [m]: corners of a polytope or of a mesh, shape (n, 3)
        triangles: of a mesh, counterclockwise seen from outside, shape (m, 3)
    """

    kind: str
    sizes: tuple[float, ...]
    size: float
    ours: Any
    points: np.ndarray | None = None
    triangles: np.ndarray | None = None


def half_space() -> Body:
    """Everything at z <= 0."""
    return Body("half_space", (), np.inf, vc.HalfSpace())


def ball(radius: float) -> Body:
    """A ball about the origin."""
    return Body("ball", (radius,), radius, vc.Sphere(radius))


def ellipsoid(*semi_axes: float) -> Body:
    """An ellipsoid along the axes."""
    return Body("ellipsoid", semi_axes, max(semi_axes), vc.Ellipsoid(semi_axes))


def box(*half_sizes: float) -> Body:
    """A box along the axes."""
    return Body("box", half_sizes, float(np.linalg.norm(half_sizes)), vc.Box(half_sizes))


def cylinder(radius: float, half_length: float) -> Body:
    """A cylinder about the z axis."""
    size = float(np.hypot(radius, half_length))
    return Body("cylinder", (radius, half_length), size, vc.Cylinder(radius, half_length))


def capsule(radius: float, half_length: float) -> Body:
    """A capsule about the z axis."""
    size = radius + half_length
    return Body("capsule", (radius, half_length), size, vc.Capsule(radius, half_length))


def torus(major_radius: float, minor_radius: float) -> Body:
    """A ring about the z axis."""
    size = major_radius + minor_radius
    return Body("torus", (major_radius, minor_radius), size, vc.Torus(major_radius, minor_radius))


def gem(corners: int, seed: int) -> Body:
    """The hull of points on the unit sphere: 2 n - 4 triangles."""
    points = np.random.default_rng(seed).normal(size=(corners, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    return Body("polytope", (), 1.0, vc.ConvexPolytope(points), points)


def bored_block(half_sizes: tuple[float, float, float], radius: float) -> Body:
    """A box with a bore through it, about the z axis."""
    solid = vc.Box(half_sizes) - vc.Cylinder(radius, 1.5 * half_sizes[2])
    return Body("bored_block", (*half_sizes, radius), float(np.linalg.norm(half_sizes)), solid)


def mesh(points: np.ndarray, triangles: np.ndarray) -> Body:
    """What closed triangles enclose."""
    size = float(np.linalg.norm(points, axis=1).max())
    triangles = np.asarray(triangles, dtype=np.int32)
    return Body("mesh", (), size, vc.Mesh(points, triangles), points, triangles)


def turned_mesh(profile: np.ndarray, chords: int) -> Body:
    """A closed profile (radius, z) [m], counterclockwise, shape (n, 2), turned about the z axis."""
    angles = 2 * np.pi * np.arange(chords) / chords
    around = np.stack([np.cos(angles), np.sin(angles), np.ones(chords)], axis=1)
    points = (around[:, None] * profile[None][:, :, [0, 0, 1]]).reshape(-1, 3)
    n = len(profile)
    i, j = (x.ravel() for x in np.meshgrid(np.arange(chords), np.arange(n), indexing="ij"))
    a, b = i * n + j, i * n + (j + 1) % n
    c, d = ((i + 1) % chords) * n + (j + 1) % n, ((i + 1) % chords) * n + j
    triangles = np.concatenate([np.stack([a, d, c], axis=1), np.stack([a, c, b], axis=1)])
    return mesh(points, triangles)
