# SPDX-License-Identifier: Apache-2.0
"""One simulation as a function, for processes of their own."""

import mujoco
import numpy as np

import volcontact as vc

# Friction that remembers, a wall to be pushed against, and steps that are implicit in the contact.
PUSHED_BOX = """
<mujoco>
  <option timestep="2e-3"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <geom name="wall" type="box" size=".02 1 .2" pos=".15 0 .2"/>
    <body pos="0 0 .052" euler="3 2 1"><freejoint/>
      <geom name="box" type="box" size=".1 .08 .05" mass="1"/></body>
  </worldbody>
  <custom>
    <numeric name="volcontact/option/threads" data="{threads}"/>
    <numeric name="volcontact/material/steel/stiffness" data="1e11"/>
    <numeric name="volcontact/material/steel/friction" data="0.2"/>
    <numeric name="volcontact/material/steel/static_friction" data="0.25"/>
    <numeric name="volcontact/material/steel/friction_law/bristle" data="1"/>
    <tuple name="volcontact/material/steel"><element objtype="geom" objname="floor"/>
      <element objtype="geom" objname="wall"/><element objtype="geom" objname="box"/></tuple>
  </custom>
</mujoco>
"""


def pushed_box(threads=0):
    return PUSHED_BOX.format(threads=threads)


def final_state(arguments):
    """qpos, qvel, forces and userdata at the end of a run: (MJCF text, force, steps)."""
    text, force, steps = arguments
    model = vc.load(text)
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = force
    with vc.attach(model):
        for _ in range(steps):
            mujoco.mj_step(model, data)
    return np.concatenate([data.qpos, data.qvel, data.qfrc_applied, data.userdata])
