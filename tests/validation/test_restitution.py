# SPDX-License-Identifier: Apache-2.0
"""Head-on impacts of a ball without gravity: the restitution of a damping, and that asked for."""

from __future__ import annotations

import mujoco
from case import Case, Figure, load, simulate

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
SCENE = """
<mujoco>
  <option timestep="1e-5" integrator="RK4" gravity="0 0 0"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body pos="0 0 0.0500001"><freejoint/><geom name="ball" size="0.05" mass="1"/></body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/ball/stiffness" data="1e9"/>
    {damping}
    <tuple name="volcontact/pair/ball">
      <element objtype="geom" objname="ball"/><element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>"""


def rebound(key: str, value: float, speed: float, case: Case, *, native: bool = False) -> float:
    """Speed after the impact over that before it [-]."""
    damping = f'<numeric name="volcontact/pair/ball/{key}" data="{value}"/>'
    model = load(SCENE.format(damping=damping))

    def throw(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        data.qvel[2] = -speed

    run = simulate(
        model, 0.06, lambda m, d: (d.qvel[2], d.qpos[2]), every=50, setup=throw, native=native
    )
    assert native or run.rows[-1, 2] > 0.05, "still in contact"
    if not native:
        case.closures.append(run.closure)
    return float(run.rows[-1, 1]) / speed


def measure() -> Case:
    """All impacts."""
    case = Case(
        "Restitution",
        "A ball hits a floor without gravity. The restitution e follows from the damping a and "
        "the impact speed alone, whatever the stiffness, the shape and the mass; and a "
        "restitution that is asked for is had at every speed.",
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
    return case


def test_restitution() -> None:
    measure().check()
