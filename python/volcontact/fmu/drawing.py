# SPDX-License-Identifier: Apache-2.0
"""The documentation inside a unit, with its solids drawn, and its icon."""

from __future__ import annotations

import struct
import zlib
from html import escape
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from volcontact.fmu.container import Container
    from volcontact.fmu.description import About
    from volcontact.fmu.variables import Group

_COLOURS = ("#44749e", "#d98533", "#5b8c5a", "#8a6bb1", "#9a9a9a")
_WIDTH = 480  # of a drawing
_FAR = 1.2  # how far what has no end is drawn, in sizes of the rest


def icon() -> bytes:
    """Two discs and what they share, as a PNG file."""
    size = 64
    y, x = np.mgrid[0:size, 0:size]
    picture = np.full((size, size, 4), (255, 255, 255, 0), dtype=np.uint8)
    left = (x - 23) ** 2 + (y - 32) ** 2 < 20**2
    right = (x - 41) ** 2 + (y - 32) ** 2 < 20**2
    picture[left] = (68, 116, 158, 255)
    picture[right] = (217, 133, 51, 255)
    picture[left & right] = (200, 40, 40, 255)
    rows = b"".join(b"\0" + row.tobytes() for row in picture)

    def chunk(kind: bytes, content: bytes) -> bytes:
        check = zlib.crc32(kind + content)
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)

    head = struct.pack(">IIBBBBB", size, size, 8, 6, 0, 0, 0)
    data = zlib.compress(rows, 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


_USE_OF_CONTACT = """<p>Set pose and twist of each body; read the force and the torque on it.
Torques are about the origin of the frame of the body. Poses map the frame of a body to the world.
Co-Simulation: `extrapolation` says how bodies go on within a communication step. A quaternion of
any length but 0 will do.</p>"""
_USE_OF_SCENE = """<p>MuJoCo steps the scene, with volumetric contact. A communication step is a
number of time steps; the inputs stay what they were at its start. The outputs are those at its
end.</p>"""


def documentation(
    about: About, groups: list[Group], fmi: int, container: Container | None = None
) -> str:
    """index.html; `container`: what to draw of a whole scene."""
    rows = "\n".join(
        f"<tr><td>{escape(group.name)}</td><td>{group.count if group.count > 1 else ''}</td>"
        f"<td>{escape(group.unit)}</td><td>{group.causality}</td>"
        f"<td>{escape(group.description)}</td></tr>"
        for group in groups
    )
    kinds = {"me": "Model Exchange", "cs": "Co-Simulation", "both": "both kinds"}[about.kind]
    title = escape(about.name)
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>
body {{ font: 15px/1.5 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em }}
table {{ border-collapse: collapse }} td, th {{ border: 1px solid #ccc; padding: .2em .5em }}
</style></head><body>
<h1>{title}</h1>
<p>{escape(about.text)}. FMI {fmi}.0, {kinds}. Made by volcontact {escape(about.version)}.</p>
{_USE_OF_SCENE if about.step else _USE_OF_CONTACT}
{picture(container or about.container)}
<h2>Variables</h2>
<table><tr><th>name</th><th>numbers</th><th>unit</th><th>causality</th><th>meaning</th></tr>
{rows}
</table>
<h2>Licence</h2>
<p>The binaries are under the Apache License 2.0{", as MuJoCo is" if about.step else ""}.</p>
</body></html>
"""


def picture(container: Container | None) -> str:
    """The solids of each body where it starts, seen from the side (x to the right, z up)."""
    if container is None:
        return ""
    outlines: list[tuple[int, np.ndarray]] = []
    endless: list[tuple[int, np.ndarray]] = []
    for model in container.models:
        sides = (model.body_a, model.body_b)
        for place, (pose, words) in enumerate(_solids(model.text)):
            body = sides[place % 2]
            start = container.bodies[body]
            X = _pose(start.position, start.quaternion) @ pose
            for inner, points in _points(words):
                target = endless if points is None else outlines
                target.append((body, X @ inner if points is None else _moved(X @ inner, points)))
    if not outlines:
        return ""
    every = np.vstack([points[:, [0, 2]] for _, points in outlines])
    low, high = every.min(axis=0), every.max(axis=0)
    middle, size = (low + high) / 2, max(float((high - low).max()), 1e-9) * _FAR
    parts = [_floor(body, X, middle, size) for body, X in endless]
    parts += [_polygon(body, _hull(points[:, [0, 2]]), middle, size) for body, points in outlines]
    legend = "".join(
        f'<text x="8" y="{18 + 18 * i}" fill="{_COLOURS[i % len(_COLOURS)]}">'
        f"{escape(body.name)}</text>"
        for i, body in enumerate(container.bodies)
    )
    shapes = "\n".join(dict.fromkeys(part for part in parts if part))
    return (
        f"<h2>The solids at the start</h2><p>From the side: x to the right, z up.</p>"
        f'<svg width="{_WIDTH}" height="{_WIDTH}" font-family="sans-serif" font-size="14">\n'
        f"{shapes}\n{legend}</svg>"
    )


def _solids(text: str) -> list[tuple[np.ndarray, list[str]]]:
    """Pose and words of each solid of a contact model, two a pair."""
    out, pose = [], np.eye(4)
    for line in text.splitlines():
        word, _, rest = line.partition(" ")
        if word == "at":
            pose = np.array([float(number) for number in rest.split()]).reshape(4, 4)
        elif word == "solid":
            out.append((pose, rest.split()))
    return out


def _points(words: list[str]) -> list[tuple[np.ndarray, np.ndarray | None]]:
    """Points whose hull is the outline, with the pose they are in; None: a half-space."""
    shape, numbers = words[0], words[1:]
    if shape == "csg":
        return [
            found
            for at, word in enumerate(words)
            if word == "member"
            for found in [
                (
                    np.array([float(n) for n in words[at + 1 : at + 17]]).reshape(4, 4) @ inner,
                    points,
                )
                for inner, points in _points(words[at + 17 :])
            ]
        ]
    if shape == "half_space":
        return [(np.eye(4), None)]
    if shape in ("mesh", "convex_polytope"):
        count = int(numbers[0])
        cloud = np.array([float(n) for n in numbers[1 : 1 + 3 * count]]).reshape(-1, 3)
        return [(np.eye(4), cloud)]
    return [(np.eye(4), _cloud(shape, [float(n) for n in numbers[:4] if _is_number(n)]))]


def _is_number(word: str) -> bool:
    return word.lstrip("-")[:1].isdigit()


def _cloud(shape: str, p: list[float]) -> np.ndarray:
    u = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    v = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 25)
    a, b = np.repeat(u, len(v)), np.tile(v, len(u))
    ball = np.column_stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)])
    ring = np.column_stack([np.cos(u), np.sin(u)])

    def rings(*levels: tuple[float, float]) -> np.ndarray:
        return np.vstack([np.column_stack([r * ring, np.full(len(u), z)]) for r, z in levels])

    if shape == "rounded_box":
        return np.asarray(np.copysign(np.array(p[:3]) - p[3], ball) + p[3] * ball)
    if shape == "box":
        signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
        return np.asarray(signs * np.array(p[:3]))
    if shape == "sphere":
        return np.asarray(p[0] * ball)
    if shape == "ellipsoid":
        return np.asarray(ball * np.array(p[:3]))
    if shape == "capsule":
        ends = np.where(ball[:, 2:] >= 0.0, 1.0, -1.0) * np.array([0.0, 0.0, p[1]])
        return np.asarray(p[0] * ball + ends)
    if shape == "cylinder":
        return rings((p[0], p[1]), (p[0], -p[1]))
    if shape == "frustum":
        return rings((p[0], -p[2]), (p[1], p[2]))
    levels = [(p[0] + p[1] * np.cos(b), p[1] * np.sin(b)) for b in 2.0 * v]  # torus
    return rings(*levels)


def _pose(position: tuple[float, ...], quaternion: tuple[float, ...]) -> np.ndarray:
    w, x, y, z = quaternion
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    pose[:3, 3] = position
    return pose


def _moved(pose: np.ndarray, points: np.ndarray) -> np.ndarray:
    moved: np.ndarray = points @ pose[:3, :3].T + pose[:3, 3]
    return moved


def _hull(points: np.ndarray) -> list[tuple[float, float]]:
    """Counterclockwise corners of the convex hull (monotone chain)."""
    ordered = sorted({(float(x), float(y)) for x, y in points})

    def half(line: list[tuple[float, float]]) -> list[tuple[float, float]]:
        chain: list[tuple[float, float]] = []
        for x, y in line:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2:]
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0:
                    break
                chain.pop()
            chain.append((x, y))
        return chain[:-1]

    return half(ordered) + half(ordered[::-1]) or ordered


def _on_page(x: float, z: float, middle: np.ndarray, size: float) -> str:
    scale = _WIDTH / size
    return f"{_WIDTH / 2 + scale * (x - middle[0]):.2f},{_WIDTH / 2 - scale * (z - middle[1]):.2f}"


def _polygon(body: int, corners: list[tuple[float, float]], middle: np.ndarray, size: float) -> str:
    points = " ".join(_on_page(x, z, middle, size) for x, z in corners)
    colour = _COLOURS[body % len(_COLOURS)]
    return f'<polygon points="{points}" fill="{colour}" fill-opacity=".25" stroke="{colour}"/>'


def _floor(body: int, pose: np.ndarray, middle: np.ndarray, size: float) -> str:
    """The side view of a half-space, where it is one."""
    normal = pose[[0, 2], 2]
    if np.linalg.norm(normal) < 1e-6:
        return ""
    normal = normal / np.linalg.norm(normal)
    along = np.array([-normal[1], normal[0]])
    foot = middle + normal * float((pose[[0, 2], 3] - middle) @ normal)
    corners = [foot + along * size, foot - along * size]
    corners += [corner - normal * 2.0 * size for corner in corners[::-1]]
    return _polygon(body, [(float(x), float(z)) for x, z in corners], middle, size)
