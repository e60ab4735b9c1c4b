# SPDX-License-Identifier: Apache-2.0
"""The geoms of a model as triangles, for the browser."""

from __future__ import annotations

import mujoco
import numpy as np

Triangles = tuple[np.ndarray, np.ndarray]

_SIDES = 32  # of a circle
_PLANE = 2.0  # half size of a plane without end, in scene extents


def geom_triangles(model: mujoco.MjModel, geom: int) -> Triangles | None:
    """A geom in its own frame.

    Returns:
        Points [m], shape (n, 3), and triangles, shape (m, 3); None for a kind without a picture.
    """
    kinds = mujoco.mjtGeom
    kind, size = int(model.geom_type[geom]), model.geom_size[geom]
    if kind == int(kinds.mjGEOM_PLANE):
        half = [s if s > 0.0 else _PLANE * float(model.stat.extent) for s in size[:2]]
        corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * [*half, 0.0]
        return corners, np.array([[0, 1, 2], [0, 2, 3]])
    if kind == int(kinds.mjGEOM_BOX):
        return box_triangles(size)
    if kind == int(kinds.mjGEOM_SPHERE):
        return turned(arc(size[0], 0.0))
    if kind == int(kinds.mjGEOM_ELLIPSOID):
        points, faces = turned(arc(1.0, 0.0))
        return points * size, faces
    if kind == int(kinds.mjGEOM_CAPSULE):
        return turned(arc(size[0], size[1]))
    if kind == int(kinds.mjGEOM_CYLINDER):
        radius, half = size[0], size[1]
        return turned(np.array([[0.0, -half], [radius, -half], [radius, half], [0.0, half]]))
    if kind == int(kinds.mjGEOM_MESH):
        return _mesh(model, int(model.geom_dataid[geom]))
    if kind == int(kinds.mjGEOM_HFIELD):
        return _height_field(model, int(model.geom_dataid[geom]))
    return None


def box_triangles(half: np.ndarray) -> Triangles:
    """A box of these half sizes; its triangles look outwards."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def arc(radius: float, half_length: float) -> np.ndarray:
    """Outline of a ball, or of a capsule, from pole to pole: radius and height, shape (n, 2)."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, _SIDES // 2 + 1)
    heights = radius * np.sin(angles)
    outline = np.column_stack([radius * np.cos(angles), heights])
    if half_length == 0.0:
        return outline
    middle = len(outline) // 2
    lower, upper = outline[: middle + 1], outline[middle:]
    shift = np.array([0.0, half_length])
    return np.concatenate([lower - shift, upper + shift])


def turned(outline: np.ndarray) -> Triangles:
    """The solid that an outline sweeps about the z axis; its triangles look outwards."""
    turn = 2.0 * np.pi * np.arange(_SIDES) / _SIDES
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    rings = [np.column_stack([r * circle, np.full(_SIDES, z)]) for r, z in outline]
    here = np.arange(_SIDES)
    there = np.roll(here, -1)
    faces = []
    for k in range(len(rings) - 1):
        low, high = k * _SIDES, (k + 1) * _SIDES
        faces.append(np.column_stack([low + here, low + there, high + there]))
        faces.append(np.column_stack([low + here, high + there, high + here]))
    return np.concatenate(rings), np.concatenate(faces)


def _mesh(model: mujoco.MjModel, mesh: int) -> Triangles:
    begin, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
    first, faces = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
    points = np.asarray(model.mesh_vert).reshape(-1, 3)[begin : begin + count]
    triangles = np.asarray(model.mesh_face).reshape(-1, 3)[first : first + faces]
    return points.astype(np.float64), triangles.copy()


def _height_field(model: mujoco.MjModel, field: int) -> Triangles:
    rows, columns = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
    x_half, y_half, top, _ = model.hfield_size[field]
    begin = model.hfield_adr[field]
    heights = top * np.asarray(model.hfield_data[begin : begin + rows * columns], np.float64)
    x, y = np.meshgrid(np.linspace(-x_half, x_half, columns), np.linspace(-y_half, y_half, rows))
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    faces = [
        np.column_stack([corner, corner + 1, corner + columns + 1]),
        np.column_stack([corner, corner + columns + 1, corner + columns]),
    ]
    return np.column_stack([x.ravel(), y.ravel(), heights]), np.concatenate(faces)
