# SPDX-License-Identifier: Apache-2.0
"""Figures 5, 7 and 9 of the CSA paper from runs of the scenes here: `./run demo --all`."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import mujoco
import numpy as np
from matplotlib.figure import Figure

import volcontact as vc
from volcontact.render import Renderer
from volcontact.report.palette import NATIVE, VOLUMETRIC

MODELS = Path(__file__).parent
PAPER = (("upright", 0.15), ("small sphere touches", 1.7), ("falls", 4.0))  # [s], figure 7
FRAME_INTERVAL = 0.2  # [s], figure 9
GRID = "#e4e7eb"
STYLE = {"font.size": 10.0, "axes.grid": True, "grid.color": GRID, "axes.axisbelow": True}

Watch = Callable[[mujoco.MjData], tuple[float, ...]]


def watched(scene: str, duration: float, interval: float, watch: Watch) -> np.ndarray:
    """What `watch` returns, under volumetric contact from the scene's keyframe `start`, if any.

    Returns:
        Time [s] and what was watched, a row an interval.
    """
    model = vc.load(str(MODELS / scene))
    data = mujoco.MjData(model)
    start = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_KEY, "start")
    if start >= 0:
        mujoco.mj_resetDataKeyframe(model, data, start)
    mujoco.mj_forward(model, data)
    steps = max(1, round(interval / model.opt.timestep))
    rows = [(data.time, *watch(data))]
    with vc.attach(model):
        while data.time < duration - 0.5 * model.opt.timestep:
            mujoco.mj_step(model, data, steps)
            rows.append((data.time, *watch(data)))
    return np.array(rows)


def ball_path(out: Path, duration: float = 30.0) -> list[Path]:
    """Figure 5: the way of the ball's centre in space, and from above."""
    rows = watched("ball_in_cylinder/scene.xml", duration, 2e-3, lambda d: tuple(d.qpos[:3]))
    x, y, z = rows[:, 1:].T
    floor = -1.0
    space = Figure(figsize=(6.4, 6.0), layout="constrained")
    axes = space.add_subplot(projection="3d")
    axes.plot(x, y, z, color=VOLUMETRIC, lw=1.0, label="centre of the ball")
    axes.plot(x, y, floor, color="#9aa3ad", lw=0.8, label="seen from above")
    axes.scatter(*rows[0, 1:], color=VOLUMETRIC, marker="o", s=24)
    axes.scatter(*rows[-1, 1:], color=NATIVE, marker="s", s=24, label="comes to rest")
    along = np.linspace(y.min() - 0.05, y.max() + 0.05, 2)
    angle, wall = np.meshgrid(np.linspace(math.pi, 2.0 * math.pi, 40), along)
    axes.plot_surface(np.cos(angle), wall, np.sin(angle), color="#c9d2dc", alpha=0.25, lw=0)
    axes.set(xlabel="x [m]", ylabel="y, along the bore [m]", zlabel="z [m]", zlim=(floor, 0.1))
    axes.view_init(elev=24.0, azim=-58.0)
    axes.legend(loc="upper left")
    axes.set_title("Ball in a cylinder (the paper's figure 5)")

    plane = Figure(figsize=(6.4, 4.0), layout="constrained")
    axes = plane.subplots()
    axes.plot(x, y, color=VOLUMETRIC, lw=1.0)
    axes.plot(x[0], y[0], "o", color=VOLUMETRIC, label="let go")
    axes.plot(x[-1], y[-1], "s", color=NATIVE, label="comes to rest")
    axes.set(xlabel="x [m]", ylabel="y, along the bore [m]")
    axes.legend(loc="lower right")
    axes.set_title("The same from above")
    return _save(out, {"ball_path_xyz.png": space, "ball_path_xy.png": plane})


def tippe_top_tilt(out: Path, duration: float = 8.0) -> list[Path]:
    """Figure 7: tilt of the tippe-top against time, with the events of the paper."""

    def tilt(data: mujoco.MjData) -> tuple[float]:
        return (math.acos(min(1.0, max(-1.0, float(data.xmat[1, 8])))),)

    rows = watched("tippe_top/scene.xml", duration, 1e-3, tilt)
    figure = Figure(figsize=(8.0, 4.0), layout="constrained")
    axes = figure.subplots()
    axes.plot(rows[:, 0], rows[:, 1], color=VOLUMETRIC, lw=1.0, label="volcontact")
    for name, time in PAPER:
        axes.axvline(time, color=NATIVE, lw=1.0, ls=":")
        axes.annotate(
            f"{name}, {time:g} s",
            (time, 3.32),
            xytext=(4, 0),
            textcoords="offset points",
            color=NATIVE,
            fontsize=9,
        )
    axes.plot([], [], color=NATIVE, lw=1.0, ls=":", label="events of the paper")
    places = _events(rows[:, 0], rows[:, 1])
    axes.plot(rows[places, 0], rows[places, 1], "o", color=VOLUMETRIC, ms=5, label="the same here")
    axes.set(xlabel="time [s]", ylabel="tilt [rad]", ylim=(0.0, 3.6), xlim=(0.0, duration))
    axes.set_yticks(
        [0.0, math.pi / 4, math.pi / 2, 3 * math.pi / 4, math.pi], ["0", "π/4", "π/2", "3π/4", "π"]
    )
    axes.legend(loc="lower right")
    axes.set_title("Tippe-top (the paper's figure 7)")
    return _save(out, {"tippe_top_tilt.png": figure})


def _events(time: np.ndarray, tilt: np.ndarray) -> list[int]:
    """Rows in which the top is upright, the small sphere touches, and the top falls, if it does."""
    touching = math.acos(
        -10.0 / 13.0
    )  # both spheres on the table: radii 15, 5, centres 13 mm apart
    places = [int(np.argmin(tilt[time < 0.6]))]
    touched = np.nonzero(tilt > touching)[0]
    if len(touched):
        places.append(int(touched[0]))
        inverted = np.nonzero(tilt > math.radians(150.0))[0]
        fallen = np.nonzero((tilt < math.radians(120.0)) & (time > time[inverted[:1]].sum()))[0]
        places += [int(i) for i in fallen[:1] if len(inverted)]
    return places


def battery_box_frames(out: Path, frames: int = 6) -> list[Path]:
    """Figure 9: the battery box as it falls into its worksite, every 0.2 s."""
    scene = str(MODELS / "battery_box" / "scene.xml")
    duration = (frames - 1) * FRAME_INTERVAL
    count = mujoco.MjModel.from_xml_path(scene).nq
    rows = watched("battery_box/scene.xml", duration, FRAME_INTERVAL, lambda d: tuple(d.qpos))
    with Renderer(vc.load(scene), width=480, height=400) as renderer:
        pictures = [renderer.draw(row[1 : 1 + count], view="overview") for row in rows]
    columns = min(3, frames)
    lines = math.ceil(frames / columns)
    figure = Figure(figsize=(4.0 * columns, 3.6 * lines), layout="constrained")
    for axes, picture, row in zip(
        figure.subplots(lines, columns, squeeze=False).flat, pictures, rows, strict=False
    ):
        axes.imshow(picture)
        axes.set_axis_off()
        axes.set_title(f"{row[0]:.1f} s")
    figure.suptitle("Battery box falling into its worksite (the paper's figure 9)")
    return _save(out, {"battery_box.png": figure})


def _save(out: Path, figures: dict[str, Figure]) -> list[Path]:
    out.mkdir(parents=True, exist_ok=True)
    for name, figure in figures.items():
        figure.savefig(out / name, dpi=130)
    return [out / name for name in figures]


def main() -> None:
    """Makes all figures in the folder of --out."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the pictures")
    arguments = parser.parse_args()
    with mpl.rc_context(STYLE):
        for make in (ball_path, tippe_top_tilt, battery_box_frames):
            for path in make(arguments.out):
                print(path)


if __name__ == "__main__":
    main()
