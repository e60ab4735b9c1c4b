# SPDX-License-Identifier: Apache-2.0
"""Draws the contact patches of a body that leans against a wall, seen from above.

./run python python/examples/draw_patches.py [FOLDER]
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import mujoco

import volcontact as vc

SCENE = """
<mujoco>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="table" pos="0 0 0.0995">
      <freejoint/>
      <geom name="leg_1" type="cylinder" size="0.02 0.1" pos="0.2 0.1 0"/>
      <geom name="leg_2" type="capsule" size="0.02 0.08" pos="-0.2 0.1 0"/>
      <geom name="leg_3" type="box" size="0.03 0.015 0.1" pos="-0.2 -0.1 0" euler="0 0 30"/>
      <geom name="leg_4" type="ellipsoid" size="0.03 0.02 0.1" pos="0.2 -0.1 0"/>
    </body>
  </worldbody>
</mujoco>
"""


def main(folder: Path) -> None:
    """Writes patches.svg."""
    model = vc.load(SCENE)
    data = mujoco.MjData(model)
    figure, axes = plt.subplots(layout="constrained")
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        for i, site in enumerate(contact.sites(data)):
            points, triangles = contact.surface(data, i, resolution=48).patch
            axes.tripcolor(points[:, 0], points[:, 1], triangles, facecolors=[1.0] * len(triangles))
            name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, int(site["geom_b"]))
            axes.annotate(f"{name}\n{1e6 * site['area']:.1f} mm^2", points[:, :2].mean(axis=0))
            print(f"{name}: {1e6 * site['area']:.2f} mm^2, {1e3 * site['depth']:.3f} mm deep")
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    figure.savefig(folder / "patches.svg")
    plt.close(figure)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
