# SPDX-License-Identifier: Apache-2.0
"""Simulates the bench tests of this folder and writes what an engineer would note.

`./run python mjcf_models/identification/make_sheets.py` writes `sheet.csv` of each scene. Tests and
the page of the bench tests take the functions: a sheet as text, without noise.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

import volcontact as vc
from volcontact.identify.direct import breakaway

FOLDER = Path(__file__).parent
GRAVITY = 9.81  # of the scenes [m/s^2]


def load(name: str, scene: str = "scene.xml", **numbers: float) -> tuple[Any, Any]:
    """A scene at its keyframe, with other numbers of its pair `bench`."""
    model = vc.load(FOLDER / name / scene)
    for field, value in numbers.items():
        place = mujoco.mj_name2id(
            model, mujoco.mjtObj.mjOBJ_NUMERIC, f"volcontact/pair/bench/{field}"
        )
        if place < 0:
            raise ValueError(f"{name}/{scene} has no {field}")
        model.numeric_data[model.numeric_adr[place]] = value
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    return model, data


def truth(name: str, scene: str = "scene.xml") -> dict[str, float]:
    """Numbers of the pair `bench` of a scene."""
    model = mujoco.MjModel.from_xml_path(str(FOLDER / name / scene))
    found = {}
    for place in range(model.nnumeric):
        parts = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_NUMERIC, place).split("/")
        if parts[:3] == ["volcontact", "pair", "bench"] and len(parts) == 4:
            found[parts[3]] = float(model.numeric_data[model.numeric_adr[place]])
    return found


def sheet(constants: dict[str, Any], columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    """Text of a sheet."""
    lines = [f"# {name} = {value}" for name, value in constants.items()]
    lines.append(",".join(columns))
    for row in rows:
        cells = ("" if x is None else str(x) if isinstance(x, str) else f"{x:.12g}" for x in row)
        lines.append(",".join(cells))
    return "\n".join(lines) + "\n"


def run(model: Any, data: Any, duration: float, watch: Callable[[], None] | None = None) -> None:
    """Steps so long."""
    for _ in range(round(duration / model.opt.timestep)):
        mujoco.mj_step(model, data)
        if watch is not None:
            watch()


def press(loads: Sequence[float] = (1, 2, 5, 10, 20, 35, 50, 75, 100), offset: float = 3e-4) -> str:
    """Dead loads, each until it rests; the gauge reads `offset` [m] at touch."""
    model, data = load("press")
    rows = []
    with vc.attach(model):
        for force in loads:
            data.ctrl[0] = force
            run(model, data, 0.6)
            rows.append((1e3 * (data.qpos[0] + offset), force))
    constants = {"a": "sphere:radius=0.02", "b": "half_space"}
    return sheet(constants, ("depth [mm]", "force [N]"), rows)


def press_ramp(speed: float = 0.02) -> str:
    """The same driven in and out: force over depth and speed."""
    model, data = load("press")
    rows = []
    with vc.attach(model):
        model.opt.timestep = 2e-5
        period = 4.0 * 5e-4 / speed
        steps = round(period / model.opt.timestep)
        for step in range(steps):
            data.ctrl[0] = 40.0 * (1.0 - math.cos(2.0 * math.pi * step / steps))
            if step % (steps // 60) == 0:  # load less inertia, all of one moment
                mujoco.mj_forward(model, data)
                force = data.ctrl[0] - 0.5 * data.qacc[0]
                rows.append((1e3 * data.qpos[0], force, 1e3 * data.qvel[0]))
            mujoco.mj_step(model, data)
    constants = {"a": "sphere:radius=0.02", "b": "half_space"}
    return sheet(constants, ("depth [mm]", "force [N]", "speed [mm/s]"), rows)


def bounces(
    heights: Sequence[float] = (0.5, 0.2),
    count: int = 5,
    scene: str = "scene.xml",
    **numbers: float,
) -> list[list[tuple[float, float]]]:
    """Times of first touch and peak heights of drops."""
    model, _ = load("drop", scene, **numbers)
    fine, coarse = model.opt.timestep, 20.0 * model.opt.timestep
    found = []
    with vc.attach(model):
        for height in heights:
            model.opt.timestep = fine
            data = mujoco.MjData(model)
            data.qpos[0] = height
            drop = [(0.0, height)]
            touched = 0.0
            while len(drop) <= count:
                before = data.time, data.qpos[0], data.qvel[0]
                margin = 4.0 * coarse * abs(before[2]) + 1e-5
                is_far = before[1] > margin and abs(before[2]) > 4.0 * coarse * GRAVITY
                model.opt.timestep = coarse if is_far else fine
                mujoco.mj_step(model, data)
                if before[1] > 0.0 >= data.qpos[0]:
                    share = before[1] / (before[1] - data.qpos[0])
                    touched = before[0] + share * (data.time - before[0])
                if before[2] > 0.0 >= data.qvel[0] and data.qpos[0] > 0.0:
                    drop.append((touched, data.qpos[0] + 0.5 * data.qvel[0] ** 2 / GRAVITY))
            found.append(drop)
    return found


def drop(heights: Sequence[float] = (0.5, 0.2), count: int = 5, scene: str = "scene.xml") -> str:
    """Heights of the bounces."""
    rows = []
    for place, peaks in enumerate(bounces(heights, count, scene)):
        rows += [(str(place + 1), 1e3 * height) for _, height in peaks]
    return sheet(_drop_constants(), ("drop", "height [mm]"), rows)


def drop_times(heights: Sequence[float] = (0.5, 0.2), count: int = 6) -> str:
    """Times from one first touch to the next; the contact time is that of the middle bounce."""
    rows = []
    for place, peaks in enumerate(bounces(heights, count)):
        touched = [time for time, _ in peaks[1:]]
        rows += [(str(place + 1), 1e3 * interval) for interval in np.diff(touched)]
    return sheet(_drop_constants(), ("drop", "interval [ms]"), rows)


def _drop_constants() -> dict[str, Any]:
    stiffness = truth("drop")["stiffness"]
    return {
        "gravity [m/s^2]": GRAVITY,
        "a": "sphere:radius=0.025",
        "b": "half_space",
        "mass [kg]": 0.5,
        "stiffness [N/m^3]": f"{stiffness:g}",
    }


def _slide(model: Any, data: Any, speed: float, duration: float) -> None:
    """Moves the sled by hand at a speed, so that its rest begins anew at the end."""
    for _ in range(round(duration / model.opt.timestep)):
        data.qvel[0] = speed
        mujoco.mj_step(model, data)
    data.qvel[0] = 0.0


def breakaways(rests: Sequence[float], rate: float = 1.0, **numbers: float) -> list[tuple]:
    """Rest until the breakaway [s] and its load [N], for rests before the load begins to rise."""
    found = []
    for rest in rests:
        model, data = load("pull", **numbers)
        data.ctrl[0] = 0.0
        with vc.attach(model):
            _slide(model, data, 0.2, 0.1)
            begin = data.time
            run(model, data, rest)
            rows = []
            start = data.time
            while data.qvel[0] < 0.02 and data.time < start + 10.0:
                data.ctrl[0] = rate * (data.time + 0.5 * model.opt.timestep - start)
                mujoco.mj_step(model, data)
                rows.append((data.time, rate * (data.time - start), data.qpos[0]))
        seen = breakaway(*np.array(rows).T, threshold=2e-6)
        found.append((seen.time - begin, seen.load))
    return found


def slides(speeds: Sequence[float], **numbers: float) -> list[tuple]:
    """Speed and force of steady slides [m/s, N]."""
    model, data = load("pull", "scene_drive.xml", **numbers)
    found = []
    with vc.attach(model):
        for speed in speeds:
            data.ctrl[0] = speed
            dwell = truth("pull")["dwell_time"] if speed < 0.04 else 0.05
            run(model, data, max(8.0 * dwell, 0.3))
            found.append((data.qvel[0], data.actuator_force[0]))
    return found


def pull(
    rests: Sequence[float] = (0.0, 1.0, 3.0, 7.0),
    speeds: Sequence[float] = (0.001, 0.004, 0.007, 0.01, 0.014, 0.02, 0.05, 0.1, 0.2),
) -> str:
    """Breakaways after rests, and steady slides."""
    rows: list[tuple] = [(rest, None, force) for rest, force in breakaways(rests)]
    rows += [(None, 1e3 * speed, force) for speed, force in slides(speeds)]
    constants = {"normal force [N]": GRAVITY}
    return sheet(constants, ("rest [s]", "speed [mm/s]", "force [N]"), rows)


def tilt(
    rests: Sequence[float] = (0.5, 2.0, 4.0, 8.0, 16.0), rate: float = math.radians(4.0)
) -> str:
    """Angles at the breakaway, the table turned at a rate [rad/s], and the slide at that angle."""
    rows = []
    for rest in rests:
        model, data = load("tilt")
        data.qpos[3] -= GRAVITY / (truth("tilt")["stiffness"] * 0.012)  # as deep as its weight
        step = model.opt.timestep
        seen: list[tuple[float, float, float]] = []
        with vc.attach(model):
            run(model, data, rest)
            while len(seen) < 2 or seen[-1][2] - seen[0][2] < 1e-3:
                data.ctrl[0] = rate * (data.time + step - rest)
                mujoco.mj_step(model, data)
                seen.append((data.time, math.sin(data.qpos[0]), _way(data)))
            found = breakaway(*np.array(seen).T, threshold=2e-6)
            # The table stays where it is, and the sled is timed once it is quick.
            slide: list[tuple[float, float]] = []
            while not slide or slide[-1][1] < 0.2:
                mujoco.mj_step(model, data)
                slide.append((data.time, _way(data)))
            held = float(data.qpos[0])
        timed = np.array([one for one in slide if one[1] > 0.03])
        acceleration = 2.0 * np.polyfit(timed[:, 0] - timed[0, 0], timed[:, 1], 2)[0]
        # Noted for the angle at the breakaway: the few milliradian that the table went on count.
        g, angle = GRAVITY, math.asin(found.load)
        kinetic = math.tan(held) - acceleration / (g * math.cos(held))
        at_break = g * (math.sin(angle) - kinetic * math.cos(angle))
        rows.append((found.time, math.degrees(angle), at_break))
    columns = ("rest [s]", "angle [deg]", "acceleration [m/s^2]")
    return sheet({"gravity [m/s^2]": GRAVITY}, columns, rows)


def _way(data: Any) -> float:
    """Of the sled down the table [m]."""
    angle = float(data.qpos[0])
    return float(data.qpos[1] * math.cos(angle) - data.qpos[3] * math.sin(angle))


def loops(
    frequencies: Sequence[float] = (5.0, 10.0, 20.0),
    amplitude: float = 0.2,
    periods: int = 4,
    samples: int = 40,
    **numbers: float,
) -> list[tuple]:
    """Micro-slip loops: label, time [s], displacement [m] and force [N]."""
    rows = []
    for place, frequency in enumerate(frequencies):
        model, data = load("slip", **numbers)
        w = 2.0 * math.pi * frequency
        step = model.opt.timestep
        with vc.attach(model):
            per = round(1.0 / (frequency * samples * step))
            for k in range((2 + periods) * samples * per):
                data.ctrl[0] = amplitude * math.sin(w * (data.time + 0.5 * step))
                if k % per == 0 and k >= 2 * samples * per:
                    force = amplitude * math.sin(w * data.time)
                    rows.append((str(place + 1), data.time, data.qpos[0], force))
                mujoco.mj_step(model, data)
    return rows


def slip(**given: Any) -> str:
    """The loops as a sheet."""
    rows = [(label, t, 1e6 * x, force) for label, t, x, force in loops(**given)]
    constants = {
        "mass [kg]": 1,
        "viscous friction [N s/m]": truth("slip")["viscous_friction"],
        "normal force [N]": GRAVITY,
        "friction": truth("slip")["friction"],
        "stribeck speed [m/s]": truth("slip")["stribeck_speed"],
    }
    return sheet(constants, ("loop", "time [s]", "displacement [um]", "force [N]"), rows)


def roll(speed: float = 1.0, duration: float = 6.0) -> str:
    """Rates of a ball that rolls out."""
    model, data = load("roll")
    rows = []
    with vc.attach(model):
        data.qvel[:] = speed * data.qvel
        every = round(0.1 / model.opt.timestep)
        for step in range(round(duration / model.opt.timestep) + 1):
            if step % every == 0 and data.time > 0.35:
                rows.append((data.time, data.qvel[4]))
            mujoco.mj_step(model, data)
    constants = {
        "a": "sphere:radius=0.05",
        "b": "half_space",
        "mass [kg]": 1,
        "inertia [kg m^2]": 0.4 * 0.05**2,
        "gravity [m/s^2]": GRAVITY,
        "stiffness [N/m^3]": f"{truth('roll')['stiffness']:g}",
    }
    return sheet(constants, ("time [s]", "rate [rad/s]"), rows)


def spin(**numbers: float) -> str:
    """Rates of a disc that spins down."""
    model, data = load("spin", **numbers)
    rows = []
    with vc.attach(model):
        every = round(0.05 / model.opt.timestep)
        for step in range(round(0.8 / model.opt.timestep) + 1):
            if step % every == 0:
                rows.append((data.time, data.qvel[5]))
            mujoco.mj_step(model, data)
    constants = {
        "a": "cylinder:radius=0.05,half_length=0.01",
        "b": "half_space",
        "mass [kg]": 1,
        "inertia [kg m^2]": 0.5 * 0.05**2,
        "gravity [m/s^2]": GRAVITY,
        "stiffness [N/m^3]": f"{truth('spin')['stiffness']:g}",
        "friction": truth("spin")["friction"],
    }
    return sheet(constants, ("time [s]", "rate [rad/s]"), rows)


if __name__ == "__main__":
    import sys

    for name in sys.argv[1:] or ("press", "drop", "tilt", "pull", "slip", "roll", "spin"):
        text = globals()[name]()
        (FOLDER / name / "sheet.csv").write_text(text, encoding="utf-8")
        print(text)
