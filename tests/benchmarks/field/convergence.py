# SPDX-License-Identifier: Apache-2.0
"""What the step costs in scenes of the project: writes results/convergence.json.

./run python tests/benchmarks/field/convergence.py
"""

from __future__ import annotations

import json
from pathlib import Path

import mujoco

import volcontact as vc

ROOT = Path(__file__).parents[3]
RESULT = Path(__file__).parent / "results" / "convergence.json"
# Scene, duration [s], runs.
SCENES = (("battery_box", 2.0, 5), ("bouncing_ball", 2.0, 5), ("tippe_top", 0.3, 4))


def main() -> None:
    """Runs all and writes the results."""
    results = {}
    for name, duration, levels in SCENES:
        scene = ROOT / "mjcf_models" / name / "scene.xml"
        found = vc.converge(scene, duration=duration, levels=levels)
        results[name] = {
            "duration": duration,
            "mujoco": mujoco.mj_versionString(),
            **found.summary(),
        }
        print(name, [one.kind for one in found.estimates])
    text = json.dumps(results, indent=1, allow_nan=False) + "\n"
    RESULT.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
