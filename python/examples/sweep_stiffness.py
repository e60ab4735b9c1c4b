# SPDX-License-Identifier: Apache-2.0
"""Numbers of a scene are live: one model, many stiffnesses, each to rest.

./run python python/examples/sweep_stiffness.py
"""

import mujoco
import numpy as np

import volcontact as vc

SCENE = """
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body pos="0 0 0.1">
      <freejoint/>
      <geom name="cube" type="box" size="0.1 0.1 0.1" mass="1"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/cube/stiffness" data="1e6"/>
    <numeric name="volcontact/pair/cube/damping" data="20"/>
    <tuple name="volcontact/pair/cube">
      <element objtype="geom" objname="cube"/>
      <element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>
"""


def main() -> None:
    """Prints how deep the cube sinks in, beside m g / (k_v A)."""
    model = vc.load(SCENE)
    stiffness = model.numeric("volcontact/pair/cube/stiffness").data
    with vc.attach(model) as contact:
        for value in np.logspace(6, 10, 5):
            stiffness[0] = value
            data = mujoco.MjData(model)
            mujoco.mj_step(model, data, 2000)
            (site,) = contact.sites(data)
            expected = 9.81 / (value * 0.04)
            print(f"k_v {value:.0e} N/m^3: {site['depth']:.6e} m, closed form {expected:.6e} m")


if __name__ == "__main__":
    main()
