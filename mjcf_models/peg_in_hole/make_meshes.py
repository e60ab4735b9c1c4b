# SPDX-License-Identifier: Apache-2.0
"""Writes the meshes of the peg and of the plate with its hole, as fine as one likes.

The points of a circle lie on it, as in the files of CAD programs: the polygons are inscribed, the
peg is thinner than the cylinder and the hole narrower, both by R (1 - cos(pi / chords)) in the
middle of a chord.

    ./run python mjcf_models/peg_in_hole/make_meshes.py mjcf_models/peg_in_hole/meshes
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

RADIUS = 0.004  # of the peg [m]
LENGTH = 0.05  # of the peg [m]
CLEARANCES = {"0.2_mm": 0.2e-3, "0.02_mm": 0.02e-3}  # diameter of the hole less that of the peg [m]
PLATE = (0.02, 0.02, 0.0045)  # half sizes [m]

Triangles = tuple[np.ndarray, np.ndarray]


def circle(radius: float, chords: int) -> np.ndarray:
    """Points of a circle in the plane [m], shape (chords, 2)."""
    angles = 2 * np.pi * np.arange(chords) / chords
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def outline(half_size: float, chords: int) -> np.ndarray:
    """The square, met by the rays of `circle` [m], shape (chords, 2).

    Its corners are among the points when `chords` is a multiple of 8.
    """
    points = circle(1.0, chords)
    return half_size * points / np.abs(points).max(axis=1, keepdims=True)


def tube(loops: list[np.ndarray]) -> np.ndarray:
    """Triangles between loops of equally many points, one loop after the other, shape (n, 3)."""
    chords = len(loops[0])
    here = np.arange(chords)
    there = np.roll(here, -1)
    strips = []
    for k in range(len(loops) - 1):
        low, high = k * chords, (k + 1) * chords
        strips.append(np.stack([low + here, low + there, high + there], axis=1))
        strips.append(np.stack([low + here, high + there, high + here], axis=1))
    return np.concatenate(strips)


def at(points: np.ndarray, height: float) -> np.ndarray:
    """A loop of the plane, lifted [m], shape (n, 3)."""
    return np.column_stack([points, np.full(len(points), height)])


def peg(chords: int, rings: int = 1) -> Triangles:
    """The peg about its middle, axis z: points [m], shape (n, 3); triangles, shape (m, 3).

    Args:
        chords: of a circle.
        rings: into which the length is divided.
    """
    rim = circle(RADIUS, chords)
    heights = np.linspace(-LENGTH / 2, LENGTH / 2, rings + 1)
    loops = [at(rim, height) for height in heights]
    ends = np.array([[0, 0, heights[0]], [0, 0, heights[-1]]])
    points = np.concatenate([*loops, ends])
    low, high = len(points) - 2, len(points) - 1
    here = np.arange(chords)
    there = np.roll(here, -1)
    top = rings * chords
    caps = [
        np.stack([np.full(chords, low), there, here], axis=1),
        np.stack([np.full(chords, high), top + here, top + there], axis=1),
    ]
    return points, np.concatenate([tube(loops), *caps])


def plate(clearance: float, chords: int, rings: int = 1) -> Triangles:
    """The plate with its hole, about its middle: points [m], shape (n, 3); triangles, shape (m, 3).

    Args:
        clearance: diameter of the hole less that of the peg [m].
        chords: of the circle, a multiple of 8.
        rings: into which the depth of the hole is divided.
    """
    if chords % 8:
        raise ValueError(f"chords must be a multiple of 8, got {chords}")
    hole = circle(RADIUS + clearance / 2, chords)
    square = outline(PLATE[0], chords)
    half = PLATE[2]
    # Down the hole, out along the lower face, up the side, and in along the upper face.
    loops = [at(hole, height) for height in np.linspace(half, -half, rings + 1)]
    loops += [at(square, -half), at(square, half)]
    faces = tube([*loops, loops[0]])
    points = np.concatenate(loops)
    return points, np.where(faces < len(points), faces, faces - len(points))


def write_obj(path: Path, mesh: Triangles) -> None:
    """Writes points in micrometres of resolution 0.001 and triangles as an OBJ file, in metres."""
    points, faces = mesh
    lines = ["# SPDX-License-Identifier: Apache-2.0", "# Made by make_meshes.py."]
    lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in points.round(10) + 0.0]
    lines += [f"f {a} {b} {c}" for a, b, c in faces + 1]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write(folder: Path, chords: int, rings: int) -> None:
    """Writes the meshes of the scenes into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    write_obj(folder / "peg.obj", peg(chords, rings))
    for name, clearance in CLEARANCES.items():
        write_obj(folder / f"plate_{name}.obj", plate(clearance, chords, rings))


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--chords", type=int, default=64, help="of a circle, a multiple of 8")
    parser.add_argument("--rings", type=int, default=1, help="divisions along the axis")
    arguments = parser.parse_args()
    write(arguments.folder, arguments.chords, arguments.rings)


if __name__ == "__main__":
    main()
