# SPDX-License-Identifier: Apache-2.0
"""What a unit costs beside the C call in it, for the battery box; docs/fmu.md, "Cost".

./run python tests/benchmarks/fmu_cost.py PROGRAM
"""

import argparse
import json
import subprocess
import tempfile
import zipfile
from pathlib import Path

import mujoco
import numpy as np

import volcontact as vc
from volcontact.running.simulation import to_start

ROOT = Path(__file__).parents[2]
SCENE = ROOT / "mjcf_models" / "battery_box" / "scene.xml"
AT_REST = 1.5  # [s]


def measure(program: str, runs: int = 1) -> list[dict[str, float]]:
    """Runs the program on the battery box where it stands in its cradle, as it moves there."""
    model = vc.load(SCENE)
    data = mujoco.MjData(model)
    to_start(model, data)
    with vc.attach(model):
        while data.time < AT_REST:
            mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
    body = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_BODY), "battery_box")
    velocity = np.zeros(6)
    mujoco.mj_objectVelocity(model, data, int(mujoco.mjtObj.mjOBJ_XBODY), body, velocity, 0)
    start = [*data.xpos[body], *data.xquat[body], *velocity]
    with tempfile.TemporaryDirectory() as folder:
        path = vc.export_fmu(SCENE, Path(folder) / "box.fmu", bodies=["battery_box", "world"])
        with zipfile.ZipFile(path) as fmu:
            fmu.extractall(folder)
        resources = Path(folder) / "resources"
        unit = resources / "unit.txt"
        lines = unit.read_text().splitlines()
        for i, line in enumerate(lines):
            words = line.split()
            if words[0] == "group" and int(words[3]) < len(start):
                first, count = int(words[3]), int(words[4])
                lines[i] = " ".join(
                    [*words[:7], *map(repr, map(float, start[first : first + count]))]
                )
        unit.write_text("\n".join(lines) + "\n")
        token = next(line.split()[1] for line in lines if line.startswith("token"))
        (binary,) = Path(folder).glob("binaries/*/box.*")
        command = [program, str(binary), str(resources), token]
        return [json.loads(subprocess.check_output(command, text=True)) for _ in range(runs)]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", help="the compiled fmu_cost.cc")
    print(json.dumps(measure(parser.parse_args().program)[0]))
