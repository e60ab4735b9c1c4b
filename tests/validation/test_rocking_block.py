# SPDX-License-Identifier: Apache-2.0
"""A block rocks on its edges after Housner."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from case import GRAVITY, Bounds, Case, Curve, Figure, Plot, Run, crossings, load, simulate

HALF_WIDTH, HALF_HEIGHT, HALF_LENGTH, FOOT = 0.1, 0.2, 0.1, 0.004
SLENDERNESS = math.atan2(HALF_WIDTH, HALF_HEIGHT)  # alpha [rad]
START = 0.2 * SLENDERNESS  # tilt at which it is let go [rad]
# 4 int d tilt / (tilt rate) of I tilt'' = -m g R sin(alpha - tilt), by quadrature: 1.3 % more than
# Housner's 0.483351 s, which has alpha - tilt in place of the sine.
PERIOD = 0.489449986
# Housner: the angular momentum about the new edge stays, all of the impulse acting there.
RATE_RATIO = 1.0 - 1.5 * math.sin(SLENDERNESS) ** 2
FLAT = f'<geom type="box" size="{HALF_WIDTH} {HALF_LENGTH} {HALF_HEIGHT}" {{friction}}/>'
FEET = "".join(
    f'<geom type="box" size="{FOOT} {HALF_LENGTH} {FOOT}" pos="{x} 0 {FOOT - HALF_HEIGHT}" '
    "{friction}/>"
    for x in (FOOT - HALF_WIDTH, HALF_WIDTH - FOOT)
)


def scene(base: str, stiffness: float, damping: float, step: float) -> str:
    """A block of 1 kg that moves in a plane, without gliding."""
    inertia = (HALF_WIDTH**2 + HALF_HEIGHT**2) / 3.0
    return f"""
<mujoco>
  <option timestep="{step!r}" integrator="RK4" gravity="0 0 -{GRAVITY}"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1" friction="1 0 0"/>
    <body name="block" pos="0 0 {HALF_HEIGHT}">
      <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
      <joint type="hinge" axis="0 1 0"/>
      <inertial pos="0 0 0" mass="1" diaginertia="{inertia} {inertia} {inertia}"/>
      {base.format(friction='friction="1 0 0"')}
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/block/stiffness" data="{stiffness}"/>
    <numeric name="volcontact/pair/block/damping" data="{damping}"/>
    <numeric name="volcontact/pair/block/friction" data="1"/>
    <numeric name="volcontact/pair/block/friction_law/bristle" data="1"/>
    <numeric name="volcontact/pair/block/bristle_stiffness" data="1e6"/>
    <numeric name="volcontact/pair/block/bristle_damping" data="2000"/>
    <numeric name="volcontact/pair/block/stribeck_speed" data="1"/>
    <tuple name="volcontact/pair/block">
      <element objtype="body" objname="block"/><element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>"""


def rock(
    base: str,
    stiffness: float,
    damping: float,
    step: float,
    duration: float,
    *,
    native: bool = False,
) -> Run:
    """Lets the block go on its edge, which is sunk by what carries the weight."""

    def tilt(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        # The wedge of depth d under a tilt: V = d^2 L / (2 sin cos), L the length of the edge.
        volume_per_square = HALF_LENGTH / (math.sin(START) * math.cos(START))
        sunk = 0.0 if native else math.sqrt(GRAVITY / (stiffness * volume_per_square))
        height = HALF_HEIGHT * math.cos(START) + HALF_WIDTH * math.sin(START)
        data.qpos[1:] = height - HALF_HEIGHT - sunk, START

    watch = lambda _, data: (data.qpos[2],)  # noqa: E731
    model = load(scene(base, stiffness, damping, step))
    return simulate(model, duration, watch, every=10, setup=tilt, native=native)


def period(run: Run) -> float:
    """Four times the way to the first upright pose [s]."""
    return 4.0 * float(crossings(run.rows[:, 0], run.rows[:, 1])[0])


def rate_ratio(run: Run) -> float:
    """Rate after over rate before the first impact, by the heights of fall and rise [-]."""
    after = -float(run.rows[:, 1].min())
    energy = lambda tilt: math.cos(SLENDERNESS - tilt) - math.cos(SLENDERNESS)  # noqa: E731
    return math.sqrt(energy(after) / energy(START))


def measure() -> Case:
    """Period of the first swing, loss of the first impact."""
    case = Case(
        "Rocking block",
        "A block of 0.2 x 0.4 m rocks on its edges, released at a fifth of the tilt at which it "
        "would fall over. Housner's period, 0.483351 s, is for small angles; the expected value is "
        "that of the full equation, 0.489450 s. His loss, an angular rate of 0.7 times that before "
        "the impact, is for a block that hits the floor only with its new edge. A block on two "
        "narrow feet comes close to that: the impulse acts in the middle of the foot. With a flat "
        "base the pressure travels across the elastic bed from the old edge to the new one, and "
        "the block keeps more.",
    )
    fall = rock(FLAT, 1e10, 10.0, 2.5e-6, 0.1235)
    native = rock(FLAT, 1e10, 10.0, 1e-4, 0.62, native=True)
    feet = rock(FEET, 1e9, 10.0, 5e-6, 0.62)
    native_feet = rock(FEET, 1e9, 10.0, 1e-4, 0.62, native=True)
    flat = rock(FLAT, 1e9, 10.0, 5e-6, 0.62)
    case.account(fall, feet, flat)
    case.figures += [
        Figure("period", "s", PERIOD, 1e-3, period(fall), period(native)),
        Figure(
            "two feet: rate after over before",
            "-",
            RATE_RATIO,
            0.05,
            rate_ratio(feet),
            rate_ratio(native_feet),
        ),
        Bounds(
            "flat base: rate after over before",
            "-",
            RATE_RATIO,
            1.0,
            rate_ratio(flat),
            rate_ratio(native),
        ),
    ]
    case.plots.append(
        Plot(
            "tilt",
            "time [s]",
            "tilt [rad]",
            (
                Curve("flat base", flat.rows[:, 0], flat.rows[:, 1]),
                Curve("two feet", feet.rows[:, 0], feet.rows[:, 1]),
                Curve("native, flat base", native.rows[:, 0], native.rows[:, 1], "--"),
            ),
            (("Housner", 0.25 * PERIOD),),
        )
    )
    return case


def test_period_is_that_of_the_equation() -> None:
    # u^2 = START - tilt takes the root at the start away; Gauss's rule does the rest.
    nodes, weights = np.polynomial.legendre.leggauss(40)
    reach = math.sqrt(START)
    u = 0.5 * reach * (nodes + 1.0)
    square = 3.0 * GRAVITY / (4.0 * math.hypot(HALF_WIDTH, HALF_HEIGHT))  # m g R / I
    top = math.cos(SLENDERNESS - START)
    rate = np.sqrt(2.0 * square * (top - np.cos(SLENDERNESS - START + u**2)))
    total = 4.0 * float(np.sum(0.5 * reach * weights * 2.0 * u / rate))
    assert abs(total - PERIOD) < 1e-8


@pytest.mark.once
def test_rocking_block() -> None:
    measure().check()
