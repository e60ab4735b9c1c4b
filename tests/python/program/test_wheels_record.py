# SPDX-License-Identifier: Apache-2.0
"""The record of the wheels: what a run adds to it, and what it must hold."""

import csv
import importlib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
RECORD = ROOT / "tests" / "benchmarks" / "results" / "wheels.csv"
# Wheels that are still to be tried with a second release, or at all.
FEWER = {("cp314", "x86_64"): 1, ("cp313", "aarch64"): 1, ("cp314", "aarch64"): 1}


@pytest.fixture
def make_wheels(monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(str(ROOT / "python"))
    module = importlib.import_module("make_wheels")
    monkeypatch.setattr(module, "TABLE", tmp_path / "wheels.csv")
    module.TABLE.write_text("python,mujoco,adaptor,platform,depth_um\n")
    return module


def row(python, mujoco, machine, depth="24.525"):
    return {
        "python": python,
        "mujoco": mujoco,
        "adaptor": "in the wheel",
        "platform": f"manylinux_2_35_{machine}",
        "depth_um": depth,
    }


def test_rows_of_other_wheels_stay(make_wheels):
    newer, older = row("cp314", "4.0.0", "x86_64"), row("cp39", "2.2.2", "x86_64")
    other_machine = row("cp314", "4.0.0", "aarch64")
    for rows in ([older, row("cp314", "3.3.7", "x86_64", "24.526")], [other_machine], [newer]):
        make_wheels.write_table(rows)
    with make_wheels.TABLE.open() as file:
        assert list(csv.DictReader(file)) == [newer, older, other_machine]


@pytest.mark.parametrize("machine", ["x86_64", "aarch64"])
@pytest.mark.parametrize("python", ["cp310", "cp311", "cp312", "cp313", "cp314"])
def test_every_wheel_was_tried_with_several_releases_of_mujoco(python, machine):
    with RECORD.open() as file:
        rows = [row for row in csv.DictReader(file) if row["python"] == python]
    tried = [row for row in rows if row["platform"].endswith(f"_{machine}")]
    releases = {row["mujoco"] for row in tried if row["adaptor"] == "in the wheel"}
    assert len(releases) >= FEWER.get((python, machine), 2)
    assert {row["depth_um"] for row in tried} <= {"24.525"}  # of a cube at rest: make_wheels.py
