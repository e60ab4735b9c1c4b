# SPDX-License-Identifier: Apache-2.0
"""A ball that bounces and rolls, measured without noise: studies with known answers."""

import csv

import mujoco
import numpy as np

import volcontact as vc

TRUE = {"stiffness": 4e6, "damping": 0.5, "friction": 0.22}
COLUMNS = ["trial", "t", "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"]
SCENE = """\
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="ball" pos="0 0 0.06">
      <freejoint name="free"/>
      <geom name="ball" type="sphere" size="0.05" mass="0.4"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/p/stiffness" data="{stiffness!r}"/>
    <numeric name="volcontact/pair/p/damping" data="{damping!r}"/>
    <numeric name="volcontact/pair/p/friction" data="{friction!r}"/>
    <numeric name="volcontact/option/implicit/on" data="1"/>
    <tuple name="volcontact/pair/p">
      <element objtype="geom" objname="ball"/>
      <element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>
"""
GUESS = {"stiffness": 1e7, "damping": 1.0, "friction": 0.3}
STUDY = """\
[identify]
scene = "scene.xml"

[measurements]
file = "measured.csv"
trial = "trial"
time = "t"

[measure.position]
of = "ball"
columns = ["x", "y", "z"]
sigma = 1e-4

[measure.orientation]
of = "ball"
columns = ["qw", "qx", "qy", "qz"]
sigma = 1e-3

[measure.velocity]
of = "ball"
columns = ["vx", "vy", "vz"]
weight = 0

[measure.angular_velocity]
of = "ball"
columns = ["wx", "wy", "wz"]
frame = "body"
weight = 0

[parameter.stiffness]
target = "volcontact/pair/p/stiffness"
bounds = [1e6, 1e8]

[parameter.damping]
target = "volcontact/pair/p/damping"
bounds = [0.05, 5]

[parameter.friction]
target = "volcontact/pair/p/friction"
bounds = [0.05, 1]
scale = "linear"
"""


def motions(count=3, samples=20, every=7, true=TRUE):
    """Rows of a ball thrown onto the floor, one trial the faster than the other."""
    model = vc.load(SCENE.format(**true))
    rows = []
    with vc.attach(model):
        for trial in range(count):
            data = mujoco.MjData(model)
            data.qpos[2] = 0.052 + 0.01 * trial
            data.qvel[:] = [0.2 + 0.1 * trial, 0.05, -0.3, 0.0, 4.0 * trial, 0.0]
            for step in range(samples * every):
                if step % every == 0:
                    rows.append([trial, data.time, *data.qpos, *data.qvel])
                mujoco.mj_step(model, data)
    return np.array(rows)


def write_study(folder, rows, text=STUDY):
    """The three files of a study; returns the path of the study."""
    (folder / "scene.xml").write_text(SCENE.format(**GUESS))
    with (folder / "measured.csv").open("w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(COLUMNS)
        for row in rows:
            writer.writerow([int(row[0]), *("" if v is None else repr(float(v)) for v in row[1:])])
    (folder / "study.toml").write_text(text)
    return folder / "study.toml"
