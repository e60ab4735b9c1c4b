# SPDX-License-Identifier: Apache-2.0
"""Forces of an elastically held peg on a chamfer and along a wall, after Whitney."""

from __future__ import annotations

import math

import mujoco
import numpy as np
from case import Case, Curve, Figure, Plot, Run, load, simulate

LATERAL, FRICTION = 1e3, 0.1  # stiffness of the holder K_x [N/m]; mu
SPEED, RADIUS = 0.05, 0.01  # of the insertion [m/s]; of the peg's tip [m]
HOLDER = 1e6  # [kg]
OFFSET = 5e-3  # of the peg from where its holder would have it, in the one-point phase [m]
SCENE = """
<mujoco>
  <option timestep="2e-5" integrator="RK4" gravity="0 0 0"/>
  <worldbody>
    <geom name="wall" type="plane" size="1 1 0.1" pos="{wall} 0 0" euler="0 {turn} 0"
      friction="{mu} 0 0"/>
    <body name="holder">
      <joint name="down" type="slide" axis="0 0 1"/>
      <inertial pos="0 0 0" mass="{holder!r}" diaginertia="1 1 1"/>
      <body name="peg">
        <joint name="aside" type="slide" axis="1 0 0" stiffness="{stiffness}"/>
        <geom name="tip" type="sphere" size="{radius}" mass="0.05" friction="{mu} 0 0"/>
      </body>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/tip/stiffness" data="1e14"/>
    <numeric name="volcontact/pair/tip/damping" data="100"/>
    <numeric name="volcontact/pair/tip/friction" data="{mu}"/>
    <numeric name="volcontact/pair/tip/slip_speed" data="1e-3"/>
    <tuple name="volcontact/pair/tip">
      <element objtype="geom" objname="tip"/><element objtype="geom" objname="wall"/>
    </tuple>
  </custom>
</mujoco>"""


def push(angle: float, offset: float, *, native: bool = False) -> Run:
    """Slides the tip along a plane at `angle` [degree] to the axis; insertion and its force.

    The tip starts on the plane, moving along it, with its holder's spring bent by `offset`.
    """
    text = SCENE.format(
        wall=offset - RADIUS / math.cos(math.radians(angle)),
        turn=90.0 - angle,
        mu=FRICTION,
        stiffness=LATERAL,
        radius=RADIUS,
        holder=HOLDER,
    )

    def move(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        data.qpos[1] = offset
        data.qvel[:] = -SPEED, SPEED * math.tan(math.radians(angle))

    # What the contact takes from the heavy holder's speed is the insertion force.
    def force(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float]:
        mujoco.mj_forward(model, data)
        return -data.qpos[0], float(data.qacc[0]) * HOLDER

    # The holder counts as outside: what it loses of its energy is its work on the peg.
    def holder(data: mujoco.MjData) -> tuple[float, float]:
        energy = 0.5 * HOLDER * float(data.qvel[0]) ** 2
        return 0.5 * HOLDER * SPEED**2 - energy, energy

    return simulate(load(text), 0.2, force, every=50, setup=move, native=native, outside=holder)


def slope(run: Run) -> float:
    """Insertion force per insertion, by least squares [N/m]."""
    way, force = run.rows[:, 1], run.rows[:, 2]
    return float(np.polyfit(way, force, 1)[0])


def measure() -> Case:
    """Chamfer and one-point contact."""
    case = Case(
        "Peg on a chamfer and at a wall",
        "A peg held by a lateral spring K_x is pushed down. On a chamfer at the angle a to the "
        "axis the insertion force grows as K_x z tan(a) tan(a + atan mu); where it touches the "
        "wall of the hole at one point, with its spring deflected by e, the force is mu K_x e. The "
        "holder is heavy enough to keep its speed; its work is part of the balance of energy.",
    )
    curves = []
    for angle in (45.0, 30.0):
        run, native = push(angle, 0.0), push(angle, 0.0, native=True)
        case.account(run)
        a = math.radians(angle)
        expected = LATERAL * math.tan(a) * math.tan(a + math.atan(FRICTION))
        case.figures.append(
            Figure(
                f"chamfer at {angle:g} degrees: force per insertion",
                "N/m",
                expected,
                1e-3,
                slope(run),
                slope(native),
            )
        )
        if angle == 45.0:
            curves += [
                Curve("volumetric", 1e3 * run.rows[:, 1], run.rows[:, 2]),
                Curve("closed form", 1e3 * run.rows[:, 1], expected * run.rows[:, 1], ":"),
                Curve("native", 1e3 * native.rows[:, 1], native.rows[:, 2], "--"),
            ]
    run, native = push(0.0, OFFSET), push(0.0, OFFSET, native=True)
    case.account(run)
    late = slice(len(run.rows) // 2, None)
    case.figures.append(
        Figure(
            "one point: force",
            "N",
            FRICTION * LATERAL * OFFSET,
            1e-3,
            float(run.rows[late, 2].mean()),
            float(native.rows[late, 2].mean()),
        )
    )
    case.plots.append(Plot("chamfer", "insertion [mm]", "insertion force [N]", tuple(curves)))
    return case


def test_peg() -> None:
    measure().check()
