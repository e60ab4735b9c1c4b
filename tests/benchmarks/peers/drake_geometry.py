# SPDX-License-Identifier: Apache-2.0
"""Drake: hydroelastic contact surfaces, and point contact."""

from __future__ import annotations

import logging

import numpy as np
from pydrake.common import MemoryFile
from pydrake.common.value import Value
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddCompliantHydroelasticPropertiesForHalfSpace,
    AddRigidHydroelasticProperties,
    Box,
    Capsule,
    Convex,
    Cylinder,
    Ellipsoid,
    FramePoseVector,
    GeometryFrame,
    GeometryInstance,
    HalfSpace,
    HydroelasticContactRepresentation,
    InMemoryMesh,
    Mesh,
    ProximityProperties,
    SceneGraph,
    Shape,
    Sphere,
)
from pydrake.math import RigidTransform

from .bodies import Body
from .library import Unsupported

logging.getLogger("drake").setLevel(logging.ERROR)  # it warns of deformable bodies; there are none

SEGMENTS = 64  # of the circles of meshes
FINENESS = 0.1  # resolution hint by the size of the body
MODULUS = 1.0  # [Pa], of all compliant bodies; with a slab of 1 m the pressure is the depth
MESHES = {"bored_block", "mesh", "torus"}


class _Scene:
    """Two bodies in a SceneGraph, the second free."""

    library = "Drake"

    def __init__(self, a: Body, b: Body) -> None:
        self._check(a, b)
        self.scene = SceneGraph()
        source = self.scene.RegisterSource("benchmark")
        self.frame = self.scene.RegisterFrame(source, GeometryFrame("b"))
        fixed, free = self._instance(a, b), self._instance(b, a)
        self.scene.RegisterAnchoredGeometry(source, fixed)
        self.scene.RegisterGeometry(source, self.frame, free)
        self.context = self.scene.CreateDefaultContext()
        self.poses = self.scene.get_source_pose_port(source)
        self.place(np.eye(4))

    def _instance(self, body: Body, other: Body) -> GeometryInstance:
        instance = GeometryInstance(RigidTransform(), _shape(body), body.kind + str(id(body)))
        properties = ProximityProperties()
        self._describe(body, other, properties)
        instance.set_proximity_properties(properties)
        return instance

    def place(self, pose: np.ndarray) -> None:
        """Sets the pose of B in A."""
        poses = FramePoseVector()
        poses.set_value(self.frame, RigidTransform(pose))
        self.poses.FixValue(self.context, Value(poses))
        self.query = self.scene.get_query_output_port().Eval(self.context)

    def finds(self, answer: list) -> bool:
        """Whether there is a contact."""
        return len(answer) > 0


class Hydroelastic(_Scene):
    """The surface of equal pressure of two fields, as polygons."""

    variant, gives = "hydroelastic", "surface"

    def _check(self, a: Body, b: Body) -> None:
        self.on_half_space = a.kind == "half_space"
        rough = {a.kind, b.kind} & MESHES
        self.note = f"resolution hint {FINENESS:g} of the size"
        if rough:
            self.note = f"rigid mesh of {SEGMENTS} segments on a compliant solid"
        if self.on_half_space:
            self.note += "; volume from the pressure of the compliant half-space"

    def _describe(self, body: Body, other: Body, properties: ProximityProperties) -> None:
        if body.kind == "half_space":
            AddCompliantHydroelasticPropertiesForHalfSpace(1.0, MODULUS, properties)
        elif body.kind in MESHES or other.kind == "half_space":
            AddRigidHydroelasticProperties(FINENESS * body.size, properties)
        else:
            AddCompliantHydroelasticProperties(FINENESS * body.size, MODULUS, properties)

    def ask(self) -> list:
        """Moves, and finds the surface."""
        return self.query.ComputeContactSurfaces(HydroelasticContactRepresentation.kPolygon)

    def volume(self, answer: list) -> float | None:
        """The pressure of a compliant half-space is the depth: its integral is the volume [m^3]."""
        if not self.on_half_space:
            return None
        total = 0.0
        kind = HydroelasticContactRepresentation.kTriangle
        for surface in self.query.ComputeContactSurfaces(kind):
            mesh, pressure = surface.tri_mesh_W(), surface.tri_e_MN()
            for k, triangle in enumerate(mesh.triangles()):
                mean = sum(pressure.EvaluateAtVertex(triangle.vertex(i)) for i in range(3)) / 3
                total += mean * mesh.area(k) * surface.face_normal(k)[2]
        return abs(total)


class PointContact(_Scene):
    """One pair of points at the deepest penetration."""

    variant, gives = "point", "points"
    note = "one pair of points and the depth"

    def _check(self, a: Body, b: Body) -> None:
        if {a.kind, b.kind} & MESHES:  # their hulls would be taken
            raise Unsupported

    def _describe(self, body: Body, other: Body, properties: ProximityProperties) -> None:
        pass

    def ask(self) -> list:
        """Moves, and finds the points."""
        return self.query.ComputePointPairPenetration()

    def volume(self, answer: list) -> None:
        """There is none."""


def _shape(body: Body) -> Shape:
    s = body.sizes
    if body.kind == "half_space":
        return HalfSpace()
    if body.kind == "ball":
        return Sphere(s[0])
    if body.kind == "ellipsoid":
        return Ellipsoid(*s)
    if body.kind == "box":
        return Box(*(2 * h for h in s))
    if body.kind == "cylinder":
        return Cylinder(s[0], 2 * s[1])
    if body.kind == "capsule":
        return Capsule(s[0], 2 * s[1])
    if body.kind == "polytope":
        assert body.points is not None
        return Convex(np.asfortranarray(body.points.T), "polytope")
    from .manifold_meshes import triangles_of

    corners, triangles = triangles_of(body, SEGMENTS)
    lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in corners]
    lines += [f"f {i + 1} {j + 1} {k + 1}" for i, j, k in triangles]
    return Mesh(InMemoryMesh(mesh_file=MemoryFile("\n".join(lines) + "\n", ".obj", body.kind)))
