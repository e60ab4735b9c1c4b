# SPDX-License-Identifier: Apache-2.0
"""MuJoCo: mj_collision of two geoms, native and by signed-distance fields."""

from __future__ import annotations

import mujoco
import numpy as np

from .bodies import Body
from .library import Unsupported

VERSION = mujoco.__version__
SEGMENTS = 64  # of the circles of meshes
NATIVE = {"half_space", "ball", "ellipsoid", "box", "cylinder", "capsule", "polytope"}
TYPES = {"half_space": "plane", "ball": "sphere"}


class Native:
    """Contact points by MuJoCo's own routines; a mesh is its convex hull."""

    library, gives = "MuJoCo", "points"
    variant, mesh_type = "native", "mesh"

    def __init__(self, a: Body, b: Body) -> None:
        self._check(a, b)
        parts = [self._geom(body, name) for body, name in ((a, "a"), (b, "b"))]
        self.model = mujoco.MjModel.from_xml_string(
            f"<mujoco><asset>{parts[0][0]}{parts[1][0]}</asset><worldbody>{parts[0][1]}"
            f"<body><freejoint/>{parts[1][1]}</body></worldbody></mujoco>"
        )
        self.data = mujoco.MjData(self.model)

    def _check(self, a: Body, b: Body) -> None:
        if {a.kind, b.kind} - NATIVE:
            raise Unsupported
        self.note = "points, depth and normal"

    def _geom(self, body: Body, name: str) -> tuple[str, str]:
        """Its asset, and its geom."""
        if body.kind == "polytope":
            assert body.points is not None
            asset = f'<mesh name="{name}" vertex="{_numbers(body.points)}"/>'
            return asset, f'<geom type="mesh" mesh="{name}" mass="1"/>'
        if body.kind in ("bored_block", "torus", "mesh"):
            from .manifold_meshes import triangles_of

            corners, triangles = triangles_of(body, SEGMENTS)
            asset = (
                f'<mesh name="{name}" vertex="{_numbers(corners)}" face="{_numbers(triangles)}"/>'
            )
            return asset, f'<geom type="{self.mesh_type}" mesh="{name}" mass="1"/>'
        sizes = body.sizes or (5.0, 5.0, 1.0)
        kind = TYPES.get(body.kind, body.kind)
        return "", f'<geom type="{kind}" size="{_numbers(np.array(sizes))}" mass="1"/>'

    def place(self, pose: np.ndarray) -> None:
        """Sets the pose of B in A, and all that follows from it."""
        self.data.qpos[:3] = pose[:3, 3]
        mujoco.mju_mat2Quat(self.data.qpos[3:7], np.ascontiguousarray(pose[:3, :3]).ravel())
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)

    def ask(self) -> int:
        """Collides."""
        mujoco.mj_collision(self.model, self.data)
        return self.data.ncon

    def finds(self, answer: int) -> bool:
        """Whether there is a contact point."""
        return answer > 0

    def volume(self, answer: int) -> None:
        """There is none."""


class Sdf(Native):
    """Contact points by descent on the signed-distance field of a mesh."""

    variant, mesh_type = "SDF", "sdf"

    def _check(self, a: Body, b: Body) -> None:
        if not {a.kind, b.kind} & {"bored_block", "torus"}:
            raise Unsupported
        self.note = f"distance field of a mesh of {SEGMENTS} segments; points"


class Hull(Native):
    """Contact points of convex hulls."""

    def _check(self, a: Body, b: Body) -> None:
        self.note = "points of the convex hulls, depth and normal"


class MeshSdf(Native):
    """Contact points by descent on the distance fields of the meshes themselves."""

    variant, mesh_type = "SDF", "sdf"

    def _check(self, a: Body, b: Body) -> None:
        self.note = "points by descent on the distance field of the mesh"


def _numbers(values: np.ndarray) -> str:
    return " ".join(f"{x:.17g}" for x in np.ravel(values))
