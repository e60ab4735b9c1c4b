# SPDX-License-Identifier: Apache-2.0
"""Writes the meshes of two spur gears with involute teeth.

Points of the outline lie on the involutes and on the circles; flanks between the root circle and
the base circle are straight. A tooth, and not a gap, lies on the axis x.

    ./run python mjcf_models/gear_pair/make_meshes.py mjcf_models/gear_pair/meshes
"""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

MODULE = 1e-3  # pitch diameter per tooth [m]
PRESSURE_ANGLE = math.radians(20.0)
ADDENDUM = 1.0  # of the tip above the pitch circle, in modules
DEDENDUM = 1.25  # of the root below it, in modules
BACKLASH = 0.1e-3  # play of the pair along the pitch circles [m]; each tooth gives half of it
POINTS = 10  # chords of a flank

Triangles = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Gear:
    """A spur gear.

    Attributes:
        teeth: their number.
        width: along the axis [m].
        bore: radius of the hole in the middle [m].
    """

    teeth: int
    width: float
    bore: float

    @property
    def pitch_radius(self) -> float:
        """Radius of the circle that rolls on that of the other gear [m]."""
        return MODULE * self.teeth / 2

    @property
    def base_radius(self) -> float:
        """Radius of the circle that the involutes are unwound from [m]."""
        return self.pitch_radius * math.cos(PRESSURE_ANGLE)


PINION = Gear(teeth=20, width=10e-3, bore=5.05e-3)
WHEEL = Gear(teeth=40, width=8e-3, bore=5.05e-3)


def involute(angle: np.ndarray | float) -> np.ndarray | float:
    """The involute function, tan a - a [rad]."""
    return np.tan(angle) - angle


def flank(gear: Gear, points: int) -> tuple[np.ndarray, np.ndarray]:
    """A flank from root to tip: radii [m] and half the angle of the tooth there [rad]."""
    base = gear.base_radius
    root = gear.pitch_radius - DEDENDUM * MODULE
    tip = gear.pitch_radius + ADDENDUM * MODULE
    thickness = math.pi * MODULE / 2 - BACKLASH / 2  # along the pitch circle
    at_base = thickness / (2 * gear.pitch_radius) + involute(PRESSURE_ANGLE)
    start = max(root, base)
    # Even steps of the roll angle, tan a: the chords then are all about equally far off.
    roll = np.linspace(
        math.sqrt((start / base) ** 2 - 1), math.sqrt((tip / base) ** 2 - 1), points + 1
    )
    radii = base * np.sqrt(1 + roll**2)
    half_angles = at_base - involute(np.arctan(roll))
    if root < base:
        # A little wider at the root: no two points of the outline have the same angle.
        radii = np.concatenate([[root], radii])
        half_angles = np.concatenate([[half_angles[0] + 0.02 * math.pi / gear.teeth], half_angles])
    return radii, half_angles


def outline(gear: Gear, points: int = POINTS) -> np.ndarray:
    """The outline in the plane, counterclockwise [m], shape (n, 2)."""
    radii, half_angles = flank(gear, points)
    tooth_radii = np.concatenate([radii, radii[::-1]])
    tooth_angles = np.concatenate([-half_angles, half_angles[::-1]])
    pitch = 2 * math.pi / gear.teeth
    angles = np.concatenate([tooth_angles + k * pitch for k in range(gear.teeth)])
    all_radii = np.tile(tooth_radii, gear.teeth)
    return all_radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def mesh(gear: Gear, points: int = POINTS) -> Triangles:
    """The gear about its middle, axis z: points [m], shape (n, 3); triangles, shape (m, 3)."""
    outside = outline(gear, points)
    inside = gear.bore * outside / np.linalg.norm(outside, axis=1, keepdims=True)
    half = gear.width / 2
    # Up the teeth, in along the upper face, down the bore and out along the lower face.
    loops = [(outside, -half), (outside, half), (inside, half), (inside, -half)]
    vertices = np.concatenate([np.column_stack([p, np.full(len(p), z)]) for p, z in loops])
    count = len(outside)
    here = np.arange(count)
    there = np.roll(here, -1)
    faces = []
    for k in range(4):
        low, high = k * count, (k + 1) % 4 * count
        faces.append(np.stack([low + here, low + there, high + there], axis=1))
        faces.append(np.stack([low + here, high + there, high + here], axis=1))
    return vertices, np.concatenate(faces)


def write_obj(path: Path, triangles: Triangles) -> None:
    """Writes an OBJ file in metres, to a tenth of a nanometre."""
    vertices, faces = triangles
    lines = ["# SPDX-License-Identifier: Apache-2.0", "# Made by make_meshes.py."]
    lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices.round(10) + 0.0]
    lines += [f"f {a} {b} {c}" for a, b, c in faces + 1]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write(folder: Path, points: int = POINTS) -> None:
    """Writes both gears into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    write_obj(folder / "pinion.obj", mesh(PINION, points))
    write_obj(folder / "wheel.obj", mesh(WHEEL, points))


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--points", type=int, default=POINTS, help="chords of a flank")
    arguments = parser.parse_args()
    write(arguments.folder, arguments.points)


if __name__ == "__main__":
    main()
