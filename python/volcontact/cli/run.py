# SPDX-License-Identifier: Apache-2.0
"""`volcontact run`: steps a scene and says how it ended."""

from __future__ import annotations

import argparse
import contextlib
import json
from pathlib import Path
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from rich.markup import escape
from rich.table import Table

import volcontact
from volcontact._files import appearing_in
from volcontact.cli.arguments import add_command, add_drive, add_keys, add_time, drive_of
from volcontact.cli.status import print_notes, report_warnings
from volcontact.cli.terminal import Terminal
from volcontact.report.units import digits, quantity

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers
    from volcontact.running.audit import Audit

_EXAMPLES = """\
  volcontact run scene.xml
  volcontact run scene.xml --duration 2 --timestep 5e-4 --out results
  volcontact run scene.xml --contact native --json
  volcontact run scene.xml --keyframe above --ctrl push=5,grip=0.2
  volcontact run scene.xml --controls motion.csv --out results --plot peg.force_z:peg.z
  volcontact run scene.xml --audit
"""
_PAIRS_NAMED = 3


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = add_command(
        commands, "run", "step a scene under one kind of contact and say how it ended", _EXAMPLES
    )
    add_time(parser, duration=3.0)
    add_drive(parser)
    add_keys(parser)
    parser.add_argument(
        "--contact",
        choices=("volumetric", "native"),
        default="volumetric",
        help="kind of contact (default: %(default)s)",
    )
    parser.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        help="write summary.json, trajectory and sites into this folder; those of an earlier "
        "report are replaced",
    )
    parser.add_argument(
        "--audit",
        action="store_true",
        help="say in which step contact created the most energy, and where",
    )
    parser.add_argument(
        "--plot",
        action="append",
        default=[],
        metavar="Y[:X]",
        help="with --out, a curve as SVG and PNG: a column of the trajectory over time, or over "
        "another one; may be repeated",
    )
    parser.add_argument(
        "--error",
        action="store_true",
        help="estimate the error of the time step from two more runs, at a half and a quarter "
        "of it",
    )
    parser.set_defaults(execute=execute)


def _audit_text(audit: Audit) -> str:
    if not audit.made > 0.0:
        return "none"
    text = f"{quantity(audit.made, 'J')} at {digits(audit.time)} s"
    if np.isfinite(audit.share):
        text += f", {digits(audit.share)} of what moved"
    if audit.geoms:
        named = ", ".join(f"{a} on {b}" for a, b in audit.geoms[:_PAIRS_NAMED])
        more = len(audit.geoms) - _PAIRS_NAMED
        text += f"; {named}" + (f" and {more} more pairs" if more > 0 else "")
    return text


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    from volcontact.report import files
    from volcontact.report.comparison import run_summary
    from volcontact.report.design_pose import read_design_pose
    from volcontact.running.simulation import simulate

    if arguments.plot and arguments.out is None:
        raise ValueError("--plot draws into the folder of --out DIR: name one")
    design = read_design_pose(arguments.scene)
    with contextlib.ExitStack() as stack:
        # Before the run, so that a place that cannot be written to says so at once.
        folder = None
        if arguments.out is not None:
            folder = stack.enter_context(appearing_in(arguments.out, files.ALL))
        bars = stack.enter_context(terminal.progress())
        recording = simulate(
            arguments.scene,
            contact=arguments.contact,
            duration=arguments.duration,
            timestep=arguments.timestep,
            material=dict(arguments.material),
            options=dict(arguments.option),
            drive=drive_of(arguments),
            follow=() if design is None else (design.body,),
            frame_interval=None,
            progress=bars.task(f"{arguments.contact} contact"),
        )
        summary = {
            arguments.contact: run_summary(recording, design),
            "mujoco_version": mujoco.mj_versionString(),
            "volcontact_version": volcontact.__version__,
        }
        if folder is not None:
            from volcontact.report.table import write_table

            text = json.dumps(summary, indent=2, allow_nan=False) + "\n"
            (folder / files.SUMMARY).write_text(text, encoding="utf-8")
            write_table((recording,), folder / files.TRAJECTORY)
            if arguments.plot:
                from volcontact.report.figures import write_figures
                from volcontact.report.plots import plots_of_run

                write_figures(plots_of_run(recording, arguments.plot), folder / files.FIGURES)
    found = None
    if arguments.error:
        from volcontact.cli.converge import error_of_step, print_estimates

        with terminal.progress() as bars:
            found = error_of_step(arguments, bars, recording)
        summary["error_of_step"] = found.summary()
    if terminal.json:
        terminal.result(summary)
    else:
        from volcontact.report.closing import closing
        from volcontact.report.key_figures import key_figures

        table = Table("", arguments.contact, box=None, pad_edge=False)
        for name, text in key_figures(recording, design):
            table.add_row(escape(name), escape(text))
        if arguments.audit:
            table.add_row("Most energy made in a step", escape(_audit_text(recording.audit())))
        terminal.out.print(table)
        if found is not None:
            terminal.out.print()
            print_estimates(found, terminal)
        terminal.out.print()
        for line in closing(recording, design):
            terminal.out.print(line, markup=False, soft_wrap=True)
        if arguments.out is not None:
            terminal.out.print(f"written to {arguments.out}", markup=False)
    print_notes((recording,), terminal)
    more = () if found is None else found.runs[1:]
    return report_warnings((recording, *more), terminal)
