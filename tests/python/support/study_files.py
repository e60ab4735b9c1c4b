# SPDX-License-Identifier: Apache-2.0
"""Small studies for tests: a function of two inputs, and a box that slides on a plane."""

from __future__ import annotations

import multiprocessing
import os
import sys
from pathlib import Path

import pytest

for library in ("scipy", "SALib", "optuna", "pyarrow", "gymnasium"):
    pytest.importorskip(library, reason=f'{library} is missing: pip install "volcontact[study]"')

FUNCTIONS = """\
import os, signal, time

def trial(values, rng):
    if values.get("fate") == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    if values.get("fate") == "hang":
        time.sleep(1000.0)
    if values.get("fate") == "raise":
        raise ValueError("this trial\\nis no good")
    time.sleep(values.get("sleep", 0.0))
    return {"sum": values["x"] + values["y"], "noise": rng.normal()}
"""
FUNCTION_STUDY = """\
[study]
name = "sums"
function = "trial"
python = "functions.py"
time_limit = 1.0
[vary.x]
distribution = "norm"
[vary.y]
distribution = "uniform"
low = 1.0
high = 3.0
[sample]
trials = 40
seed = 3
[record]
columns = ["sum", "noise"]
[success]
sum = [-inf, 2.5]
"""
SCENE = """\
<mujoco model="slide">
  <option timestep="0.001"/>
  <default>
    <default class="block"><geom size="0.05 0.05 0.02" density="1000"/></default>
  </default>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="block" pos="0 0 0.02">
      <freejoint/>
      <geom name="block" class="block" type="box"/>
    </body>
    <body name="wall" pos="0.3 0 0.05"><geom name="wall" type="box" size="0.01 0.2 0.05"/></body>
  </worldbody>
  <custom>
    <numeric name="volcontact/material/all/stiffness" data="1e8"/>
    <numeric name="volcontact/material/all/damping" data="5"/>
    <numeric name="volcontact/material/all/friction" data="0.3"/>
    <tuple name="volcontact/material/all">
      <element objtype="geom" objname="floor"/>
      <element objtype="geom" objname="block"/>
      <element objtype="geom" objname="wall"/>
    </tuple>
  </custom>
</mujoco>
"""
SCENE_STUDY = """\
[study]
name = "slide"
scene = "scene.xml"
[vary.friction]
distribution = "uniform"
low = 0.1
high = 0.5
target = "volcontact/material/all/friction"
[vary.height]
distribution = "norm"
mean = 0.02
std = 0.001
target = "geom/block/size/2"
[vary.speed]
distribution = "uniform"
low = 0.3
high = 1.5
target = "qvel/block/0"
[sample]
trials = 12
seed = 1
[end]
duration = 0.4
[success]
"position/block/x" = [0.08, 0.2]
"speed/block" = [0.0, 0.01]
[pose]
body = "block"
pos = [0.1, 0.0, 0.02]
[record]
final = { x = "position/block/x" }
peak = { fastest = "speed/block" }
[record.places]
floor = ["floor"]
wall = ["wall"]
"""


def function_study(folder: Path, text: str = FUNCTION_STUDY, **fates: float) -> Path:
    """The study of a function; with fates also an input `fate`, words and their weights."""
    (folder / "functions.py").write_text(FUNCTIONS)
    if fates:
        words = ", ".join(f'"{word}"' for word in fates)
        weights = ", ".join(str(weight) for weight in fates.values())
        text += f"[vary.fate]\nchoices = [{words}]\nweights = [{weights}]\n"
    path = folder / "study.toml"
    path.write_text(text)
    return path


def scene_study(folder: Path, text: str = SCENE_STUDY, scene: str = SCENE) -> Path:
    """The study of the sliding box."""
    (folder / "scene.xml").write_text(scene)
    path = folder / "study.toml"
    path.write_text(text)
    return path


def bits(table) -> list[bytes]:
    """Every column of a result as bytes, texts as they are."""
    columns = []
    for name in table.column_names:
        column = table[name]
        if str(column.type) == "string":
            columns.append(repr(column.to_pylist()).encode())
        else:
            columns.append(column.to_numpy().tobytes())
    return columns


# Programs of their own that need not import everything anew: forked from one that has.
_SERVER = multiprocessing.get_context("forkserver")
_SERVER.set_forkserver_preload(["volcontact.cli.study", "volcontact.study.driver", "scipy.stats"])


def start(*arguments: str, log: Path | None = None) -> multiprocessing.Process:
    """Starts the program `volcontact` in a process; `log` takes what it says on stderr."""
    process = _SERVER.Process(target=_program, args=(arguments, log))
    process.start()
    return process


def _program(arguments: tuple[str, ...], log: Path | None) -> None:
    from volcontact.cli import main

    with open(os.devnull if log is None else log, "wb") as file:
        os.dup2(file.fileno(), 2)
        os.dup2(file.fileno(), 1)
        sys.exit(main(list(arguments)))
