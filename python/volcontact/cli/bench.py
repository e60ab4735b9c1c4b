# SPDX-License-Identifier: Apache-2.0
"""`volcontact bench`: parameters straight from the data sheet of a bench test."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from rich.markup import escape
from rich.table import Table

from volcontact.cli.arguments import add_file, key, plain_command
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers
    from volcontact.identify.readings import Reading

TESTS = {
    "press": "stiffness, from force over depth",
    "drop": "damping or restitution, from bounce heights or times",
    "tilt": "static friction, from angles at which a sled breaks away",
    "pull": "friction at rest and at speeds, dwell time, Stribeck speed",
    "slip": "bristle stiffness and damping, from micro-slip loops",
    "roll": "rolling resistance, from how a body that rolls slows down",
    "spin": "friction against spin and its coupling",
}
_EXAMPLES = """\
  volcontact bench press --template > press.csv    a sheet to fill in
  volcontact bench press press.csv --out results
  volcontact bench pull pull.csv --given normal_force=12.3
  volcontact bench drop drop.csv --json
"""
_NOT_CONVERGED = 3


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = plain_command(
        commands,
        "bench",
        "read parameters off the data sheet of a bench test",
        _EXAMPLES + "\ntests:\n" + "".join(f"  {k:<8}{v}\n" for k, v in TESTS.items()),
    )
    parser.add_argument("test", choices=tuple(TESTS), metavar="TEST", help="see below")
    add_file(parser, "sheet", nargs="?", metavar="SHEET", help="CSV with units in its head")
    parser.add_argument(
        "--template", action="store_true", help="print a sheet to fill in, and read none"
    )
    parser.add_argument(
        "--given",
        type=key,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a constant of the sheet in SI, such as normal_force=9.81; may be repeated",
    )
    parser.add_argument(
        "--level", type=_level, default=0.95, help="of the intervals (default: %(default)s)"
    )
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="folder of the results (default: none are written)"
    )
    parser.add_argument("--no-report", action="store_true", help="write no report.html")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    parser.set_defaults(execute=execute, usage=parser.error)


def _level(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1.0:
        raise argparse.ArgumentTypeError(f"{text!r} must be a number above 0 and below 1")
    return value


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status: 3 when the regression did not converge."""
    from volcontact.identify import direct

    if arguments.template:
        text = direct.template(arguments.test)
        if terminal.json:
            terminal.result({"template": text})
        else:
            terminal.out.print(text, end="", markup=False, soft_wrap=True)
        return 0
    if arguments.sheet is None:
        arguments.usage("give the SHEET, or --template for one to fill in")
    found = direct.bench(
        arguments.test,
        arguments.sheet,
        arguments.out,
        given=dict(arguments.given),
        level=arguments.level,
        report=not arguments.no_report,
    )
    if terminal.json:
        terminal.result(found.as_dict())
    else:
        _tell(found, arguments.out, terminal)
    if not found.converged:
        terminal.warning("not converged: the regression ended at its limit of evaluations")
        return _NOT_CONVERGED
    return 0


def _tell(found: Reading, out: Path | None, terminal: Terminal) -> None:
    from volcontact.identify.direct.output import RESULT, row_of

    percent = f"{100 * found.level:g} % interval"
    table = Table("quantity", "value", percent, "unit", "", box=None, pad_edge=False)
    for name in found.values:
        table.add_row(*map(escape, row_of(name, found)))
    terminal.out.print(table)
    for line in found.findings:
        terminal.out.print(line, markup=False, style="bold")
    for line in found.validity:
        terminal.out.print(line, markup=False)
    lines = found.mjcf()
    if lines:
        terminal.out.print(lines, markup=False, soft_wrap=True)
    if out is not None:
        terminal.out.print(f"written to {out / RESULT}", markup=False, soft_wrap=True)
