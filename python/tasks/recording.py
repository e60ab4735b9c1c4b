# SPDX-License-Identifier: Apache-2.0
"""Measurements that are kept: benchmarks, accuracy, search, campaign, releases, wheels."""

from __future__ import annotations

import csv
import os
import re
import shutil
import xml.etree.ElementTree as xml
from pathlib import Path

from tasks.building import CORE, build, build_core, configure
from tasks.cgal import NoCgal, build_cgal, link_cgal
from tasks.environments import BASELINE, Environment, NoPython, located, prepared
from tasks.interpreters import VERSIONS, all_interpreters, from_newer_debian
from tasks.shell import BUILD, RESULTS, ROOT, Stopped, output_of, run, say
from tasks.sites import tool_environment
from tasks.system import need_system
from tasks.testing import pytest

TABLES = ROOT / "tests" / "benchmarks" / "results"
# Releases whose structs or functions differ from those before, and what is tested on each.
MATRIX = [BASELINE, "2.3.7", "3.0.1", "3.3.7", "3.10.0", "3.17.0", "newest"]
_MATRIX_TESTS = [
    f"tests/python/{name}.py"
    for name in (
        "adaptor/test_ledger", "adaptor/test_checkpoints", "adaptor/test_parallel_runs",
        "adaptor/test_mixed_scenes", "adaptor/test_releases_agree", "hosts/test_hosts",
        "scene/test_scene", "scene/test_scene_batches", "scene/test_scene_errors",
        "scene/test_scene_reading",
    )
]  # fmt: skip
# In turns, so that a busy second spoils no row.
_OFTEN = [
    "--benchmark_repetitions=9",
    "--benchmark_enable_random_interleaving=true",
    "--benchmark_min_time=0.03",
    "--benchmark_report_aggregates_only=true",
]


def benchmark(environment: Environment, arguments: list[str]) -> None:
    """All benchmarks and their page, or with arguments the C++ ones alone, which keeps nothing."""
    # As users have it: two threads of the octree are not put to sleep between calls.
    os.environ.pop("OMP_WAIT_POLICY", None)
    _build(environment, "volcontact_benchmarks")
    folder = environment.tree / "tests" / "benchmarks"
    programs = sorted(folder.glob("*_benchmark"))
    if arguments:
        for program in programs:
            run(program, *arguments)
        return
    try:
        environment.install("--group", "benchmark")
    except Stopped:
        say("some of the other libraries cannot be installed here: they are left out")
    try:
        build_cgal()
    except NoCgal as error:
        say(f"going on without CGAL: {error}")
    link_cgal(environment.venv)
    os.environ["PYTHONPATH"] = str(folder)
    _measure(environment, "conditions", "conditions")
    for program in programs:
        out = environment.tree / "benchmark.csv"
        run(program, *_OFTEN, f"--benchmark_out={out}", "--benchmark_out_format=csv")
        text = out.read_text()
        table = TABLES / f"{program.name.removesuffix('_benchmark')}.csv"
        table.write_text(text[text.index("name,") :])  # what is before names this machine
    for script, table_name in (("step", "steps"), ("peers", "peers"), ("mesh", "mesh_pairs")):
        _measure(environment, f"{script}_benchmark", table_name)
    environment.script("tests/benchmarks/many_bodies.py")
    try:
        environment.script("tests/benchmarks/simbody.py")
    except Stopped:
        say("Simbody is left out")
    for page in ("performance", "comparison", "blocks"):
        environment.script(f"docs/generate/make_{page}.py")


def accuracy(environment: Environment, arguments: list[str]) -> None:
    """Measures the errors of all engines, or of those named, and writes their page."""
    program = _program(environment, "characterise")
    table, record = environment.tree / "accuracy.csv", TABLES / "accuracy.csv"
    with table.open("w") as file:
        run(program, *arguments, table=file)
    named = {word for word in arguments if not word.isdecimal()}
    if named and record.exists():
        with table.open(newline="") as file:
            measured = list(csv.DictReader(file))
        with record.open(newline="") as file:
            kept = [row for row in csv.DictReader(file) if row["engine"] not in named]
        place = {(row["a"], row["b"]): i for i, row in enumerate(kept)}
        rows = sorted(kept + measured, key=lambda row: place.get((row["a"], row["b"]), len(place)))
        with table.open("w", newline="") as file:
            writer = csv.DictWriter(file, list(measured[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    table.replace(record)
    environment.script("docs/generate/make_accuracy.py")
    environment.script("docs/generate/make_blocks.py")


def search(environment: Environment, arguments: list[str]) -> None:
    """Arguments are those of the random search, as `--cases 10000` or `--family cones`."""
    if not arguments:
        program = _program(environment, "fuzz_pairs")
        environment.script("tests/benchmarks/search_for_failures.py", program)
    program = _program(environment, "search_pairs")
    environment.script("tests/benchmarks/random_search.py", program, *arguments)
    if not arguments:
        environment.script("tests/benchmarks/search_meshes.py")
    environment.script("docs/generate/make_accuracy.py")


def campaign(environment: Environment, arguments: list[str]) -> None:
    """Runs what is missing of the campaign and writes its page."""
    environment.script("tests/campaign/campaign.py", *arguments)
    environment.script("docs/generate/make_campaign.py")


def matrix(releases: list[str]) -> None:
    """Adds a row for each release to the table; what does not build is a row, too."""
    RESULTS.mkdir(parents=True, exist_ok=True)
    # All are set up before the first is tested: each is compared with the newer ones.
    built = {release: _try_to_prepare(release) for release in releases or MATRIX}
    table = TABLES / "releases.csv"
    rows = {}
    if table.exists():
        rows = {row["mujoco"]: row for row in csv.DictReader(table.open())}
    for release, environment in built.items():
        version = (environment or located(release)).version
        report = RESULTS / f"mujoco-{version}-python.xml"
        report.unlink(missing_ok=True)
        if environment is not None:
            try:
                pytest(environment, ["-q", *_MATRIX_TESTS])
            except Stopped as error:
                say(str(error))
        rows[version] = _matrix_row(version, report, located(version).venv)
    with table.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(next(iter(rows.values()))), lineterminator="\n")
        writer.writeheader()
        writer.writerows(
            sorted(rows.values(), key=lambda r: [int(n) for n in r["mujoco"].split(".")])
        )
    print(table.read_text())


def wheels(arguments: list[str]) -> None:
    """One for each Python here, with the adaptors of the matrix; or for another machine.

    The other release shows that what is not in a wheel is compiled at first use.
    """
    python = tool_environment("wheels")
    need_system("mmdebstrap", "patchelf")
    pythons = {path.name: path for path in reversed(list(all_interpreters()))}
    for version in sorted(VERSIONS):
        other_python = None if f"python{version}" in pythons else from_newer_debian(version)
        if other_python is not None:
            pythons = {other_python.name: other_python} | pythons
    script, other = "make_wheels.py", ["--other", "3.5.0"]
    if "--machine=aarch64" in arguments:
        maven = [] if shutil.which("mvn") else ["maven"]  # it may be there without a package
        need_system("g++-aarch64-linux-gnu", "qemu-user-static", *maven)
        script, other = "make_aarch64_wheels.py", []
        arguments = [each for each in arguments if not each.startswith("--machine")]
    run(
        python, ROOT / "python" / script, *other,
        "--releases", *MATRIX, "--pythons", *reversed(pythons.values()), *arguments,
    )  # fmt: skip


def _build(environment: Environment, target: str) -> None:
    need_system("libbenchmark-dev")
    configure(environment.tree, VOLCONTACT_BENCHMARKS="ON")
    build(environment.tree, target)
    TABLES.mkdir(parents=True, exist_ok=True)


def _program(environment: Environment, name: str) -> Path:
    _build(environment, name)
    return environment.tree / "tests" / "benchmarks" / name


def _measure(environment: Environment, script: str, table: str) -> None:
    environment.script(f"tests/benchmarks/{script}.py", "--out", TABLES / f"{table}.csv")


def _try_to_prepare(release: str) -> Environment | None:
    try:
        return prepared(release, tests=True)
    except (Stopped, NoPython) as error:
        say(str(error))
        return None


def _matrix_row(version: str, report: Path, venv: Path) -> dict[str, str | int]:
    row: dict[str, str | int] = {"mujoco": version, "python": "", "passed": 0}
    row |= {"failed": "not built", "skipped": 0, "left_out": ""}
    if not report.exists():
        return row
    suites = list(xml.parse(report).iter("testsuite"))
    count = {
        key: sum(int(suite.get(key, 0)) for suite in suites)
        for key in ("tests", "failures", "errors", "skipped")
    }
    failed = count["failures"] + count["errors"]
    row |= {"failed": failed, "skipped": count["skipped"]}
    row["passed"] = count["tests"] - failed - count["skipped"]
    reasons = {skip.get("message", "") for suite in suites for skip in suite.iter("skipped")}
    row["left_out"] = "; ".join(sorted(reasons))
    folders = [path.name for path in (venv / "lib").glob("python3.*")]
    row["python"] = re.sub("^python", "", folders[0])
    return row


def sanitize() -> None:
    """The C++ tests of the core and of `c_api` under the sanitizers of memory and arithmetic."""
    need_system("libgtest-dev")
    # The sanitizers are to watch the core; the tests are compiled once.
    build_core("volcontact_core_tests", VOLCONTACT_TESTS="ON")
    run("cmake", "--preset", "asan", f"-DVOLCONTACT_TEST_OBJECTS={CORE}")
    run("cmake", "--build", "--preset", "asan", "--target", "volcontact_core_tests",
        "volcontact_c_api_tests")  # fmt: skip
    jobs = os.environ["CMAKE_BUILD_PARALLEL_LEVEL"]
    run("ctest", "--preset", "asan", "--no-tests=error", "-j", jobs)


def threads(environment: Environment) -> None:
    """It knows nothing of OpenMP's own locks: tests that stay on their own threads."""
    need_system("libgtest-dev")
    mujoco = f"-DMUJOCO_DIR={environment.mujoco}"
    run("cmake", "--preset", "tsan", "-DVOLCONTACT_MUJOCO=ON", mujoco)
    run("cmake", "--build", "--preset", "tsan", "--target", "c_api_test", "adaptor_threads_test")
    tests = BUILD / "tsan" / "tests"
    run(tests / "c_api" / "c_api_test", "--gtest_filter=CThreads.*")
    run(tests / "adaptor" / "adaptor_threads_test")
    assert output_of("cmake", "--version")
