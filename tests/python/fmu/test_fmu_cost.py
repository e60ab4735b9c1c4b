# SPDX-License-Identifier: Apache-2.0
"""A unit costs hardly more than the C call in it, for the battery box: docs/fmu.md, "Cost"."""

import subprocess
import sys
from pathlib import Path

import mujoco
import pytest

from volcontact.fmu.container import library_folder

ROOT = Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "tests" / "benchmarks"))
import fmu_cost  # noqa: E402 - lies there

MOST = 1.15


@pytest.mark.soak
@pytest.mark.skipif(
    tuple(map(int, mujoco.__version__.split(".")[:2])) < (3, 0),
    reason="has nothing to do with MuJoCo: once is enough",
)
def test_a_step_and_the_derivatives_cost_at_most_a_seventh_more_than_the_call(tmp_path):
    """A time: nothing for `./run test`."""
    program, folder = tmp_path / "fmu_cost", library_folder()
    source = Path(fmu_cost.__file__).with_suffix(".cc")
    libraries = [folder / "libvolcontact.so", f"-Wl,-rpath,{folder}", "-ldl"]
    compiler = ["c++", "-std=c++20", "-O2", f"-I{ROOT / 'plugin'}"]
    subprocess.run([*compiler, source, "-o", program, *libraries], check=True)
    # The two take turns; where others keep the machine busy, one of three runs is quiet enough.
    runs = fmu_cost.measure(str(program), runs=3)
    assert runs[0]["sites"] > 1.0
    for ratio in ("get_derivatives_ratio", "do_step_ratio"):
        assert min(run[ratio] for run in runs) <= MOST
