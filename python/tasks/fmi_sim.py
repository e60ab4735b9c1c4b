# SPDX-License-Identifier: Apache-2.0
"""fmi-sim, in build/fmi-sim: a master of FMUs in Rust that shares no code with ours."""

from __future__ import annotations

import os
import shutil
import subprocess

from tasks.shell import BUILD, ROOT, TOOLS, Stopped, locked, run, say

FOLDER = BUILD / "fmi-sim"
PROGRAM = FOLDER / "bin" / "fmi-sim"
_VERSION = "0.7.0"


class NoFmiSim(Stopped):
    """fmi-sim is not to be had here."""


def build_fmi_sim() -> None:
    """Builds the program once, for `./run soak`: some four minutes of one core."""
    if PROGRAM.exists() or shutil.which("fmi-sim"):
        return
    if "VOLCONTACT_SOAK" not in os.environ:
        raise NoFmiSim("./run soak builds it, once, in some four minutes of one core")
    if shutil.which("cargo") is None:
        raise NoFmiSim("there is no cargo: install Rust")
    with locked("fmi-sim.lock"):
        say(f"building fmi-sim {_VERSION}, which takes minutes")
        FOLDER.mkdir(parents=True, exist_ok=True)
        with (FOLDER / "build.log").open("w") as log:
            run(
                "cargo", "install", "--debug", "--locked", "--version", _VERSION, "--root", FOLDER,
                "--target-dir", FOLDER / "target", "fmi-sim", env=_clang(), log=log,
            )  # fmt: skip


def _clang() -> dict[str, str]:
    """Where libclang is, with which a crate reads headers: that of PyPI."""
    packages = FOLDER / "packages"
    if not packages.exists():
        run(
            TOOLS / "bin" / "uv", "pip", "install", "-q", "--target", packages,
            "--group", f"{ROOT / 'pyproject.toml'}:fmi-sim",
        )  # fmt: skip
    (library,) = packages.glob("clang/native/libclang*")
    headers = subprocess.run(
        ["cc", "-print-file-name=include"], capture_output=True, text=True, check=True
    ).stdout.strip()
    return {"LIBCLANG_PATH": str(library.parent), "BINDGEN_EXTRA_CLANG_ARGS": f"-I{headers}"}
