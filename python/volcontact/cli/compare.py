# SPDX-License-Identifier: Apache-2.0
"""`volcontact compare`: volumetric beside native contact, and the report."""

from __future__ import annotations

import argparse
import contextlib
from pathlib import Path
from typing import TYPE_CHECKING

import mujoco
from rich.markup import escape
from rich.padding import Padding
from rich.table import Table

import volcontact
from volcontact._files import appearing_in
from volcontact.cli.arguments import (
    add_command,
    add_drive,
    add_keys,
    add_time,
    drive_of,
    pixels,
    positive,
)
from volcontact.cli.status import print_notes, report_warnings
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers
    from volcontact.render import Renderer
    from volcontact.report import Comparison

_EXAMPLES = """\
  volcontact compare scene.xml
  volcontact compare scene.xml --duration 3 --out report
  volcontact compare scene.xml --frame-interval 0.1 --width 960 --height 720 --camera side
  volcontact compare scene.xml --material stiffness=1e9 --option mesh=exact_or_hull
  volcontact compare scene.xml --ctrl push=5 --keyframe above --plot peg.force_z:peg.z
  volcontact compare scene.xml --no-frames --json
"""


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = add_command(
        commands,
        "compare",
        "run a scene under volumetric and under native contact and write a report",
        _EXAMPLES,
    )
    add_time(parser, duration=3.0)
    add_drive(parser)
    add_keys(parser)
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("volcontact-report"),
        metavar="DIR",
        help="folder of the report (default: %(default)s)",
    )
    parser.add_argument(
        "--frame-interval",
        type=positive,
        default=0.2,
        metavar="S",
        help="simulated time between two pictures [s] (default: %(default)s)",
    )
    parser.add_argument(
        "--width", type=pixels, default=800, metavar="PX", help="of a picture (default: 800)"
    )
    parser.add_argument(
        "--height", type=pixels, default=600, metavar="PX", help="of a picture (default: 600)"
    )
    parser.add_argument("--camera", metavar="NAME", help="camera of the scene (default: its first)")
    parser.add_argument(
        "--force-limit",
        type=positive,
        metavar="N",
        help="largest force that one contact may carry [N]",
    )
    parser.add_argument(
        "--torque-limit",
        type=positive,
        metavar="NM",
        help="largest torque of one contact about its own position [N m]",
    )
    parser.add_argument(
        "--no-frames", action="store_true", help="make no pictures (then OpenGL is not needed)"
    )
    parser.add_argument(
        "--plot",
        type=str,
        action="append",
        default=[],
        metavar="Y[:X]",
        help="one more curve: a column of the trajectory over time, or over another one, such as "
        "shaft.force_z:joint.press.position; may be repeated",
    )
    parser.add_argument(
        "--error",
        action="store_true",
        help="estimate the error of the time step under volumetric contact, from two more runs",
    )
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    from volcontact.cli.converge import error_of_step, print_estimates
    from volcontact.report import Comparison, Limits, files, fill_report
    from volcontact.report.design_pose import read_design_pose, read_peak_limits
    from volcontact.running.simulation import simulate

    drive = drive_of(arguments)
    with contextlib.ExitStack() as stack:
        design = read_design_pose(arguments.scene)
        limits = Limits(
            arguments.force_limit, arguments.torque_limit, read_peak_limits(arguments.scene)
        )
        # Before the runs, so that a place that cannot be written to says so at once, and a machine
        # without OpenGL.
        folder = stack.enter_context(appearing_in(arguments.out, files.ALL))
        renderer = None if arguments.no_frames else stack.enter_context(_renderer(arguments))
        bars = stack.enter_context(terminal.progress())
        volumetric, native = (
            simulate(
                arguments.scene,
                contact=contact,
                duration=arguments.duration,
                timestep=arguments.timestep,
                material=dict(arguments.material),
                options=dict(arguments.option),
                drive=drive,
                follow=() if design is None else (design.body,),
                frame_interval=arguments.frame_interval,
                progress=bars.task(f"{contact} contact"),
            )
            for contact in ("volumetric", "native")
        )
        found = error_of_step(arguments, bars, volumetric) if arguments.error else None
        comparison = Comparison(
            scene=arguments.scene,
            volumetric=volumetric,
            native=native,
            design=design,
            mujoco_version=mujoco.mj_versionString(),
            volcontact_version=volcontact.__version__,
            limits=limits,
            error_of_step=found,
            plots=tuple(arguments.plot),
        )
        fill_report(
            comparison,
            folder,
            renderer=renderer,
            camera=arguments.camera,
            progress=bars.task("pictures"),
        )
    report = arguments.out / files.REPORT
    if terminal.json:
        terminal.result({**comparison.summary(), "report": str(report)})
    else:
        _print(comparison, report, terminal)
        if found is not None:
            terminal.out.print()
            print_estimates(found, terminal)
    print_notes(comparison.runs, terminal)
    more = () if found is None else found.runs[1:]
    return report_warnings((*comparison.runs, *more), terminal)


def _renderer(arguments: argparse.Namespace) -> Renderer:
    from volcontact.render import Renderer, camera_id
    from volcontact.running.simulation import native_model

    model = native_model(arguments.scene)
    if arguments.camera is not None:
        camera_id(model, arguments.camera)  # an unknown one is an error now, not after the runs
    return Renderer(model, width=arguments.width, height=arguments.height)


def _print(comparison: Comparison, report: Path, terminal: Terminal) -> None:
    from volcontact.report.closing import closing_of_two
    from volcontact.report.findings import findings
    from volcontact.report.key_figures import key_figures_side_by_side

    table = Table("", "volumetric", "native", box=None, pad_edge=False)
    for row in key_figures_side_by_side(comparison):
        table.add_row(*map(escape, (row.name, row.volumetric, row.native)))
    terminal.out.print(table)
    colors = {"good": "green", "bad": "red", "plain": "bold"}
    for finding in findings(comparison):
        terminal.out.print()
        terminal.out.print(f"[{colors[finding.verdict]}]{escape(finding.title)}[/]")
        terminal.out.print(Padding(escape(finding.text), (0, 0, 0, 2)))
    terminal.out.print()
    for line in closing_of_two(comparison):
        terminal.out.print(line, markup=False, soft_wrap=True)
    terminal.out.print(f"report: {report}", markup=False, soft_wrap=True)
