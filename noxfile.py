# SPDX-License-Identifier: Apache-2.0
"""The commands of `./run`. What they do is in python/tasks; all set-up is in .venv/ and build/.

MUJOCO=2.2.2 ./run ...   uses that MuJoCo; the default is the newest at the first set-up.
Remove .venv/ and build/ to start afresh.
"""

from __future__ import annotations

import functools
import logging
import os
import sys
from collections.abc import Callable
from pathlib import Path

import nox

sys.path.insert(0, str(Path(__file__).parent / "python"))

from tasks import (
    cgal,
    crossing,
    environments,
    linting,
    recording,
    releasing,
    shell,
    sites,
    system,
    testing,
)

logging.getLogger("nox").setLevel(logging.ERROR)  # the output of a command is its own
nox.options.sessions = []
COMMANDS: dict[str, str] = {}  # name and what it does
shell.clean_environment()
system.use_compiler_cache()


def command(work: Callable[[nox.Session], None]) -> Callable[[nox.Session], None]:
    """A session without an environment of nox's: those of a release are kept and are shared."""

    @functools.wraps(work)
    def session_function(session: nox.Session) -> None:
        try:
            work(session)
        except shell.Stopped as stopped:
            shell.say(str(stopped))
            sys.stdout.flush()
            os._exit(stopped.status)  # the status of the command, as the message, is its own

    name = work.__name__.rstrip("_")
    COMMANDS[name] = (work.__doc__ or "").strip()
    return nox.session(venv_backend="none", name=name)(session_function)


@command
def help_(session: nox.Session) -> None:
    """This list."""
    print(f"Usage: ./run COMMAND [ARGS]\n\n{__doc__}")
    for name, meaning in COMMANDS.items():
        print(f"  {name:12s}{meaning}")


@command
def demo(session: nox.Session) -> None:
    """Drop the battery box; report in build/demo (--all: figures of the CSA paper, too)."""
    environment = environments.prepared()
    out = shell.BUILD / "demo"
    arguments = [word for word in session.posargs if word != "--all"]
    scene = shell.ROOT / "mjcf_models" / "battery_box" / "scene.xml"
    program = environment.venv / "bin" / "volcontact"
    shell.run(program, "compare", scene, "--out", out, "--error", *arguments)
    shell.say(f"the report is {out / 'report.html'}")
    if "--all" in session.posargs:
        environment.script("mjcf_models/make_paper_figures.py", "--out", out / "paper")


@command
def test(session: nox.Session) -> None:
    """C++ and Python tests, on both MuJoCo releases; ARGS of pytest select."""
    testing.test(session.posargs)


@command
def soak(session: nox.Session) -> None:
    """`test` with every case of the long tests: before a release, or after deep changes."""
    testing.soak(session.posargs)


@command
def python(session: nox.Session) -> None:
    """Python with volcontact; scripts in tests/ get the libraries of the tests, too."""
    called_in = Path(os.environ.get("VOLCONTACT_CALLED_IN", shell.ROOT))
    of_tests = any(
        (called_in / word).resolve().is_relative_to(shell.ROOT / "tests")
        for word in session.posargs[:1]
    )
    environment = environments.prepared(tests=of_tests)
    shell.become(environment.python, *session.posargs, cwd=called_in)


@command
def volcontact(session: nox.Session) -> None:
    """The command line program."""
    environment = environments.prepared()
    if session.posargs[:1] == ["mesh"]:
        try:
            cgal.build_cgal()
        except shell.Stopped as error:
            shell.say(f"going on without CGAL: {error}")
        cgal.link_cgal(environment.venv)
    program = environment.venv / "bin" / "volcontact"
    shell.become(program, *session.posargs, cwd=os.environ.get("VOLCONTACT_CALLED_IN"))


@command
def sanitize(session: nox.Session) -> None:
    """The C++ tests without MuJoCo under the address and undefined-behaviour sanitizers."""
    recording.sanitize()


@command
def threads(session: nox.Session) -> None:
    """The C++ tests with threads under the thread sanitizer."""
    recording.threads(environments.prepared())


@command
def benchmark(session: nox.Session) -> None:
    """All benchmarks, docs/performance.md; ARGS of Google Benchmark: the C++ ones, unkept."""
    recording.benchmark(environments.prepared(), session.posargs)


@command
def accuracy(session: nox.Session) -> None:
    """Errors of all engines, or of those named, in docs/accuracy.md (all: half an hour)."""
    recording.accuracy(environments.prepared(), session.posargs)


@command
def search(session: nox.Session) -> None:
    """Two million poses in search of failures; ARGS as --cases 10000: random pairs alone."""
    recording.search(environments.prepared(), session.posargs)


@command
def campaign(session: nox.Session) -> None:
    """Thousands of scenes in search of energy that contact makes; writes docs/campaign.md."""
    recording.campaign(environments.prepared(), session.posargs)


@command
def matrix(session: nox.Session) -> None:
    """Tests of the plugin on many MuJoCo releases, or on those named, for docs/plugin.md."""
    system.need_system()
    recording.matrix(session.posargs)


@command
def wheels(session: nox.Session) -> None:
    """Builds the wheels, in build/wheels/dist, and tries them in fresh environments."""
    system.need_system()
    recording.wheels(session.posargs)


@command
def cross(session: nox.Session) -> None:
    """Core and C container elsewhere, emulated: ARGS as x86_64-windows-gnu, aarch64-macos."""
    system.need_system()
    machine, *rest = session.posargs or [""]
    crossing.cross(machine, rest)


@command
def release(session: nox.Session) -> None:
    """What is left to do before a version is given away; ARGS as 0.2.0: writes that version."""
    releasing.release(*session.posargs[:1])


@command
def docs(session: nox.Session) -> None:
    """The documentation as a site, in build/site; needs no network to read."""
    system.need_system()
    sites.build_site()


@command
def lint(session: nox.Session) -> None:
    """Formatters and linters, checking only."""
    linting.lint()


@command
def format_(session: nox.Session) -> None:
    """Formatters, changing files."""
    linting.format_files()
