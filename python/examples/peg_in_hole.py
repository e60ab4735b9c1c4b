# SPDX-License-Identifier: Apache-2.0
"""A peg falls through a hole that is cut exactly, with 0.2 mm of play all round.

./run python python/examples/peg_in_hole.py
"""

import mujoco
import numpy as np

import volcontact as vc

SCENE = """
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <geom name="floor" type="plane" size="0.5 0.5 0.1"/>
    <body name="plate" pos="0 0 0.06">
      <geom name="plate" type="box" size="0.1 0.1 0.01"/>
      <geom name="hole" type="cylinder" size="0.0202 0.012" mass="0"/>
    </body>
    <body name="peg" pos="0.001 0 0.13" euler="0 0.5 0">
      <freejoint/>
      <geom name="peg" type="cylinder" size="0.02 0.05" mass="1"/>
    </body>
  </worldbody>
  <custom>
    <tuple name="volcontact/solid/bored_plate">
      <element objtype="geom" objname="plate" prm="1"/>
      <element objtype="geom" objname="hole" prm="-1"/>
    </tuple>
    <numeric name="volcontact/material/metal/stiffness" data="1e10"/>
    <numeric name="volcontact/material/metal/damping" data="5"/>
    <numeric name="volcontact/material/metal/friction" data="0.2"/>
    <numeric name="volcontact/material/metal/slip_speed" data="0.01"/>
    <tuple name="volcontact/material/metal">
      <element objtype="body" objname="peg"/>
      <element objtype="body" objname="plate"/>
      <element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>
"""


def main() -> None:
    """Prints the first touch, the largest force of the wall, and how the peg stands."""
    model = vc.load(SCENE)
    data = mujoco.MjData(model)
    kind = mujoco.mjtObj.mjOBJ_GEOM
    plate, peg = (mujoco.mj_name2id(model, kind, name) for name in ("plate", "peg"))
    first, largest = None, 0.0
    with vc.attach(model) as contact:
        while data.time < 1.0:
            mujoco.mj_step(model, data)
            for site in contact.sites(data):
                if {site["geom_a"], site["geom_b"]} == {plate, peg}:
                    first = data.time if first is None else first
                    largest = max(largest, float(site["normal_force"]))
        axis = data.geom_xmat[peg].reshape(3, 3)[:, 2]
        print(f"first touch of the plate after {first:.3f} s, at most {largest:.1f} N there")
        print(f"the peg stands {1e3 * (data.qpos[2] - 0.05):.4f} mm above the floor")
        print(f"its axis leans by {np.degrees(np.arccos(min(1.0, axis[2]))):.3f} degrees")


if __name__ == "__main__":
    main()
