# SPDX-License-Identifier: Apache-2.0
"""Viscous friction of bristles in explicit and in implicit steps: the force of the law."""

import mujoco
import numpy as np
import pytest

import volcontact as vc

MU, VISCOUS, MASS = 0.3, 2.0, 1.0
SCENE = f"""
<mujoco>
  <option timestep="5e-4" integrator="{{integrator}}" gravity="0 0 -9.81"/>
  <worldbody>
    <geom name="plate" type="plane" size="2 0.3 0.05"/>
    <body name="sled" pos="0 0 0.02">
      <joint name="way" type="slide" axis="1 0 0"/>
      <joint name="heave" type="slide" axis="0 0 1"/>
      <geom name="sled" type="box" size="0.05 0.04 0.02" mass="{MASS}"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/p/stiffness" data="1e8"/>
    <numeric name="volcontact/pair/p/damping" data="100"/>
    <numeric name="volcontact/pair/p/friction_law/bristle" data="1"/>
    <numeric name="volcontact/pair/p/friction" data="{MU}"/>
    <numeric name="volcontact/pair/p/static_friction" data="{MU}"/>
    <numeric name="volcontact/pair/p/viscous_friction" data="{VISCOUS}"/>
    <tuple name="volcontact/pair/p">
      <element objtype="geom" objname="sled"/><element objtype="geom" objname="plate"/>
    </tuple>
  </custom>
</mujoco>"""


def coasts(integrator, implicit, duration=0.2):
    """Speed after a while, from 1 m/s."""
    model = vc.load(SCENE.format(integrator=integrator))
    data = mujoco.MjData(model)
    data.qpos[1] = -MASS * 9.81 / (1e8 * 8e-3)
    data.qvel[0] = 1.0
    with vc.attach(model, options={"implicit": implicit}):
        for _ in range(round(duration / model.opt.timestep)):
            mujoco.mj_step(model, data)
    return data.qvel[0]


@pytest.mark.parametrize("integrator", ["Euler", "RK4"])
@pytest.mark.parametrize("implicit", ["auto", "on"])
def test_sliding_sled_slows_down_by_both_frictions(integrator, implicit):
    """m dv/dt = -mu m g - sigma_2 v in closed form."""
    speed, rate = MU * 9.81 * MASS / VISCOUS, VISCOUS / MASS
    exact = (1.0 + speed) * np.exp(-rate * 0.2) - speed
    assert coasts(integrator, implicit) == pytest.approx(exact, rel=2e-3)


def test_pull_beyond_the_cone_ends_at_the_speed_at_which_viscous_friction_bears_the_rest():
    model = vc.load(SCENE.format(integrator="Euler"))
    data = mujoco.MjData(model)
    data.qpos[1] = -MASS * 9.81 / (1e8 * 8e-3)
    with vc.attach(model):
        for _ in range(8000):
            data.qfrc_applied[0] = MU * MASS * 9.81 + 1.0
            mujoco.mj_step(model, data)
    assert data.qvel[0] == pytest.approx(1.0 / VISCOUS, rel=2e-3)
