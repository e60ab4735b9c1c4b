# SPDX-License-Identifier: Apache-2.0
"""OFF files: a header, three counts, points, polygons."""

from __future__ import annotations

import re

from volcontact.meshes.text_lines import Polygons, count_of, points_of, text_of
from volcontact.meshes.triangles import Triangles, fail

__all__ = ["read_off"]

HEADER = re.compile(r"(ST)?C?N?OFF\b")


def read_off(path: str, content: bytes) -> Triangles:
    """Reads the content of an OFF file."""
    rows = [
        (number, words)
        for number, line in enumerate(text_of(path, content), 1)
        if (words := line.partition("#")[0].split())
    ]
    if not rows or not HEADER.fullmatch(rows[0][1][0]):
        fail(
            path, "line 1", "an OFF file begins with the word OFF", "Check what kind of file it is"
        )
    if "BINARY" in rows[0][1]:
        fail(path, "line 1", "binary OFF is not read", "Export as STL, OBJ or PLY")
    if len(rows[0][1]) > 1:
        rows[0] = (rows[0][0], rows[0][1][1:])  # the counts may follow the word
    else:
        del rows[0]
    if not rows or len(rows[0][1]) < 2:
        fail(
            path, f"line {rows[0][0] if rows else 1}", "the numbers of points and faces are missing"
        )
    line, counts = rows.pop(0)
    vertices = count_of(path, line, counts[0], "points", len(content))
    faces = count_of(path, line, counts[1], "faces", len(content))
    if len(rows) != vertices + faces:
        fail(
            path,
            f"line {rows[-1][0] if rows else line}",
            f"{vertices} points and {faces} faces are announced on line {line}, "
            f"{vertices + faces} lines ought to follow, here are {len(rows)}",
        )
    points = points_of(path, [row for _, row in rows[:vertices]], [n for n, _ in rows[:vertices]])
    polygons = Polygons(path, first=0)
    for number, words in rows[vertices:]:
        corners = count_of(path, number, words[0], "corners", vertices)
        if len(words) < 1 + corners:
            fail(
                path, f"line {number}", f"{corners} corners are announced, {len(words) - 1} follow"
            )
        polygons.add(words[1 : 1 + corners], number, vertices)
    return Triangles(points, polygons.faces(), path, "OFF", polygons.lines(), "line")
