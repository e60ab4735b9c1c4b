# SPDX-License-Identifier: Apache-2.0
"""Ten tosses of a cube whose parameters are known, with or without the noise of real ones."""

from __future__ import annotations

import csv
from pathlib import Path

import mujoco
import numpy as np

import volcontact as vc
from volcontact.identify import rotations

HALF = 0.0517  # [m]
TOSSES, FRAMES, EVERY, RATE = 10, 14, 5, 148.0
# Of the real cube's flights about a parabola and a turn: docs/identification/cube_tosses.md.
POSITION, ANGLE = 7e-5, 4e-4  # [m] [rad]
COLUMNS = ["trial", "t", "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"]
SCENE = """\
<mujoco>
  <option timestep="{step!r}" integrator="Euler"/>
  <worldbody>
    <geom name="board" type="plane" size="2 2 0.1"/>
    <body name="cube" pos="0 0 0.06">
      <freejoint name="cube"/>
      <inertial pos="0 0 0.005" mass="0.37" diaginertia="0.00095 0.00095 0.00095"/>
      <geom name="cube" type="box" size="0.0517 0.0517 0.0517"/>
    </body>
  </worldbody>
  <custom>
{numbers}
    <numeric name="volcontact/option/implicit/on" data="1"/>
    <tuple name="volcontact/pair/p">
      <element objtype="geom" objname="cube"/>
      <element objtype="geom" objname="board"/>
    </tuple>
  </custom>
</mujoco>
"""
HEAD = """\
[identify]
scene = "scene.xml"
[measurements]
file = "tosses.csv"
trial = "trial"
[measure.position]
of = "cube"
columns = ["x", "y", "z"]
sigma = {position}
[measure.orientation]
of = "cube"
columns = ["qw", "qx", "qy", "qz"]
sigma = {angle}
"""
# Where starts are exact.
STARTS = """\
[measure.velocity]
of = "cube"
columns = ["vx", "vy", "vz"]
weight = 0
[measure.angular_velocity]
of = "cube"
columns = ["wx", "wy", "wz"]
frame = "body"
weight = 0
"""
# Where they are looked for: as wide as first guesses from poses err, or wider.
NUISANCE = """\
[nuisance]
position = 1e-3
angle = 5e-3
velocity = 0.02
spin = 0.1
"""


def scene(values: dict[str, float], law: str = "regularized_coulomb") -> str:
    """The scene with numbers of the pair, and a law of friction."""
    numbers = [
        f'    <numeric name="volcontact/pair/p/{key}" data="{value!r}"/>'
        for key, value in values.items()
    ]
    numbers.append(f'    <numeric name="volcontact/pair/p/friction_law/{law}" data="1"/>')
    return SCENE.format(step=1.0 / RATE / EVERY, numbers="\n".join(numbers))


def tosses(text: str, seed: int = 0, count: int = TOSSES, frames: int = FRAMES) -> np.ndarray:
    """Rows of cubes that are about to land on a corner, columns as of `COLUMNS`.

    The next corner is 15 mm higher or more: where two land at the same time, motions have kinks.
    """
    model = vc.load(text)
    generator = np.random.default_rng(seed)
    rows = []
    with vc.attach(model):
        for toss in range(count):
            data = mujoco.MjData(model)
            turned, next_corner = np.empty(9), 0.0
            while next_corner < 0.015:
                turn = generator.standard_normal(4)
                data.qpos[3:7] = turn / np.linalg.norm(turn)
                mujoco.mju_quat2Mat(turned, data.qpos[3:7])
                next_corner = 2.0 * HALF * float(np.abs(turned[6:]).min())
            data.qvel[:2] = 0.7 * generator.standard_normal(2)
            data.qvel[2] = -1.0
            data.qvel[3:] = 3.0 * generator.standard_normal(3)
            data.qpos[2] = HALF * float(np.abs(turned[6:]).sum()) + 0.04  # six frames above
            for frame in range(frames):
                rows.append([toss, frame / RATE, *data.qpos, *data.qvel])
                for _ in range(EVERY):
                    mujoco.mj_step(model, data)
    return np.array(rows)


def slides(text: str, seed: int = 0, count: int = TOSSES, frames: int = 40) -> np.ndarray:
    """Rows of cubes that are thrown along the board, slide on a face and stop."""
    model = vc.load(text)
    generator = np.random.default_rng(seed)
    rows = []
    with vc.attach(model):
        for toss in range(count):
            data = mujoco.MjData(model)
            data.qpos[2] = HALF - 1e-6
            data.qvel[:2] = 0.15 * generator.standard_normal(2)
            data.qvel[5] = generator.standard_normal()
            for frame in range(frames):
                rows.append([toss, frame / RATE, *data.qpos, *data.qvel])
                for _ in range(EVERY):
                    mujoco.mj_step(model, data)
    return np.array(rows)


def noisy(rows: np.ndarray, seed: int) -> np.ndarray:
    """Rows as cameras see them."""
    generator = np.random.default_rng(seed)
    found = rows.copy()
    found[:, 2:5] += POSITION * generator.standard_normal((len(rows), 3))
    turn = rotations.quaternion(ANGLE * generator.standard_normal((len(rows), 3)))
    found[:, 5:9] = rotations.product(rows[:, 5:9], turn)
    return found


def write(folder: Path, text: str, rows: np.ndarray, study: str) -> Path:
    """The files of a study of tosses; returns the path of the study."""
    (folder / "scene.xml").write_text(text)
    with (folder / "tosses.csv").open("w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(COLUMNS)
        writer.writerows([int(row[0]), *(repr(float(v)) for v in row[1:])] for row in rows)
    head = HEAD.format(position=POSITION, angle=ANGLE)
    (folder / "study.toml").write_text(head + study)
    return folder / "study.toml"


def parameter(name: str, low: float, high: float, scale: str = "log") -> str:
    """A table of the study."""
    return (
        f'[parameter.{name}]\ntarget = "volcontact/pair/p/{name}"\n'
        f'bounds = [{low!r}, {high!r}]\nscale = "{scale}"\n'
    )
