# SPDX-License-Identifier: Apache-2.0
"""Contact of meshes by Drake: the pressure surface of a rigid mesh in a compliant solid."""

from __future__ import annotations

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddRigidHydroelasticProperties,
    GeometryInstance,
    InMemoryMesh,
    Mesh,
    ProximityProperties,
)
from pydrake.math import RigidTransform

from .bodies import Body
from .drake_geometry import MODULUS, Hydroelastic
from .library import Unsupported


class MeshHydroelastic(Hydroelastic):
    """A rigid mesh on a compliant half-space, primitive, or mesh filled with tetrahedra."""

    def _check(self, a: Body, b: Body) -> None:
        super()._check(a, b)
        if a.kind == b.kind == "mesh":
            # Drake does not fill a mesh: its middle, if it sees all faces, makes the tetrahedra.
            if not sees_all(b):
                raise Unsupported
            self.note = "rigid mesh; the other filled with one tetrahedron a triangle"
        else:
            self.note = self.note.replace("mesh of 64 segments", "mesh")
        self.soft = b if a.kind == b.kind == "mesh" else None
        self.made = 0

    def _instance(self, body: Body, other: Body) -> GeometryInstance:
        self.made += 1
        if self.soft is None or self.made == 1:  # A is first
            return super()._instance(body, other)
        mesh = Mesh(InMemoryMesh(mesh_file=MemoryFile(filled(body), ".vtk", "filled")))
        instance = GeometryInstance(RigidTransform(), mesh, f"filled{id(body)}")
        properties = ProximityProperties()
        AddCompliantHydroelasticProperties(body.size, MODULUS, properties)
        instance.set_proximity_properties(properties)
        return instance

    def _describe(self, body: Body, other: Body, properties: ProximityProperties) -> None:
        if body.kind == "mesh":
            AddRigidHydroelasticProperties(body.size, properties)
        else:
            super()._describe(body, other, properties)


def sees_all(body: Body) -> bool:
    """Whether the origin is on the inner side of every triangle."""
    assert body.points is not None and body.triangles is not None
    p, q, r = (body.points[body.triangles[:, k]] for k in range(3))
    return bool((np.einsum("ni,ni->n", p, np.cross(q, r)) > 0.0).all())


def filled(body: Body) -> str:
    """A VTK file of the tetrahedra from the origin to the triangles."""
    assert body.points is not None and body.triangles is not None
    lines = ["# vtk DataFile Version 3.0", "filled", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [f"POINTS {len(body.points) + 1} double"]
    lines += [f"{x:.17g} {y:.17g} {z:.17g}" for x, y, z in body.points]
    middle, count = len(body.points), len(body.triangles)
    lines += ["0 0 0", f"CELLS {count} {5 * count}"]
    lines += [f"4 {middle} {i} {j} {k}" for i, j, k in body.triangles]
    lines += [f"CELL_TYPES {count}", *["10"] * count]
    return "\n".join(lines) + "\n"
