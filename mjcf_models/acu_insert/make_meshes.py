# SPDX-License-Identifier: Apache-2.0
"""Writes the meshes of the seats: a cone, and the cup that it fits.

Both are turned outlines with the same chords, so that all their facets coincide in the seated pose.
Coordinates are those of the unit's frame, the axis of a seat at x = y = 0.

    ./run python mjcf_models/acu_insert/make_meshes.py mjcf_models/acu_insert/meshes
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np

CHORDS = 32
SLOPE = 19 / 30  # radius per height of the cone's wall
BASE = (0.025, -0.125)  # radius and height of the cone's wide end [m]
TIP = (0.006, -0.155)  # of its narrow end
CUP_TOP, CUP_FLOOR, CUP_BOTTOM = -0.13, -0.158, -0.17  # heights [m]
CUP_RADIUS = 0.035  # outside [m]


def wall(height: float) -> float:
    """Radius of the cone's wall, and of the cup's, at a height [m]."""
    return BASE[0] + SLOPE * (height - BASE[1])


CONE = ((0.0, TIP[1]), TIP, BASE, (0.0, BASE[1]))
CUP = (
    (0.0, CUP_BOTTOM),
    (CUP_RADIUS, CUP_BOTTOM),
    (CUP_RADIUS, CUP_TOP),
    (wall(CUP_TOP), CUP_TOP),
    (wall(CUP_FLOOR), CUP_FLOOR),
    (0.0, CUP_FLOOR),
)


def turned(outline: tuple[tuple[float, float], ...]) -> tuple[np.ndarray, np.ndarray]:
    """A solid of revolution in chords, with a facet towards each of x, y, -x and -y.

    Args:
        outline: radius and height of points that run counterclockwise, radius to the right, from
            axis to axis [m].

    Returns:
        Points [m], shape (n, 3), and triangles, counterclockwise seen from outside, shape (m, 3).
    """
    points = [(0.0, 0.0, outline[0][1]), (0.0, 0.0, outline[-1][1])]
    for radius, height in outline[1:-1]:
        for k in range(CHORDS):
            angle = 2 * math.pi * (k + 0.5) / CHORDS
            points.append((radius * math.cos(angle), radius * math.sin(angle), height))
    rings = len(outline) - 2

    def at(ring: int, k: int) -> int:
        return 2 + ring * CHORDS + k % CHORDS

    faces = []
    for k in range(CHORDS):
        faces.append((0, at(0, k + 1), at(0, k)))
        faces.append((1, at(rings - 1, k), at(rings - 1, k + 1)))
        for ring in range(rings - 1):
            faces.append((at(ring, k), at(ring, k + 1), at(ring + 1, k + 1)))
            faces.append((at(ring, k), at(ring + 1, k + 1), at(ring + 1, k)))
    return np.array(points), np.array(faces)


def write(folder: Path) -> None:
    """Writes cone.obj and cup.obj."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, outline in (("cone", CONE), ("cup", CUP)):
        points, faces = turned(outline)
        lines = [f"v {x:.9f} {y:.9f} {z:.9f}" for x, y, z in points + 0.0]
        lines += [f"f {a} {b} {c}" for a, b, c in faces + 1]
        (folder / f"{name}.obj").write_text("\n".join(lines) + "\n")


def main() -> None:
    """Writes the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, help="where the files go")
    write(parser.parse_args().folder)


if __name__ == "__main__":
    main()
