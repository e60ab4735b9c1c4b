# SPDX-License-Identifier: Apache-2.0
"""Drops a box on a floor and reads where it touches.

./run python python/examples/drop_a_box.py
"""

import mujoco

import volcontact as vc

SCENE = """
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="box" pos="0 0 0.3" euler="20 10 0">
      <freejoint/>
      <geom name="box" type="box" size="0.1 0.08 0.05" mass="1"/>
    </body>
  </worldbody>
</mujoco>
"""


def main() -> None:
    """Steps for two seconds and prints the contact sites at the end."""
    model = vc.load(SCENE)
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:  # native contact is off until the end
        while data.time < 2.0:
            mujoco.mj_step(model, data)
        for site in contact.sites(data):
            print(f"area {1e4 * site['area']:.1f} cm^2, {1e6 * site['depth']:.2f} um deep")
            print(f"normal force {site['normal_force']:.3f} N")
        energy = contact.energy(data)
        print(f"dissipated {energy.dissipated:.3f} J: {energy.by_channel}")


if __name__ == "__main__":
    main()
