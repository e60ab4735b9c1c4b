# SPDX-License-Identifier: Apache-2.0
"""The rod of Painleve: where rigid bodies have no solution, elastic ones jam."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from case import Bounds, Case, Curve, Figure, Plot, Run, load, simulate

import volcontact as vc

WEIGHT = 10.0  # m g [N]


def slide(friction: float, *, native: bool = False) -> Run:
    """Rows of time, height, speed and energy of motion."""
    model = load("painleve_rod/scene.xml", pair__rod__friction=friction)

    def watch(_: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float, float]:
        return data.qpos[2], data.qvel[0], data.qvel[4]

    return simulate(model, 0.3, watch, every=5, native=native)


def native_forces(friction: float) -> tuple[np.ndarray, np.ndarray]:
    """Normal force [N] and slip [m/s] (nan apart) of the same run under MuJoCo's own contact."""
    model = load("painleve_rod/scene.xml")
    model.geom_friction[:, 0] = friction
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    forces, slip, force = [], [], np.zeros(6)
    lower = np.array([0.0, 0.0, -1.0])
    for _ in range(round(0.3 / model.opt.timestep / 5)):
        mujoco.mj_step(model, data, 5)
        total = 0.0
        for contact in range(data.ncon):
            mujoco.mj_contactForce(model, data, contact, force)
            total += float(force[0])
        forces.append(total)
        end = data.xmat[1].reshape(3, 3) @ lower  # the rod's end from its middle
        slip.append(data.qvel[0] + data.qvel[4] * end[2] if data.ncon else math.nan)
    return np.array(forces), np.abs(np.array(slip))


def forces(friction: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time [s], normal force [N] and slip [m/s] (nan apart) of the same run."""
    model = load("painleve_rod/scene.xml", pair__rod__friction=friction)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    time, force, slip = [], [], []
    with vc.attach(model) as contact:
        for _ in range(round(0.3 / model.opt.timestep / 5)):
            mujoco.mj_step(model, data, 5)
            mujoco.mj_forward(model, data)
            sites = contact.sites(data)
            time.append(data.time)
            force.append(float(sites["normal_force"].sum()))
            slip.append(float(sites["slip"][0]) if len(sites) else math.nan)
    return np.array(time), np.array(force), np.array(slip)


def measure() -> Case:
    """Peak of the force with and without the paradox."""
    case = Case(
        "Painleve's rod",
        "A rod of half length 1 m slides on its lower end, leaning against its motion. For mu > "
        "4/3 there are poses in which no force can keep a rigid rod from penetrating the floor: "
        "friction tips it into the floor faster than the normal force lifts it. An elastic contact "
        "passes through: the force grows within milliseconds until the end sticks, a tangential "
        "impact.",
    )
    run, calm = slide(5.0 / 3.0), slide(1.0)
    case.account(run, calm)
    time, force, slip = forces(5.0 / 3.0)
    _, calm_force, _ = forces(1.0)
    own_force, own_slip = native_forces(5.0 / 3.0)
    own_calm, _ = native_forces(1.0)
    own_run = slide(5.0 / 3.0, native=True)
    own_peak = int(np.argmax(own_force))
    peak = int(np.argmax(force))
    before = slip[max(0, peak - 400) : peak]
    case.figures += [
        Bounds(
            "peak of the force over the weight, mu = 5/3",
            "-",
            15.0,
            50.0,
            force[peak] / WEIGHT,
            own_force[own_peak] / WEIGHT,
        ),
        Bounds(
            "the same, mu = 1",
            "-",
            1.0,
            6.0,
            calm_force.max() / WEIGHT,
            own_calm.max() / WEIGHT,
        ),
        Bounds(
            "slip 20 ms before the peak",
            "m/s",
            0.1,
            5.0,
            float(np.nanmax(before)),
            float(np.nanmax(own_slip[max(0, own_peak - 400) : own_peak + 1])),
        ),
        Bounds(
            "slip within 2 ms of the peak",
            "m/s",
            0.0,
            1e-3,
            float(np.nanmin(slip[peak - 40 : peak + 40])),
            float(np.nanmin(own_slip[max(0, own_peak - 40) : own_peak + 40])),
        ),
        Figure(
            "numbers that are not finite",
            "-",
            0.0,
            0.0,
            *(float(np.sum(~np.isfinite(r.rows))) for r in (run, own_run)),
        ),
    ]
    case.plots.append(
        Plot(
            "force",
            "time [s]",
            "normal force over the weight [-]",
            (
                Curve("mu = 5/3", time, force / WEIGHT),
                Curve("mu = 1", time, calm_force / WEIGHT, ":"),
            ),
        )
    )
    return case


@pytest.mark.once
def test_painleve_rod() -> None:
    measure().check()
