# SPDX-License-Identifier: Apache-2.0
"""A run of `./run wheels` that makes some wheels keeps what is known of the others."""

import csv
import importlib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


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
