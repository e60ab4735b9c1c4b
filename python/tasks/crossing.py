# SPDX-License-Identifier: Apache-2.0
"""`./run cross MACHINE`: the core and the C container on another machine or system.

Their tests run in emulation. Nothing here runs programs of macOS: there they are compiled alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tasks.building import build, configure
from tasks.shell import BUILD, ROOT, VENVS, Stopped, run, say, stop
from tasks.system import need_system


@dataclass(frozen=True)
class Machine:
    """How programs for a machine are made and run here.

    Attributes:
        packages: of apt: its compiler, and what runs its programs.
        emulator: words before the name of a program.
        suffix: of the names of programs.
    """

    packages: tuple[str, ...]
    emulator: tuple[str, ...]
    suffix: str = ""


MACHINES = {
    "aarch64-linux-gnu": Machine(
        ("g++-aarch64-linux-gnu", "qemu-user-static"),
        ("qemu-aarch64-static", "-L", "/usr/aarch64-linux-gnu"),
    ),
    "x86_64-windows-gnu": Machine(
        ("g++-mingw-w64-x86-64-posix", "wine", "wine64"), ("wine",), ".exe"
    ),
}
_GOOGLETEST = Path("/usr/src/googletest")  # as apt has it
_TESTS = ("volcontact_core_tests", "volcontact_c_api_tests")


MACOS = "aarch64-macos"


def cross(machine: str, arguments: list[str]) -> None:
    """Compiles core, C container and their tests, and runs these; arguments are GoogleTest's."""
    if machine == MACOS:
        _macos_tools(VENVS / "macos")
        _configure(machine)
        build(BUILD / "cross" / machine, "volcontact_core", "volcontact_c")
        say(f"{machine}: core and C container are compiled; nothing here runs them")
        return
    if machine not in MACHINES:
        stop(f"cross: {machine!r} is not among: {', '.join([*MACHINES, MACOS])}")
    need_system("googletest", *MACHINES[machine].packages)
    tree = BUILD / "cross" / machine
    tests = _googletest(tree / "googletest", _toolchain(machine))
    _configure(
        machine,
        CMAKE_FIND_ROOT_PATH=f"{tests}",
        CMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE="PRE_TEST",
        GTest_DIR=f"{tests / 'lib' / 'cmake' / 'GTest'}",
        VOLCONTACT_TESTS="ON",
    )
    build(tree, *_TESTS)
    _run_tests(MACHINES[machine], tree, arguments)
    say(f"{machine}: the tests of the core and of the C container passed, in emulation")


def _toolchain(machine: str) -> Path:
    return ROOT / "python" / "toolchains" / f"{machine}.cmake"


def _configure(machine: str, **settings: str) -> None:
    configure(
        BUILD / "cross" / machine,
        CMAKE_BUILD_TYPE="Release",
        CMAKE_TOOLCHAIN_FILE=f"{_toolchain(machine)}",
        VOLCONTACT_CGAL="OFF",
        VOLCONTACT_MUJOCO="OFF",
        **settings,
    )


def _macos_tools(place: Path) -> None:
    """What python/toolchains/aarch64-macos.cmake names: zig as a compiler, and LLVM's OpenMP."""
    if (place / ".ready").exists():
        return
    run("uv", "venv", "-q", "--clear", place)
    python = place / "bin" / "python"
    run("uv", "pip", "install", "-q", "--python", python, "ziglang")
    run(
        "uv", "pip", "install", "-q", "--python", python, "--no-deps", "--only-binary", ":all:",
        "--python-platform", "aarch64-apple-darwin", "--target", place / "openmp", "cmeel-libomp",
    )  # fmt: skip
    target = f"-target {MACOS}"
    for name, words in {
        "C": f"cc {target}",
        "CXX": f"c++ {target}",
        "ar": "ar",
        "ranlib": "ranlib",
    }.items():
        program = place / "bin" / name
        program.write_text(f'#!/bin/sh\nexec "{python}" -m ziglang {words} "$@"\n')
        program.chmod(0o755)
    (place / ".ready").touch()


def _run_tests(machine: Machine, tree: Path, arguments: list[str]) -> None:
    """All programs, whatever the first says. Each whole: an emulator takes seconds to start."""
    folder = str(tree / "plugin" / "c_api").replace("/", "\\")  # of the library, for its programs
    environment = {
        "WINEPATH": f"Z:{folder}",
        "WINEDEBUG": "-all",
        "WINEDLLOVERRIDES": "winedbg.exe=d",  # whose status hides that of a program that crashed
    }
    failed = []
    for program in sorted((tree / "tests").rglob(f"*_test{machine.suffix}")):
        say(program.name)
        try:
            run(
                *machine.emulator, program, "--gtest_brief=1", *arguments,
                cwd=program.parent, env=environment,
            )  # fmt: skip
        except Stopped:
            failed.append(program.name)
    try:
        program = tree / "tests" / "c_api" / f"c_api_program{machine.suffix}"
        run(*machine.emulator, program, cwd=program.parent, env=environment)
    except Stopped:
        failed.append(program.name)
    if failed:
        stop(f"tests failed in {', '.join(failed)}")


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
