# SPDX-License-Identifier: Apache-2.0
"""Balls, cylinders and boxes at rest, in small vibration, and in head-on impacts."""

from __future__ import annotations

import math

import numpy as np
import pytest
from case import GRAVITY, NO_STIFFNESS, Case, Figure, crossings, load, simulate
from scenes import over_floor

import volcontact as vc

SHAPES = {
    "sphere": 'type="sphere" size="0.05"',
    "cylinder": 'type="cylinder" size="0.05 0.05"',
    "lying cylinder": 'type="cylinder" size="0.05 0.05" euler="90 0 0"',
    "box": 'type="box" size="0.05 0.05 0.05"',
}


DEPTH = 0.7923638796e-3  # at which a ball of 1 kg rests on k_v = 1e8 N/m^3 [m]
# Volume and second moment about the normal's cross axis of its cap: docs/theory.md.
CAP = (
    math.pi * DEPTH**2 * (0.15 - DEPTH) / 3.0,
    math.pi * DEPTH**3 * (20.0 * 0.05**2 - 15.0 * 0.05 * DEPTH + 3.0 * DEPTH**2) / 60.0,
)


def gyration_radius() -> float:
    """Of the patch of the resting ball about its normal [m]."""
    pose = np.eye(4)
    pose[2, 3] = 0.05 - DEPTH
    overlap = vc.interference(vc.HalfSpace(), vc.Sphere(radius=0.05), pose)
    return math.sqrt(overlap.inertia[2, 2] / overlap.volume)


def depth_at_rest(shape: str, stiffness: float, case: Case, *, native: bool = False) -> float:
    """How deep a body of 1 kg sinks [m]."""
    scene = over_floor(
        SHAPES[shape], height=0.05, step=5e-5, gravity=GRAVITY, stiffness=stiffness, damping=20.0
    )
    run = simulate(load(scene), 1.5, lambda _, d: (d.qpos[2],), every=200, native=native)
    if not native:
        case.account(run)
    return 0.05 - float(run.rows[-1, 1])


def bounce_frequency(case: Case, *, native: bool = False) -> float:
    """Of a ball that sinks by 0.79 mm, in a vibration of a micrometre [Hz]."""
    height = 0.05 - DEPTH + 1e-6
    scene = over_floor(
        SHAPES["sphere"], height=height, step=1e-4, gravity=GRAVITY, stiffness=1e8, damping=0.0
    )
    watch = lambda _, d: (d.qpos[2] - 0.05 + DEPTH,)  # noqa: E731
    run = simulate(load(scene), 1.0, watch, native=native)
    if not native:
        case.account(run)
    zeros = crossings(run.rows[:, 0], run.rows[:, 1])
    if len(zeros) < 3:
        return math.nan  # it does not swing
    return 0.5 * (len(zeros) - 1) / float(zeros[-1] - zeros[0])


def impact_constant(shape: str, case: Case, *, native: bool = False) -> float:
    """Time in contact times speed over greatest depth, without gravity or damping [-]."""
    step, speed = 1e-6, 0.2
    height = 0.05 + 1e-9
    scene = over_floor(
        SHAPES[shape], height=height, step=step, speed=speed, stiffness=1e9, damping=0.0
    )
    model = load(scene)
    duration, watch = 0.02, lambda _, d: (d.qpos[2] - 0.05,)
    if native:  # that lasts longer
        model.opt.timestep, duration = 1e-5, 0.2
    run = simulate(model, duration, watch, every=10, native=native)
    if not native:
        case.account(run)
    touch, leave = (*crossings(run.rows[:, 0], run.rows[:, 1]), math.nan, math.nan)[:2]
    return float(leave - touch) * speed / -float(run.rows[:, 1].min())


def measure() -> Case:
    """Depths, frequency, impact times."""
    case = Case(
        "Rest and impact",
        "A body of 1 kg sinks until k_v V equals its weight. With k_v = E/R, a layer as thick as "
        "the radius, a ball has F = pi E x^2 and a cylinder on its face pi E R x, the table of "
        "Drake's documentation (E = 1e7 Pa). An impact lasts c h/v, h the greatest depth: c = pi "
        "for a flat face, whose force is linear, 2.94328 for a lying cylinder, whose force grows "
        "with the power 3/2 like Hertz's, and 2.80436 for a shallow cap, quadratic in depth. "
        "Native contact takes its depth from the solver's parameters, whatever the material.",
    )
    soft = 1e7 / 0.05  # E/R
    case.figures += [
        Figure(
            "ball, k_v = 1e8 N/m^3",
            "m",
            DEPTH,
            1e-6,
            depth_at_rest("sphere", 1e8, case),
            depth_at_rest("sphere", 1e8, case, native=True),
        ),
        Figure(
            "radius of gyration of its patch",
            "m",
            math.sqrt(2.0 * CAP[1] / CAP[0]),
            1e-9,
            gyration_radius(),
            "a point, no patch",
        ),
        Figure(
            "2e8 and 5e8 N/m^3 in series",
            "N/m^3",
            1.428571e8,
            1e-6,
            vc.series_stiffness(2e8, 5e8),
            NO_STIFFNESS,
        ),
        Figure(
            "ball, k_v = 1e8 N/m^3: bounce frequency",
            "Hz",
            25.011,
            1e-4,
            bounce_frequency(case),
            bounce_frequency(case, native=True),
        ),
    ]
    for shape, expected, tolerance in (("sphere", 0.559e-3, 3e-3), ("cylinder", 6.2e-6, 1e-2)):
        name = "ball" if shape == "sphere" else shape
        depths = (depth_at_rest(shape, soft, case, native=native) for native in (False, True))
        case.figures.append(Figure(f"{name}, E = 1e7 Pa", "m", expected, tolerance, *depths))
    for name, shape, expected, tolerance in (
        ("a flat face", "box", math.pi, 1e-4),
        ("a lying cylinder", "lying cylinder", 2.94328, 2e-3),
        ("a ball", "sphere", 2.80436, 2e-3),
    ):
        constants = impact_constant(shape, case), impact_constant(shape, case, native=True)
        case.figures.append(Figure(f"impact of {name}: c", "-", expected, tolerance, *constants))
    return case


@pytest.mark.once
def test_static_and_impact() -> None:
    measure().check()
