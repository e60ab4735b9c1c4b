# SPDX-License-Identifier: Apache-2.0
"""Reading and writing mesh files, strictly: a file that is not whole is refused, never guessed."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from volcontact._files import appearing
from volcontact.meshes.obj import read_obj
from volcontact.meshes.off import HEADER, read_off
from volcontact.meshes.ply import ply_bytes, read_ply
from volcontact.meshes.stl import read_stl, stl_bytes
from volcontact.meshes.triangles import MeshFileError, Triangles, fail

__all__ = ["FORMATS", "read_mesh", "write_mesh"]

_READERS: dict[str, Callable[[str, bytes], Triangles]] = {
    ".stl": read_stl,
    ".obj": read_obj,
    ".ply": read_ply,
    ".off": read_off,
}
FORMATS = "STL, OBJ, PLY or OFF"
_LARGEST = 1 << 31  # [byte]
_OBJ_LINE = re.compile(rb"^(v|vn|vt|f|g|o|s|mtllib|usemtl)[ \t]", re.MULTILINE)


def read_mesh(path: str | os.PathLike[str]) -> Triangles:
    """Reads the triangles of a file.

    Args:
        path: an STL (ASCII or binary), OBJ, PLY (ASCII or binary) or OFF file.

    Returns:
        The triangles; polygons are cut into them from their first corner.

    Raises:
        MeshFileError: the file is missing, cut off, inconsistent or of another kind. The message
            names the file, the line, byte, face or vertex, and what to do.
    """
    name = os.fspath(path)
    content = _content(name)
    _refuse_stand_ins(name, content)
    suffix = Path(name).suffix.lower()
    if suffix not in _READERS:
        fail(
            name,
            "",
            f"'{suffix}' is no format that is read here" if suffix else "the name has no suffix",
            f"Convert it to {FORMATS}, and name it so",
        )
    found = _sniffed(content)
    if found is not None and found != suffix and not (suffix == ".stl" and _is_whole_stl(content)):
        fail(
            name,
            "byte 0",
            f"this is {found[1:].upper()}, not {suffix[1:].upper()}",
            f"Rename it to {Path(name).with_suffix(found).name}",
        )
    mesh = _READERS[suffix](name, content)
    if not len(mesh.faces):
        fail(name, "", "the file has no face", "Export the surface as triangles")
    return mesh


def write_mesh(
    path: str | os.PathLike[str], vertices: NDArray[np.float64], faces: NDArray[np.int64]
) -> None:
    """Writes triangles: binary STL, OBJ, binary PLY or OFF, by the suffix of the name.

    Only STL rounds coordinates, to single precision. The file appears whole or not at all.

    Args:
        path: the file.
        vertices: shape (n, 3).
        faces: indices of vertices, shape (m, 3).
    """
    name = os.fspath(path)
    content = _bytes_of(name, vertices, faces)
    try:
        with appearing(name) as part:
            part.write_bytes(content)
    except OSError as error:
        raise MeshFileError(
            f"{name}: {error.strerror}. Choose a place that can be written."
        ) from None


def _bytes_of(name: str, vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> bytes:
    suffix = Path(name).suffix.lower()
    if suffix == ".stl":
        return stl_bytes(vertices, faces)
    if suffix == ".ply":
        return ply_bytes(vertices, faces)
    points = vertices.tolist()
    if suffix == ".obj":
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points]
        lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    elif suffix == ".off":
        lines = ["OFF", f"{len(vertices)} {len(faces)} 0"]
        lines += [f"{x!r} {y!r} {z!r}" for x, y, z in points]
        lines += [f"3 {a} {b} {c}" for a, b, c in faces.tolist()]
    else:
        fail(name, "", f"'{suffix}' is no format that is written here", f"Choose {FORMATS}")
    return ("\n".join(lines) + "\n").encode()


def _content(name: str) -> bytes:
    try:
        status = Path(name).stat()
        if stat.S_ISDIR(status.st_mode):
            fail(name, "", "this is a folder", "Name one file")
        if not stat.S_ISREG(status.st_mode):
            fail(name, "", "this is no regular file", "Name a file on disk")
        if status.st_size > _LARGEST:
            fail(name, "", f"{status.st_size} bytes are more than can be read", "Decimate the mesh")
        if status.st_size == 0:
            fail(name, "byte 0", "the file is empty")
        return Path(name).read_bytes()
    except FileNotFoundError:
        fail(name, "", "there is no such file", "Check the path")
    except (OSError, ValueError) as error:
        if isinstance(error, MeshFileError):
            raise
        reason = getattr(error, "strerror", None) or str(error)
        fail(name, "", f"it cannot be read: {reason}", "Check the path and its permissions")


def _refuse_stand_ins(name: str, content: bytes) -> None:
    """What often lies where a mesh ought to be."""
    start = content[:200].lstrip().lower()
    if start.startswith(b"version https://git-lfs"):
        fail(name, "line 1", "this stands for a file that Git LFS keeps", "Run git lfs pull")
    if start.startswith((b"<!doctype html", b"<html")):
        fail(name, "line 1", "this is a web page", "Download the file itself")


def _sniffed(content: bytes) -> str | None:
    """The suffix that the content asks for, None if it does not say."""
    start = content[:512].lstrip()
    if re.match(rb"ply\r?\n", start):
        return ".ply"
    if HEADER.match(start[:5].decode("latin-1")):
        return ".off"
    if _is_whole_stl(content) or re.match(rb"solid\b[^\0]*?\s+facet\b", start, re.IGNORECASE):
        return ".stl"
    if b"\0" not in content[:4096] and _OBJ_LINE.search(content[:4096]):
        return ".obj"
    return None


def _is_whole_stl(content: bytes) -> bool:
    return len(content) >= 84 and len(content) == 84 + 50 * int.from_bytes(content[80:84], "little")
