# SPDX-License-Identifier: Apache-2.0
"""The GPL program of `volcontact mesh`, in build/cgal, with CGAL from the system or unpacked."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

from tasks.shell import BUILD, JOBS, ROOT, VENVS, Stopped, locked, newer, output_of, run, say
from tasks.system import install, need_system

PROGRAM = BUILD / "cgal" / "volcontact-cgal"
_UNPACKED = VENVS / "cgal"


class NoCgal(Stopped):
    """CGAL is not to be had here."""


def build_cgal() -> None:
    """Builds the program where its sources are newer."""
    if not newer([ROOT / "plugin" / "cgal"], PROGRAM):
        return
    tree = PROGRAM.parent
    tree.mkdir(parents=True, exist_ok=True)
    with locked("cgal.lock"):
        need_system()
        prefix = _headers()
        say("building volcontact-cgal, which takes a minute")
        with (tree / "configure.log").open("w") as log:
            run(
                "cmake", "-S", ROOT / "plugin" / "cgal", "-B", tree, "-G", "Ninja",
                "-DVOLCONTACT_CGAL=ON", "-DVOLCONTACT_WARNINGS_AS_ERRORS=ON",
                f"-DCMAKE_PREFIX_PATH={prefix}", log=log,
            )  # fmt: skip
        run("cmake", "--build", tree, "--target", "volcontact_cgal", "-j", JOBS)
        PROGRAM.touch()  # newer than a source whose object stayed the same


def link_cgal(venv: Path) -> None:
    """Puts the program, if there is one, where the volcontact of that environment looks for it."""
    link = venv / "bin" / "volcontact-cgal"
    link.unlink(missing_ok=True)
    if PROGRAM.exists():
        link.symlink_to(PROGRAM)


def _headers() -> Path:
    """The prefix of CGAL's headers, installed as root, else unpacked into .venv/cgal."""
    system = Path("/usr")
    if all((system / "include" / name).exists() for name in ("CGAL/Surface_mesh.h", "mpfr.h")):
        return system
    prefix = _UNPACKED / "usr"
    if (_UNPACKED / ".ready").exists():
        return prefix
    if shutil.which("apt-get") is None:
        raise NoCgal("no CGAL headers here: install CGAL 5.4 or newer with GMP and MPFR")
    if os.geteuid() == 0:
        say("installing system packages: libcgal-dev libmpfr-dev")
        try:
            install("libcgal-dev", "libmpfr-dev")
        except Stopped as error:
            raise NoCgal(f"CGAL cannot be installed here: {error}") from error
        return system
    _unpack()
    return prefix


def _unpack() -> None:
    say("unpacking the headers of CGAL into .venv/cgal")
    shutil.rmtree(_UNPACKED, ignore_errors=True)
    debs = _UNPACKED / "debs"
    debs.mkdir(parents=True)
    listed = output_of(
        "apt-cache", "depends", "--recurse", "--no-recommends", "--no-suggests", "--no-conflicts",
        "--no-breaks", "--no-replaces", "--no-enhances", "libcgal-dev", "libmpfr-dev",
    )  # fmt: skip
    wanted = set(re.findall(r"^lib(?:cgal|boost|gmp|mpfr)[a-z0-9.-]*$", listed or "", re.MULTILINE))
    try:
        run("apt-get", "-qq", "download", *sorted(wanted), cwd=debs)
        for package in sorted(debs.glob("*.deb")):
            run("dpkg-deb", "-x", package, _UNPACKED)
    except Stopped as error:
        raise NoCgal(f"CGAL cannot be unpacked here: {error}") from error
    shutil.rmtree(debs)
    (_UNPACKED / ".ready").touch()
