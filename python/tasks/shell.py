# SPDX-License-Identifier: Apache-2.0
"""Places of this checkout, messages, and programs that are run."""

from __future__ import annotations

import contextlib
import fcntl
import os
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import IO, Any, NoReturn

ROOT = Path(__file__).resolve().parents[2]
VENVS = ROOT / ".venv"
TOOLS = VENVS / "tools"  # uv, nox, CMake, Ninja and Eigen, private to this checkout
BUILD = ROOT / "build"
RESULTS = BUILD / "test-results"
JOBS = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL") or str(len(os.sched_getaffinity(0)))


class Stopped(Exception):
    """Ends a command with a message and an exit status, and no traceback."""

    def __init__(self, message: str, status: int = 1) -> None:
        super().__init__(message)
        self.status = status


_ASIDE = threading.local()  # `file`: where the work of a thread tells what it does


@contextlib.contextmanager
def aside(file: IO[str]) -> Iterator[None]:
    """What this thread says, and the programs that it runs, goes to a file."""
    _ASIDE.file = file
    try:
        yield
    finally:
        del _ASIDE.file


def say(message: str) -> None:
    """Tells the user, beside the output of the programs that run."""
    print(f"run: {message}", file=getattr(_ASIDE, "file", sys.stderr), flush=True)


def stop(message: str, status: int = 1) -> NoReturn:
    """Ends the command."""
    raise Stopped(message, status)


def run(
    *command: str | Path,
    cwd: Path | None = ROOT,
    env: Mapping[str, str] | None = None,
    log: IO[str] | None = None,
    table: IO[str] | None = None,
) -> None:
    """Runs a program of the tools or of the system; a status other than 0 ends the command.

    `log` takes all that it says, `table` what it says to its standard output alone.
    """
    words = [str(word) for word in command]
    sys.stdout.flush()
    log = log or getattr(_ASIDE, "file", None)
    done = subprocess.run(
        words,
        cwd=cwd,
        env={**os.environ, **(env or {})},
        stdout=table or log,
        stderr=subprocess.STDOUT if log and not table else log,
        check=False,
    )
    if done.returncode != 0:
        stop(f"{Path(words[0]).name} ended with status {done.returncode}", 1)


def output_of(*command: str | Path) -> str | None:
    """What a program prints, None when it fails or is not there."""
    try:
        done = subprocess.run(
            [str(word) for word in command], capture_output=True, text=True, check=False
        )
    except OSError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def become(program: Path, *arguments: str, cwd: str | None = None) -> NoReturn:
    """Goes on as another program, so that its signals and its status are its own."""
    sys.stdout.flush()
    sys.stderr.flush()
    if cwd:
        os.chdir(cwd)
    os.execv(program, [str(program), *arguments])


def newer(places: list[Path], than: Path) -> bool:
    """Whether a file of these places has changed since that file was written."""
    if not than.exists():
        return True
    limit = than.stat().st_mtime
    files = (
        file
        for place in places
        for file in ([place] if place.is_file() else place.rglob("*"))
        if "__pycache__" not in file.parts
    )
    return any(file.stat().st_mtime > limit for file in files)


@contextlib.contextmanager
def locked(name: str = "lock") -> Iterator[None]:
    """Two commands that start at a time set up once."""
    VENVS.mkdir(exist_ok=True)
    with (VENVS / name).open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def clean_environment() -> None:
    """What every command and all that it starts sees of the environment."""
    for name in ("PYTHONHOME", "PYTHONPATH", "VIRTUAL_ENV", "CONDA_PREFIX"):
        os.environ.pop(name, None)
    defaults: dict[str, Any] = {
        "UV_PYTHON_DOWNLOADS": "never",
        "UV_NO_PROGRESS": "1",
        "OMP_WAIT_POLICY": "passive",  # spinning threads starve small machines
        "CMAKE_BUILD_PARALLEL_LEVEL": JOBS,
    }
    if not os.environ.get("DISPLAY"):
        defaults["MUJOCO_GL"] = "egl"
    for name, value in defaults.items():
        if not os.environ.get(name):
            os.environ[name] = value
    os.environ["PATH"] = f"{TOOLS / 'bin'}{os.pathsep}{os.environ['PATH']}"
