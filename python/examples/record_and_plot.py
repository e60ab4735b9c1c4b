# SPDX-License-Identifier: Apache-2.0
"""Records a bouncing ball, writes Parquet and plots force and energy.

./run python python/examples/record_and_plot.py [FOLDER]
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import mujoco

import volcontact as vc

SCENE = """
<mujoco>
  <option timestep="0.0005"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body pos="0 0 0.25">
      <freejoint/>
      <geom name="ball" type="sphere" size="0.05" mass="1"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/ball/stiffness" data="1e8"/>
    <numeric name="volcontact/pair/ball/restitution" data="0.8"/>
    <tuple name="volcontact/pair/ball">
      <element objtype="geom" objname="ball"/>
      <element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>
"""


def main(folder: Path) -> None:
    """Writes states.parquet, sites.parquet and bounces.svg."""
    model = vc.load(SCENE)
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        recorder = vc.Recorder(contact)
        for _ in range(3000):
            recorder.record(data)
            mujoco.mj_step(model, data)
        files = recorder.write(folder)
        recorded = recorder.variables()
    time = recorded["time"].values
    figure, (above, below) = plt.subplots(2, sharex=True, layout="constrained")
    above.plot(time, recorded["qpos"].values[:, 2])
    above.set_ylabel("height [m]")
    below.plot(time, recorded["contact_force"].values)
    below.set_ylabel("contact force [N]")
    below.set_xlabel("time [s]")
    figure.savefig(folder / "bounces.svg")
    plt.close(figure)
    for file in (*files, folder / "bounces.svg"):
        print(f"written: {file}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
