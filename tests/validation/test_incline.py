# SPDX-License-Identifier: Apache-2.0
"""A box on a slope: it sticks up to mu_S without creep, slides at mu_C; a ball rolls or slips."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from case import (
    GRAVITY,
    ONE_FRICTION,
    Bounds,
    Case,
    Curve,
    Figure,
    Plot,
    Run,
    depth_of_ball,
    load,
    simulate,
)
from scenes import over_floor

KINETIC, STATIC = 0.3, 0.4


def lean(
    tangent: float, *, ramp: float, duration: float, native: bool = False, precise: bool = False
) -> Run:
    """The scene's box on a slope that leans to `tangent` in `ramp` seconds; rows of x and v.

    Euler's steps of a millisecond, or precise ones, whose energy can be accounted for.
    """
    model = load("incline/scene.xml")
    if precise:
        model.opt.timestep = 1e-4
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4

    def drive(m: mujoco.MjModel, data: mujoco.MjData) -> None:
        m.opt.gravity[0] = GRAVITY * tangent * min(1.0, data.time / ramp)

    model.opt.gravity[0] = 0.0
    return simulate(
        model,
        duration,
        lambda _, d: (d.qpos[0], d.qvel[0]),
        every=10,
        drive=drive,
        native=native,
    )


def creep(run: Run, since: float) -> float:
    """How far the box moves from then on [m]."""
    late = run.rows[run.rows[:, 0] >= since, 1]
    return float(np.abs(late - late[0]).max())


def slide(*, native: bool = False) -> Run:
    """The box let go on a slope of 30 degrees, where it slides from the start."""
    # Stiff bristles: they give by a quarter of a micrometre before friction is whole.
    model = load(
        "incline/scene.xml",
        pair__box__static_friction=KINETIC,
        pair__box__bristle_stiffness=1e7,
        pair__box__bristle_damping=1e3,
    )
    angle = math.radians(30.0)
    model.opt.gravity[:] = GRAVITY * np.array([math.sin(angle), 0.0, -math.cos(angle)])
    model.opt.timestep = 2e-5
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    return simulate(model, 1.0, lambda _, d: (d.qpos[0], d.qvel[0]), every=50, native=native)


def acceleration(run: Run) -> float:
    """Of a slide, but for its first 50 ms [m/s^2]."""
    return float(np.polyfit(run.rows[50:, 0], run.rows[50:, 2], 1)[0])


def slip_of_ball(degrees: float, case: Case, *, native: bool = False) -> float:
    """Rate of slip of a ball over its acceleration, in the second quarter of a second [-]."""
    angle = math.radians(degrees)
    depth = depth_of_ball(GRAVITY * math.cos(angle), 0.05, 1e12)
    scene = over_floor(
        'size="0.05"',
        height=0.05 - depth,
        step=1e-4,
        surface='friction="0.3 0 0"',
        stiffness=1e12,
        damping=0.0,
        friction_law__bristle=1,
        bristle_stiffness=1e6,
        bristle_damping=500.0,
    )
    model = load(scene)
    model.opt.gravity[:] = GRAVITY * np.array([math.sin(angle), 0.0, -math.cos(angle)])
    run = simulate(model, 0.5, lambda _, d: (d.qvel[0], d.qvel[4]), every=100, native=native)
    if not native:
        case.account(run)
    gained = run.rows[-1] - run.rows[len(run.rows) // 2]
    return float(1.0 - 0.05 * gained[2] / gained[1])


def measure() -> Case:
    """Creep, the angles at which sliding and slipping begin, and the slide itself."""
    case = Case(
        "Slope",
        "A box on a slope. Up to the tangent mu_S it rests without any creep; above it slides, and "
        "once it slides mu_C applies. A ball rolls up to the tangent 7/2 mu. The balance of energy "
        "includes the work of tilting the slope, in runs with Runge-Kutta; the minutes at rest use "
        "Euler steps of 1 ms.",
    )
    held = lean(0.9 * KINETIC, ramp=2.0, duration=70.0)
    native = lean(0.9 * KINETIC, ramp=2.0, duration=70.0, native=True)
    case.figures.append(
        Figure(
            "creep in 60 s at 0.9 of the cone", "m", 0.0, 1e-15, creep(held, 10), creep(native, 10)
        )
    )
    edge = lean(0.999 * STATIC, ramp=20.0, duration=90.0)
    case.figures.append(
        Figure("creep in 60 s at tan = 0.999 mu_S", "m", 0.0, 1e-15, creep(edge, 30), ONE_FRICTION)
    )
    over = lean(1.001 * STATIC, ramp=20.0, duration=25.0)
    ramp = lean(1.1 * STATIC, ramp=22.0, duration=22.0)
    begins = STATIC * 1.1 / 22.0 * ramp.rows[int(np.argmax(ramp.rows[:, 2] > 1e-4)), 0]
    case.figures += [
        Bounds(
            "speed at tan = 1.001 mu_S, 5 s later", "m/s", 1.0, 10.0, over.rows[-1, 2], ONE_FRICTION
        ),
        Figure("tangent at which it begins to slide", "-", STATIC, 3e-3, begins, ONE_FRICTION),
    ]
    run, other = slide(), slide(native=True)
    case.account(run)
    for tangent in (0.9 * KINETIC, 1.1 * STATIC):
        case.account(lean(tangent, ramp=2.0, duration=3.0, precise=True))
    rolls, slips = (
        (slip_of_ball(degrees, case), slip_of_ball(degrees, case, native=True))
        for degrees in (46.3, 50.0)
    )
    metre = [float(np.interp(1.0, r.rows[:, 1], r.rows[:, 0])) for r in (run, other)]
    case.figures += [
        Figure(
            "acceleration at 30 degrees", "m/s^2", 2.35629, 1e-3, *map(acceleration, (run, other))
        ),
        Figure("time for 1 m", "s", 0.92130, 1e-3, *metre),
        Figure("slip of a ball over its acceleration, 46.3 degrees", "-", 0.0, 1e-3, *rolls),
        # a = g (sin - mu cos), r w' = 5/2 mu g cos: slip over speed = 1 - 5/2 mu cos/(sin - mu cos)
        Figure("the same, 50 degrees", "-", slip_ratio(50.0), 1e-3, *slips),
    ]
    curves = [Curve("volumetric", held.rows[:, 0], held.rows[:, 1] * 1e3)]
    curves.append(Curve("native", native.rows[:, 0], native.rows[:, 1] * 1e3, "--"))
    case.plots.append(Plot("creep", "time [s]", "way at 0.9 of the cone [mm]", tuple(curves)))
    return case


def slip_ratio(degrees: float) -> float:
    """Closed form of `slip_of_ball` beyond 46.397 degrees."""
    angle = math.radians(degrees)
    spun = 2.5 * KINETIC * math.cos(angle)
    return 1.0 - spun / (math.sin(angle) - KINETIC * math.cos(angle))


@pytest.mark.once
def test_incline() -> None:
    measure().check()
