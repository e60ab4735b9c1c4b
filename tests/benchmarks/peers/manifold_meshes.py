# SPDX-License-Identifier: Apache-2.0
"""manifold3d: exact booleans of triangle meshes; and the meshes that other peers are given."""

from __future__ import annotations

import manifold3d
import numpy as np
from manifold3d import CrossSection, Manifold, Mesh64

from .bodies import Body

VERSION = getattr(manifold3d, "__version__", "")
FAR = 4.0  # [m] extent of the half-space


def mesh_of(body: Body, segments: int) -> Manifold:
    """The solid as a mesh whose circles have so many corners, all on the true circle."""
    s = body.sizes
    if body.kind == "half_space":
        return Manifold.cube([2 * FAR, 2 * FAR, FAR], center=True).translate([0, 0, -FAR / 2])
    if body.kind == "ball":
        return Manifold.sphere(s[0], segments)
    if body.kind == "ellipsoid":
        return Manifold.sphere(1.0, segments).scale(s)
    if body.kind == "box":
        return Manifold.cube([2 * h for h in s], center=True)
    if body.kind == "cylinder":
        return Manifold.cylinder(2 * s[1], s[0], s[0], segments, center=True)
    if body.kind == "capsule":
        ball = Manifold.sphere(s[0], segments)
        ends = [ball.translate([0, 0, s[1]]), ball.translate([0, 0, -s[1]])]
        return Manifold.batch_hull(ends)
    if body.kind == "torus":
        circle = CrossSection.circle(s[1], segments).translate([s[0], 0])
        return Manifold.revolve(circle, segments)
    if body.kind == "polytope":
        return Manifold.hull_points(np.asarray(body.points))
    if body.kind == "mesh":
        assert body.triangles is not None
        return Manifold(Mesh64(body.points, body.triangles.astype(np.uint64)))
    assert body.kind == "bored_block"
    bore = Manifold.cylinder(3 * s[2], s[3], s[3], segments, center=True)
    return Manifold.cube([2 * h for h in s[:3]], center=True) - bore


def triangles_of(body: Body, segments: int) -> tuple[np.ndarray, np.ndarray]:
    """Corners [m], shape (n, 3), and triangles, shape (m, 3), of the mesh."""
    if body.kind == "mesh":
        return body.points, body.triangles
    mesh = mesh_of(body, segments).to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts)


class Boolean:
    """Intersection of two meshes and its volume."""

    library, gives = "manifold3d", "volume"
    segments = 0

    def __init__(self, a: Body, b: Body) -> None:
        self.a, self.b = mesh_of(a, self.segments), mesh_of(b, self.segments)
        # Moving a mesh costs time too: the smaller one is moved.
        self.moves_b = self.b.num_tri() <= self.a.num_tri()
        flat = {"half_space", "box", "mesh", "polytope"}
        exact = a.kind in flat and b.kind in flat
        self.variant = "boolean" if exact else f"boolean, {self.segments} segments"
        triangles = self.a.num_tri() + self.b.num_tri()
        self.note = f"{triangles} triangles" + ("" if exact else "; the chords are the error")

    def place(self, pose: np.ndarray) -> None:
        """Sets the pose of B in A."""
        moved = pose if self.moves_b else np.linalg.inv(pose)
        self.pose = np.ascontiguousarray(moved[:3])

    def ask(self) -> float:
        """Moves, intersects, measures."""
        if self.moves_b:
            return (self.a ^ self.b.transform(self.pose)).volume()
        return (self.b ^ self.a.transform(self.pose)).volume()

    def finds(self, answer: float) -> bool:
        """Whether they overlap."""
        return answer > 0.0

    def volume(self, answer: float) -> float:
        """The volume [m^3]."""
        return answer


class CoarseBoolean(Boolean):
    """Circles of 64 corners."""

    segments = 64


class FineBoolean(Boolean):
    """Circles of 256 corners."""

    segments = 256
