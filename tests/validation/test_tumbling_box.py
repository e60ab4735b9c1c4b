# SPDX-License-Identifier: Apache-2.0
"""A box tumbles on a floor without friction or damping: energy stays."""

from __future__ import annotations

import math

import numpy as np
import pytest
from case import RUNGE_KUTTA_IS_FOURTH, Bounds, Case, Curve, Plot, Run, load, simulate

from volcontact._mujoco_views import dense

# The order in which energy errs when a body turns under a torque of its pose, and the most it errs
# by, of the energy, at each step.
ORDER = (3.3, 5.0) if RUNGE_KUTTA_IS_FOURTH else (1.8, 3.0)
ERRORS = (1e-8, 1e-9, 1e-10) if RUNGE_KUTTA_IS_FOURTH else (1e-6, 1e-6, 1e-6)


def tumble(step: float) -> Run:
    """Rows of time and height."""
    model = load("tumbling_box/scene.xml")
    model.opt.timestep = step
    return simulate(model, 3.0, lambda _, d: (d.qpos[2],), every=round(1e-3 / step))


def measure() -> Case:
    """Three seconds at three time steps, under Runge-Kutta."""
    case = Case(
        "Tumbling box",
        "A box falls on its corners for 3 s without friction or damping. The force k_v V at the "
        "centroid of the volume is conservative against a plane, so any loss or gain is the error "
        "of the integrator, here fourth-order Runge-Kutta. On MuJoCo 2.2.2 that method is of "
        "second order for a rotating body, with any force.",
    )
    errors, curves = [], []
    for step in (2e-4, 1e-4, 5e-5):
        run = tumble(step)
        errors.append(run.closure)
        if step == 1e-4:
            case.account(run)
            curves.append(Curve("volumetric", run.rows[:, 0], run.rows[:, 1]))
    drifts = []
    for step, error, most in zip((2e-4, 1e-4, 5e-5), errors, ERRORS, strict=True):
        native_model = load("tumbling_box/scene.xml")
        native_model.opt.timestep = step
        native = simulate(
            native_model,
            3.0,
            lambda _, d: (d.qpos[2], *dense(d.energy)),
            every=round(1e-3 / step),
            native=True,
        )
        sums = native.rows[:, 2] + native.rows[:, 3]
        drifts.append(float(np.abs(sums / sums[0] - 1.0).max()))
        name = f"error of energy, step {step:g} s"
        case.figures.append(Bounds(name, "-", 0.0, most, error, drifts[-1]))
        if step == 1e-4:
            curves.append(Curve("native", native.rows[:, 0], native.rows[:, 1], "--"))
    orders = (0.5 * math.log2(of[0] / of[2]) for of in (errors, drifts))
    case.figures.append(Bounds("order of the error", "-", *ORDER, *orders))
    case.plots.append(Plot("height", "time [s]", "height of the centre [m]", tuple(curves)))
    return case


@pytest.mark.once
def test_tumbling_box() -> None:
    measure().check()
