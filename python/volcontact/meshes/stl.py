# SPDX-License-Identifier: Apache-2.0
"""STL files, binary and ASCII: three points a triangle, no indices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from volcontact.meshes.text_lines import points_of, text_of
from volcontact.meshes.triangles import LONGEST, Triangles, fail

__all__ = ["read_stl", "stl_bytes"]

_HEADER = 84
_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_stl(path: str, content: bytes) -> Triangles:
    """Reads the content of an STL file of either kind."""
    # Binary files may begin with "solid" too; their length gives them away.
    if len(content) != _promised_size(content) and content[:512].lstrip()[:5].lower() == b"solid":
        return _read_ascii(path, content)
    return _read_binary(path, content)


def stl_bytes(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> bytes:
    """The content of a binary STL file. Coordinates are rounded to single precision."""
    corners = vertices[faces].astype("<f4")
    facets = np.zeros(len(faces), _FACET)
    facets["corners"] = corners
    with np.errstate(all="ignore"):
        wide = corners.astype(np.float64)
        normals = np.cross(wide[:, 1] - wide[:, 0], wide[:, 2] - wide[:, 0])
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    facets["normal"] = np.where(lengths > 0.0, normals / np.where(lengths > 0.0, lengths, 1.0), 0.0)
    count = len(faces).to_bytes(4, "little")
    return b"volcontact".ljust(80) + count + facets.tobytes()


def _promised_size(content: bytes) -> int:
    if len(content) < _HEADER:
        return -1
    return _HEADER + _FACET.itemsize * int.from_bytes(content[80:_HEADER], "little")


def _read_binary(path: str, content: bytes) -> Triangles:
    size = _promised_size(content)
    if size < 0:
        fail(path, f"byte {len(content)}", f"the file ends inside the header of {_HEADER} bytes")
    count = (size - _HEADER) // _FACET.itemsize
    if size != len(content):
        what = "it was cut off" if size > len(content) else "there is more behind them"
        fail(
            path,
            f"byte {min(size, len(content))}",
            f"byte 80 announces {count} faces, which take {size} bytes, the file has "
            f"{len(content)}: {what}, or it is no STL file",
        )
    facets = np.frombuffer(content, _FACET, offset=_HEADER)
    corners = facets["corners"].astype(np.float64)
    bytes_of = _HEADER + _FACET.itemsize * np.arange(count, dtype=np.int64)
    bad = np.flatnonzero(~(np.abs(corners) <= LONGEST).all(axis=(1, 2)))
    if bad.size:
        fail(
            path,
            f"face {bad[0]} (byte {bytes_of[bad[0]]})",
            f"a corner is no point: coordinates are finite and at most {LONGEST:g}",
            "Correct the number or the unit where the mesh was made",
        )
    faces = np.arange(3 * count, dtype=np.int64).reshape(-1, 3)
    return Triangles(corners.reshape(-1, 3), faces, path, "STL, binary", bytes_of, "byte")


def _read_ascii(path: str, content: bytes) -> Triangles:
    rows: list[list[str]] = []
    lines: list[int] = []
    places: list[int] = []
    inside = ""  # what is open: "", "solid", "facet" or "loop"
    corners = number = 0
    for number, line in enumerate(text_of(path, content), 1):
        words = line.split()
        if not words:
            continue
        keyword = words[0].lower()
        if keyword == "vertex" and inside == "loop":
            corners += 1
            rows.append(words[1:])
            lines.append(number)
        elif keyword == "facet" and inside == "solid":
            inside = "facet"
            places.append(number)
        elif keyword == "outer" and inside == "facet":
            inside, corners = "loop", 0
        elif keyword == "endloop" and inside == "loop":
            inside = "facet"
            if corners != 3:
                fail(path, f"line {number}", f"a facet has three corners, here are {corners}")
        elif keyword == "endfacet" and inside == "facet":
            inside = "solid"
            if len(rows) != 3 * len(places):
                fail(path, f"line {number}", "a facet ends without its three corners")
        elif keyword == "solid" and inside == "":
            inside = "solid"
        elif keyword == "endsolid" and inside == "solid":
            inside = ""
        else:
            shown = "".join(letter if letter.isprintable() else "?" for letter in words[0][:20])
            fail(path, f"line {number}", f"'{shown}' does not belong here in an ASCII STL file")
    if inside:
        fail(path, f"line {number}", f"the file ends inside a {inside}: it was cut off")
    points = points_of(path, rows, lines)
    faces = np.arange(len(points), dtype=np.int64).reshape(-1, 3)
    return Triangles(points, faces, path, "STL, ASCII", np.array(places, np.int64), "line")
