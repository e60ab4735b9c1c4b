# SPDX-License-Identifier: Apache-2.0
"""A cube on its face: the stiffness of its patch against heave and tilt."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from case import GRAVITY, Case, Curve, Figure, Plot, Run, crossings, load, simulate

import volcontact as vc

HALF, STIFFNESS, MASS = 0.1, 1e7, 1.0
SINK = MASS * GRAVITY / (STIFFNESS * 4.0 * HALF**2)
SCENE = f"""
<mujoco>
  <option timestep="5e-5" integrator="RK4" gravity="0 0 -{GRAVITY}"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1" friction="0 0 0"/>
    <body pos="0 0 {HALF - SINK!r}"><freejoint/>
      <geom name="cube" type="box" size="{HALF} {HALF} {HALF}" mass="{MASS}" friction="0 0 0"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/cube/stiffness" data="{STIFFNESS}"/>
    <numeric name="volcontact/pair/cube/normal_law/volume_spring" data="1"/>
    <numeric name="volcontact/pair/cube/friction" data="0"/>
    <tuple name="volcontact/pair/cube">
      <element objtype="geom" objname="cube"/><element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>"""


def tilt_stiffness() -> float:
    """-d torque / d tilt about the middle of the sunken face [N m/rad], by central differences."""
    model = vc.ContactModel(
        pairs=[vc.Pair(vc.Box(half_sizes=(HALF, HALF, HALF)), vc.HalfSpace())],
        normal=vc.VolumeSpring(stiffness=STIFFNESS),
    )

    def torque(angle: float) -> float:
        c, s = math.cos(angle), math.sin(angle)
        pose = np.eye(4)
        pose[:3, :3] = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
        pivot = np.array([0.0, 0.0, -SINK])
        pose[:3, 3] = pivot + pose[:3, :3] @ np.array([0.0, 0.0, HALF])
        report = model.evaluate(X_WA=pose)
        arm = pose[:3, 3] - pivot
        return float((report.torque_on_A + np.cross(arm, report.force_on_A))[1])

    step = 1e-5
    return (torque(-step) - torque(step)) / (2.0 * step)


def native_tilt_ratio() -> float:
    """Stiffness against tilt over Winkler's, from that against heave, of MuJoCo's contact [-].

    The cube rests under a little more force, and under a little torque: its points are where its
    corners are, and not spread over the face.
    """
    rests = []
    for force, torque in ((0.0, 0.0), (0.1, 0.0), (0.0, 2e-3)):
        model = load(SCENE)

        def push(
            _: mujoco.MjModel, data: mujoco.MjData, force: float = force, torque: float = torque
        ) -> None:
            data.qfrc_applied[2], data.qfrc_applied[4] = -force, torque

        watch = lambda _, d: (d.qpos[2], 2.0 * d.qpos[5])  # noqa: E731
        run = simulate(model, 0.5, watch, every=100, setup=push, native=True)
        rests.append(run.rows[-1, 1:])
    heave = 0.1 / (rests[0][0] - rests[1][0])
    tilt = 2e-3 / abs(rests[2][1] - rests[0][1])
    return tilt / (heave * HALF**2 / 3.0)  # I/A of the square


def sink(*, native: bool = False) -> float:
    """How deep the cube sinks [m], seen half a second after it was let go, with damping."""
    text = SCENE.replace('normal_law/volume_spring" data="1"', 'damping" data="300"')
    model = load(text)
    run = simulate(model, 0.5, lambda _, d: (d.qpos[2],), every=100, native=native)
    return HALF - float(run.rows[-1, 1])


def vibration(coordinate: str, *, native: bool = False) -> tuple[float, Run]:
    """Frequency [Hz], and rows of time and deflection, of a free small vibration."""

    def disturb(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        if coordinate == "heave":
            data.qpos[2] += 2e-6
        else:
            data.qvel[4] = 4e-3

    def watch(_: mujoco.MjModel, data: mujoco.MjData) -> tuple[float]:
        return (data.qpos[2] - (HALF - SINK) if coordinate == "heave" else data.qpos[5],)

    run = simulate(load(SCENE), 0.3, watch, setup=disturb, native=native)
    zeros = crossings(run.rows[:, 0], run.rows[:, 1])
    frequency = 0.5 * (len(zeros) - 1) / (zeros[-1] - zeros[0]) if len(zeros) > 1 else math.nan
    return frequency, run


def measure() -> Case:
    """Stiffness, depth and frequencies."""
    case = Case(
        "Cube on its face",
        "The patch of a flat face is a Winkler foundation: k A against heave and k I against "
        "tilt, I the second moment of its area. The frequencies follow, less the tipping moment "
        "of the weight.",
    )
    winkler = STIFFNESS * (2.0 * HALF) ** 4 / 12.0
    case.figures.append(
        Figure(
            "tilt stiffness over Winkler's",
            "-",
            1.0,
            1e-6,
            tilt_stiffness() / winkler,
            native_tilt_ratio(),
        )
    )
    case.figures.append(Figure("sinks by", "m", SINK, 1e-6, sink(), sink(native=True)))
    for name, expected in (("heave", 100.658), ("rocking", 71.150)):
        frequency, run = vibration(name)
        native, native_run = vibration(name, native=True)
        case.account(run)
        case.figures.append(Figure(name, "Hz", expected, 1e-3, frequency, native))
    early, native_early = (r.rows[r.rows[:, 0] < 0.06] for r in (run, native_run))
    case.plots.append(
        Plot(
            "rocking",
            "time [s]",
            "tilt [microrad]",
            (
                Curve("volumetric", early[:, 0], 2e6 * early[:, 1]),
                Curve("native", native_early[:, 0], 2e6 * native_early[:, 1], "--"),
            ),
        )
    )
    return case


@pytest.mark.once
def test_flat_patch() -> None:
    measure().check()
