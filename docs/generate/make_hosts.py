# SPDX-License-Identifier: Apache-2.0
"""Runs the two scenes in every simulator of python/examples/hosts, and draws what it saw.

`./run python docs/generate/make_hosts.py` writes tests/benchmarks/results/hosts.json, the tables of
docs/hosts/ and the pictures there, in a minute or two; it needs the simulators, which `./run test`
installs. `--diagram` draws the picture of docs/simulink.md alone.
"""

from __future__ import annotations

import json
import sys
import time
from functools import partial
from importlib.metadata import version
from pathlib import Path

import make_blocks
import mujoco
import numpy as np
from make_concepts import Drawn, save
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from parts.hosts_diagram import block_diagram

from volcontact.report.palette import NATIVE, VOLUMETRIC

DOCS = Path(__file__).parents[1]
PICTURES = DOCS / "hosts"
RESULT = DOCS.parent / "tests" / "benchmarks" / "results" / "hosts.json"
sys.path.insert(0, str(DOCS.parent / "tests" / "python" / "support"))

from host_runs import HOSTS, Run, in_host, in_mujoco  # noqa: E402 (the path comes first)

SCENES = ("ball_in_cylinder", "tippe_top")
PACKAGE = {"scipy": "scipy", "drake": "drake", "dart": "dartpy", "basilisk": "bsk"}
UNDER = {"color": "#c9d2dc", "lw": 4.0, "label": "MuJoCo"}


def measure() -> dict:
    """Events of every host and of MuJoCo, and how long each run took."""
    found = {
        "mujoco": mujoco.__version__,
        "reference": {name: in_mujoco(name).events for name in SCENES},
        "hosts": {},
    }
    for host in HOSTS:
        seconds = {}
        for name in SCENES:
            start = time.process_time()
            in_host(host, name)
            seconds[name] = round(time.process_time() - start, 1)
        found["hosts"][host] = {
            "version": f"{PACKAGE[host]} {version(PACKAGE[host])}",
            "seconds": seconds,
            "events": {name: in_host(host, name).events for name in SCENES},
        }
    return found


def numbers(found: dict, host: str) -> list[float]:
    """What a picture shows: the events of a host and of MuJoCo."""
    both = found["reference"], found["hosts"][host]["events"]
    return [time for events in both for name in SCENES for time in events[name].values()]


def picture(found: dict, host: str) -> Drawn:
    """The way of the ball, and the tilt of the top, over MuJoCo's."""
    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.15))
    label = found["hosts"][host]["version"]
    draw_ball(left, in_mujoco(SCENES[0]), in_host(host, SCENES[0]), label)
    draw_top(right, in_mujoco(SCENES[1]), in_host(host, SCENES[1]), label)
    return figure, numbers(found, host)


def draw_ball(axes: Axes, reference: Run, run: Run, label: str) -> None:
    """Seen along the bore."""
    angle = np.linspace(np.pi, 2.0 * np.pi, 200)
    axes.plot(np.cos(angle), np.sin(angle), color="#30363d", lw=1.0)
    for one, style in ((reference, UNDER), (run, {"color": VOLUMETRIC, "lw": 1.2, "label": label})):
        axes.plot(one.poses[:, 0, 3], one.poses[:, 2, 3], **style)
    touch = [np.interp(run.events["touches"], run.times, run.poses[:, i, 3]) for i in (0, 2)]
    axes.plot(*touch, "o", color=NATIVE, ms=5)
    axes.annotate(f"touches,\n{run.events['touches']:.6f} s", touch, (-0.35, -0.45), color=NATIVE)
    axes.set(aspect="equal", xlabel="x [m]", ylabel="z [m]", title="Ball in a cylinder, 4 s")


def draw_top(axes: Axes, reference: Run, run: Run, label: str) -> None:
    """Its tilt, with the events of the host."""
    for one, style in ((reference, UNDER), (run, {"color": VOLUMETRIC, "lw": 1.2, "label": label})):
        tilt = np.degrees(np.arccos(np.clip(one.poses[:, 2, 2], -1.0, 1.0)))
        axes.plot(one.times, tilt, **style)
    for event, time_of in run.events.items():
        axes.axvline(time_of, color=NATIVE, lw=0.8, ls=":")
        place, end = (175.0, "top") if event == "upright" else (5.0, "bottom")
        axes.annotate(
            f"{event}, {time_of:.3f} s", (time_of, place), (-3, 0), textcoords="offset points",
            rotation=90, ha="right", va=end, fontsize=8, color=NATIVE,
        )  # fmt: skip
    axes.set(xlabel="time [s]", ylabel="tilt [degree]", ylim=(0, 180), title="Tippe-top")
    axes.legend(loc="center left", bbox_to_anchor=(0.16, 0.5), fontsize=8)


def main() -> None:
    """Measures, fills the tables and draws."""
    PICTURES.mkdir(exist_ok=True)
    save({"simulink": block_diagram}, PICTURES)
    if "--diagram" in sys.argv:
        return
    found = measure()
    RESULT.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    save({host: partial(picture, found, host) for host in HOSTS}, PICTURES)
    for page in (DOCS / "hosts.md", *PICTURES.glob("*.md")):
        page.write_text(make_blocks.render(page.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
