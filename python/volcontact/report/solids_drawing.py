# SPDX-License-Identifier: Apache-2.0
"""The surface of a solid as volcontact understands it, as triangles: holes are open."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from volcontact.view.geoms import Triangles, arc, box_triangles, turned

_FINE = 24  # so many triangles go along a composed solid before its edges are looked for
_HALVINGS = 4  # of triangles that an edge of a composed solid crosses
_SKIN = 1e-6  # of its size: how far from the surface it is asked what is solid
_FEW = 24  # corners, whose hull is found by trying all planes
_LENGTHS = {  # how many numbers the text of a shape has
    "half_space": 0,
    "sphere": 1,
    "capsule": 2,
    "cylinder": 2,
    "torus": 2,
    "ellipsoid": 3,
    "box": 3,
    "frustum": 3,
    "rounded_box": 4,
}


@dataclass(frozen=True)
class Part:
    """One shape of a solid.

    Attributes:
        pose: in the frame of the solid, shape (4, 4).
        shape: its word.
        numbers: its parameters, as of `ContactModel.text`.
        points: of a mesh or convex polytope [m], shape (n, 3).
        faces: of a mesh, shape (m, 3).
    """

    pose: np.ndarray
    shape: str
    numbers: np.ndarray
    points: np.ndarray | None = None
    faces: np.ndarray | None = None


Step = Part | str  # a part, or what is done with the two before it


def solids_of(text: str) -> list[tuple[np.ndarray, list[Step]]]:
    """Pose and steps of both solids of a pair, out of `ContactModel.text`."""
    solids, pose = [], np.eye(4)
    for line in text.splitlines():
        word, _, rest = line.partition(" ")
        if word == "at":
            pose = np.array(rest.split(), np.float64).reshape(4, 4)
        elif word == "solid":
            solids.append((pose, list(_steps(iter(rest.split())))))
    return solids


def surface(steps: list[Step]) -> Triangles | None:
    """Points [m], shape (n, 3), and triangles, shape (m, 3), facing out; None of a half-space.

    A convex polytope that stands alone has no triangles: MuJoCo draws the hull of its points.
    """
    parts = [step for step in steps if isinstance(step, Part)]
    if any(part.shape == "half_space" for part in parts):
        return None
    if len(parts) == 1 and parts[0].shape == "convex_polytope":
        assert parts[0].points is not None
        points = parts[0].points @ parts[0].pose[:3, :3].T + parts[0].pose[:3, 3]
        return points, np.zeros((0, 3), np.int64)
    if len(parts) == 1:
        return _placed(parts[0])
    return _composed(steps, parts)


def _steps(words: Iterator[str]) -> Iterator[Step]:
    for word in words:
        if word == "csg":
            for _ in range(int(next(words))):
                step = next(words)
                if step == "member":
                    pose = _numbers(words, 16).reshape(4, 4)
                    yield _part(pose, next(words), words)
                else:
                    yield step
        else:
            yield _part(np.eye(4), word, words)


def _part(pose: np.ndarray, shape: str, words: Iterator[str]) -> Part:
    if shape in _LENGTHS:
        return Part(pose, shape, _numbers(words, _LENGTHS[shape]))
    points = _numbers(words, 3 * int(next(words))).reshape(-1, 3)
    if shape == "convex_polytope":
        return Part(pose, shape, np.zeros(0), points)
    faces = _numbers(words, 3 * int(next(words))).astype(np.int64).reshape(-1, 3)
    return Part(pose, shape, np.zeros(0), points, faces)


def _numbers(words: Iterator[str], count: int) -> np.ndarray:
    return np.array([float(next(words)) for _ in range(count)])


def _placed(part: Part) -> Triangles:
    points, faces = _triangles(part)
    return points @ part.pose[:3, :3].T + part.pose[:3, 3], faces


def _triangles(part: Part) -> Triangles:
    p, kind = part.numbers, part.shape
    if part.points is not None:
        return part.points, _hull(part.points) if part.faces is None else part.faces
    if kind == "box":
        return box_triangles(p)
    if kind in ("sphere", "ellipsoid"):
        points, faces = turned(arc(1.0, 0.0))
        return points * p, faces
    if kind == "capsule":
        return turned(arc(p[0], p[1]))
    if kind == "rounded_box":
        points, faces = turned(arc(1.0, 0.0))
        return np.copysign(p[:3] - p[3], points) + p[3] * points, faces
    if kind == "torus":
        angles = np.linspace(-np.pi, np.pi, 33)
        return turned(np.column_stack([p[0] + p[1] * np.cos(angles), p[1] * np.sin(angles)]))
    low, high, half = (p[0], p[0], p[1]) if kind == "cylinder" else (p[0], p[1], p[2])
    return turned(np.array([[0.0, -half], [low, -half], [high, half], [0.0, half]]))


def _hull(points: np.ndarray) -> np.ndarray:
    """Triangles of the convex hull: each plane through three points that has all on one side."""
    if len(points) > _FEW:
        from scipy.spatial import ConvexHull

        hull = ConvexHull(points)
        out = points[hull.simplices].mean(axis=1) - points.mean(axis=0)
        corners = points[hull.simplices]
        turns = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        away = np.einsum("ij,ij->i", turns, out) > 0.0
        found: np.ndarray = np.where(away[:, None], hull.simplices, hull.simplices[:, ::-1])
        return found
    middle = points.mean(axis=0)
    size = float(np.ptp(points, axis=0).max())
    faces: dict[tuple[int, ...], None] = {}
    for i in range(len(points)):
        for j in range(i + 1, len(points)):
            for k in range(j + 1, len(points)):
                normal = np.cross(points[j] - points[i], points[k] - points[i])
                length = float(np.linalg.norm(normal))
                if length < 1e-12 * size**2:
                    continue
                heights = (points - points[i]) @ normal / length
                if heights.max() > 1e-9 * size and heights.min() < -1e-9 * size:
                    continue
                faces[tuple(np.flatnonzero(np.abs(heights) <= 1e-9 * size))] = None
    triangles = []
    for face in faces:
        corners = points[list(face)]
        center = corners.mean(axis=0)
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        normal = normal if normal @ (center - middle) > 0.0 else -normal
        across = corners[0] - center
        up = np.cross(normal, across)
        order = np.argsort(np.arctan2((corners - center) @ up, (corners - center) @ across))
        ring = [face[i] for i in order]
        triangles += [(ring[0], ring[i], ring[i + 1]) for i in range(1, len(ring) - 1)]
    return np.array(triangles)


def _composed(steps: list[Step], parts: list[Part]) -> Triangles:
    """The faces of all parts, as far as solid and air meet there."""
    placed = [_placed(part) for part in parts]
    size = float(np.ptp(placed[0][0], axis=0).max())
    kept = [
        _bounding(steps, part, _finer(points[faces], size / _FINE), _SKIN * size)
        for part, (points, faces) in zip(parts, placed, strict=True)
    ]
    every = np.concatenate(kept)
    return every.reshape(-1, 3), np.arange(3 * len(every)).reshape(-1, 3)


def _bounding(steps: list[Step], part: Part, corners: np.ndarray, skin: float) -> np.ndarray:
    """Those triangles of a part that bound the solid, facing out, shape (n, 3, 3)."""
    kept = []
    for level in range(_HALVINGS + 1):
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        length = np.linalg.norm(normal, axis=1)
        corners, normal = corners[length > 0.0], normal[length > 0.0] / length[length > 0.0, None]
        middle = corners.mean(axis=1)
        # Near the corners and in the middle: corners may lie on edges.
        probes = np.concatenate([0.98 * corners + 0.02 * middle[:, None], middle[:, None]], axis=1)
        shift = skin * normal[:, None]
        # The part itself is on one side whatever its chords leave out.
        sign = _is_solid(steps, probes - shift, (part, True)).astype(int)
        sign -= _is_solid(steps, probes + shift, (part, False))
        alike = (sign == sign[:, :1]).all(axis=1)
        side = sign[:, 3]  # -1: it bounds a hole, and faces inwards
        done = (alike | (level == _HALVINGS)) & (side != 0)
        kept.append(np.where(side[done, None, None] > 0, corners[done], corners[done][:, ::-1]))
        corners = _halved(corners[~alike])
        if not len(corners):
            break
    return np.concatenate(kept)


def _finer(corners: np.ndarray, longest: float) -> np.ndarray:
    """Triangles whose sides are at most so long."""
    while True:
        sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        long = sides > longest
        if not long.any():
            return corners
        corners = np.concatenate([corners[~long], _halved(corners[long])])


def _halved(corners: np.ndarray) -> np.ndarray:
    """Two triangles for each, cut across its longest side."""
    if not len(corners):
        return corners
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    first = sides.argmax(axis=1)
    rows = np.arange(len(corners))
    a, b, c = (corners[rows, (first + i) % 3] for i in range(3))
    middle = 0.5 * (a + b)
    return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])


def _is_solid(steps: list[Step], points: np.ndarray, known: tuple[Part, bool]) -> np.ndarray:
    """Whether points are in the solid, where that is known of one part; (..., 3) to (...)."""
    stack: list[np.ndarray] = []
    for step in steps:
        if isinstance(step, Part):
            inside = step is known[0]
            stack.append(np.full(points.shape[:-1], known[1]) if inside else _is_in(step, points))
            continue
        b, a = stack.pop(), stack.pop()
        stack.append(a | b if step == "union" else a & b if step == "intersection" else a & ~b)
    return stack[-1]


def _is_in(part: Part, points: np.ndarray) -> np.ndarray:
    local = (points - part.pose[:3, 3]) @ part.pose[:3, :3]
    p, kind = part.numbers, part.shape
    radius, z = np.hypot(local[..., 0], local[..., 1]), local[..., 2]
    inside: np.ndarray
    if part.points is not None:
        planes = _planes(part.points)
        inside = (local @ planes[:, :3].T <= planes[:, 3]).all(axis=-1)
    elif kind == "box":
        inside = (np.abs(local) <= p).all(axis=-1)
    elif kind in ("sphere", "ellipsoid"):
        inside = ((local / p) ** 2).sum(axis=-1) <= 1.0
    elif kind == "capsule":
        inside = np.hypot(radius, np.maximum(np.abs(z) - p[1], 0.0)) <= p[0]
    elif kind == "rounded_box":
        beyond = np.maximum(np.abs(local) - (p[:3] - p[3]), 0.0)
        inside = np.linalg.norm(beyond, axis=-1) <= p[3]
    elif kind == "torus":
        inside = np.hypot(radius - p[0], z) <= p[1]
    else:
        low, high, half = (p[0], p[0], p[1]) if kind == "cylinder" else (p[0], p[1], p[2])
        edge = low + (high - low) * (z + half) / (2.0 * half)
        inside = (radius <= edge) & (np.abs(z) <= half)
    return inside


def _planes(points: np.ndarray) -> np.ndarray:
    """Outer normals and offsets of the planes of a hull, shape (n, 4)."""
    corners = points[_hull(points)]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return np.column_stack([normal, np.einsum("ij,ij->i", normal, corners[:, 0])])
