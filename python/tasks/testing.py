# SPDX-License-Identifier: Apache-2.0
"""`./run test`: the core once, then the adaptor and Python on each MuJoCo release."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

from tasks.building import CORE, build, build_core, configure
from tasks.cgal import NoCgal, build_cgal, link_cgal
from tasks.environments import BASELINE, Environment, NoPython, furnish, prepared
from tasks.fmi_sim import NoFmiSim, build_fmi_sim
from tasks.shell import BUILD, JOBS, RESULTS, ROOT, run, stop
from tasks.sites import build_site
from tasks.stages import Stages
from tasks.system import need_system, use_compiler_cache, wish_system

# Files that no MuJoCo release can change, as the tests marked `once`: they run on one release. Of
# each folder but the first there are others that run on both.
WITHOUT_MUJOCO = (
    "tests/python/core/*",
    "tests/python/fmu/test_fmu_*.py",
    "tests/python/hosts/test_host_scenes.py",
    "tests/python/identify/test_[!i]*.py",
    "tests/python/pages/test_t*.py",
    "tests/python/report/test_report_browser.py",
    "tests/python/report/test_step_error.py",
    "tests/python/scene/test_files.py",
    "tests/python/study/test_study_[!s]*.py",
    "tests/test_includes.py",
    "tests/test_layering.py",
)
_IGNORED = [f"--ignore-glob={path}" for path in WITHOUT_MUJOCO]
_NO_TESTS = 5  # pytest: none was selected
# A file to each process, in the order of tests/conftest.py: xdist would begin with many short.
_SHARED_OUT = ("--dist", "loadfile", "--no-loadscope-reorder")


def soak(arguments: list[str]) -> None:
    """`test` with all cases of the long tests, of which it has few or smaller ones."""
    os.environ["VOLCONTACT_SOAK"] = "1"  # read by tests/python/support and tests/core/support
    test(arguments)


def test(arguments: list[str]) -> None:
    """The tests, or with arguments of pytest those that they select, on one release."""
    _need_packages(arguments)
    shutil.rmtree(RESULTS, ignore_errors=True)
    RESULTS.mkdir(parents=True)
    stages = Stages(RESULTS)
    if arguments:
        _test_selected(stages, arguments)
    else:
        _test_all(stages)
    if stages.summary():
        stop("tests failed")


def _need_packages(arguments: list[str]) -> None:
    need_system("libgtest-dev")
    wish_system("a compiler cache", "ccache")
    use_compiler_cache()
    if not arguments:
        wish_system("a browser", "chromium", "xvfb", "xauth")
        # Of the baseline's release; without it its test is skipped and says so.
        wish_system("simulate", "libmujoco-samples")


# What needs one core for long goes beside what needs both.
def _test_all(stages: Stages) -> None:
    site = stages.beside("Documentation", lambda: build_site(quiet=True))
    releases = [release] if (release := os.environ.get("MUJOCO")) else ["newest", BASELINE]
    furnished = stages.beside("Python environments", lambda: _furnish(releases))
    core = stages.run("Core: build of its tests", _build_core_tests)
    site()
    furnished()
    cgal = stages.beside("The CGAL program", lambda: _build_cgal(stages))
    if core:
        stages.run("Core: C++ tests", lambda: ctest(CORE, "cpp-core"))
    cgal()
    stages.run("fmi-sim, a master of FMUs", lambda: _build_fmi_sim(stages))
    tested = [_Release(release) for release in releases]
    tested[0].is_built = stages.run(tested[0].title, tested[0].set_up)
    for place, release in enumerate(tested):
        release.test_in_cpp(stages)
        # Tests in Python wait for browsers, for disks, for what they have killed.
        built = [
            (following, stages.beside(following.title, following.set_up, idle=True))
            for following in tested[place + 1 : place + 2]
        ]
        release.test_in_python(stages, everything=place == 0)
        for following, wait in built:
            following.is_built = wait()


def _furnish(releases: list[str]) -> None:
    """What comes from the network, while the compiler works."""
    for release in releases:
        with contextlib.suppress(NoPython):  # said where the release is tested
            furnish(release)


def _build_core_tests() -> None:
    build_core("volcontact_core_tests", "volcontact_c_api_tests", VOLCONTACT_TESTS="ON")


def _build_cgal(stages: Stages) -> None:
    """The tests that need CGAL are skipped, and say so, where it is not to be had."""
    try:
        build_cgal()
    except NoCgal as error:
        if os.environ.get("CI") == "true":
            raise
        stages.note("NOT RUN", f"TESTS WITH CGAL: {error}")


def _build_fmi_sim(stages: Stages) -> None:
    """The tests that run FMUs in it are skipped, and say so, where it is not to be had."""
    try:
        build_fmi_sim()
    except NoFmiSim as error:
        stages.note("NOT RUN", f"FMUS IN FMI-SIM: {error}")


class _Release:
    """One MuJoCo release."""

    def __init__(self, release: str) -> None:
        self.title = f"MuJoCo {release}: set-up and builds"
        self.is_built = False
        self._release = release
        self._made: Environment | None = None
        self._is_missing = False

    def set_up(self) -> None:
        """Its environment, adaptor and C++ tests."""
        try:
            self._made = prepared(self._release, tests=True)
            _build_adaptor_tests(self._made)
        except NoPython:
            if self._release != BASELINE or os.environ.get("CI") == "true":
                raise
            self._is_missing = True

    def test_in_cpp(self, stages: Stages) -> None:
        """The adaptor."""
        if self._is_missing:
            title = f"MuJoCo {self._release}: C++ tests, on Debian's library"
            stages.run(title, _ctest_on_system)
        if (made := self._made) and self.is_built:
            name = f"mujoco-{made.version}-cpp"
            stages.run(f"MuJoCo {made.version}: C++ tests", lambda: ctest(made.tree, name))

    def test_in_python(self, stages: Stages, *, everything: bool) -> None:
        """All tests in Python, or those that the release can change."""
        if self._is_missing:
            title = f"MuJoCo {self._release}: ALL PYTHON TESTS, for want of Python 3.10"
            stages.note("NOT RUN", title)
        if not (made := self._made):
            return
        once = not everything and "VOLCONTACT_SOAK" not in os.environ
        arguments = ["--again", *_IGNORED] if once else []
        stages.run(f"MuJoCo {made.version}: Python tests", lambda: pytest(made, arguments))


def _build_adaptor_tests(environment: Environment) -> None:
    configure(environment.tree, VOLCONTACT_TESTS="ON")
    build(environment.tree, "volcontact_adaptor_tests")


def _ctest_on_system() -> None:
    """The adaptor against Debian's MuJoCo, where no Python fits the baseline."""
    need_system("libmujoco-dev")
    tree = BUILD / f"mujoco-{BASELINE}-system"
    configure(
        tree,
        MUJOCO_DIR="/usr",
        VOLCONTACT_MUJOCO="ON",
        VOLCONTACT_PYTHON="OFF",
        VOLCONTACT_CORE=str(CORE),
        VOLCONTACT_TESTS="ON",
    )
    build(tree, "volcontact_adaptor_tests")
    ctest(tree, f"mujoco-{BASELINE}-system-cpp")


def ctest(tree: Path, report: str, names: list[str] | None = None) -> None:
    """The C++ tests of a tree, or those of these names."""
    words: list[str | Path] = ["ctest", "--test-dir", tree, "--no-tests=error", "-j", JOBS]
    if names is not None:
        chosen = tree / "chosen_tests.txt"
        chosen.write_text("".join(f"{name}\n" for name in names))
        words += ["--tests-from-file", chosen]
    run(*words, "--output-on-failure", "--output-junit", RESULTS / f"{report}.xml")


def pytest(environment: Environment, arguments: list[str]) -> None:
    """The Python tests on one release."""
    link_cgal(environment.venv)
    name = f"mujoco-{environment.version}"
    # What the tests see of the report and of the viewers.
    pictures = os.environ.get("VOLCONTACT_SCREENSHOTS") or str(RESULTS / f"{name}-screenshots")
    Path(pictures).mkdir(parents=True, exist_ok=True)
    run(
        environment.python, "-m", "pytest", "-n", JOBS, *_SHARED_OUT,
        f"--junit-xml={RESULTS / name}-python.xml", *arguments,
        # One thread of NumPy's own a process: the processes share the processors.
        env={"VOLCONTACT_SCREENSHOTS": pictures, "OPENBLAS_NUM_THREADS": "1"},
    )  # fmt: skip


# ---- A selection ---------------------------------------------------------------------------------


@dataclass
class _Selection:
    """What `-k EXPRESSION` chooses among the C++ tests, by pytest's rules: parts of names."""

    expression: str
    found: list[str] = field(default_factory=list)

    def of(self, tree: Path) -> list[str]:
        listed = subprocess.run(
            ["ctest", "--test-dir", str(tree), "-N"], capture_output=True, text=True, check=True
        ).stdout
        names = re.findall(r"^ +Test +#\d+: (\S+)$", listed, re.MULTILINE)
        chosen = [name for name in names if self._matches(name.lower())]
        self.found += chosen
        return chosen

    def _matches(self, name: str) -> bool:
        def truth(word: re.Match[str]) -> str:
            text = word.group().lower()
            if text in {"and", "or", "not"}:
                return text
            return str(text in name or text.replace("_", "") in name)  # our_word is OurWord there

        return bool(eval(re.sub(r"[\w.:/-]+", truth, self.expression), {"__builtins__": {}}))


def _test_selected(stages: Stages, arguments: list[str]) -> None:
    environment = prepared(tests=True)
    selection = None
    if arguments[0] == "-k" and len(arguments) == 2:
        selection = _Selection(arguments[1])
        for title, tree, make in (
            ("core", CORE, _build_core_tests),
            ("adaptor", environment.tree, lambda: _build_adaptor_tests(environment)),
        ):
            if stages.run(f"C++ tests of the {title}: build", make):
                names = selection.of(tree)
                if names:
                    stages.run(
                        f"C++ tests of the {title}: {len(names)} of them",
                        lambda tree=tree, names=names, title=title: ctest(tree, title, names),
                    )
    chosen_in_cpp = bool(selection and selection.found)
    stages.run(
        f"MuJoCo {environment.version}: Python tests",
        lambda: _pytest_selected(environment, arguments, may_be_none=chosen_in_cpp),
    )


def _pytest_selected(environment: Environment, arguments: list[str], *, may_be_none: bool) -> None:
    link_cgal(environment.venv)
    report = RESULTS / f"mujoco-{environment.version}-python.xml"
    # A few tests are sooner run than shared out: each process imports all files to choose of them.
    jobs = "0" if "-k" in arguments else JOBS
    done = subprocess.run(
        [str(environment.python), "-m", "pytest", "-n", jobs, *_SHARED_OUT,
         f"--junit-xml={report}", *arguments],
        cwd=ROOT, check=False,
    )  # fmt: skip
    if done.returncode == _NO_TESTS and may_be_none:
        return
    if done.returncode != 0:
        stop(f"pytest ended with status {done.returncode}")
