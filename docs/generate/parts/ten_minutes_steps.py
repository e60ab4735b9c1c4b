# SPDX-License-Identifier: Apache-2.0
"""What docs/tutorials/ten_minutes.md types: commands, files, and errors with what helps."""

from __future__ import annotations

from dataclasses import dataclass

PUSHER = """\
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <geom name="table" type="box" size="0.3 0.2 0.02" pos="0 0 -0.02"/>
    <body name="pusher" pos="-0.15 0 0.025">
      <joint name="push" type="slide" axis="1 0 0" damping="5"/>
      <geom name="pusher" type="box" size="0.01 0.05 0.02" mass="0.2"/>
    </body>
    <body name="part" pos="0 0 0.0301">
      <freejoint/>
      <geom name="part" type="cylinder" size="0.04 0.03" mass="0.5"/>
    </body>
  </worldbody>
  <actuator><motor name="push" joint="push"/></actuator>
  <custom>
    <numeric name="volcontact/material/plastic/stiffness" data="1e10"/>
    <numeric name="volcontact/material/plastic/friction" data="0.3"/>
    <tuple name="volcontact/material/plastic">
      <element objtype="geom" objname="table"/>
      <element objtype="geom" objname="pusher"/>
      <element objtype="geom" objname="part"/>
    </tuple>
  </custom>
</mujoco>
"""

READ = """\
import pyarrow.parquet as pq

run = pq.read_table("press/results/trajectory.parquet")
depth = -1e3 * run["joint.press.position"].to_numpy()
force = run["shaft.force_z"].to_numpy()
for d in (1.5, 2.0, 4.0, 8.0, 12.0, 20.0):
    print(f"{d:5.1f} mm  {force[abs(depth - d).argmin()]:6.2f} N")
print(f"largest {force.max():.2f} N at {depth[force.argmax()]:.2f} mm")
"""


@dataclass(frozen=True)
class Step:
    """A command, and what is kept of what it says.

    Attributes:
        command: for the shell.
        keep: parts of the lines that are shown; empty shows all.
        file: a file that is written first, and its text.
    """

    command: str
    keep: tuple[str, ...] = ()
    file: tuple[str, str] | None = None


@dataclass(frozen=True)
class Slip:
    """A command that fails, and the one that its message leads to.

    Attributes:
        wrong: what was typed; it ends with a status other than 0.
        says: of the message, at least.
        right: what it then was.
    """

    wrong: str
    says: str
    right: str


INSTALL = (
    Step("python3 -m venv env"),
    Step("env/bin/pip install -q --no-index --find-links index volcontact"),
    Step("volcontact doctor", ("good ", "extra report", "extra view")),
)
START = (
    Step("volcontact new first"),
    Step("volcontact run first/scene.xml"),
)
OWN = (
    Step("volcontact check pusher.xml", file=("pusher.xml", PUSHER)),
    Step("volcontact run pusher.xml --ctrl push=4 --duration 0.5"),
    Step("volcontact metrics pusher.xml --time 0.5"),
)
PRESS = (
    Step('env/bin/pip install -q --no-index --find-links index "volcontact[report]"'),
    Step("volcontact new press --template insertion"),
    Step("volcontact check press/scene.xml"),
    Step(
        "volcontact run press/scene.xml --controls press/press.csv --duration 1.5 "
        "--out press/results --plot shaft.force_z:joint.press.position"
    ),
    Step("env/bin/python read.py", file=("read.py", READ)),
)
SLIPS = (
    Slip(
        "volcontact run pusher.xml --ctrl psuh=4",
        "did you mean",
        "volcontact run pusher.xml --ctrl push=4 --duration 0.1",
    ),
    Slip(
        "volcontact run pusher.xml --material stifness=1e9",
        "did you mean",
        "volcontact run pusher.xml --material stiffness=1e9 --duration 0.1",
    ),
    Slip(
        "volcontact run press/meshes/shaft.obj",
        "mesh",
        "volcontact mesh check press/meshes/shaft.obj",
    ),
    Slip("volcontact new press", "exists already", "volcontact new drop"),
    Slip(
        "volcontact view pusher.xml --browser --seconds 1",
        'pip install "volcontact[view]"',
        'env/bin/pip install -q --no-index --find-links index "volcontact[view]"',
    ),
    Slip(
        "volcontact view pusher.xml --seconds 1",
        "use --browser",
        "volcontact view pusher.xml --browser --seconds 1",
    ),
)
