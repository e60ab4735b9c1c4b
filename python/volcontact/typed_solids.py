# SPDX-License-Identifier: Apache-2.0
"""Solids and poses as one types them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import volcontact as vc
from volcontact.meshes.reading import read_mesh

SHAPES: dict[str, type] = {
    "half_space": vc.HalfSpace,
    "sphere": vc.Sphere,
    "ellipsoid": vc.Ellipsoid,
    "capsule": vc.Capsule,
    "cylinder": vc.Cylinder,
    "frustum": vc.Frustum,
    "box": vc.Box,
    "rounded_box": vc.RoundedBox,
    "torus": vc.Torus,
}


def solid(text: str) -> Any:
    """A solid from "sphere:radius=0.05", "box:half_sizes=0.1,0.1,0.2" or the name of a mesh file.

    Raises:
        ValueError: it is neither; the message says how to write it.
    """
    name, _, rest = text.partition(":")
    if name not in SHAPES:
        return _mesh(text)
    values: dict[str, Any] = {}
    word = ""
    for part in filter(None, rest.split(",")):
        key, equals, number = part.partition("=")
        word, number = (key, number) if equals else (word, part)
        try:
            values.setdefault(word, []).append(float(number))
        except ValueError:
            raise ValueError(f"{text}: {number!r} is no number; {_usage(name)}") from None
    arguments = {key: list_[0] if len(list_) == 1 else list_ for key, list_ in values.items()}
    try:
        return SHAPES[name](**arguments)
    except TypeError:
        raise ValueError(f"{text}: {_usage(name)}") from None


def pose(at: list[float], turn: list[float]) -> np.ndarray:
    """A pose from a position [m] and turns about x, then y, then z [degree], shape (4, 4)."""
    X = np.eye(4)
    for axis, angle in enumerate(np.deg2rad(turn)):
        c, s = np.cos(angle), np.sin(angle)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        R = np.eye(3)
        R[i, i] = R[j, j] = c
        R[j, i], R[i, j] = s, -s
        X[:3, :3] = R @ X[:3, :3]
    X[:3, 3] = at
    return X


def _mesh(text: str) -> vc.Mesh:
    if not Path(text).is_file():
        names = ", ".join(SHAPES)
        raise ValueError(f"{text}: neither a mesh file nor a solid; a solid is one of {names}")
    triangles = read_mesh(text)
    return vc.Mesh(triangles.vertices, triangles.faces.astype(np.int32))


def _usage(name: str) -> str:
    fields = _FIELDS[name]
    example = ",".join(f"{field}={'X,Y,Z' if field in _VECTORS else 'X'}" for field in fields)
    return f"write {name}:{example}" if fields else f"write {name}"


_VECTORS = ("half_sizes", "semi_axes")
_FIELDS = {
    name: [
        key
        for key, value in vars(shape).items()
        if isinstance(value, property) and key not in ("bounds",)
    ]
    for name, shape in SHAPES.items()
}
