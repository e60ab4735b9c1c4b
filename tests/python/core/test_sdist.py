# SPDX-License-Identifier: Apache-2.0
"""The source distribution: what `pip install volcontact-*.tar.gz` compiles.

That it installs and works is measured by tests/benchmarks/pip_install.py, which takes minutes.
"""

import csv
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
RECORD = ROOT / "tests" / "benchmarks" / "results" / "pip_install.csv"
BUILD = "import sys; from scikit_build_core.build import build_sdist; build_sdist(sys.argv[1])"


@pytest.fixture(scope="module")
def wanted():
    """All files of the repository."""
    listed = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if listed.returncode != 0:
        pytest.skip("this is no checkout")
    return {name for name in listed.stdout.split() if (ROOT / name).is_file()}


@pytest.fixture(scope="module")
def files(wanted, tmp_path_factory):
    """Of the distribution; in the checkout itself all that ./run put there would be looked at."""
    pytest.importorskip("scikit_build_core")
    copy, folder = tmp_path_factory.mktemp("checkout"), tmp_path_factory.mktemp("sdist")
    for name in (*wanted, "build/core/CMakeCache.txt", ".venv/newest"):
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_bytes((ROOT / name).read_bytes() if name in wanted else b"built")
    subprocess.run([sys.executable, "-c", BUILD, folder], cwd=copy, check=True, capture_output=True)
    (archive,) = folder.glob("volcontact-*.tar.gz")
    with tarfile.open(archive) as tar:
        return {name.partition("/")[2] for name in tar.getnames()}


def test_has_every_file_of_the_repository_but_the_gpl_program(files, wanted):
    missing = wanted - files
    assert missing and all(name.startswith("plugin/cgal/") for name in missing), sorted(missing)


def test_has_nothing_that_was_built(files):
    assert not [name for name in files if name.startswith(("build/", ".venv/"))]


def test_record_says_what_installing_costs_and_downloads():
    with RECORD.open(encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert float(row["processor_s"]) > 0.0
    named = set(row["downloads"].split())
    assert {"nanobind", "scikit-build-core", "mujoco", "numpy", "rich"} <= named
