# SPDX-License-Identifier: Apache-2.0
"""Overlaps of triangle meshes by manifold3d and by CGAL, with the moments that ours must equal."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from volcontact.meshes import cgal
from volcontact.meshes.moments import Moments, moments_of
from volcontact.meshes.reading import write_mesh

from .bodies import Body
from .library import Unsupported
from .manifold_meshes import Boolean, triangles_of

FLAT = {"half_space", "box", "mesh"}
SMALL = np.vstack([np.zeros(3), np.eye(3)]), np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


class MeshBoolean(Boolean):
    """manifold3d: the intersection of two meshes and its volume; round solids have 64 segments."""

    segments = 64

    def __init__(self, a: Body, b: Body) -> None:
        super().__init__(a, b)
        self.is_exact = {a.kind, b.kind} <= FLAT

    def place(self, pose: np.ndarray) -> None:
        """Sets the pose of B in A."""
        super().place(pose)
        self.X_AB = pose

    def ask(self) -> Any:
        """Moves, intersects, measures."""
        still, moving = (self.a, self.b) if self.moves_b else (self.b, self.a)
        common = still ^ moving.transform(self.pose)
        common.volume()  # it works when it is asked
        return common

    def finds(self, answer: Any) -> bool:
        """Whether they overlap."""
        return answer.volume() > 0.0

    def volume(self, answer: Any) -> float:
        """The volume [m^3]."""
        return answer.volume()

    def moments(self, answer: Any) -> Moments:
        """Of the overlap at the last pose, in A."""
        mesh = answer.to_mesh64()
        points = np.asarray(mesh.vert_properties)[:, :3]
        if len(points) == 0:
            return Moments(0.0, np.zeros(3), np.zeros((3, 3)))
        if not self.moves_b:
            points = points @ self.X_AB[:3, :3].T + self.X_AB[:3, 3]
        return moments_of(points, np.asarray(mesh.tri_verts, dtype=np.int64))


class Corefinement:
    """CGAL in a program of its own: the time is that of the processor in it, but for its start.

    The start is what it takes for two meshes of four triangles.
    """

    library, variant, gives = "CGAL", "corefinement", "volume"
    is_exact = True

    def __init__(self, a: Body, b: Body) -> None:
        program = cgal.program()
        if program is None or not {a.kind, b.kind} <= FLAT:
            raise Unsupported
        self.program = program
        self.folder = tempfile.TemporaryDirectory(prefix="volcontact-")
        self.paths = [str(Path(self.folder.name) / f"{name}.off") for name in "ab"]
        self.start = 0.0
        for path in self.paths:
            write_mesh(path, *SMALL)
        self.start = min(self._spent() for _ in range(4))
        write_mesh(self.paths[0], *_mesh(a))
        self.b = _mesh(b)
        self.note = "exact numbers; a program of its own: reading and building count, its start not"

    def _spent(self) -> float:
        self.ask()
        return self.spent_us

    def place(self, pose: np.ndarray) -> None:
        """Writes B where it is in A."""
        points, triangles = self.b
        write_mesh(self.paths[1], points @ pose[:3, :3].T + pose[:3, 3], triangles)

    def ask(self) -> dict[str, Any]:
        """Runs the program; `spent_us` is then what it took."""
        command = [self.program, "overlap", *self.paths]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as running:
            assert running.stdout is not None
            text = running.stdout.read()
            _, status, usage = os.wait4(running.pid, 0)
            running.returncode = os.waitstatus_to_exitcode(status)
        if running.returncode != 0:
            raise RuntimeError(f"volcontact-cgal ended with {running.returncode}")
        self.spent_us = max(0.0, 1e6 * (usage.ru_utime + usage.ru_stime) - self.start)
        return json.loads(text)

    def finds(self, answer: dict[str, Any]) -> bool:
        """Whether they overlap."""
        return answer["volume"] > 0.0

    def volume(self, answer: dict[str, Any]) -> float:
        """The volume [m^3]."""
        return answer["volume"]

    def moments(self, answer: dict[str, Any]) -> Moments:
        """Of the overlap, in A."""
        centroid, inertia = np.array(answer["centroid"]), np.array(answer["inertia"])
        return Moments(answer["volume"], centroid, inertia)


def _mesh(body: Body) -> tuple[np.ndarray, np.ndarray]:
    points, triangles = triangles_of(body, 0)
    return np.asarray(points, dtype=float), np.asarray(triangles, dtype=np.int64)
