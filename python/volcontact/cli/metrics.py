# SPDX-License-Identifier: Apache-2.0
"""`volcontact metrics`: the overlap of two solids, or all contact sites of a scene."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from rich.box import SIMPLE_HEAD
from rich.markup import escape
from rich.table import Table

import volcontact
from volcontact.cli.arguments import add_file, add_keyframe, plain_command, positive
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers

_EXAMPLES = """\
  volcontact metrics scene.xml                     contact sites at the start
  volcontact metrics scene.xml --time 2            the same after two seconds
  volcontact metrics scene.xml --keyframe seated   at a keyframe
  volcontact metrics box:half_sizes=0.1,0.1,0.1 sphere:radius=0.05 --at 0 0 0.149
  volcontact metrics hole.stl peg.stl --at 0 0 0.01 --turn 0 0 30 --json
"""
_SCENES = (".xml", ".mjb", ".urdf")


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = plain_command(
        commands,
        "metrics",
        "print volume, area, depth and forces of the contact sites of a scene, or the overlap of "
        "two solids",
        _EXAMPLES,
    )
    add_file(
        parser,
        "what",
        nargs="+",
        metavar="SCENE | A B",
        help="MJCF file; or two solids, each a mesh file or as in the examples",
    )
    parser.add_argument("--time", type=positive, metavar="S", help="simulate this long first [s]")
    add_keyframe(parser)
    parser.add_argument(
        "--at",
        type=float,
        nargs=3,
        default=[0.0, 0.0, 0.0],
        metavar=("X", "Y", "Z"),
        help="position of B in the frame of A [m]",
    )
    parser.add_argument(
        "--turn",
        type=float,
        nargs=3,
        default=[0.0, 0.0, 0.0],
        metavar=("RX", "RY", "RZ"),
        help="rotation of B about the axes of A, x first [degree]",
    )
    parser.add_argument(
        "--tolerance",
        type=positive,
        default=1e-3,
        metavar="E",
        help="requested relative error of the volume of two solids (default: %(default)s)",
    )
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    what: list[str] = arguments.what
    if len(what) == 1:
        if Path(what[0]).suffix.lower() not in _SCENES:
            raise ValueError(f"{what[0]}: one solid overlaps nothing; give a scene or two solids")
        _print_scene(what[0], arguments.time, arguments.keyframe, terminal)
        return 0
    if len(what) != 2 or arguments.time is not None or arguments.keyframe is not None:
        raise ValueError("give one scene, with --time and --keyframe if wanted, or two solids")
    from volcontact.typed_solids import pose, solid

    found = volcontact.interference(
        solid(what[0]),
        solid(what[1]),
        pose(arguments.at, arguments.turn),
        tolerance=arguments.tolerance,
    )
    _print_overlap(found, terminal)
    return 0


def _print_overlap(found: volcontact.Interference, terminal: Terminal) -> None:
    rows = [_of_metrics(site) for site in found.sites]
    total = _of_metrics(found)
    if terminal.json:
        terminal.result({"engine": found.engine, "total": total, "sites": rows})
        return
    if not found.touching:
        bounded = found.status == "ok"
        terminal.out.print(
            "the solids do not overlap" if bounded else f"no finite overlap: {found.status}"
        )
        return
    terminal.out.print(f"engine {found.engine}, status {found.status}, in the frame of A")
    columns = [total, *rows] if len(rows) > 1 else [total]
    names = ["all", *(f"site {i}" for i in range(len(rows)))]
    _print_table(names, columns, terminal)


def _of_metrics(metrics: volcontact.VolumeMetrics) -> dict[str, Any]:
    return {
        "volume [m^3]": metrics.volume,
        "volume error [m^3]": metrics.volume_error,
        "centroid [m]": metrics.centroid.tolist(),
        "normal [-]": metrics.normal.tolist(),
        "area of A inside B [m^2]": metrics.area,
        "area of B inside A [m^2]": metrics.counter_area,
        "projected area [m^2]": float(np.linalg.norm(metrics.area_vector)),
        "depth [m]": metrics.depth,
        "flatness [-]": metrics.flatness,
    }


def _print_scene(scene: str, time: float | None, keyframe: str | None, terminal: Terminal) -> None:
    from volcontact.running.driving import to_keyframe

    model = volcontact.load(scene)
    data = mujoco.MjData(model)
    to_keyframe(model, data, keyframe)
    with volcontact.attach(model) as contact:
        steps = round((time or 0.0) / model.opt.timestep)
        with terminal.progress() as bars:
            move = bars.task("steps")
            for i in range(steps):
                mujoco.mj_step(model, data)
                if i % 100 == 0:
                    move(i, steps)
        mujoco.mj_forward(model, data)
        sites = contact.sites(data)
        rows = [_of_site(model, site) for site in sites]
        energy = contact.energy(data)
    if terminal.json:
        terminal.result(
            {
                "time": data.time,
                "sites": rows,
                "elastic_energy": energy.elastic,
                "dissipated_energy": energy.dissipated,
            }
        )
        return
    terminal.out.print(f"t = {data.time:g} s: " + ("nothing touches" if not rows else ""))
    if rows:
        _print_table([f"site {i}" for i in range(len(rows))], rows, terminal)


def _of_site(model: mujoco.MjModel, site: np.void) -> dict[str, Any]:
    def name(geom: int) -> str:
        kind = int(mujoco.mjtObj.mjOBJ_GEOM)
        return mujoco.mj_id2name(model, kind, int(geom)) or f"geom {geom}"

    return {
        "geoms": f"{name(site['geom_a'])}, {name(site['geom_b'])}",
        "status": _STATUS[int(site["status"])],
        "volume [m^3]": float(site["volume"]),
        "depth [m]": float(site["depth"]),
        "area [m^2]": float(site["area"]),
        "centroid [m]": site["centroid"].tolist(),
        "normal [-]": site["normal"].tolist(),
        "normal force [N]": float(site["normal_force"]),
        "force on the first [N]": site["force"].tolist(),
        "torque on the first [N m]": site["torque"].tolist(),
        "slip [m/s]": float(site["slip"]),
        "elastic energy [J]": float(site["elastic_energy"]),
    }


_STATUS = ("ok", "contained", "approximate", "unbounded", "invalid")


def _print_table(names: list[str], columns: list[dict[str, Any]], terminal: Terminal) -> None:
    """Sites side by side, as many as the terminal is wide for, one block below the other."""
    across = max(1, (terminal.out.width - 28) // 32)
    for first in range(0, len(columns), across):
        table = Table("", *names[first : first + across], box=SIMPLE_HEAD)
        for key in columns[0]:
            cells = (_text(column[key]) for column in columns[first : first + across])
            table.add_row(escape(key), *(escape(cell) for cell in cells))
        terminal.out.print(table)


def _text(value: object) -> str:
    if isinstance(value, list):
        return " ".join(f"{x:.4g}" for x in value)
    return value if isinstance(value, str) else f"{value:.6g}"
