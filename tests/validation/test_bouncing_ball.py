# SPDX-License-Identifier: Apache-2.0
"""A ball falls from 1 m and bounces with e = 0.8."""

from __future__ import annotations

import math

import mujoco
import numpy as np
from case import GRAVITY, Case, Curve, Figure, Plot, contact_of, load, start

from volcontact._mujoco_views import dense

RADIUS, HEIGHT, RESTITUTION = 0.05, 1.0, 0.8
BOUNCES = 12
# So hard that gravity does nothing during an impact, which lasts some 36 microseconds.
STIFFNESS = 1e15  # [N/m^3]
FLIGHT_STEP, CONTACT_STEP = 2e-4, 4e-7  # [s]
LONG = 0.01  # a contact of this length is rest [s]


def bounce(case: Case, *, native: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Launch speed after each impact [m/s], and the path: rows of time [s] and height [m]."""
    model = load("bouncing_ball/scene.xml", pair__ball__stiffness=STIFFNESS)
    data = start(model)
    launches: list[float] = []
    path: list[tuple[float, float]] = []
    touching, since = False, 0.0
    with contact_of(model, native=native) as contact:
        while len(launches) < BOUNCES and data.time < 5.0:
            gap, speed = data.qpos[2] - RADIUS, data.qvel[2]
            near = gap < 2.0 * FLIGHT_STEP * abs(speed) + 1e-5
            model.opt.timestep = CONTACT_STEP if near else FLIGHT_STEP
            if touching and gap > 0.0:  # speed at the instant of leaving
                launches.append(math.sqrt(speed**2 + 2.0 * GRAVITY * gap))
            if gap > 0.0:
                since = data.time
            touching = gap <= 0.0
            if data.time - since > LONG:
                break
            path.append((data.time, gap))
            mujoco.mj_step(model, data)
        if contact is not None:
            mujoco.mj_forward(model, data)
            energy = contact.energy(data)
            whole = float(dense(data.energy).sum()) + energy.elastic + energy.dissipated
            first = GRAVITY * (HEIGHT + RADIUS)
            case.closures.append(abs(whole - first) / (GRAVITY * HEIGHT))
            mechanical = float(dense(data.energy).sum()) - energy.work
            case.works.append(abs(mechanical - first) / (GRAVITY * HEIGHT))
    launches += [0.0] * (BOUNCES - len(launches))
    return np.array(launches), np.array(path)


def flight_time(launches: np.ndarray) -> float:
    """Time in the air until rest [s]: fall, flights seen, and a geometric rest of the last."""
    fall = math.sqrt(2.0 * HEIGHT / GRAVITY)
    ratio = launches[-1] / launches[-2] if launches[-2] > 0.0 else 0.0
    rest = launches[-1] * ratio / (1.0 - ratio)
    return fall + 2.0 / GRAVITY * (float(launches.sum()) + rest)


def measure() -> Case:
    """Speeds of the bounces, and the time until rest."""
    case = Case(
        "Bouncing ball",
        "A ball falls from 1 m and bounces with e = 0.8 at every speed. All bounces together last "
        "sqrt(2 h/g) (1 + e)/(1 - e) on a rigid floor: k_v = 1e15 N/m^3 here, since gravity acts "
        "during a softer impact and lowers the restitution.",
    )
    launches, path = bounce(case)
    native, native_path = bounce(case, native=True)
    impact = math.sqrt(2.0 * GRAVITY * HEIGHT)
    for n in (1, 2, 4, 8):
        speed = RESTITUTION**n * impact
        case.figures.append(
            Figure(f"speed after bounce {n}", "m/s", speed, 1e-3, launches[n - 1], native[n - 1])
        )
    times = flight_time(launches), flight_time(native)
    case.figures.append(Figure("time in the air", "s", 4.06371, 1e-3, *times))
    case.plots.append(
        Plot(
            "height",
            "time [s]",
            "height [m]",
            (
                Curve("volumetric", path[:, 0], path[:, 1]),
                Curve("native", native_path[:, 0], native_path[:, 1], "--"),
            ),
        )
    )
    return case


def test_bouncing_ball() -> None:
    measure().check()
