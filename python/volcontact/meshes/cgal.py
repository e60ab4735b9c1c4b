# SPDX-License-Identifier: Apache-2.0
"""Runs the program volcontact-cgal, which is GPL-3.0-or-later and a program of its own."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from volcontact.meshes.reading import read_mesh, write_mesh
from volcontact.meshes.triangles import Triangles

__all__ = ["MISSING", "check", "overlap", "program", "repair", "wrap"]

_PATIENCE = 900.0  # of one call [s]

MISSING = (
    "the program volcontact-cgal is not installed. In a checkout `./run volcontact mesh` builds "
    "it; else see docs/meshes.md"
)

Points = NDArray[np.float64]
Faces = NDArray[np.int64]


def program() -> str | None:
    """The path of the program, None if it is not installed.

    It is what the variable VOLCONTACT_CGAL names, else beside the Python that runs, else on the
    PATH. An empty variable says that it shall not be used.
    """
    named = os.environ.get("VOLCONTACT_CGAL")
    if named is not None:
        return named or None
    beside = Path(sys.executable).parent / "volcontact-cgal"
    return str(beside) if beside.is_file() else shutil.which("volcontact-cgal")


def check(vertices: Points, faces: Faces) -> dict[str, Any]:
    """What CGAL says of triangles: crossings, closedness, orientation, moments."""
    with tempfile.TemporaryDirectory(prefix="volcontact-") as folder:
        mesh = _put(folder, "mesh", vertices, faces)
        return _run("check", mesh)


def overlap(
    vertices_a: Points, faces_a: Faces, vertices_b: Points, faces_b: Faces
) -> dict[str, Any]:
    """Volume, centroid and inertia of the exact intersection of two solids."""
    with tempfile.TemporaryDirectory(prefix="volcontact-") as folder:
        a = _put(folder, "a", vertices_a, faces_a)
        return _run("overlap", a, _put(folder, "b", vertices_b, faces_b))


def repair(
    vertices: Points, faces: Faces, *, weld: float, fill: bool
) -> tuple[dict[str, Any], Triangles]:
    """Welds, cleans, orients, stitches and fills; returns what was done and the triangles."""
    with tempfile.TemporaryDirectory(prefix="volcontact-") as folder:
        mesh = _put(folder, "mesh", vertices, faces)
        out = str(Path(folder) / "out.off")
        report = _run("repair", mesh, out, repr(float(weld)), str(int(fill)))
        return report, read_mesh(out)


def wrap(vertices: Points, faces: Faces, *, alpha: float, offset: float) -> Triangles:
    """A closed surface around any triangles."""
    with tempfile.TemporaryDirectory(prefix="volcontact-") as folder:
        mesh = _put(folder, "mesh", vertices, faces)
        out = str(Path(folder) / "out.off")
        _run("wrap", mesh, out, repr(float(alpha)), repr(float(offset)))
        return read_mesh(out)


def _put(folder: str, name: str, vertices: Points, faces: Faces) -> str:
    path = str(Path(folder) / f"{name}.off")
    write_mesh(path, vertices, faces)
    return path


def _run(*arguments: str) -> dict[str, Any]:
    path = program()
    if path is None:
        raise RuntimeError(MISSING)
    try:
        done = subprocess.run(
            [path, *arguments], capture_output=True, text=True, timeout=_PATIENCE, check=False
        )
    except OSError as error:
        raise RuntimeError(f"{path} does not start: {error.strerror}") from None
    except subprocess.TimeoutExpired:
        raise RuntimeError(f"volcontact-cgal {arguments[0]} took over {_PATIENCE:g} s") from None
    if done.returncode < 0:
        raise RuntimeError(f"volcontact-cgal {arguments[0]} crashed with signal {-done.returncode}")
    if done.returncode:
        raise RuntimeError(f"volcontact-cgal: {done.stderr.strip()}")
    result: dict[str, Any] = json.loads(done.stdout)
    return result
