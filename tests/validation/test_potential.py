# SPDX-License-Identifier: Apache-2.0
"""The potential formulation: boxes on boxes, edge on corner, keep their energy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from case import NO_FIELD, RUNGE_KUTTA_IS_FOURTH, Bounds, Case, Curve, Plot, load, simulate

import volcontact as vc
from volcontact._mujoco_views import dense

STIFFNESS, SAMPLES = 2e6, 4000
# Errors of energy on the grate, of a box and of a cylinder.
KEPT, ROUND_KEPT = (1e-7, 1e-6) if RUNGE_KUTTA_IS_FOURTH else (1e-5, 1e-5)
BARS = "".join(
    f'<geom name="bar{i}" type="box" size="0.5 0.03 0.03" pos="0 {y} 0" euler="45 0 0"/>'
    for i, y in enumerate((-0.24, -0.08, 0.08, 0.24))
)
WALLS = "".join(
    f'<geom name="wall{i}" type="box" size="{size}" pos="{pos}"/>'
    for i, (size, pos) in enumerate(
        (
            ("0.02 0.4 0.4", "0.2 0 0.2"),
            ("0.02 0.4 0.4", "-0.2 0 0.2"),
            ("0.4 0.02 0.4", "0 0.2 0.2"),
            ("0.4 0.02 0.4", "0 -0.2 0.2"),
        )
    )
)
GRATE = f"""
<mujoco model="grate">
  <option timestep="1e-4" integrator="RK4" gravity="0 0 -9.81"><flag energy="enable"/></option>
  <worldbody>
    {BARS}{WALLS}
    <body name="box">
      <freejoint/>
      <geom name="box" type="box" size="0.1 0.08 0.05" mass="1"/>
    </body>
  </worldbody>
  <keyframe>
    <key name="start" qpos="0 0 0.2 0.936293363584 0.289629477626 0.189796060979 0.0587108016938"
      qvel="0 0 0 1 2 3"/>
  </keyframe>
  <custom>
    <numeric name="volcontact/option/formulation/FORMULATION" data="1"/>
    <numeric name="volcontact/pair/box/stiffness" data="{STIFFNESS}"/>
    <numeric name="volcontact/pair/box/normal_law/volume_spring" data="1"/>
    <numeric name="volcontact/pair/box/friction" data="0"/>
    <tuple name="volcontact/pair/box">
      <element objtype="body" objname="box"/>
      <element objtype="body" objname="world"/>
    </tuple>
  </custom>
</mujoco>
"""


def turned(x: float, y: float) -> np.ndarray:
    """Rotation about x, then about y."""
    c, s = math.cos(y), math.sin(y)
    about_y = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    c, s = math.cos(x), math.sin(x)
    return about_y @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


# The same with a cylinder in the place of the box, from nearer by.
ROUND = GRATE.replace(
    'type="box" size="0.1 0.08 0.05" mass', 'type="cylinder" size="0.09 0.06" mass'
)
ROUND = ROUND.replace('qpos="0 0 0.2', 'qpos="0 0 0.15').replace("1e-4", "4e-4")


def loop_work(
    formulation: str, solid: object = vc.Box(half_sizes=(0.1, 0.08, 0.05)), samples: int = SAMPLES
) -> float:
    """Work of the contact on a solid led round a box's corner, over the largest energy."""
    model = vc.ContactModel(
        pairs=[vc.Pair(solid, vc.Box(half_sizes=(0.1, 0.1, 0.1)))],
        normal=vc.VolumeSpring(stiffness=STIFFNESS),
        formulation=formulation,
        share_of_a=0.3,
    )
    work, stored = 0.0, 0.0
    pose = np.eye(4)
    for i in range(samples):
        s = 2.0 * math.pi * i / samples
        pose[:3, :3] = turned(0.3, 0.35 + 0.12 * math.sin(s))
        pose[:3, 3] = 0.17 + 0.01 * math.cos(s), 0.14, 0.12 + 0.01 * math.sin(2.0 * s)
        velocity = np.array([-0.01 * math.sin(s), 0.0, 0.02 * math.cos(2.0 * s)])
        report = model.evaluate(X_WA=pose)
        power = report.force_on_A @ velocity + report.torque_on_A[1] * 0.12 * math.cos(s)
        work += 2.0 * math.pi / samples * power
        stored = max(stored, report.elastic_energy)
    return abs(work) / stored


def native_drift(text: str, duration: float) -> float:
    """Largest relative change of energy under MuJoCo's contact.

    It counts no elastic energy, and dissipates by default.
    """
    model = load(text.replace("FORMULATION", "gonthier"))
    watch = lambda _, d: (float(dense(d.energy).sum()),)  # noqa: E731
    rows = simulate(model, duration, watch, every=10, native=True).rows
    return float(np.abs(rows[:, 1] / rows[0, 1] - 1.0).max())


def measure() -> Case:
    """A closed loop and three seconds of tumbling, under both formulations."""
    case = Case(
        "Boxes on boxes",
        "A box is moved around the corner of another one, and falls on a grate of bars with their "
        "edges up, between walls, without friction or damping. The formulation potential, a wrench "
        "that is the gradient of int min(p_A, p_B) dV, is conservative there; k_v V along the area "
        "vector, the formulation gonthier, is not. For round solids the energy is a sum over eight "
        "levels whose gradient is as exact as the metrics of lines; a cylinder falls on the grate "
        "as well.",
    )
    case.figures += [
        Bounds(
            "loop, potential: work over energy", "-", 0.0, 1e-11, loop_work("potential"), NO_FIELD
        ),
        Bounds("loop, gonthier: the same", "-", 1e-3, 1.0, loop_work("gonthier"), NO_FIELD),
    ]
    for name, solid, most in (
        ("ball", vc.Sphere(radius=0.08), 1e-7),
        ("frustum", vc.Frustum(bottom_radius=0.09, top_radius=0.05, half_length=0.06), 1e-6),
        ("cylinder", vc.Cylinder(radius=0.08, half_length=0.06), 5e-5),
        ("torus", vc.Torus(major_radius=0.07, minor_radius=0.03), 2e-6),
    ):
        # With fewer samples some sums are small by chance.
        work = loop_work("potential", solid, 2000)
        case.figures.append(Bounds(f"loop, potential: {name}", "-", 0.0, most, work, NO_FIELD))
    drift = native_drift(GRATE, 3.0)
    curves = []
    for formulation, low, high in (("potential", 0.0, KEPT), ("gonthier", 1e-4, 1.0)):
        model = load(GRATE.replace("FORMULATION", formulation))
        run = simulate(model, 3.0, lambda _, d: (d.qpos[2], d.ncon), every=10)
        case.figures.append(
            Bounds(f"grate, {formulation}: error of energy", "-", low, high, run.closure, drift)
        )
        if formulation == "potential":
            case.account(run)
        curves.append(Curve(formulation, run.rows[:, 0], run.unaccounted))
    fall = simulate(load(ROUND.replace("FORMULATION", "potential")), 0.25, lambda *_: (), every=10)
    case.account(fall)
    error = fall.closure, native_drift(ROUND, 0.25)
    case.figures.append(
        Bounds("cylinder on the grate: error of energy", "-", 0.0, ROUND_KEPT, *error)
    )
    case.plots.append(
        Plot("energy", "time [s]", "energy unaccounted for, of that turned over [-]", tuple(curves))
    )
    return case


@pytest.mark.once
def test_potential() -> None:
    measure().check()
