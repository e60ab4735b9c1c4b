# SPDX-License-Identifier: Apache-2.0
"""A ball falls inside a horizontal cylinder, swings, and comes to rest."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from case import Bounds, Case, Curve, Figure, Plot, Run, crossings, load, simulate

BORE, RADIUS = 1.0, 0.1
NO_BORE = "no bore"


def place(data: mujoco.MjData) -> tuple[float, float, float]:
    """Centre of the ball [m]."""
    return tuple(data.qpos[:3])


def come_to_rest(duration: float = 30.0, *, step: float = 2e-4, native: bool = False) -> Run:
    """The whole scene, thrown along the bore and spinning: rows of place and largest speed."""

    def whole(_: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, ...]:
        return (*place(data), float(np.abs(data.qvel).max()))

    scene = load("ball_in_cylinder/scene.xml")
    scene.opt.timestep = step
    return simulate(scene, duration, whole, every=round(0.02 / step), native=native)


def rests_from(run: Run) -> float:
    """From when on it is slower than 1 mm/s and 1 mrad/s [s]."""
    return float(run.rows[run.rows[:, 4] > 1e-3, 0][-1])


def measure() -> Case:
    """First touch, period of small swings, rest."""
    case = Case(
        "Ball in a cylinder",
        "The first demonstration of the CSA paper: a ball of 0.1 m falls inside a horizontal "
        "cylinder of 1 m, an exact bore. Free fall brings it to the wall; small swings of a "
        "rolling ball have the period T = 2 pi sqrt(7 (R - r)/(5 g)); rolling resistance and spin "
        "friction bring it to rest.",
    )
    # Free fall to |centre| = R - r.
    fall = load("ball_in_cylinder/scene.xml", pair__ball__stiffness=1e8)
    fall.opt.timestep = 1e-5

    def let_go(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        data.qvel[:] = 0.0

    def gap(_: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float, float]:
        x, _, z = place(data)
        return math.hypot(x, z) - (BORE - RADIUS), z, -data.qvel[2]

    run = simulate(fall, 0.39065, gap, every=1, setup=let_go)
    touch = crossings(run.rows[:, 0], run.rows[:, 1])[0]
    case.figures += [
        Figure("first touch", "s", 0.390596, 1e-5, touch, NO_BORE),
        Figure(
            "speed then",
            "m/s",
            3.83174,
            1e-5,
            np.interp(touch, run.rows[:, 0], run.rows[:, 3]),
            NO_BORE,
        ),
        Figure(
            "height of its centre then",
            "m",
            -0.748331,
            1e-5,
            np.interp(touch, run.rows[:, 0], run.rows[:, 2]),
            NO_BORE,
        ),
    ]
    swing = load("ball_in_cylinder/scene.xml", pair__ball__stiffness=1e9, pair__ball__damping=0.0)
    depth = math.sqrt(
        9.81 * math.sqrt(1.0 / RADIUS * (1.0 / RADIUS - 1.0 / BORE)) / (1e9 * math.pi)
    )

    def hang(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        angle, reach = 0.02, BORE - RADIUS + depth
        data.qvel[:] = 0.0
        data.qpos[:3] = reach * math.sin(angle), 0.0, -reach * math.cos(angle)

    small = simulate(swing, 6.0, lambda _, d: place(d), every=50, setup=hang)
    period = 2.0 * float(np.mean(np.diff(crossings(small.rows[:, 0], small.rows[:, 1]))))
    case.figures.append(Figure("period of small swings", "s", 2.25180, 5e-3, period, NO_BORE))
    case.account(run, small)
    rest, native = come_to_rest(), come_to_rest(3.0, native=True)
    case.account(rest)
    time, speed = rest.rows[:, 0], rest.rows[:, 4]
    case.figures += [
        Bounds("slower than 1 mm/s and 1 mrad/s from", "s", 5.0, 28.0, rests_from(rest), NO_BORE),
        Bounds("speed after 30 s", "m/s, rad/s", 0.0, 1e-4, speed[-1], NO_BORE),
        Bounds("dissipated by rolling", "J", 0.1, 10.0, rest.dissipated[1], NO_BORE),
        Bounds("dissipated by spinning", "J", 0.01, 10.0, rest.dissipated[3], NO_BORE),
    ]
    case.plots += [
        Plot(
            "path",
            "x [m]",
            "z [m]",
            (
                Curve("volumetric", rest.rows[:, 1], rest.rows[:, 3]),
                Curve("native", native.rows[:, 1], native.rows[:, 3], "--"),
            ),
        ),
        Plot(
            "from_above",
            "x [m]",
            "y, along the bore [m]",
            (Curve("volumetric", rest.rows[:, 1], rest.rows[:, 2]),),
        ),
        Plot(
            "swing",
            "time [s]",
            "x and y [m]",
            (Curve("x", time, rest.rows[:, 1]), Curve("y", time, rest.rows[:, 2])),
        ),
    ]
    return case


@pytest.mark.soak
def test_ball_in_cylinder() -> None:
    """Of `./run test` the whole run in test_sensitivity.py."""
    measure().check()
