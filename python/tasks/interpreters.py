# SPDX-License-Identifier: Apache-2.0
"""The Pythons of this machine that can build an extension."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

from tasks.shell import output_of, say

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
