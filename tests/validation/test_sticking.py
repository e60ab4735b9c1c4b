# SPDX-License-Identifier: Apache-2.0
"""The default material holds: in a gripper, on a slope, on a turntable; no key is set."""

from __future__ import annotations

import math
from collections.abc import Callable

import mujoco
import numpy as np
import pytest
from case import GRAVITY, Bounds, Case, Figure

import volcontact as vc

GRIPPER = """
<mujoco><option timestep="{step}"/><worldbody>
  <body name="held"><freejoint/>
    <geom type="box" size=".02 .02 .02" mass=".2" friction=".6"/></body>
  <body pos="-.03 0 0"><joint name="left" type="slide" axis="1 0 0" damping="1"/>
    <geom type="box" size=".01 .01 .02" mass=".1" friction=".6"/></body>
  <body pos=".03 0 0"><joint name="right" type="slide" axis="-1 0 0" damping="1"/>
    <geom type="box" size=".01 .01 .02" mass=".1" friction=".6"/></body>
</worldbody><actuator><motor joint="left"/><motor joint="right"/></actuator></mujoco>"""
SLOPE = """
<mujoco><option timestep="{step}" gravity="{along} 0 {down}"/><worldbody>
  <geom type="plane" size="1 1 1" friction=".5"/>
  <body name="held" pos="0 0 .05"><freejoint/>
    <geom type="box" size=".05 .05 .05" mass="1" friction=".5"/></body>
</worldbody></mujoco>"""
TURNTABLE = """
<mujoco><option timestep="{step}" integrator="{integrator}"/><worldbody>
  <body><joint axis="0 0 1"/><geom type="cylinder" size=".4 .02" mass="1000" friction=".5"/></body>
  <body name="held" pos=".2 0 .0399"><freejoint/>
    <geom type="box" size=".02 .02 .02" mass=".1" friction=".5"/></body>
</worldbody></mujoco>"""
TURNING = 3.0  # [rad/s]


def moved(
    text: str,
    seconds: float,
    place: Callable[[mujoco.MjData], np.ndarray],
    *,
    settles: float = 3.0,
    start: Callable[[mujoco.MjData], None] | None = None,
    material: dict[str, object] | None = None,
    native: bool = False,
) -> float:
    """How far `held` moves in some seconds, once it has settled [m]."""
    if material is None:
        model = mujoco.MjModel.from_xml_string(text)  # as of others: no room in userdata
    else:
        model = vc.load(text, material=material)
    data = mujoco.MjData(model)
    if start is not None:
        start(data)
    if not native:
        with vc.attach(model, material=material):
            return _moved(model, data, seconds, settles, place)
    return _moved(model, data, seconds, settles, place)


def _moved(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    seconds: float,
    settles: float,
    place: Callable[[mujoco.MjData], np.ndarray],
) -> float:
    mujoco.mj_step(model, data, round(settles / model.opt.timestep))
    before = place(data)
    mujoco.mj_step(model, data, round(seconds / model.opt.timestep))
    return float(np.linalg.norm(place(data) - before))


def where(data: mujoco.MjData) -> np.ndarray:
    """Place of the body that is held [m]."""
    return np.array(data.body("held").xpos)


def radius(data: mujoco.MjData) -> np.ndarray:
    """Its way from the axis of the turntable [m]."""
    return np.array([math.hypot(*where(data)[:2])])


def grip(step: float, seconds: float, *, native: bool = False) -> float:
    """A cube of 200 g between two fingers that press with 10 N [m]."""

    def press(data: mujoco.MjData) -> None:
        data.ctrl[:] = 10.0

    return moved(GRIPPER.format(step=step), seconds, where, start=press, native=native)


def on_slope(share: float, step: float, seconds: float, *, native: bool = False) -> float:
    """A cube on a slope of a share of the friction cone [m]."""
    angle = math.atan(0.5 * share)
    along, down = GRAVITY * math.sin(angle), -GRAVITY * math.cos(angle)
    text = SLOPE.format(step=step, along=along, down=down)
    return moved(text, seconds, where, settles=10.0, native=native)


def on_turntable(
    step: float,
    integrator: str,
    material: dict[str, object] | None = None,
    *,
    native: bool = False,
) -> float:
    """How far a cube on a turntable moves inward or outward in 5 s [m]."""

    def turn(data: mujoco.MjData) -> None:
        data.qvel[0] = data.qvel[6] = TURNING
        data.qvel[2] = TURNING * 0.2

    text = TURNTABLE.format(step=step, integrator=integrator)
    return moved(text, 5.0, radius, start=turn, material=material, native=native)


def measure() -> Case:
    """All that is held."""
    case = Case(
        "Sticking",
        "The default material, without any keys. A gripper holds a cube of 200 g with 10 N at a "
        "friction of 0.6; a cube rests on a slope at nine tenths of the friction cone for ten "
        "minutes; a cube rides on a turntable at 3 rad/s, 0.2 m from its axis. Steps of 2 ms.",
    )

    def held(name: str, value: float, native: float) -> None:
        own = native if native < 100.0 else "slips out"
        case.figures.append(Figure(name, "m", 0.0, 1e-9, value, own))

    held("gripper, slip in 60 s", grip(2e-3, 60.0), grip(2e-3, 60.0, native=True))
    share, time = 0.9, 600.0
    native = on_slope(share, 2e-3, time, native=True)
    held("slope, creep in 10 min", on_slope(share, 2e-3, time), native)
    native = on_turntable(2e-3, "Euler", native=True)
    held("turntable, drift in 5 s", on_turntable(2e-3, "Euler"), native)
    stiff = on_turntable(2e-3, "Euler", {"stiffness": 1e9})
    held("the same at 1e9 N/m^3", stiff, native)
    bristle = on_turntable(2e-3, "Euler", {"friction_law": "bristle"})
    held("the same on bristles", bristle, native)
    slid = on_slope(1.02, 2e-3, 10.0)
    # 0.5 (sin - mu cos) g t^2 between 10 s and 20 s.
    angle = math.atan(0.51)
    expected = 0.5 * GRAVITY * (math.sin(angle) - 0.5 * math.cos(angle)) * (20.0**2 - 10.0**2)
    text = "at 1.02 of the cone it slides, from 10 s to 20 s"
    case.figures.append(Bounds(text, "m", 0.8 * expected, 1.02 * expected, slid, "no such run"))
    return case


@pytest.mark.once
def test_sticking() -> None:
    measure().check()


@pytest.mark.parametrize("step", [1e-3, 5e-3])
def test_grip_holds_at_other_steps(step: float) -> None:
    assert grip(step, 10.0) < 1e-9


@pytest.mark.parametrize("step", [1e-3, 5e-3])
@pytest.mark.parametrize("share", [0.5, 0.95])
def test_slope_holds_at_other_steps_and_loads(step: float, share: float) -> None:
    assert on_slope(share, step, 10.0) < 1e-7


@pytest.mark.parametrize(
    "integrator",
    [
        word
        for word in ("implicit", "implicitfast", "RK4")
        if hasattr(mujoco.mjtIntegrator, f"mjINT_{word.upper()}")
    ],
)
def test_turntable_under_other_integrators(integrator: str) -> None:
    assert on_turntable(2e-3, integrator, {"stiffness": 1e9}) < 1e-9
