# SPDX-License-Identifier: Apache-2.0
"""Contact far too stiff for an explicit step, at MuJoCo's usual 2 ms."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from case import GRAVITY, Bounds, Case, Figure, contact_of, load

STEP, MASS, HALF = 2e-3, 12.0, 0.1
LIMIT = 4.0 * MASS / STEP**2  # k of a contact that an explicit step just holds [N/m]
BOX = """
<mujoco>
  <option timestep="{step}" gravity="0 0 -{gravity}"/>
  <worldbody>
    <geom name="floor" type="plane" size="2 2 0.1" friction="{friction} 0 0"/>
    <body pos="0 0 0.35"><freejoint/>
      <geom name="box" type="box" size="{half} {half} {half}" mass="{mass}"
        friction="{friction} 0 0"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/box/stiffness" data="{stiffness}"/>
    <numeric name="volcontact/pair/box/damping" data="0"/>
    <numeric name="volcontact/pair/box/friction" data="{friction}"/>
    <tuple name="volcontact/pair/box">
      <element objtype="geom" objname="box"/><element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>"""
ARM = """
<mujoco>
  <compiler angle="degree"/>
  <option timestep="2e-3"/>
  <worldbody>
    <geom name="floor" type="plane" size="2 2 0.1"/>
    <body pos="0 0 0.5">
      <joint name="shoulder" axis="0 1 0" damping="2"/>
      <geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.02" mass="3" contype="0"
        conaffinity="0"/>
      <body pos="0.5 0 0">
        <joint name="elbow" axis="0 1 0" damping="2"/>
        <geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.02" mass="2" contype="0"
          conaffinity="0"/>
        <body pos="0.5 0 0"><geom name="hand" type="box" size="0.05 0.05 0.05" mass="1"/></body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position joint="shoulder" kp="200"/>
    <position joint="elbow" kp="200"/>
  </actuator>
  <custom>
    <numeric name="volcontact/pair/hand/stiffness" data="1e11"/>
    <numeric name="volcontact/pair/hand/damping" data="0"/>
    <numeric name="volcontact/pair/hand/friction" data="0.5"/>
    <tuple name="volcontact/pair/hand">
      <element objtype="geom" objname="hand"/><element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>"""


def box(factor: float, friction: float) -> mujoco.MjModel:
    """The box whose face is `factor` times as stiff as an explicit step holds."""
    stiffness = factor * LIMIT / (4.0 * HALF**2)
    return load(
        BOX.format(
            step=STEP,
            gravity=GRAVITY,
            friction=friction,
            half=HALF,
            mass=MASS,
            stiffness=repr(stiffness),
        )
    )


def drops(
    factor: float, friction: float, count: int, *, steps: int = 2000, native: bool = False
) -> tuple[float, int, float]:
    """Boxes thrown at the floor.

    Returns:
        The largest kinetic and gravitational energy over that at the start, how many still move
        faster than 1e-3 at the end, and the largest change of kinetic and gravitational energy
        less the work of the contact, over the energy at the start. With it goes what semi-implicit
        Euler steps make of free fall, h m g v/2.
    """
    model, moving, most, unaccounted = box(factor, friction), 0, 0.0, 0.0
    inertia = np.diag([MASS] * 3 + [MASS * 2.0 * HALF**2 / 3.0] * 3)  # a cube's is the same turned
    with contact_of(model, native=native) as contact:
        for seed in range(count):
            random = np.random.default_rng(seed)
            data = mujoco.MjData(model)
            turn = random.normal(size=4)
            data.qpos[3:7] = turn / np.linalg.norm(turn)
            data.qvel[:3] = random.normal(size=3) * 0.5
            data.qvel[3:] = random.normal(size=3) * 2.0
            qpos, qvel = data.qpos, data.qvel
            first = 0.5 * qvel @ inertia @ qvel + MASS * GRAVITY * qpos[2]
            of_steps = 0.5 * STEP * MASS * GRAVITY * qvel[2]
            for step in range(steps):
                mujoco.mj_step(model, data)
                energy = 0.5 * qvel @ inertia @ qvel + MASS * GRAVITY * qpos[2]
                most = max(most, energy / first)
                if contact is None or step % 10:
                    continue
                mujoco.mj_forward(model, data)
                change = energy - first - contact.energy(data).work
                change -= 0.5 * STEP * MASS * GRAVITY * qvel[2] - of_steps
                unaccounted = max(unaccounted, abs(change) / first)
            moving += np.linalg.norm(qvel) > 1e-3
    return float(most), int(moving), float(unaccounted)


def depth(factor: float, *, native: bool = False) -> float:
    """How deep the box rests [m]."""
    model = box(factor, 0.5)
    data = mujoco.MjData(model)
    data.qpos[2] = HALF + 1e-4
    with contact_of(model, native=native):
        mujoco.mj_step(model, data, 2000)
    return HALF - float(data.qpos[2])


def stiff_battery_box(step: float) -> mujoco.MjModel:
    """The battery box with k_v = 1e10 N/m^3 of each pair."""
    model = load("battery_box/scene.xml")
    model.opt.timestep = step
    for i in range(model.nnumeric):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_NUMERIC, i)
        if name.endswith("/stiffness"):
            model.numeric_data[model.numeric_adr[i]] = 2e10  # two in series
    return model


def seated(step: float, *, native: bool = False) -> np.ndarray:
    """Position of the battery box after its drop [m]."""
    model = stiff_battery_box(step)
    data = mujoco.MjData(model)
    with contact_of(model, native=native):
        mujoco.mj_step(model, data, round(2.5 / step))
    return np.array(data.qpos[:3])


def press(*, native: bool = False) -> np.ndarray:
    """Force of the hand on the floor in 100 steps [N], while the servos press it there."""
    model = load(ARM)
    data = mujoco.MjData(model)
    data.ctrl[:] = (1.2, 0.3)
    forces = []
    with contact_of(model, native=native) as contact:
        mujoco.mj_step(model, data, 5000)
        for _ in range(100):
            mujoco.mj_step(model, data)
            if contact is None:
                forces.append(sum_of_native(model, data))
            else:
                forces.append(contact.sites(data)["normal_force"].sum())
    return np.array(forces)


def sum_of_native(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Sum of the normal forces of MuJoCo's own contacts [N]."""
    force, total = np.zeros(6), 0.0
    for i in range(data.ncon):
        mujoco.mj_contactForce(model, data, i, force)
        total += force[0]
    return total


def measure(count: int = 4) -> Case:
    """Drops, rest, an arm that presses, and the battery box."""
    case = Case(
        "Implicit contact at 2 ms",
        "A 12 kg cube on a floor, without damping, 1 to 1e6 times as stiff as an explicit step of "
        "2 ms can handle, thrown at random; its energy is kinetic plus gravitational. A two-link "
        "arm whose servos press its hand on the floor, k_v = 1e11 N/m^3. The battery box with k_v "
        "= 1e10 N/m^3, aluminium on aluminium, seated at 2 and 5 ms, against 0.1 ms. Steps become "
        "implicit in the contact forces automatically (volcontact/option/implicit/auto).",
    )
    native, _, _ = drops(1.0, 0.5, count, native=True)
    for factor in (1.0, 1e3, 1e6):
        most, _, unaccounted = drops(factor, 0.5, count)
        case.works.append(unaccounted)
        case.figures.append(
            Bounds(
                f"largest energy over first, {factor:g} times the limit",
                "-",
                0.0,
                1.000001,
                most,
                native,
            )
        )
    weight = MASS * GRAVITY
    for factor in (1.0, 1e4):
        case.figures.append(
            Figure(
                f"rests at, {factor:g} times the limit",
                "m",
                weight / (factor * LIMIT),
                1e-6,
                depth(factor),
                depth(factor, native=True),
            )
        )
    forces, native_forces = press(), press(native=True)
    case.figures.append(
        Bounds(
            "arm: spread of its force over its mean",
            "-",
            0.0,
            1e-3,
            float(np.ptp(forces) / forces.mean()),
            float(np.ptp(native_forces) / native_forces.mean()),
        )
    )
    fine, native_fine = seated(1e-4), seated(1e-4, native=True)
    for step in (2e-3, 5e-3):
        case.figures.append(
            Bounds(
                f"battery box at {1e3 * step:g} ms: off its place at 0.1 ms",
                "m",
                0.0,
                1e-4,
                float(np.linalg.norm(seated(step) - fine)),
                float(np.linalg.norm(seated(step, native=True) - native_fine)),
            )
        )
    return case


@pytest.mark.once
def test_implicit_contact() -> None:
    measure().check()


@pytest.mark.parametrize("step", [2e-3, 5e-3])
def test_battery_box_does_not_chatter(step: float) -> None:
    model = stiff_battery_box(step)
    data = mujoco.MjData(model)
    fastest = 0.0
    with contact_of(model, native=False):
        mujoco.mj_step(model, data, round(1.5 / step))
        for _ in range(round(1.0 / step)):
            mujoco.mj_step(model, data)
            fastest = max(fastest, float(np.abs(data.qvel).max()))
    assert fastest < 1e-10
