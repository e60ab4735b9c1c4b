# SPDX-License-Identifier: Apache-2.0
"""The script that runs scenes of others, on scenes that are made here, and its recorded run."""

from __future__ import annotations

import csv
import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import mujoco
import pytest

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"

SCENE = """
<mujoco>
  <option timestep="2e-3">{flag}</option>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body pos="0 0 .051">
      <joint name="lift" type="slide" axis="0 0 1"/><joint name="slide" type="slide"/>
      <geom type="box" size=".05 .05 .05"/>
    </body>
  </worldbody>
  <actuator><motor joint="slide" ctrllimited="true" ctrlrange="-1 1"/></actuator>
</mujoco>"""


@pytest.fixture
def script() -> ModuleType:
    path = BENCHMARKS / "third_party.py"
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module  # its dataclasses look there
    spec.loader.exec_module(module)
    return module


def test_row_has_both_contacts(script):
    row = script.examine(lambda: mujoco.MjModel.from_xml_string(SCENE.format(flag="")), 300)
    assert (row["dofs"], row["pairs"], row["hulls"], row["said"]) == (2, 1, 0, "")
    assert (row["volumetric_contacts"], row["native_contacts"]) == (1, 4)
    assert row["volumetric_warnings"] == row["native_warnings"] == ""
    # A box of 1 kg (density 1000) at rest under k_v = 5e8: m g/(k_v A); deeper at first touch.
    assert 9.81 / (5e8 * 0.01) * 0.99 < float(row["volumetric_depth"]) < 1e-3
    assert 0.0 < float(row["native_depth"]) < 1e-2


def test_row_of_a_scene_that_is_refused_has_the_reason(script):
    keys = '<custom><numeric name="volcontact/option/tolerance" data="1e-3"/></custom>'
    text = SCENE.format(flag="").replace("</mujoco>", keys + "</mujoco>")  # without room
    row = script.examine(lambda: mujoco.MjModel.from_xml_string(text), 10)
    assert "mjData.userdata is too small" in row["refused"]
    assert "volumetric_us" not in row and row["native_contacts"] == 4


def test_recorded_run_has_no_warning_or_a_reason(script):
    with (BENCHMARKS / "results" / "third_party.csv").open(encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    assert [(row["package"], row["scene"]) for row in rows] == list(script.SCENES)
    assert {row["package"] for row in rows} == set(script.PACKAGES)
    ran = [row for row in rows if not row["refused"]]
    assert len(ran) >= 30
    assert not any(row["volumetric_warnings"] for row in ran)
