# SPDX-License-Identifier: Apache-2.0
"""`volcontact converge`: what the step costs, figure by figure."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from rich.markup import escape
from rich.table import Table

from volcontact._files import appearing
from volcontact.cli.arguments import add_command, add_drive, add_keys, add_time, drive_of, positive
from volcontact.cli.status import print_notes, report_warnings
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers
    from volcontact.cli.terminal import ProgressBars
    from volcontact.convergence import Convergence
    from volcontact.running.recording import Recording

_EXAMPLES = """\
  volcontact converge scene.xml
  volcontact converge scene.xml --duration 2 --levels 6 --out convergence.json
  volcontact converge scene.xml --quantities force penetration --within 0.001
  volcontact converge scene.xml --contact native --json
"""
_FEWEST = 3


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = add_command(
        commands,
        "converge",
        "run a scene at its step, at half of it and so on, and say what the step costs",
        _EXAMPLES,
    )
    add_time(parser, duration=3.0)
    add_drive(parser)
    add_keys(parser)
    parser.add_argument(
        "--levels",
        type=_levels,
        default=5,
        metavar="N",
        help="runs, each at half the step of the one before (default: %(default)s)",
    )
    parser.add_argument(
        "--quantities",
        nargs="+",
        default=[],
        metavar="WORD",
        help="figures whose name has one of these words (default: all)",
    )
    parser.add_argument(
        "--within",
        type=positive,
        default=0.01,
        metavar="SHARE",
        help="relative error that is asked of a figure (default: %(default)s)",
    )
    parser.add_argument(
        "--contact",
        choices=("volumetric", "native"),
        default="volumetric",
        help="kind of contact (default: %(default)s)",
    )
    parser.add_argument(
        "--out", type=Path, metavar="FILE", help="write all of it as JSON into this file"
    )
    parser.set_defaults(execute=execute)


def _levels(text: str) -> int:
    if not (text.isdecimal() and _FEWEST <= int(text) <= 12):
        raise argparse.ArgumentTypeError(f"{text!r} must be a whole number from {_FEWEST} to 12")
    return int(text)


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    from volcontact.convergence import converge

    with terminal.progress() as bars:
        tasks: dict[str, object] = {}

        def told(done: int, total: int, name: str) -> None:
            if name not in tasks:
                tasks[name] = bars.task(f"step {name}" if name[0] == "1" else name)
            tasks[name](done, total)  # type: ignore[operator]

        found = converge(
            arguments.scene,
            duration=arguments.duration,
            timestep=arguments.timestep,
            levels=arguments.levels,
            within=arguments.within,
            contact=arguments.contact,
            quantities=arguments.quantities,
            material=dict(arguments.material),
            options=dict(arguments.option),
            drive=drive_of(arguments),
            progress=told,
        )
    if arguments.out is not None:
        text = json.dumps(found.summary(), indent=2, allow_nan=False) + "\n"
        with appearing(arguments.out) as part:
            part.write_text(text, encoding="utf-8")
    if terminal.json:
        terminal.result(found.summary())
    else:
        print_estimates(found, terminal)
        if arguments.out is not None:
            terminal.out.print(f"written to {arguments.out}", markup=False)
    print_notes(found.runs, terminal)
    return report_warnings(found.runs, terminal)


def error_of_step(
    arguments: argparse.Namespace, bars: ProgressBars, first: Recording
) -> Convergence:
    """For `--error` of other commands: two runs more, at a half and a quarter of the step."""
    from volcontact.convergence import converge

    task = bars.task("error of the step")
    return converge(
        arguments.scene,
        duration=arguments.duration,
        timestep=arguments.timestep,
        levels=_FEWEST,
        contact=first.contact,
        material=dict(arguments.material),
        options=dict(arguments.option),
        drive=drive_of(arguments),
        with_tolerance=False,
        first=first,
        progress=lambda done, total, _: task(done, total),
    )


def print_estimates(found: Convergence, terminal: Terminal) -> None:
    """The table, and what it says in words."""
    from volcontact.report import step_error

    table = Table(box=None, pad_edge=False)
    table.add_column("", min_width=18)
    for head in step_error.heads(found):
        table.add_column(head, no_wrap=True)
    for row in step_error.rows(found):
        table.add_row(*map(escape, row))
    terminal.out.print(table)
    for line in step_error.sentences(found):
        terminal.out.print(line, markup=False)
