# SPDX-License-Identifier: Apache-2.0
"""Compiles the adaptor for a MuJoCo that the package was not built for, once, and keeps it.

The package has the adaptor's sources and the compiled core in the folder `source`. What is made of
them is kept in `$XDG_CACHE_HOME/volcontact`, one folder for each state of these.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import mujoco

_LOG_LINES = 15  # of a build that failed, shown


def build(library_name: str, source: Path) -> Path:
    """Returns the library from the cache; compiles it first where it is not there.

    Args:
        library_name: name of the file, which has the release in it.
        source: folder of the package with `adaptor` and the compiled core.

    Raises:
        RuntimeError: the package has no sources, MuJoCo no headers, or the compiler is missing or
            failed; the message says what to do.
    """
    package = Path(mujoco.__file__).parent
    _require_one_mujoco(package)
    if not (source / "libvolcontact_core.a").is_file():
        raise RuntimeError("this installation of volcontact has no sources to compile")
    folder = _cache() / _state_of(source)
    library = folder / library_name
    with _lock(folder):
        if not library.is_file():
            _compile(library, source, package)
    return library


def _require_one_mujoco(package: Path) -> None:
    """MuJoCo's package has headers and the library of the release that it says it is."""
    library = package / f"libmujoco.so.{mujoco.__version__}"
    header = package / "include" / "mujoco" / "mujoco.h"
    for path in (library, header):
        if not path.is_file():
            raise RuntimeError(f"the MuJoCo that runs has no {path}")


def _cache() -> Path:
    root = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(root) / "volcontact"


def _state_of(source: Path) -> str:
    """A word for the contents of the folder."""
    digest = hashlib.sha256()
    for path in sorted(path for path in source.rglob("*") if path.is_file()):
        digest.update(str(path.relative_to(source)).encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@contextlib.contextmanager
def _lock(folder: Path) -> Iterator[None]:
    """Two programs that start at a time compile once."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def _compile(library: Path, source: Path, package: Path) -> None:
    cmake = _program("cmake", "pip install cmake")
    if os.environ.get("CXX") is None and shutil.which("c++") is None:
        raise RuntimeError("there is no C++ compiler: install g++ 11 or newer")
    print(
        f"volcontact: compiling for MuJoCo {mujoco.__version__}, once; this takes a minute or two",
        file=sys.stderr,
    )
    with tempfile.TemporaryDirectory(prefix="volcontact-") as tree:
        configure = [cmake, "-S", str(source / "adaptor"), "-B", tree, f"-DMUJOCO_DIR={package}"]
        parallel = str(os.cpu_count() or 1)
        make = [cmake, "--build", tree, "--target", "volcontact_mujoco", "--parallel", parallel]
        for command in (configure, make):
            _run(command, library.with_suffix(".log"))
        made = Path(tree) / "plugin" / library.name
        # In one go, so that no one ever loads a part of it.
        shutil.copy(made, library.with_suffix(".part"))
        library.with_suffix(".part").replace(library)


def _program(name: str, advice: str) -> str:
    if importlib.util.find_spec(name) is not None:  # the PyPI package of that name
        program = Path(sys.executable).parent / name
        if program.is_file():
            return str(program)
    found = shutil.which(name)
    if found is None:
        raise RuntimeError(f"there is no {name}: {advice}")
    return found


def _run(command: list[str], log: Path) -> None:
    done = subprocess.run(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    log.write_text(done.stdout, encoding="utf-8")
    if done.returncode != 0:
        end = "\n".join(done.stdout.splitlines()[-_LOG_LINES:])
        raise RuntimeError(f"compiling failed; it needs g++ 11 or newer. The end of {log}:\n{end}")
