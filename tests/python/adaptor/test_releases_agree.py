# SPDX-License-Identifier: Apache-2.0
"""The same stream of poses gives the same forces under every newer MuJoCo that is set up here.

Newer ones alone: `./run test` sets them up first, while an older one may still hold a former build.
"""

import subprocess
from pathlib import Path

import mujoco
import numpy as np
import pose_stream
import pytest

ROOT = Path(__file__).parents[3]


def release(name: str) -> tuple[int, ...]:
    return tuple(int(part) for part in name.removeprefix("mujoco-").split("."))


OTHERS = [
    folder
    for folder in sorted((ROOT / ".venv").glob("mujoco-*"))
    if release(folder.name) > release(mujoco.__version__) and (folder / ".ready").exists()
]


@pytest.mark.skipif(not OTHERS, reason="no newer MuJoCo is set up in this checkout")
@pytest.mark.parametrize("other", OTHERS, ids=lambda folder: folder.name)
def test_core_agrees_to_the_bit_and_forces_to_rounding(other, tmp_path):
    out = tmp_path / "stream.npz"
    program = [other / "bin/python", Path(pose_stream.__file__), out]
    done = subprocess.run(program, capture_output=True, text=True)
    if "was built for" in done.stderr:
        pytest.skip(f"{other.name} is not built")
    assert done.returncode == 0, done.stderr
    theirs = np.load(out)
    core = pose_stream.through_the_core()
    assert np.count_nonzero(core[:, 0]) > 100
    assert np.array_equal(core, theirs["core"])
    forces = pose_stream.through_mujoco()
    largest = np.abs(forces).max(axis=0)
    assert largest.min() > 0.0
    np.testing.assert_array_less(np.abs(forces - theirs["mujoco"]).max(axis=0), 1e-12 * largest)
