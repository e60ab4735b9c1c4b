# SPDX-License-Identifier: Apache-2.0
"""A ball is thrown sliding and ends rolling."""

from __future__ import annotations

import mujoco
import numpy as np
from case import GRAVITY, Case, Curve, Figure, Plot, depth_of_ball, load, simulate

MASS, RADIUS, STIFFNESS, FRICTION, SPEED = 1.0, 0.05, 1e12, 0.3, 7.0
SCENE = f"""
<mujoco>
  <option timestep="5e-5" integrator="RK4" gravity="0 0 -{GRAVITY}"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 1 0.1" friction="{FRICTION} 0.005 0.0001"/>
    <body pos="0 0 {RADIUS - depth_of_ball(MASS * GRAVITY, RADIUS, STIFFNESS)!r}"><freejoint/>
      <geom name="ball" size="{RADIUS}" mass="{MASS}" friction="{FRICTION} 0.005 0.0001"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/ball/stiffness" data="{STIFFNESS}"/>
    <numeric name="volcontact/pair/ball/damping" data="0"/>
    <numeric name="volcontact/pair/ball/friction" data="{FRICTION}"/>
    <numeric name="volcontact/pair/ball/slip_speed" data="5e-3"/>
    <tuple name="volcontact/pair/ball">
      <element objtype="geom" objname="ball"/><element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>"""


def end_of_slip(rows: np.ndarray) -> float:
    """When the slip, which falls by 7/2 mu g, reaches zero [s]: from where 1 % of it is left."""
    i = int(np.argmax(rows[:, 2] < 0.01 * SPEED))
    return float(rows[i, 0] + rows[i, 2] / (3.5 * FRICTION * GRAVITY))


def measure() -> Case:
    """Time and speed at which the ball begins to roll."""
    case = Case(
        "From sliding to rolling",
        "A ball is thrown at 7 m/s without spin. Friction slows it down and spins it up until it "
        "rolls, at 2 v0/(7 mu g) with 5/7 v0 in the limit of a hard floor.",
    )

    def throw(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        data.qvel[0] = SPEED

    def watch(_: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float]:
        return data.qvel[0], data.qvel[0] - RADIUS * data.qvel[4]

    run = simulate(load(SCENE), 0.8, watch, every=10, setup=throw)
    native = simulate(load(SCENE), 0.8, watch, every=10, setup=throw, native=True)
    case.account(run)
    case.figures += [
        Figure("begins to roll", "s", 0.67958, 1e-3, *map(end_of_slip, (run.rows, native.rows))),
        Figure("speed when rolling", "m/s", 5.0, 1e-3, run.rows[-1, 1], native.rows[-1, 1]),
    ]
    case.plots.append(
        Plot(
            "speed",
            "time [s]",
            "speed and slip [m/s]",
            (
                Curve("speed", run.rows[:, 0], run.rows[:, 1]),
                Curve("slip", run.rows[:, 0], run.rows[:, 2]),
                Curve("speed, native", native.rows[:, 0], native.rows[:, 1], "--"),
            ),
        )
    )
    return case


def test_slide_to_roll() -> None:
    measure().check()
