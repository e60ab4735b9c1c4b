# SPDX-License-Identifier: Apache-2.0
"""`volcontact study`: runs and checks studies, says how far they are, replays their trials."""

from __future__ import annotations

import argparse
import contextlib
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

from volcontact.cli.arguments import add_file, plain_command, positive
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers

_EXAMPLES = """\
  volcontact study check study.toml
  volcontact study run study.toml --out results
  volcontact study status results
"""
_RUN_EXAMPLES = """\
  volcontact study run study.toml --out results
  volcontact study run study.toml --engine serial --trials 20 --seed 7 --out few
  volcontact study run study.toml --engine ray --address auto --out results
  volcontact study run study.toml --engine dask --address tcp://10.0.0.1:8786 --out results
"""
_CHECK_EXAMPLES = """\
  volcontact study check study.toml
  volcontact study check study.toml --picture inputs.svg
"""
_RESUME_EXAMPLES = """\
  volcontact study resume results
  volcontact study resume results --engine processes --workers 2
"""
_STATUS_EXAMPLES = """\
  volcontact study status results
  volcontact study status results --json
"""
_REPLAY_EXAMPLES = """\
  volcontact study replay results 17
  volcontact study replay results 17 --record trial17
  volcontact study replay results 17 --report trial17 --frame-interval 0.05
  volcontact study replay results 17 --view
"""
_REPORT_EXAMPLES = """\
  volcontact study report results
  volcontact study report results --out report.html --map friction --map angle
"""
_DIFFERS = 3
_SAY_EVERY = 30.0  # seconds, where there is no terminal


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = plain_command(
        commands, "study", "run thousands of trials of a scene over what varies", _EXAMPLES
    )
    ways = parser.add_subparsers(metavar="COMMAND", required=True)
    _add_run(ways)
    _add_check(ways)
    _add_resume(ways)
    _add_status(ways)
    _add_replay(ways)
    _add_report(ways)


def _whole(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} must be a whole number")
    return int(text)


def _add_json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print the result as JSON")


def _add_engine(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--engine",
        choices=("serial", "processes", "ray", "dask"),
        default="processes",
        help="what runs the trials; the results are the same (default: %(default)s)",
    )
    parser.add_argument(
        "--workers", type=_whole, metavar="N", help="trials at a time (default: one a core)"
    )
    parser.add_argument("--address", help="of a running Ray or Dask cluster")


def _add_run(ways: Subparsers) -> None:
    parser = plain_command(ways, "run", "run all trials of a study", _RUN_EXAMPLES)
    add_file(parser, "study", metavar="STUDY", help="study file, TOML")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder of the rows")
    parser.add_argument("--trials", type=_whole, metavar="N", help="instead of those of the file")
    parser.add_argument("--seed", type=_whole, metavar="S", help="instead of that of the file")
    _add_engine(parser)
    _add_json(parser)
    parser.set_defaults(execute=run)


def _add_check(ways: Subparsers) -> None:
    parser = plain_command(
        ways, "check", "check a study and show what it would draw, running nothing", _CHECK_EXAMPLES
    )
    add_file(parser, "study", metavar="STUDY", help="study file, TOML")
    parser.add_argument("--trials", type=_whole, metavar="N", help="instead of those of the file")
    parser.add_argument("--seed", type=_whole, metavar="S", help="instead of that of the file")
    add_file(
        parser, "--picture", type=Path, metavar="FILE", help="draw the sampled inputs, SVG or PNG"
    )
    _add_json(parser)
    parser.set_defaults(execute=check)


def _add_resume(ways: Subparsers) -> None:
    parser = plain_command(ways, "resume", "run the trials that have no row yet", _RESUME_EXAMPLES)
    parser.add_argument("out", type=Path, metavar="DIR", help="folder of the study")
    _add_engine(parser)
    _add_json(parser)
    parser.set_defaults(execute=resume)


def _add_status(ways: Subparsers) -> None:
    parser = plain_command(ways, "status", "say how far a study is", _STATUS_EXAMPLES)
    parser.add_argument("out", type=Path, metavar="DIR", help="folder of the study")
    _add_json(parser)
    parser.set_defaults(execute=status)


def _add_replay(ways: Subparsers) -> None:
    parser = plain_command(
        ways, "replay", "run one trial again, to the same bits", _REPLAY_EXAMPLES
    )
    parser.add_argument("out", type=Path, metavar="DIR", help="folder of the study")
    parser.add_argument("trial", type=_whole, metavar="TRIAL", help="its number")
    parser.add_argument(
        "--record",
        type=Path,
        metavar="FOLDER",
        help="write states, energies and contact sites of every look",
    )
    parser.add_argument(
        "--report",
        type=Path,
        metavar="FOLDER",
        help="write report.html, a film and all numbers, beside the trial under native contact",
    )
    parser.add_argument(
        "--frame-interval",
        type=positive,
        default=0.2,
        metavar="T",
        help="time between two pictures of the report [s] (default: %(default)s)",
    )
    parser.add_argument(
        "--no-frames", action="store_true", help="make no pictures (then OpenGL is not needed)"
    )
    parser.add_argument("--view", action="store_true", help="show it in MuJoCo's window")
    parser.add_argument("--browser", action="store_true", help="show it in the browser, by viser")
    _add_json(parser)
    parser.set_defaults(execute=replay)


def _add_report(ways: Subparsers) -> None:
    parser = plain_command(
        ways, "report", "write probabilities, maps, indices and the worst trials", _REPORT_EXAMPLES
    )
    parser.add_argument("out", type=Path, metavar="DIR", help="folder of the study")
    parser.add_argument(
        "--out", dest="file", type=Path, metavar="FILE", help="(default: DIR/report.html)"
    )
    parser.add_argument(
        "--map",
        action="append",
        default=[],
        metavar="INPUT",
        help="map over pairs of these inputs (default: the four that decide most)",
    )
    parser.add_argument("--no-pictures", action="store_true", help="draw no worst trials")
    _add_json(parser)
    parser.set_defaults(execute=report)


def report(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs `study report`."""
    from volcontact.study.report import write_study_report

    file = arguments.file or arguments.out / "report.html"
    write_study_report(
        arguments.out, file, inputs=tuple(arguments.map), pictures=not arguments.no_pictures
    )
    if terminal.json:
        terminal.result({"report": str(file)})
    else:
        terminal.out.print(f"written to {file}", markup=False)
    return 0


def run(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs `study run`."""
    from volcontact.study import Study

    study = Study(arguments.study, trials=arguments.trials, seed=arguments.seed)
    with _Bar(terminal) as bar:
        study.run(
            arguments.out,
            engine=arguments.engine,
            workers=arguments.workers,
            address=arguments.address,
            progress=bar.move,
        )
    return _tell(arguments.out, terminal)


def resume(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs `study resume`."""
    from volcontact.study import Study

    with _Bar(terminal) as bar:
        Study.resume(
            arguments.out,
            engine=arguments.engine,
            workers=arguments.workers,
            address=arguments.address,
            progress=bar.move,
        )
    return _tell(arguments.out, terminal)


def check(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs `study check`."""
    from volcontact.study import Study
    from volcontact.study.plans import Plan

    study = Study(arguments.study, trials=arguments.trials, seed=arguments.seed)
    values = study.check()
    trials = Plan(study.settings).trials
    summary: dict[str, Any] = {
        "name": study.settings.name,
        "method": study.settings.sample.method,
        "trials": trials,
        "inputs": {
            name: {"least": min(column.tolist()), "most": max(column.tolist())}
            for name, column in values.items()
        },
    }
    if arguments.picture is not None:
        from volcontact.study.figures import draw_inputs

        draw_inputs(values, arguments.picture)
    if terminal.json:
        terminal.result(summary)
        return 0
    terminal.out.print(f"{study.settings.name}: {summary['method']}, {trials} trials", markup=False)
    table = Table("input", "least", "most", box=None, pad_edge=False)
    for name, ends in summary["inputs"].items():
        table.add_row(escape(name), *(escape(_short(ends[key])) for key in ("least", "most")))
    terminal.out.print(table)
    return 0


def status(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs `study status`."""
    return _tell(arguments.out, terminal)


def replay(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs `study replay`."""
    from volcontact.study.replay import replay_trial

    done = replay_trial(arguments.out, arguments.trial, arguments.record)
    if terminal.json:
        row = {n: None if v != v else v for n, v in done.row.items()}
        terminal.result({"row": row, "differing": list(done.differing)})
    else:
        table = Table("", f"trial {arguments.trial}", box=None, pad_edge=False)
        for name, value in done.row.items():
            table.add_row(escape(name), escape(_short(value)))
        terminal.out.print(table)
    if arguments.report is not None:
        _report_trial(arguments, terminal)
    if arguments.view or arguments.browser:
        _show_trial(arguments, terminal)
    if done.differing:
        terminal.warning("differs from the recorded trial in " + ", ".join(done.differing))
        return _DIFFERS
    return 0


def _report_trial(arguments: argparse.Namespace, terminal: Terminal) -> None:
    from volcontact._files import appearing_in
    from volcontact.report import files, fill_report
    from volcontact.study.replay import compare_trial

    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(appearing_in(arguments.report, files.ALL))
        comparison, model = compare_trial(
            arguments.out, arguments.trial, frame_interval=arguments.frame_interval
        )
        renderer = None
        if not arguments.no_frames:
            from volcontact.render import Renderer

            renderer = stack.enter_context(Renderer(model))
        fill_report(comparison, folder, renderer=renderer)
    if not terminal.json:
        terminal.out.print(f"report: {arguments.report / files.REPORT}", markup=False)


def _show_trial(arguments: argparse.Namespace, terminal: Terminal) -> None:
    from volcontact.study.replay import play_trial
    from volcontact.view import browser, window

    reason = "" if arguments.browser else window.why_no_window()
    if reason:
        raise RuntimeError(reason)
    with play_trial(arguments.out, arguments.trial) as stage:
        if not arguments.browser:
            window.show(stage)
            return
        with browser.Page(stage) as page:
            terminal.out.print(f"open {page.address}, end with Ctrl-C", markup=False)
            page.run()


class _Bar:
    """How far a study is: a bar, or, where the log is no terminal, a line now and then."""

    def __init__(self, terminal: Terminal) -> None:
        self._terminal = terminal
        self._bars = terminal.progress()
        self._said = self._begin = time.monotonic()
        self._first: int | None = None  # trials that were there when it began

    def __enter__(self) -> _Bar:
        self._move = self._bars.__enter__().task("trials")
        return self

    def __exit__(self, *error: Any) -> None:
        self._bars.__exit__(*error)

    def move(self, done: int, total: int, outcomes: dict[str, int]) -> None:
        """Says how far it is."""
        now = time.monotonic()
        if self._first is None:
            self._first = done
        rate = (done - self._first) / max(now - self._begin, 1e-3)
        failed = {word: n for word, n in outcomes.items() if word != "success" and n}
        note = f"{rate:.3g} trials/s, {sum(failed.values())} without success"
        if failed:
            note += f" ({', '.join(f'{word} {n}' for word, n in sorted(failed.items()))})"
        self._move(done, total, note)
        log = self._terminal.log
        if not log.is_terminal and now - self._said > _SAY_EVERY:
            self._said = now
            left = f", {(total - done) / rate:.0f} s left" if rate > 0.0 else ""
            log.print(f"{done} of {total} trials, {note}{left}", markup=False, soft_wrap=True)


def _tell(out: Path, terminal: Terminal) -> int:
    from volcontact.study.status import status_of

    found = status_of(out)
    if terminal.json:
        terminal.result(found)
        return 0
    table = Table("", found["name"], box=None, pad_edge=False)
    table.add_row("trials", f"{found['done']} of {found['trials']}")
    for outcome, count in found["outcomes"].items():
        table.add_row(f"  {outcome}", f"{count}")
    if found["success"] is not None:
        low, high = found["interval"]
        table.add_row("success", f"{found['success']:.4g}, 95 % interval {low:.4g} to {high:.4g}")
    if found["rate"] is not None:
        table.add_row("trials/s", f"{found['rate']:.3g}")
    if found["running"] and found["seconds_left"] is not None:
        table.add_row("time left", f"{found['seconds_left']:.0f} s")
    table.add_row("state", found["state"])
    terminal.out.print(table)
    return 0


def _short(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
