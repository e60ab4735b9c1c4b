# SPDX-License-Identifier: Apache-2.0
"""PLY files, ASCII and binary of either byte order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from volcontact.meshes.ply_header import Element, Header, read_header
from volcontact.meshes.text_lines import Polygons, count_of, points_of, text_of
from volcontact.meshes.triangles import LONGEST, Triangles, fail

__all__ = ["ply_bytes", "read_ply"]

_CORNERS = ("vertex_indices", "vertex_index")
_MANY = 1000  # corners of a polygon; more is a broken number


def read_ply(path: str, content: bytes) -> Triangles:
    """Reads the content of a PLY file."""
    header = read_header(path, content)
    names = [element.name for element in header.elements]
    for needed in ("vertex", "face"):
        if names.count(needed) != 1:
            fail(
                path,
                f"line {header.lines}",
                f"the header announces no {needed}"
                if needed not in names
                else f"two elements are named {needed}",
                "A mesh needs points and faces: export triangles",
            )
    vertex, face = header.elements[names.index("vertex")], header.elements[names.index("face")]
    if names.index("vertex") > names.index("face"):
        fail(path, f"line {face.line}", "faces before points are not read")
    for name in "xyz":
        place = vertex.index(name)
        if place is None or vertex.properties[place].count_code:
            fail(path, f"line {vertex.line}", f"the points have no number {name}")
    corners = face.index(*_CORNERS)
    if corners is None or not face.properties[corners].count_code:
        fail(path, f"line {face.line}", "the faces have no list vertex_indices")
    if face.properties[corners].code.startswith("f"):
        fail(path, f"line {face.line}", "indices of vertices are whole numbers")
    return (
        _read_binary(path, content, header) if header.order else _read_ascii(path, content, header)
    )


def ply_bytes(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> bytes:
    """The content of a binary PLY file, which keeps double precision."""
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment volcontact\n"
        f"element vertex {len(vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.zeros(len(faces), np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    rows["count"] = 3
    rows["corners"] = faces
    return header.encode() + vertices.astype("<f8").tobytes() + rows.tobytes()


# ---- ASCII ---------------------------------------------------------------------------------------


def _read_ascii(path: str, content: bytes, header: Header) -> Triangles:
    text = text_of(path, content)
    rows = [
        (number, words)
        for number, line in enumerate(text[header.lines :], header.lines + 1)
        if (words := line.split())
    ]
    announced = sum(element.count for element in header.elements)
    if len(rows) != announced:
        fail(
            path,
            f"line {rows[-1][0] if rows else header.lines}",
            f"the header announces {announced} rows, the file has {len(rows)}",
        )
    points = np.zeros((0, 3))
    polygons = Polygons(path, first=0)
    at = 0
    for element in header.elements:
        part = rows[at : at + element.count]
        at += element.count
        if element.name == "vertex":
            points = _ascii_points(path, element, part)
        elif element.name == "face":
            for number, words in part:
                polygons.add(_ascii_corners(path, element, number, words), number, len(points))
    return Triangles(points, polygons.faces(), path, "PLY, ASCII", polygons.lines(), "line")


def _ascii_points(
    path: str, element: Element, rows: list[tuple[int, list[str]]]
) -> NDArray[np.float64]:
    places = [element.index(name) or 0 for name in "xyz"]
    if any(one.count_code for one in element.properties[: max(places)]):
        fail(path, f"line {element.line}", "a list before x, y, z is not read")
    picked = [[words[i] for i in places if i < len(words)] for _, words in rows]
    return points_of(path, picked, [number for number, _ in rows])


def _ascii_corners(path: str, element: Element, number: int, words: list[str]) -> list[str]:
    """The indices of one face: other properties may stand before them."""
    at = 0
    for one in element.properties:
        if at >= len(words):
            break
        if not one.count_code:
            at += 1
            continue
        count = count_of(path, number, words[at], "corners", _MANY)
        if one.name in _CORNERS:
            found = words[at + 1 : at + 1 + count]
            if len(found) < count:
                break
            return found
        at += 1 + count
    fail(path, f"line {number}", f"the face is incomplete, here are {len(words)} words")


# ---- Binary --------------------------------------------------------------------------------------


def _read_binary(path: str, content: bytes, header: Header) -> Triangles:
    points = np.zeros((0, 3))
    polygons = Polygons(path, first=0)
    triangles, bytes_of = polygons.faces(), polygons.lines()
    at = header.size
    for element in header.elements:
        start = at
        if any(one.count_code for one in element.properties):
            corners, starts, at = _rows_with_lists(path, content, element, header.order, start)
        else:
            kind = np.dtype(
                [(f"p{i}", header.order + one.code) for i, one in enumerate(element.properties)]
            )
            at = start + kind.itemsize * element.count
            if at > len(content):
                _cut_off(path, content, element, (len(content) - start) // max(kind.itemsize, 1))
        if element.name == "vertex":
            if any(one.count_code for one in element.properties):
                fail(path, f"line {element.line}", "points with lists are not read")
            points = _binary_points(path, content, element, kind, start)
        elif element.name == "face":
            triangles, bytes_of = _triangles(path, corners, starts, len(points))
    if at != len(content):
        fail(path, f"byte {at}", f"the rows end here, and {len(content) - at} bytes follow")
    kind_of_file = "PLY, binary"
    return Triangles(points, triangles, path, kind_of_file, bytes_of, "byte")


def _cut_off(path: str, content: bytes, element: Element, complete: int) -> None:
    fail(
        path,
        f"byte {len(content)}",
        f"the file ends after {complete} of {element.count} rows of {element.name}: it was cut off",
    )


def _binary_points(
    path: str, content: bytes, element: Element, kind: np.dtype[np.void], start: int
) -> NDArray[np.float64]:
    rows = np.frombuffer(content, kind, count=element.count, offset=start)
    columns = [rows[f"p{element.index(name)}"].astype(np.float64) for name in "xyz"]
    points = np.stack(columns, axis=1)
    bad = np.flatnonzero(~(np.abs(points) <= LONGEST).all(axis=1))
    if bad.size:
        fail(
            path,
            f"vertex {bad[0]} (byte {start + kind.itemsize * bad[0]})",
            f"{points[bad[0]].tolist()} is no point: "
            f"coordinates are finite and at most {LONGEST:g}",
            "Correct the number or the unit where the mesh was made",
        )
    return points


def _rows_with_lists(
    path: str, content: bytes, element: Element, order: str, start: int
) -> tuple[list[NDArray[np.int64]], list[int], int]:
    """The list of corners of each row, where each row begins, and where the rows end."""
    steps = [
        (one, np.dtype(order + one.code), np.dtype(order + (one.count_code or "u1")))
        for one in element.properties
    ]
    corners: list[NDArray[np.int64]] = []
    starts: list[int] = []
    at = start
    for row in range(element.count):
        starts.append(at)
        for one, kind, count_kind in steps:
            count = 1
            if one.count_code:
                if at + count_kind.itemsize > len(content):
                    _cut_off(path, content, element, row)
                count = int(np.frombuffer(content, count_kind, count=1, offset=at)[0])
                at += count_kind.itemsize
                if not 0 <= count <= _MANY:
                    fail(
                        path,
                        f"{element.name} {row} (byte {starts[-1]})",
                        f"a list of {count} numbers is no polygon",
                    )
            if at + count * kind.itemsize > len(content):
                _cut_off(path, content, element, row)
            if one.count_code and one.name in _CORNERS:
                found = np.frombuffer(content, kind, count=count, offset=at)
                corners.append(found.astype(np.int64))
            at += count * kind.itemsize
    return corners, starts, at


def _triangles(
    path: str, corners: list[NDArray[np.int64]], starts: list[int], vertices: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    triangles: list[NDArray[np.int64]] = []
    bytes_of: list[int] = []
    for row, (polygon, start) in enumerate(zip(corners, starts, strict=True)):
        place = f"face {row} (byte {start})"
        if len(polygon) < 3:
            fail(path, place, f"a face needs three corners, here are {len(polygon)}")
        if polygon.min() < 0 or polygon.max() >= vertices:
            fail(
                path,
                place,
                f"its corners are {polygon[:8].tolist()}, the vertices are 0 to {vertices - 1}",
            )
        for second in range(1, len(polygon) - 1):
            triangles.append(polygon[[0, second, second + 1]])
            bytes_of.append(start)
    faces = np.array(triangles, dtype=np.int64).reshape(-1, 3)
    return faces, np.array(bytes_of, dtype=np.int64)
