# SPDX-License-Identifier: Apache-2.0
"""Head-on impacts of a ball without gravity: the restitution of a damping, and that asked for."""

from __future__ import annotations

import math
from contextlib import nullcontext

import mujoco
import numpy as np
import pytest
from case import Bounds, Case, Figure, load, simulate
from scenes import over_floor

import volcontact as vc

# a v_i with e, from ln((1 + A)/(1 - e A)) = A (1 + e): docs/theory.md, "Restitution".
TABLE = {
    0.01: 0.993377,
    0.05: 0.967739,
    0.1: 0.937476,
    0.2: 0.882190,
    0.5: 0.748435,
    1.0: 0.593624,
    2.0: 0.410720,
    5.0: 0.196980,
    10.0: 0.099982,
}


# A of some e, from the same relation.
NUMBERS = {0.5: 1.43275, 0.8: 0.37315, 0.95: 0.07893}


def rebound(key: str, value: float, speed: float, case: Case, *, native: bool = False) -> float:
    """Speed after the impact over that before it [-]."""
    scene = over_floor(
        'size="0.05"', height=0.0500001, step=1e-5, speed=speed, stiffness=1e9, **{key: value}
    )
    run = simulate(load(scene), 0.06, lambda m, d: (d.qvel[2], d.qpos[2]), every=50, native=native)
    assert native or run.rows[-1, 2] > 0.05, "still in contact"
    if not native:
        case.account(run)
    return float(run.rows[-1, 1]) / speed


def let_go(restitution: float, *, native: bool = False) -> tuple[float, float]:
    """A ball that was pressed slowly on the floor with 500 N: its speed, and the closed form [m/s].

    Parting, the damped force is the elastic one times 1 - A e, so e_k = U (1 - A e).
    """
    scene = over_floor(
        'size="0.05"', height=0.05, step=1e-5, stiffness=1e9, restitution=restitution
    )
    model = load(scene)
    data = mujoco.MjData(model)
    with nullcontext() if native else vc.attach(model) as contact:
        for i in range(20000):
            data.xfrc_applied[1, 2] = -500.0 * min(1.0, i / 10000)
            mujoco.mj_step(model, data)
        stored = 0.0 if contact is None else contact.energy(data).elastic
        data.xfrc_applied[1, 2] = 0.0
        while data.qpos[2] < 0.0501 and data.time < 1.0:
            mujoco.mj_step(model, data)
        mass = float(model.body_mass[1])
    A = next(a for e, a in NUMBERS.items() if e == restitution)
    return float(data.qvel[2]), math.sqrt(2.0 * stored * (1.0 - A * restitution) / mass)


def cradle(gap: float, restitution: float) -> tuple[np.ndarray, float]:
    """Three balls of 1 kg in a row, hit at 1 m/s: speeds [m/s], and the energy left [-]."""
    balls = "".join(
        f'<body pos="{x} 0 0"><joint type="slide" axis="1 0 0"/>'
        '<geom type="sphere" size=".05" mass="1"/></body>'
        for x in (-0.101 - gap, 0.0, 0.1 + gap)
    )
    material = {"stiffness": 1e9, "friction": 0.0, "restitution": restitution}
    model = vc.load(
        f'<mujoco><option timestep="1e-5" gravity="0 0 0"/><worldbody>{balls}</worldbody></mujoco>',
        material=material,
    )
    data = mujoco.MjData(model)
    data.qvel[0] = 1.0
    with vc.attach(model, material=material):
        mujoco.mj_step(model, data, 2000)
    speeds = np.array(data.qvel)
    return speeds, float(speeds @ speeds)


def measure() -> Case:
    """All impacts."""
    case = Case(
        "Restitution",
        "A ball hits a floor without gravity. The restitution e follows from the damping a and the "
        "impact speed alone, not from the stiffness, the shape or the mass; a prescribed "
        "restitution holds at every speed.",
    )
    own = rebound("damping", 0.0, 0.7, case, native=True)  # whatever the damping
    for product, expected in TABLE.items():
        measured = rebound("damping", product / 0.7, 0.7, case)
        name = f"e at a v = {product:g}"
        case.figures.append(Figure(name, "-", expected, 1e-4 / expected, measured, own))
    for asked in (0.9, 0.8, 0.5):
        for speed in (0.1, 1.0, 3.0):
            measured = rebound("restitution", asked, speed, case)
            native = rebound("restitution", asked, speed, case, native=True)
            name = f"e = {asked:g} asked for, at {speed:g} m/s"
            case.figures.append(Figure(name, "-", asked, 1e-3, measured, native))
    for asked in NUMBERS:
        measured, expected = let_go(asked)
        name = f"e = {asked:g}, pressed with 500 N and let go"
        native, _ = let_go(asked, native=True)
        case.figures.append(Figure(name, "m/s", expected, 5e-3, measured, native))
    apart, _ = cradle(1e-3, 0.95)
    touching, left = cradle(1e-6, 0.95)
    none = "another law"
    name = "three balls in a row, 1 mm apart: speed of the last"
    once = 0.25 * (1.0 + 0.95) ** 2  # two impacts, one after the other
    case.figures.append(Figure(name, "m/s", once, 1e-2, apart[2], none))
    name = "the same that touch"
    case.figures.append(Bounds(name, "m/s", 0.99 * once, 1.0, touching[2], none))
    case.figures.append(Bounds("energy left by those that touch", "-", 0.89, 0.92, left, none))
    return case


@pytest.mark.once
def test_restitution() -> None:
    measure().check()
