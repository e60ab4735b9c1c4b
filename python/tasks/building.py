# SPDX-License-Identifier: Apache-2.0
"""The build trees: one of the core, one for each MuJoCo release, whose adaptor links that core."""

from __future__ import annotations

from pathlib import Path

from tasks.shell import BUILD, ROOT, locked, newer, run

CORE = BUILD / "core"
_WITHOUT_RELEASE = {
    "VOLCONTACT_MUJOCO": "OFF",
    "VOLCONTACT_PYTHON": "OFF",
    "VOLCONTACT_WARNINGS_AS_ERRORS": "ON",
}


def configure(tree: Path, **settings: str) -> None:
    """Runs CMake for a tree of this checkout, quietly; its log lies in the tree."""
    tree.mkdir(parents=True, exist_ok=True)
    words = [f"-D{name}={value}" for name, value in settings.items()]
    with (tree / "configure.log").open("w") as log:
        try:
            run("cmake", "-S", ROOT, "-B", tree, "-G", "Ninja", *words, log=log)
        except Exception:
            print((tree / "configure.log").read_text())
            raise


def build(tree: Path, *targets: str) -> None:
    """Builds targets of a tree."""
    run("cmake", "--build", tree, "--target", *targets)


def build_core(*targets: str, **settings: str) -> None:
    """The core and the C container, which know no MuJoCo; `settings` as `VOLCONTACT_TESTS="ON"`."""
    with locked("core.lock"):
        if settings or not (CORE / "build.ninja").exists():
            configure(CORE, **_WITHOUT_RELEASE, **settings)
        build(CORE, "volcontact_core", "volcontact_c", *targets)


def build_core_if_older() -> None:
    """The same where a source is newer than the last build."""
    stamp = CORE / ".built"
    if not newer([ROOT / "plugin", ROOT / "CMakeLists.txt"], stamp):
        return
    CORE.mkdir(parents=True, exist_ok=True)
    started = CORE / ".building"  # older than any edit made during the build
    started.touch()
    build_core()
    started.replace(stamp)
