# SPDX-License-Identifier: Apache-2.0
"""Packages of Debian and Ubuntu. Elsewhere CONTRIBUTING.md lists what is needed."""

from __future__ import annotations

import os
import shutil
import subprocess

from tasks.interpreters import all_interpreters, has_headers
from tasks.shell import ROOT, run, say, stop


def need_system(*packages: str) -> None:
    """Installs, as root, what is missing of these packages and of what every command needs."""
    wanted = ["libegl1", "libgl1", "libgl1-mesa-dri", *packages]
    if shutil.which(os.environ.get("CXX", "c++")) is None:
        wanted.append("g++")
    if not has_headers("python3") and not any(all_interpreters()):
        wanted.append("python3-dev")

    if shutil.which("dpkg-query") is None:  # not Debian
        if "g++" in wanted:
            stop("no C++ compiler: install g++ 11 or newer")
        return
    missing = [package for package in wanted if not _is_installed(package)]
    if not missing:
        return
    if os.geteuid() != 0:
        stop(
            "system packages are missing. Install them, then run this again:\n"
            f"    sudo apt-get install {' '.join(missing)}"
        )
    say(f"installing system packages: {' '.join(missing)}")
    install(*missing)


def wish_system(purpose: str, *packages: str) -> bool:
    """The same for what a command can do without: only root installs, and a failure is told."""
    if all(map(_is_installed, packages)):
        return True
    if os.geteuid() != 0 or shutil.which("apt-get") is None:
        return False
    try:
        need_system(*packages)
    except Exception as error:
        say(f"going on without {purpose}: {error}")
        return False
    return True


def install(*packages: str) -> None:
    """By apt, as root."""
    quiet = {"DEBIAN_FRONTEND": "noninteractive"}
    run("apt-get", "-qq", "update", env=quiet)
    with open(os.devnull, "w") as null:
        run(
            "apt-get", "-qq", "install", "-y", "--no-install-recommends", *packages,
            env=quiet, log=null,
        )  # fmt: skip


def use_compiler_cache() -> None:
    """With ccache, what one checkout has compiled is not compiled again in another."""
    if shutil.which("ccache") and "CMAKE_CXX_COMPILER_LAUNCHER" not in os.environ:
        os.environ |= {
            "CMAKE_C_COMPILER_LAUNCHER": "ccache",
            "CMAKE_CXX_COMPILER_LAUNCHER": "ccache",
            "CCACHE_BASEDIR": str(ROOT),
            "CCACHE_NOHASHDIR": "1",
            # The headers are looked at after the compiler has read them, and nothing is kept where
            # one is newer than its start. Else the cache reads them twice, and what was compiled
            # from a header in the middle of an edit is kept as made from the one before it.
            "CCACHE_DEPEND": "1",
            "CCACHE_SLOPPINESS": "pch_defines,time_macros",  # precompiled headers ask for both
        }


def _is_installed(package: str) -> bool:
    done = subprocess.run(
        ["dpkg-query", "-W", "-f", "${db:Status-Status}", package],
        capture_output=True,
        text=True,
        check=False,
    )
    return done.stdout == "installed"
