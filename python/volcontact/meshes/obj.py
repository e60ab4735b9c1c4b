# SPDX-License-Identifier: Apache-2.0
"""Wavefront OBJ files: points and polygons; materials, normals and textures are passed over."""

from __future__ import annotations

from volcontact.meshes.text_lines import Polygons, points_of, text_of
from volcontact.meshes.triangles import Triangles, fail

__all__ = ["read_obj"]

_PASSED_OVER = frozenset(
    [
        "vn",
        "vt",
        "vp",
        "g",
        "o",
        "s",
        "l",
        "p",
        "usemtl",
        "mtllib",
        "usemap",
        "maplib",
        "mg",
        "lod",
        "bevel",
        "c_interp",
        "d_interp",
        "shadow_obj",
        "trace_obj",
    ]
)
_CURVED = frozenset(
    [
        "cstype",
        "deg",
        "bmat",
        "step",
        "curv",
        "curv2",
        "surf",
        "parm",
        "trim",
        "hole",
        "scrv",
        "sp",
        "end",
        "con",
    ]
)


def read_obj(path: str, content: bytes) -> Triangles:
    """Reads the content of an OBJ file."""
    points: list[list[str]] = []
    lines: list[int] = []
    polygons = Polygons(path, first=1)
    pending = ""
    for number, text in enumerate(text_of(path, content), 1):
        line = pending + text.partition("#")[0]
        pending = ""
        if line.endswith("\\"):
            pending = line[:-1] + " "
            continue
        words = line.split()
        if not words:
            continue
        keyword = words[0]
        if keyword == "v":
            points.append(words[1:])
            lines.append(number)
        elif keyword == "f":
            corners = [word.partition("/")[0] for word in words[1:]]
            polygons.add(corners, number, len(points), relative=True)
        elif keyword in _CURVED:
            fail(path, f"line {number}", "curved surfaces are not read", "Export triangles")
        elif keyword not in _PASSED_OVER:
            shown = "".join(letter if letter.isprintable() else "?" for letter in keyword[:20])
            fail(
                path,
                f"line {number}",
                f"'{shown}' is no word of an OBJ file",
                "Check what kind of file it is, or export it again",
            )
    vertices = points_of(path, points, lines)
    return Triangles(vertices, polygons.faces(), path, "OBJ", polygons.lines(), "line")
