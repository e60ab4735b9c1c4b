# SPDX-License-Identifier: Apache-2.0
"""What a scene of many bodies costs: n free boxes on a floor, and one box among n that do not move.

    ./run python tests/benchmarks/many_bodies.py [100 1000 ...]

For each n: time and memory of `attach`, and a step under volumetric and native contact and without
contact, in turns in one process a row, processor time of one thread. Writes results/many_bodies.csv
and results/fixed_bodies.csv; docs/generate/make_performance.py has the tables.
"""

from __future__ import annotations

import csv
import json
import resource
import subprocess
import sys
import time
from pathlib import Path

import mujoco
import numpy as np

import volcontact as vc

RESULTS = Path(__file__).parent / "results"
COLUMNS = (
    *("bodies", "attach_s", "kilobytes_per_geom", "first_step_ms"),
    *("volumetric_us", "native_us", "apart_us", "sites"),
)
KINDS = {  # file: whether the boxes are free, and how many of them
    "many_bodies": (True, [10, 100, 300, 1000, 5000]),
    "fixed_bodies": (False, [10, 100, 1000, 10000]),
}
MATERIAL, OPTIONS = {"stiffness": 1e8}, {"threads": 1}
SPACING, HALF, STEP = 0.25, 0.1, 0.002


def scene(bodies: int) -> str:
    """Boxes side by side in a square, a tenth of a millimetre above the floor."""
    side = int(np.ceil(np.sqrt(bodies)))
    boxes = "".join(
        f'<body pos="{SPACING * (i % side)} {SPACING * (i // side)} {HALF + 1e-4}">'
        f'<freejoint/><geom type="box" size="{HALF} {HALF} {HALF}" mass="1"/></body>'
        for i in range(bodies)
    )
    return (
        f'<mujoco><option timestep="{STEP}"/><size memory="2G"/><worldbody>'
        f'<geom type="plane" size="50 50 1"/>{boxes}</worldbody></mujoco>'
    )


def fixed_scene(bodies: int) -> str:
    """A box that lies on a floor, beside boxes of the world that it does not touch."""
    side = int(np.ceil(np.sqrt(bodies)))
    boxes = "".join(
        f'<geom type="box" size="{HALF} {HALF} {HALF}" '
        f'pos="{SPACING * (1 + i % side)} {SPACING * (i // side)} 0"/>'
        for i in range(bodies)
    )
    return (
        f'<mujoco><option timestep="{STEP}"/><size memory="200M"/><worldbody>'
        f'<geom type="plane" size="50 50 1"/>{boxes}<body pos="0 0 {HALF - 1e-4}"><freejoint/>'
        f'<geom type="box" size="{HALF} {HALF} {HALF}" mass="1"/></body></worldbody></mujoco>'
    )


def memory() -> int:
    """Most memory that the process had, in bytes."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def rates(model: mujoco.MjModel, steps: int) -> float:
    """Microseconds a step of boxes that lie."""
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 20)
    begin = time.process_time()
    mujoco.mj_step(model, data, steps)
    return 1e6 * (time.process_time() - begin) / steps


def measured(bodies: int, are_free: bool) -> dict[str, float]:
    """One row."""
    model = mujoco.MjModel.from_xml_string((scene if are_free else fixed_scene)(bodies))
    # Past the most that compiling took, the most says what attach takes.
    touched = np.ones(max(0, memory()) // 64 + 1)
    before, begin = memory(), time.process_time()
    with vc.attach(model, material=MATERIAL, options=OPTIONS) as contact:
        attach = time.process_time() - begin
        used = memory() - before
        data = mujoco.MjData(model)
        begin = time.process_time()
        mujoco.mj_step(model, data)
        first = time.process_time() - begin
        mujoco.mj_step(model, data, 20)
        sites = len(contact.sites(data))
    del touched
    steps = max(10, 20000 // bodies)
    ours, native, apart = [], [], []
    for _ in range(5):
        with vc.attach(model, material=MATERIAL, options=OPTIONS):
            ours.append(rates(model, steps))
        native.append(rates(model, steps))
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        apart.append(rates(model, steps))
        model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    return {
        "bodies": bodies,
        "attach_s": attach,
        "kilobytes_per_geom": used / 1024 / (bodies + 1),
        "first_step_ms": 1e3 * first,
        "volumetric_us": float(np.median(ours)),
        "native_us": float(np.median(native)),
        "apart_us": float(np.median(apart)),
        "sites": sites,
    }


def main() -> None:
    """A process a row, so that none has memory of another."""
    if sys.argv[1:2] == ["--row"]:
        print(json.dumps(measured(int(sys.argv[2]), sys.argv[3] == "free")))
        return
    for name, (are_free, usual) in KINDS.items():
        rows = []
        for bodies in [int(word) for word in sys.argv[1:]] or usual:
            kind = "free" if are_free else "fixed"
            command = [sys.executable, __file__, "--row", str(bodies), kind]
            out = subprocess.run(command, check=True, capture_output=True, text=True).stdout
            rows.append(json.loads(out.splitlines()[-1]))
            print(kind, *(f"{column}={rows[-1][column]:.4g}" for column in COLUMNS), flush=True)
        with (RESULTS / f"{name}.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows({k: f"{v:.5g}" for k, v in row.items()} for row in rows)


if __name__ == "__main__":
    main()
