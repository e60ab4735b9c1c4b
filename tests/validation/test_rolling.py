# SPDX-License-Identifier: Apache-2.0
"""Rolling resistance of a ball: the rate at which it slows down."""

from __future__ import annotations

import math

import mujoco
import numpy as np
from case import GRAVITY, Case, Curve, Figure, Plot, depth_of_ball, load, simulate

import volcontact as vc

MASS, RADIUS, STIFFNESS, DAMPING = 1.0, 0.05, 1e8, 0.5
DEPTH = depth_of_ball(MASS * GRAVITY, RADIUS, STIFFNESS)
NO_PATCH = "a point, no patch"
SCENE = f"""
<mujoco>
  <option timestep="1e-4" integrator="RK4" gravity="0 0 -{GRAVITY}"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 1 0.1" friction="0.3 0.005 0.0001"/>
    <body pos="0 0 {RADIUS - DEPTH!r}"><freejoint/>
      <geom name="ball" size="{RADIUS}" mass="{MASS}" friction="0.3 0.005 0.0001"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/ball/stiffness" data="{STIFFNESS}"/>
    <numeric name="volcontact/pair/ball/damping" data="{DAMPING}"/>
    <numeric name="volcontact/pair/ball/friction_law/bristle" data="1"/>
    <numeric name="volcontact/pair/ball/friction" data="0.3"/>
    <numeric name="volcontact/pair/ball/bristle_damping" data="100"/>
    <tuple name="volcontact/pair/ball">
      <element objtype="geom" objname="ball"/><element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>"""


def rate(rows: np.ndarray) -> float:
    """Decay of the angular velocity after the first half second [1/s]."""
    late = rows[rows[:, 0] > 0.5]
    return float(-math.log(late[-1, 1] / late[0, 1]) / (late[-1, 0] - late[0, 0]))


def measure() -> Case:
    """The decay of a ball that rolls at 1 m/s."""
    case = Case(
        "Rolling resistance",
        "A ball rolls without slipping on a damped floor: (I + m r^2) dw/dt = -k a X2 w, with X2 "
        "the second moment of its cap and r the height of the centre over the centroid of the "
        "volume, where friction acts.",
    )
    arm = 3.0 * (2.0 * RADIUS - DEPTH) ** 2 / (4.0 * (3.0 * RADIUS - DEPTH))

    def roll(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        data.qvel[0], data.qvel[4] = 1.0, 1.0 / arm

    watch = lambda _, data: (data.qvel[4],)  # noqa: E731
    run = simulate(load(SCENE), 3.0, watch, every=100, setup=roll)
    native = simulate(load(SCENE), 3.0, watch, every=100, setup=roll, native=True)
    case.account(run)
    # k a X2 w, X2 the second moment of the cap, at 1 m/s and the arm.
    cap = math.pi * DEPTH**3 * (20.0 * RADIUS**2 - 15.0 * RADIUS * DEPTH + 3.0 * DEPTH**2) / 60.0
    model = vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(radius=RADIUS), vc.HalfSpace())],
        normal=vc.HuntCrossley(stiffness=STIFFNESS, damping=DAMPING),
    )
    pose = np.eye(4)
    pose[2, 3] = RADIUS - DEPTH
    report = model.evaluate(X_WA=pose, V_WA=np.array([0.0, 1.0 / RADIUS, 0.0, 1.0, 0.0, 0.0]))
    torque = -float(report.torque_on_A[1])
    case.figures += [
        Figure("torque at 1 m/s", "N m", 1.28696e-3, 1e-5, torque, "none with condim 3"),
        Figure("second moment of the cap", "m^5", cap, 1e-9, torque * RADIUS / 5e7, NO_PATCH),
        Figure("decay", "1/s", 0.018665, 1e-3, rate(run.rows), rate(native.rows)),
        Figure("arm of the friction", "m", 0.04947, 1e-4, arm, NO_PATCH),
    ]
    time = run.rows[:, 0]
    exact = run.rows[0, 1] * np.exp(-0.018665 * time)
    case.plots.append(
        Plot(
            "spin",
            "time [s]",
            "angular velocity [rad/s]",
            (
                Curve("volumetric", time, run.rows[:, 1]),
                Curve("closed form", time, exact, ":"),
                Curve("native", native.rows[:, 0], native.rows[:, 1], "--"),
            ),
        )
    )
    return case


def test_rolling() -> None:
    measure().check()
