# SPDX-License-Identifier: Apache-2.0
"""One Python environment for each MuJoCo release, with volcontact built for it."""

from __future__ import annotations

import os
import shutil
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from tasks.building import CORE, build_core_if_older
from tasks.interpreters import python_for
from tasks.shell import BUILD, ROOT, VENVS, Stopped, locked, newer, run, say
from tasks.system import need_system, use_compiler_cache

BASELINE = "2.2.2"  # the oldest MuJoCo served
NEWEST = VENVS / "newest"  # what that was when it was last looked up
_SOURCES = (
    "CMakeLists.txt",
    "pyproject.toml",
    "plugin",
    "python/CMakeLists.txt",
    "python/bindings",
    "python/tasks/building.py",
    "python/tasks/environments.py",
)


class NoPython(Stopped):
    """No Python of this machine has that MuJoCo."""


@dataclass(frozen=True)
class Environment:
    """Of one release: `.venv/mujoco-<version>` and `build/mujoco-<version>`."""

    version: str

    @property
    def venv(self) -> Path:
        """Its folder."""
        return VENVS / f"mujoco-{self.version}"

    @property
    def tree(self) -> Path:
        """The build tree of its adaptor and Python extension."""
        return BUILD / f"mujoco-{self.version}"

    @property
    def python(self) -> Path:
        """Its interpreter."""
        return self.venv / "bin" / "python"

    @property
    def mujoco(self) -> Path:
        """Folder of the installed package."""
        return next((self.venv / "lib").glob("python3.*/site-packages/mujoco"))

    def install(self, *words: str | Path) -> None:
        """Installs packages; `words` are arguments of uv."""
        run("uv", "pip", "install", "-q", "--python", self.python, *words)

    def script(self, path: str, *arguments: str | Path) -> None:
        """Runs a Python script of this checkout."""
        run(self.python, ROOT / path, *arguments)


def located(release: str) -> Environment:
    """`release` is a number or "newest"."""
    if release == "newest" and NEWEST.exists():
        return Environment(NEWEST.read_text().strip())
    return Environment(release)


def prepared(release: str | None = None, *, tests: bool = False) -> Environment:
    """The environment of a release, made and built where a source is newer.

    Args:
        release: a number or "newest"; the variable MUJOCO says it where it is left out.
        tests: whether the libraries of the tests are wanted as well.
    """
    release = release or os.environ.get("MUJOCO") or "newest"
    if not _is_up_to_date(located(release), tests):
        with locked():
            if not _is_up_to_date(located(release), tests):
                need_system()
                use_compiler_cache()
                # Compiling waits for processors, installing for the network.
                with ThreadPoolExecutor(1) as beside:
                    core = beside.submit(build_core_if_older)
                    environment = _made(release)
                    _install_requirements(environment, tests)
                    core.result()
                _install_package(environment)
    return located(release)


def furnish(release: str) -> None:
    """Makes the environment of a release with all that its tests need, without volcontact."""
    with locked():
        if not _is_up_to_date(located(release), tests=True):
            _install_requirements(_made(release), tests=True)


# The stamp holds the checkout's path: a moved checkout is set up anew.
def _is_up_to_date(environment: Environment, tests: bool) -> bool:
    stamp = environment.venv / ".ready"
    return (
        environment.python.exists()
        and stamp.exists()
        and stamp.read_text().strip() == str(ROOT)
        and (not tests or (environment.venv / ".tests").exists())
        and not newer([ROOT / source for source in _SOURCES], stamp)
    )


def _made(release: str) -> Environment:
    """The environment, empty where it is new."""
    environment = located(release)
    path = environment.venv / ".path"
    if environment.python.exists() and path.exists() and path.read_text().strip() == str(ROOT):
        return environment
    found = python_for("mujoco" if release == "newest" else f"mujoco=={release}")
    if found is None:
        raise NoPython(f"MuJoCo {release} needs another Python", 3)
    python, version = found
    if release == "newest":
        NEWEST.write_text(f"{version}\n")
    environment = Environment(version)
    say(f"making the environment .venv/mujoco-{version} with {python.name}")
    shutil.rmtree(environment.venv, ignore_errors=True)
    shutil.rmtree(environment.tree, ignore_errors=True)
    run("uv", "venv", "-q", "--python", python, environment.venv)
    (environment.venv / ".path").write_text(f"{ROOT}\n")
    return environment


def _install_requirements(environment: Environment, tests: bool) -> None:
    """All that volcontact needs there to be built and run."""
    wanted = environment.venv / ".tests"
    if tests:
        wanted.touch()
    extras = (word for extra in _extras(environment) for word in ("--extra", extra))
    environment.install(
        f"mujoco=={environment.version}", "scikit-build-core", "nanobind",
        "-r", ROOT / "pyproject.toml", *extras,
    )  # fmt: skip


def _extras(environment: Environment) -> list[str]:
    wants_tests = (environment.venv / ".tests").exists()
    return ["test"] if wants_tests else ["gym", "report", "study", "view"]


def _install_package(environment: Environment) -> None:
    say(f"building volcontact for MuJoCo {environment.version}")
    started = environment.venv / ".building"  # older than any edit made during the build
    started.write_text(f"{ROOT}\n")
    settings = {
        "MUJOCO_DIR": environment.mujoco,
        "VOLCONTACT_MUJOCO": "ON",
        "VOLCONTACT_CORE": CORE,
        "VOLCONTACT_WARNINGS_AS_ERRORS": "ON",
    }
    environment.install(
        "--no-build-isolation",
        "--reinstall-package",
        "volcontact",
        f"-Cbuild-dir={environment.tree}",
        *(f"-Ccmake.define.{name}={value}" for name, value in settings.items()),
        "-e",
        f"{ROOT}[{','.join(_extras(environment))}]",
        f"mujoco=={environment.version}",
    )
    if (environment.venv / ".tests").exists() and environment == located("newest"):
        _install_hosts(environment)
    started.replace(environment.venv / ".ready")


def _install_hosts(environment: Environment) -> None:
    """Other simulators, as wheels; their tests are skipped, and say so, where there are none."""
    try:
        environment.install("--no-deps", "--only-binary", ":all:", "--group", "hosts")
    except Stopped:
        if os.environ.get("CI") == "true":
            raise
        say("going on without the simulators of python/examples/hosts")
