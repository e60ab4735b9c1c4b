# SPDX-License-Identifier: Apache-2.0
"""The outputs of fuzz_pairs are added up."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

SCRIPT = Path(__file__).resolve().parents[2] / "benchmarks" / "search_for_failures.py"


def search() -> ModuleType:
    """The script as a module."""
    spec = importlib.util.spec_from_file_location(SCRIPT.stem, SCRIPT)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


FIRST = """\
plan,1,0.5,0.25,0.1,0.2,0.3
count,lines,random,10,8
error,lines,random,1.00e-06
error,lines,random,3.00e-06
undecided,1
failure,lines,box,bored_block,missed,0.000000e+00,7.000000e-09,Pose{Mat3(1, 0), Vec3(0, 1)}
seconds,2.5
"""
SECOND = """\
plan,1,0.5,0.25,0.1,0.2,0.3
count,lines,random,5,4
count,clip,random,0,0
error,lines,random,2.00e-06
undecided,2
seconds,1.5
crash,7,-11
"""


def test_outputs_are_added_up() -> None:
    result = search().summary([FIRST, SECOND])
    (row,) = result["rows"]
    assert (row["engine"], row["poses"], row["overlapping"]) == ("lines", 15, 12)
    assert (row["compared"], row["median"], row["worst"]) == (3, 2e-6, 3e-6)
    assert (result["undecided"], result["crashes"], result["seconds"]) == (3, 1, 4)
    assert result["weights"] == [1.0, 0.5, 0.25]


def test_failures_keep_their_poses() -> None:
    (failure,) = search().summary([FIRST])["failures"]
    assert (failure["what"], failure["expected"]) == ("missed", 7e-9)
    assert failure["X_AB"] == "Pose{Mat3(1, 0), Vec3(0, 1)}"
