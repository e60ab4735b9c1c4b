# SPDX-License-Identifier: Apache-2.0
"""Writes the meshes of scene_mesh.xml, of the sizes below, beside this file.

The points of a circle lie on it, as in the files of CAD programs, so both polygons are inscribed:
the bore is narrower and the shaft thinner by r (1 - cos(pi / CHORDS)) in the middle of a chord.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

SHAFT, LENGTH = 0.00499, 0.04  # radius and length [m]
BORE, MOUTH, CHAMFER = 0.005, 0.006, 0.001  # radii of the bore and of its mouth, and its depth [m]
HALF, HEIGHT = 0.02, 0.03  # half width of the block, and its height [m]; its top is at z = 0
CHORDS = 128  # of a circle, a multiple of 8


def loop(radius: float, height: float, *, square: bool = False) -> np.ndarray:
    """Points around the z axis [m], shape (CHORDS, 3), on a circle or on a square about it."""
    angles = 2.0 * np.pi * np.arange(CHORDS) / CHORDS
    points = np.column_stack([np.cos(angles), np.sin(angles)])
    if square:
        points /= np.abs(points).max(axis=1, keepdims=True)
    return np.column_stack([radius * points, np.full(CHORDS, height)])


def strip(low: int, high: int) -> np.ndarray:
    """Triangles between two loops, by their numbers, facing out where the second is above."""
    here = np.arange(CHORDS)
    there = np.roll(here, -1)
    low, high = low * CHORDS, high * CHORDS
    return np.concatenate(
        [
            np.column_stack([low + here, low + there, high + there]),
            np.column_stack([low + here, high + there, high + here]),
        ]
    )


def block() -> tuple[np.ndarray, np.ndarray]:
    """The block with its chamfered bore: down the bore, out below, up the side, in above."""
    loops = [
        loop(MOUTH, 0.0),
        loop(BORE, -CHAMFER),
        loop(BORE, -HEIGHT),
        loop(HALF, -HEIGHT, square=True),
        loop(HALF, 0.0, square=True),
    ]
    count = len(loops)
    return np.concatenate(loops), np.concatenate([strip(i, (i + 1) % count) for i in range(count)])


def shaft() -> tuple[np.ndarray, np.ndarray]:
    """The shaft about its middle."""
    ends = np.array([[0.0, 0.0, -LENGTH / 2], [0.0, 0.0, LENGTH / 2]])
    points = np.concatenate([loop(SHAFT, -LENGTH / 2), loop(SHAFT, LENGTH / 2), ends])
    here = np.arange(CHORDS)
    there = np.roll(here, -1)
    middle = np.full(CHORDS, 2 * CHORDS)
    caps = [
        np.column_stack([middle, there, here]),
        np.column_stack([middle + 1, CHORDS + here, CHORDS + there]),
    ]
    return points, np.concatenate([strip(0, 1), *caps])


def main() -> None:
    """Writes `meshes/shaft.obj` and `meshes/block.obj`."""
    folder = Path(__file__).parent / "meshes"
    folder.mkdir(exist_ok=True)
    for name, (points, faces) in (("shaft", shaft()), ("block", block())):
        lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in points.round(9) + 0.0]
        lines += [f"f {a} {b} {c}" for a, b, c in faces + 1]
        (folder / f"{name}.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
