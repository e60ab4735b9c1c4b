# SPDX-License-Identifier: Apache-2.0
"""`volcontact identify`: parameters of a scene from measured motions."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

from volcontact.cli.arguments import add_file, plain_command
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers

_EXAMPLES = """\
  volcontact identify study.toml --out results
  volcontact identify study.toml --check
  volcontact identify study.toml --measurements /data/tosses.parquet --out results
  volcontact identify study.toml --workers 1 --json
"""
_NOT_CONVERGED = 3
_SAY_EVERY = 30.0  # seconds, where there is no terminal


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = plain_command(
        commands, "identify", "find parameters of a scene from measured motions", _EXAMPLES
    )
    add_file(parser, "study", metavar="STUDY", help="identification file, TOML")
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("volcontact-identified"),
        metavar="DIR",
        help="folder of the results; an interrupted run goes on in it (default: %(default)s)",
    )
    add_file(
        parser,
        "--measurements",
        type=Path,
        action="append",
        metavar="FILE",
        help="CSV or Parquet, instead of the files that the study names; may be repeated",
    )
    parser.add_argument(
        "--check", action="store_true", help="check file, scene and measurements, and fit nothing"
    )
    parser.add_argument(
        "--workers", type=_whole, metavar="N", help="processes (default: one a core)"
    )
    parser.add_argument("--no-report", action="store_true", help="write no report.html")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    parser.set_defaults(execute=execute)


def _whole(text: str) -> int:
    if not text.isdecimal() or text == "0":
        raise argparse.ArgumentTypeError(f"{text!r} must be a whole number above 0")
    return int(text)


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status: 3 when the estimator did not converge."""
    from volcontact.identify.reading import read_settings
    from volcontact.identify.run import RESULT, check, run

    settings = read_settings(arguments.study, measurements=arguments.measurements)
    if arguments.check:
        found = check(settings)
        if terminal.json:
            terminal.result(found)
        else:
            _tell_check(found, terminal)
        return 0
    with _Bar(terminal) as bar:
        result = run(
            settings,
            arguments.out,
            workers=arguments.workers,
            progress=bar.move,
            report=not arguments.no_report,
        )
    if terminal.json:
        terminal.result({**result.summary, "result": str(arguments.out / RESULT)})
    else:
        _tell(result.summary, arguments.out / RESULT, terminal)
    if not result.converged:
        terminal.warning(f"not converged: {result.summary['reason']}")
        return _NOT_CONVERGED
    return 0


class _Bar:
    """How far a fit is: a bar, or, where the log is no terminal, a line now and then."""

    def __init__(self, terminal: Terminal) -> None:
        self._log, self._bars, self._said = terminal.log, terminal.progress(), time.monotonic()

    def __enter__(self) -> _Bar:
        self._move = self._bars.__enter__().task("evaluations")
        return self

    def __exit__(self, *error: Any) -> None:
        self._bars.__exit__(*error)

    def move(self, done: int, total: int, note: str) -> None:
        """Says how far it is."""
        self._move(done, total, note)
        now = time.monotonic()
        if not self._log.is_terminal and now - self._said > _SAY_EVERY:
            self._said = now
            self._log.print(f"{done} of {total}, {note}", markup=False, soft_wrap=True)


def _tell_check(found: dict[str, Any], terminal: Terminal) -> None:
    table = Table("", found["name"], box=None, pad_edge=False)
    table.add_row("trials of the fit", str(found["fit"]))
    table.add_row("trials to judge on", str(found["judge"]))
    table.add_row("samples", str(found["samples"]))
    for name, value in found["start"].items():
        table.add_row(f"{escape(name)} begins at", f"{value:.6g}")
    terminal.out.print(table)


def _tell(summary: dict[str, Any], file: Path, terminal: Terminal) -> None:
    percent = f"{100 * summary['level']:g} % interval"
    table = Table("parameter", "value", percent, box=None, pad_edge=False)
    for name, each in summary["parameters"].items():
        low, high = ("" if end is None else f"{end:.4g}" for end in (each["low"], each["high"]))
        table.add_row(escape(name), f"{each['value']:.6g}", f"{low} to {high}")
    terminal.out.print(table)
    for word, title in (("fit", "error on the fit"), ("judge", "error on trials not used")):
        for name, each in summary.get(word, {}).items():
            line = f"{title}: {name} {each['mean']:.4g} {each['unit']}, median {each['median']:.4g}"
            terminal.out.print(line, markup=False)
    for line in summary["findings"]:
        terminal.out.print(line, markup=False, style="bold")
    terminal.out.print(f"written to {file}", markup=False, soft_wrap=True)
