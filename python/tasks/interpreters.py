# SPDX-License-Identifier: Apache-2.0
"""The Pythons of this machine that can build an extension."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

from tasks.shell import VENVS, output_of, run, say

_SUITES = {"3.14": "forky"}  # of Debian, that have a CPython which older ones have not
VERSIONS = ("3.13", "3.12", "3.11", "3.14", "3.10")  # best first
_HEADERS = """import os, sysconfig
assert os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h"))"""


def has_headers(python: str | Path) -> bool:
    """Whether an extension can be built for it."""
    return output_of(python, "-c", _HEADERS) is not None


def all_interpreters() -> Iterator[Path]:
    """Best first; those of pyenv, then what uv finds on the system."""
    pyenv = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv") / "versions"
    for version in VERSIONS:
        found = sorted(pyenv.glob(f"{version}.*/bin/python{version}"))
        place = output_of("uv", "python", "find", "--system", "--no-project", version)
        for python in [*found, *([Path(place)] if place else [])]:
            if has_headers(python):
                yield python


def python_for(requirement: str) -> tuple[Path, str] | None:
    """The best Python that has wheels for a requirement such as `mujoco==2.2.2`, and the release.

    None, with a message, when there is no such Python here.
    """
    reason = ""
    for python in all_interpreters():
        done = subprocess.run(
            ["uv", "pip", "compile", "-q", "--no-header", "--no-annotate", "--no-deps",
             "--only-binary", "mujoco", "--python", str(python), "-"],
            input=requirement, capture_output=True, text=True, check=False,
        )  # fmt: skip
        if done.returncode == 0:
            return python, done.stdout.strip().removeprefix("mujoco==")
        reason = done.stderr
    say(f"no Python here has {requirement} (looked for CPython 3.10 to 3.14 with its headers)")
    say(reason)
    return None


def from_newer_debian(version: str) -> Path | None:
    """A CPython that this system does not have, beside it: `.venv/cpython-<version>`.

    It has its own C library, which its programs find by their own paths, so what is compiled for it
    here runs in it. Needs root, mmdebstrap and patchelf. None where no suite is known to have it.
    """
    suite = _SUITES.get(version)
    if suite is None:
        return None
    root = VENVS / f"cpython-{version}"
    tree, name = root / "usr", f"python{version}"
    if not (root / ".ready").exists():
        say(f"CPython {version} of Debian {suite}")
        shutil.rmtree(root, ignore_errors=True)
        packages = f"--include={name},lib{name}-dev,libstdc++6"
        # A mirror that lags behind a suite that moves has lists that are signed, and out of date.
        lag = "--aptopt=Acquire::Check-Valid-Until false;"
        run("mmdebstrap", "--quiet", "--mode=root", "--variant=extract", lag, packages, suite, root)
        libraries, loader = tree / "lib" / "x86_64-linux-gnu", tree / "lib64"
        run(
            "patchelf", "--set-interpreter", loader / "ld-linux-x86-64.so.2",
            "--force-rpath", "--set-rpath", libraries, tree / "bin" / name,
        )  # fmt: skip
        # Where Debian's leads to is below /usr/include alone.
        headers = tree / "include"
        shutil.copy(headers / "x86_64-linux-gnu" / name / "pyconfig.h", headers / name)
        (root / ".ready").touch()
    return tree / "bin" / name
