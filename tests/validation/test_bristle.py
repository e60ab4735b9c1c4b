# SPDX-License-Identifier: Apache-2.0
"""Bristle friction under ramps and vibration: breakaway, growth of stiction, drift."""

from __future__ import annotations

import math
from collections.abc import Callable

import mujoco
import numpy as np
import pytest
from case import GRAVITY, Case, Curve, Figure, Plot, Run, load, simulate

MASS, KINETIC, STATIC, DWELL = 1.0, 0.3, 0.4, 0.5
HELD = 4  # steps with one load
# A flat plate of 1 kg, its centre of mass in the plane of contact: a block on a line.
SCENE = f"""
<mujoco>
  <option timestep="5e-5" integrator="RK4" gravity="0 0 -{GRAVITY}"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 1 0.1" friction="{KINETIC} 0.005 0.0001"/>
    <body pos="0 0 {0.01 - GRAVITY / (1e7 * 0.04)!r}"><freejoint/>
      <inertial pos="0 0 -0.01" mass="{MASS}" diaginertia="0.01 0.01 0.01"/>
      <geom name="plate" type="box" size="0.1 0.1 0.01" friction="{KINETIC} 0.005 0.0001"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/plate/stiffness" data="1e7"/>
    <numeric name="volcontact/pair/plate/damping" data="20"/>
    <numeric name="volcontact/pair/plate/friction_law/bristle" data="1"/>
    <numeric name="volcontact/pair/plate/friction" data="{KINETIC}"/>
    <numeric name="volcontact/pair/plate/static_friction" data="{STATIC}"/>
    <numeric name="volcontact/pair/plate/bristle_stiffness" data="1e5"/>
    <numeric name="volcontact/pair/plate/bristle_damping" data="{2.0 * math.sqrt(1e5)!r}"/>
    <numeric name="volcontact/pair/plate/stribeck_speed" data="1e-3"/>
    <numeric name="volcontact/pair/plate/dwell_time" data="{DWELL}"/>
    <tuple name="volcontact/pair/plate">
      <element objtype="geom" objname="plate"/><element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>"""


class Puller:
    """A load along x that is constant for HELD steps at a time, and the work that it does."""

    def __init__(self, load_at: Callable[[float], float]) -> None:
        self._load_at = load_at
        self._load, self._place, self._work = 0.0, 0.0, 0.0

    def drive(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Sets the load of the next steps."""
        self._work, self._place = self.work(data), float(data.qpos[0])
        self._load = self._load_at(data.time + 0.5 * HELD * model.opt.timestep)
        data.qfrc_applied[0] = self._load

    def work(self, data: mujoco.MjData) -> float:
        """Since the start [J]."""
        return self._work + self._load * (float(data.qpos[0]) - self._place)


def pull(
    load_at: Callable[[float], float],
    duration: float,
    *,
    step: float = 5e-5,
    native: bool = False,
    **numbers: float,
) -> Run:
    """The plate under a force load_at(t) [N]; rows of place, speed and load."""
    model = load(SCENE, **{f"pair__plate__{name}": value for name, value in numbers.items()})

    model.opt.timestep = step
    puller = Puller(load_at)
    # Every sample is one assignment of the load: it stays what the user assigned.
    return simulate(
        model,
        duration,
        lambda _, d: (d.qpos[0], d.qvel[0], load_at(d.time)),
        every=HELD,
        drive=puller.drive,
        native=native,
        outside=lambda d: (puller.work(d), 0.0),
    )


def breakaway(rest: float, rate: float, case: Case, *, native: bool = False) -> float:
    """Largest friction over weight under a ramp of the load after a rest [-].

    Args:
        rest: [s].
        rate: of the load, weights per second.
        case: takes note of the balance of energy.
        native: under MuJoCo's own contact.
    """
    run = pull(
        lambda t: MASS * GRAVITY * rate * max(0.0, t - rest),
        rest + 0.5 / rate,
        step=5e-5 if rate > 1.0 else 2e-4,
        native=native,
        stribeck_speed=1e-2 if rate > 1.0 else 1e-3,
    )
    if not native:
        case.account(run)
    acceleration = np.gradient(run.rows[:, 2], run.rows[:, 0])
    # When it has settled, until it is away.
    pulled = (run.rows[:, 3] > 0.1 * MASS * GRAVITY) & (run.rows[:, 1] < 1e-3)
    friction = (run.rows[:, 3] - MASS * acceleration)[pulled]
    return float(friction.max() / (MASS * GRAVITY))


def drift(speed: float, case: Case, *, stiffness: float = 1e5, native: bool = False) -> float:
    """Mean speed under 2 +- 1 N at 10 Hz, over whole periods [m/s]."""

    def vibrate(t: float) -> float:
        return min(1.0, t) * (2.0 + math.sin(2.0 * math.pi * 10.0 * t))

    run = pull(
        vibrate,
        4.0,
        native=native,
        stribeck_speed=speed,
        bristle_stiffness=stiffness,
        bristle_damping=2.0 * math.sqrt(stiffness * MASS),
    )
    if not native:
        case.account(run)
    ends = np.interp((2.0, 4.0), run.rows[:, 0], run.rows[:, 1])
    return float(ends[1] - ends[0]) / 2.0


def stiction(rest: float) -> float:
    """Static friction after a rest [-]."""
    return KINETIC + (STATIC - KINETIC) * (1.0 - math.exp(-rest / DWELL))


def after_a_rest(rest: float, rate: float) -> float:
    """Friction over weight at the breakaway, under a ramp of so many weights per second [-]."""
    grown = KINETIC
    for _ in range(5):  # it grows on while the ramp rises
        grown = stiction(rest + grown / rate)
    return grown


def measure() -> Case:
    """Breakaway after long and short rests, and drift."""
    case = Case(
        "Bristles",
        "A plate of 1 kg on bristles (1e5 N/m, critically damped, mu_C = 0.3, mu_S = 0.4, tau_dw = "
        "0.5 s). A slow ramp breaks it away at mu_S; after a short rest t a quick ramp does so at "
        "mu_C + (mu_S - mu_C)(1 - exp(-t/tau_dw)), t with the ramp itself. Under vibration it "
        "drifts as the equations of the law do, integrated separately. The balance of energy "
        "includes the work of the load.",
    )
    slow = (breakaway(0.0, 0.02, case), breakaway(0.0, 0.02, case, native=True))
    case.figures.append(Figure("slow ramp: friction over weight", "-", STATIC, 5e-3, *slow))
    own = breakaway(0.3, 20.0, case, native=True)  # whatever the rest
    for rest in (0.1, 0.3, 1.0):
        grown = after_a_rest(rest, 20.0)
        name = f"quick ramp after {rest:g} s of rest"
        measured = breakaway(rest, 20.0, case)
        case.figures.append(Figure(name, "-", grown, 1e-2, measured, own))
    shaken = drift(1e-3, case, native=True)
    case.figures += [
        Figure("drift, v_s = 1 mm/s", "m/s", 6.75905e-5, 2e-3, drift(1e-3, case), shaken),
        Figure("drift, v_s = 10 mm/s", "m/s", 5.32871e-6, 2e-3, drift(1e-2, case), shaken),
        Figure(
            "drift, v_s = 1 mm/s, 1e6 N/m",
            "m/s",
            1.51772e-6,
            2e-3,
            drift(1e-3, case, stiffness=1e6),
            shaken,
        ),
    ]
    ramp = pull(lambda t: 0.2 * MASS * GRAVITY * t, 2.2, step=2e-4)
    native = pull(lambda t: 0.2 * MASS * GRAVITY * t, 2.2, step=2e-4, native=True)
    case.plots.append(
        Plot(
            "ramp",
            "load over weight [-]",
            "way [mm]",
            tuple(
                Curve(
                    label,
                    run.rows[run.rows[:, 1] < 1e-3, 3] / GRAVITY,
                    1e3 * run.rows[run.rows[:, 1] < 1e-3, 1],
                    style,
                )
                for label, run, style in (("volumetric", ramp, "-"), ("native", native, "--"))
            ),
        )
    )
    return case


@pytest.mark.soak
def test_bristle() -> None:
    """`./run test` has test_breaks_away_after_a_rest."""
    measure().check()


@pytest.mark.parametrize("rest", [0.1, 1.0])
def test_breaks_away_after_a_rest(rest: float) -> None:
    case = Case("", "")
    assert breakaway(rest, 20.0, case) == pytest.approx(after_a_rest(rest, 20.0), rel=1e-2)
    case.check()  # of the balance of energy
