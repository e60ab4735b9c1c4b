# SPDX-License-Identifier: Apache-2.0
"""The `volcontact` program: one module per command.

Exit status: 0 all went well, 1 the scene, the mesh or the request is at fault, 2 wrong usage, 3 it
ran and MuJoCo or volcontact warned of the numbers, or a fit did not converge, 130 interrupted.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import sys
import threading
from collections.abc import Iterator, Sequence

import mujoco

import volcontact
from volcontact.cli import (
    bench,
    check,
    compare,
    completion,
    converge,
    doctor,
    fmu,
    identify,
    mesh,
    metrics,
    new,
    run,
    study,
    view,
)
from volcontact.cli.terminal import Terminal
from volcontact.messages import extras

__all__ = ["main", "make_parser"]

_COMMANDS = (
    new,
    check,
    run,
    compare,
    converge,
    view,
    metrics,
    mesh,
    study,
    identify,
    bench,
    fmu,
    doctor,
    completion,
)
_ERROR, _INTERRUPTED = 1, 130

_EXAMPLES = """\
examples:
  volcontact new my_scene                          a scene to start from
  volcontact check scene.xml                       what volcontact understands of a scene
  volcontact run scene.xml --duration 2            step it and say how it ended
  volcontact compare scene.xml --out report        volumetric beside native contact, with pictures
  volcontact converge scene.xml                    what its step costs, figure by figure
  volcontact view scene.xml                        watch it, with contact patches and forces
  volcontact metrics scene.xml                     its contact sites in numbers
  volcontact mesh check part.stl                   whether a mesh is a solid
  volcontact study run study.toml --out results    thousands of trials of a scene
  volcontact identify study.toml --out results     parameters from measured motions
  volcontact bench press press.csv                 parameters from a bench test
  volcontact fmu scene.xml --bodies ball world     its contact for other simulators, as an FMU
  volcontact doctor                                what is installed and whether it works

exit status:
  0 all went well, 1 the scene, the mesh or the request is at fault, 2 wrong usage,
  3 it ran and MuJoCo or volcontact warned of the numbers, or a fit did not converge,
  130 interrupted
"""


def main(argv: Sequence[str] | None = None) -> int:
    """Runs the program and returns its exit status."""
    arguments = make_parser().parse_args(argv)
    terminal = Terminal(json=getattr(arguments, "json", False))
    try:
        with _ended_as_by_hand(), terminal.python_warnings():
            status: int = arguments.execute(arguments, terminal)
            terminal.flush()
            return status
    except KeyboardInterrupt:
        terminal.error("interrupted")
        return _INTERRUPTED
    except ModuleNotFoundError as error:
        advice = extras.advice(error.name)
        if advice is None:
            raise
        terminal.error(advice)
        return _ERROR
    except (ValueError, OSError, RuntimeError, mujoco.FatalError) as error:
        terminal.error(str(error) or type(error).__name__)
        return _ERROR
    finally:
        _give_up_output()


@contextlib.contextmanager
def _ended_as_by_hand() -> Iterator[None]:
    """Within it SIGTERM and SIGHUP end the program as Ctrl-C does, so that it tidies up."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGHUP)}
    taken = [number for number, handler in before.items() if handler == signal.SIG_DFL]
    for number in taken:
        signal.signal(number, signal.default_int_handler)
    try:
        yield
    finally:
        for number in taken:
            signal.signal(number, before[number])


def _give_up_output() -> None:
    """Drops what standard output does not take, so that Python does not try again at its end."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def make_parser() -> argparse.ArgumentParser:
    """The arguments of the program."""
    parser = argparse.ArgumentParser(
        prog="volcontact",
        description="Volumetric contact for MuJoCo scenes.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--version",
        action="version",
        version=f"volcontact {volcontact.__version__} (MuJoCo {mujoco.mj_versionString()})",
    )
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for command in _COMMANDS:
        command.add_to(commands)
    return parser
