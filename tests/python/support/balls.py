# SPDX-License-Identifier: Apache-2.0
"""A ball over a floor, for the tests of scenes."""

BALL = """
<mujoco>
  <option timestep="1e-3"/>
  {size}
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body pos="0 0 {height}"><freejoint/>
      <geom name="ball" type="sphere" size=".05" mass="1"/></body>
  </worldbody>
  <custom>
    <numeric name="volcontact/option/tolerance" data="1e-4"/>
    <numeric name="volcontact/material/rubber/stiffness" data="2e8"/>
    <numeric name="volcontact/material/rubber/damping" data="10"/>
    <numeric name="volcontact/material/rubber/friction" data="0.3"/>
    <tuple name="volcontact/material/rubber">
      <element objtype="geom" objname="floor"/><element objtype="geom" objname="ball"/>
    </tuple>
  </custom>
</mujoco>
"""


def ball(height=0.0493, size=""):
    return BALL.format(height=height, size=size)
