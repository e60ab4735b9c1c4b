# SPDX-License-Identifier: Apache-2.0
"""One scene under volumetric and under MuJoCo's own contact: who creeps down the slope?

./run python python/examples/compare_with_native.py
"""

from volcontact.running.simulation import simulate

SCENE = """
<mujoco>
  <option timestep="0.001" gravity="2.5 0 -9.5"/>
  <worldbody>
    <geom name="slope" type="plane" size="5 5 0.1" friction="0.3 0.005 0.0001"/>
    <body name="box" pos="0 0 0.05">
      <freejoint/>
      <geom name="box" type="box" size="0.1 0.1 0.05" mass="1" friction="0.3 0.005 0.0001"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/box/stiffness" data="1e7"/>
    <numeric name="volcontact/pair/box/damping" data="20"/>
    <numeric name="volcontact/pair/box/friction" data="0.3"/>
    <numeric name="volcontact/pair/box/friction_law/bristle" data="1"/>
    <numeric name="volcontact/pair/box/bristle_stiffness" data="1e5"/>
    <numeric name="volcontact/pair/box/bristle_damping" data="300"/>
    <tuple name="volcontact/pair/box">
      <element objtype="geom" objname="box"/>
      <element objtype="geom" objname="slope"/>
    </tuple>
  </custom>
</mujoco>
"""


def main() -> None:
    """Prints how far the box has slid after each of three seconds."""
    for contact in ("volumetric", "native"):
        run = simulate(SCENE, contact=contact, duration=3.0, frame_interval=None)
        slid = [1e3 * run.position[second * 1000, 0, 0] for second in (1, 2, 3)]
        print(f"{contact:<11}" + ", ".join(f"{x:.4f} mm" for x in slid))


if __name__ == "__main__":
    main()
