# SPDX-License-Identifier: Apache-2.0
"""The stiffest contact that an explicit step of 2 ms bears."""

from __future__ import annotations

import numpy as np
from case import Case, Figure, load, simulate

import volcontact as vc

HALF, MASS, STEP, GRAVITY = 0.1, 1.0, 2e-3, 9.81
STEPS = 2000
NATIVE = f"""
<mujoco>
  <option timestep="{STEP}" gravity="0 0 -{GRAVITY}"/>
  <worldbody>
    <geom type="plane" size="1 1 0.1"/>
    <body pos="0 0 {HALF}"><freejoint/>
      <geom type="box" size="{HALF} {HALF} {HALF}" mass="{MASS}"/></body>
  </worldbody>
</mujoco>"""


def grows(ratio: float) -> bool:
    """Whether a cube leaves its rest on a patch of K h^2/m = ratio, under semi-implicit Euler."""
    stiffness = ratio * MASS / STEP**2 / (4.0 * HALF**2)  # K = k_v A
    model = vc.ContactModel(
        pairs=[vc.Pair(vc.Box(half_sizes=(HALF, HALF, HALF)), vc.HalfSpace())],
        normal=vc.VolumeSpring(stiffness=stiffness),
    )
    sink = MASS * GRAVITY / (stiffness * 4.0 * HALF**2)
    pose = np.eye(4)
    height, speed, start = HALF - 1.001 * sink, 0.0, 1e-3 * sink
    for _ in range(STEPS):
        pose[2, 3] = height
        speed += STEP * (float(model.evaluate(X_WA=pose).force_on_A[2]) / MASS - GRAVITY)
        height += STEP * speed
        if abs(height - HALF + sink) > 100.0 * start:
            return True
    return False


def measure() -> Case:
    """The limit by bisection."""
    case = Case(
        "Stiff contact at 2 ms",
        "An explicitly integrated force, as every contact force is without implicit treatment, is "
        "stable for K h^2/m < 4, with K = k_v A the stiffness of the patch. The table is for a "
        "cube of 1 kg on its face. Stiffer contact needs a shorter step, or one that is linearly "
        "implicit in the contact forces. Native contact rests at any time step, on the stiffness "
        "of its solver, which depends on the step: the depth is in the table.",
    )
    low, high = 1.0, 8.0
    for _ in range(12):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if grows(middle) else (middle, high)
    run = simulate(load(NATIVE), 2.0, lambda _, d: (d.qpos[2],), every=100, native=True)
    depth = HALF - float(run.rows[-1, 1])
    case.figures.append(
        Figure(
            "largest K h^2/m at rest",
            "-",
            4.0,
            1e-2,
            low,
            f"at rest, {1e6 * depth:.3g} um deep",
        )
    )
    return case


def test_stiff_contact() -> None:
    measure().check()
