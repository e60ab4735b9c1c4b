# SPDX-License-Identifier: Apache-2.0
"""A thin disc rolls on its edge: steady precession."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from case import GRAVITY, Bounds, Case, Curve, Figure, Plot, Run, load, simulate, start

from volcontact._mujoco_views import dense

RADIUS, TILT = 0.0375, 0.1


def roll(*, native: bool = False) -> Run:
    """Half a second; rows of time, heading of the axis [rad], tilt [rad]."""

    def watch(_: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float]:
        axis = data.xmat[1].reshape(3, 3)[:, 2]
        return math.atan2(axis[1], axis[0]), math.acos(min(1.0, axis[2]))

    return simulate(load("euler_disc/scene.xml"), 0.5, watch, every=20, native=native)


def rate(rows: np.ndarray) -> float:
    """Of the precession [rad/s]."""
    turned = np.unwrap(rows[:, 1])
    return float((turned[-1] - turned[0]) / (rows[-1, 0] - rows[0, 0]))


def measure() -> Case:
    """Rate of precession, and how steady it is."""
    case = Case(
        "Euler's disc",
        "A thin disc that rolls on its edge with its centre at rest precesses at W^2 = 4 g/(R sin "
        "a), with a the tilt. The disc here is 0.4 mm thick and starts without the deflections of "
        "its steady state, so it nods a little.",
    )
    run, native = roll(), roll(native=True)
    case.account(run)
    model = load("euler_disc/scene.xml")
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    data = start(model)
    mujoco.mj_forward(model, data)
    mass, thickness = float(model.body_mass[1]), float(model.geom_size[model.ngeom - 1][1])
    energy = float(dense(data.energy).sum()) - mass * GRAVITY * thickness  # over that at rest, flat
    ratio = energy / (mass * GRAVITY * RADIUS * math.sin(TILT))  # before there is any contact
    case.figures += [
        Figure("energy at the start over m g R sin a", "-", 1.5, 1e-2, ratio, ratio),
        Figure("precession", "rad/s", 102.38, 1e-2, rate(run.rows), rate(native.rows)),
        Bounds("least tilt", "rad", 0.095, TILT, run.rows[:, 2].min(), native.rows[:, 2].min()),
        Bounds("largest tilt", "rad", TILT, 0.105, run.rows[:, 2].max(), native.rows[:, 2].max()),
    ]
    case.plots.append(
        Plot(
            "tilt",
            "time [s]",
            "tilt [rad]",
            (
                Curve("volumetric", run.rows[:, 0], run.rows[:, 2]),
                Curve("native", native.rows[:, 0], native.rows[:, 2], "--"),
            ),
        )
    )
    return case


@pytest.mark.once
def test_euler_disc() -> None:
    measure().check()
