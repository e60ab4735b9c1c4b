# SPDX-License-Identifier: Apache-2.0
"""Stiffness, damping and friction of a ball's contact, from its motion alone.

The motion comes from a simulation here, with noise; in a laboratory it comes from a camera.
"""

import csv
import tempfile
from pathlib import Path

import mujoco
import numpy as np

import volcontact as vc

SCENE = """
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="ball" pos="0 0 0.06">
      <freejoint/>
      <geom name="ball" type="sphere" size="0.05" mass="0.4"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/p/stiffness" data="{stiffness}"/>
    <numeric name="volcontact/pair/p/damping" data="{damping}"/>
    <numeric name="volcontact/pair/p/friction" data="{friction}"/>
    <numeric name="volcontact/option/implicit/on" data="1"/>
    <tuple name="volcontact/pair/p">
      <element objtype="geom" objname="ball"/>
      <element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>
"""

STUDY = """
[identify]
scene = "scene.xml"
[measurements]
file = "measured.csv"
trial = "trial"
[measure.position]
of = "ball"
columns = ["x", "y", "z"]
sigma = 1e-4
[nuisance]
position = 1e-4
velocity = 0.05
spin = 0.5
[measure.orientation]
of = "ball"
columns = ["qw", "qx", "qy", "qz"]
sigma = 1e-3
[parameter.stiffness]
target = "volcontact/pair/p/stiffness"
bounds = [1e6, 1e8]
[parameter.damping]
target = "volcontact/pair/p/damping"
[parameter.friction]
target = "volcontact/pair/p/friction"
[estimator]
starts = 1
evaluations = 15
tolerance = 1e-4
"""


def measure(true: dict[str, float], file: Path) -> None:
    """Throws the ball twice and writes what a camera of 125 Hz would see."""
    noise = np.random.default_rng(0)
    model = vc.load(SCENE.format(**true))
    with vc.attach(model), file.open("w", newline="") as out:
        table = csv.writer(out)
        table.writerow(["trial", "t", "x", "y", "z", "qw", "qx", "qy", "qz"])
        for trial in range(2):
            data = mujoco.MjData(model)
            data.qpos[2] = 0.07 + 0.01 * trial
            data.qvel[:3] = 0.3, 0.0, -0.2
            for step in range(160):
                if step % 8 == 0:
                    seen = data.qpos[:3] + 1e-4 * noise.standard_normal(3)
                    table.writerow([trial, data.time, *seen, *data.qpos[3:]])
                mujoco.mj_step(model, data)


def main() -> None:
    """Measures, identifies, prints values beside the truth."""
    true = {"stiffness": 4e6, "damping": 0.5, "friction": 0.22}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        measure(true, folder / "measured.csv")
        guess = {"stiffness": 1e7, "damping": 1.0, "friction": 0.3}
        (folder / "scene.xml").write_text(SCENE.format(**guess))
        (folder / "study.toml").write_text(STUDY)
        found = vc.identify(folder / "study.toml", workers=1)
    for key, value in found.values.items():
        print(f"{key}: {value:.4g}, true {true[key]:.4g}")
    for line in found.findings:
        print(line)


if __name__ == "__main__":
    main()
