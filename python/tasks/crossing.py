# SPDX-License-Identifier: Apache-2.0
"""`./run cross MACHINE`: the core and the C container on another machine or system, emulated."""

from __future__ import annotations

from pathlib import Path

from tasks.building import build, configure
from tasks.shell import BUILD, ROOT, TOOLS, run, say, stop
from tasks.system import need_system

# What each asks of apt: its compiler and what runs its programs.
MACHINES = {
    "aarch64-linux-gnu": ("g++-aarch64-linux-gnu", "qemu-user-static"),
    "x86_64-windows-gnu": ("g++-mingw-w64-x86-64-posix", "wine", "wine64"),
}
_GOOGLETEST = Path("/usr/src/googletest")  # as apt has it
_TESTS = ("volcontact_core_tests", "volcontact_c_api_tests")


def cross(machine: str, arguments: list[str]) -> None:
    """Compiles core, C container and their tests, and runs these; arguments are those of ctest."""
    if machine not in MACHINES:
        stop(f"cross: {machine!r} is not among: {', '.join(MACHINES)}")
    need_system("googletest", *MACHINES[machine])
    toolchain = ROOT / "python" / "toolchains" / f"{machine}.cmake"
    tree = BUILD / "cross" / machine
    tests = _googletest(tree / "googletest", toolchain)
    configure(
        tree,
        CMAKE_BUILD_TYPE="Release",
        CMAKE_TOOLCHAIN_FILE=f"{toolchain}",
        CMAKE_FIND_ROOT_PATH=f"{tests}",
        CMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE="PRE_TEST",
        Eigen3_ROOT=f"{TOOLS / 'eigen'}",
        GTest_DIR=f"{tests / 'lib' / 'cmake' / 'GTest'}",
        VOLCONTACT_CGAL="OFF",
        VOLCONTACT_MUJOCO="OFF",
        VOLCONTACT_TESTS="ON",
    )
    build(tree, *_TESTS)
    run("ctest", "--test-dir", tree, "--output-on-failure", *arguments)
    say(f"{machine}: the tests of the core and of the C container passed, in emulation")


def _googletest(tree: Path, toolchain: Path) -> Path:
    """Where it is installed for that machine."""
    installed = tree / "installed"
    if not (installed / "lib" / "cmake" / "GTest").is_dir():
        run(
            "cmake", "-S", _GOOGLETEST, "-B", tree, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
            f"-DCMAKE_TOOLCHAIN_FILE={toolchain}", f"-DCMAKE_INSTALL_PREFIX={installed}",
            "-DCMAKE_INSTALL_LIBDIR=lib", "-DBUILD_GMOCK=ON",
        )  # fmt: skip
        run("cmake", "--build", tree, "--target", "install")
    return installed
