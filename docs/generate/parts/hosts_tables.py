# SPDX-License-Identifier: Apache-2.0
"""Tables of docs/hosts.md and docs/hosts/ from tests/benchmarks/results/hosts.json."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

RESULT = Path(__file__).parents[3] / "tests" / "benchmarks" / "results" / "hosts.json"
SCENE = {"ball_in_cylinder": "ball in a cylinder", "tippe_top": "tippe-top"}
FREE_FALL = 0.390596  # to the wall of the bore, sqrt(2 sqrt(0.9^2 - 0.5^2)/g) [s]


@functools.cache
def results() -> dict[str, Any]:
    """What `make_hosts.py` measured."""
    return json.loads(RESULT.read_text(encoding="utf-8"))


def host(name: str) -> str:
    """Events of one simulator beside MuJoCo's."""
    found, reference = results()["hosts"][name], results()["reference"]
    mujoco = f"MuJoCo {results()['mujoco']} [s]"
    lines = [
        f"| scene | event | {mujoco} | {found['version']} [s] | difference [s] |",
        "| --- " * 5 + "|",
    ]
    for scene, events in found["events"].items():
        for event, time in events.items():
            expected = reference[scene][event]
            cells = f"{expected:.6f}", f"{time:.6f}", difference(time - expected)
            lines.append(f"| {' | '.join((SCENE[scene], event, *cells))} |")
    seconds = found["seconds"]
    lines.append(
        f"\nFree fall takes the ball to the wall in {FREE_FALL} s; the straight line between "
        "samples 1 ms apart, in both columns, meets it 7e-7 s early. The runs took "
        f"{seconds['ball_in_cylinder']:g} s and {seconds['tippe_top']:g} s of one core."
    )
    return "\n".join(lines) + "\n"


def difference(seconds: float) -> str:
    """Less than a picosecond is the rounding of a sum of steps."""
    return f"{seconds:.1g}" if abs(seconds) > 1e-12 else "0"


def hosts(_: str) -> str:
    """All simulators: the largest difference of each scene."""
    titles = [f"{scene}, largest difference [s]" for scene in SCENE.values()]
    lines = [f"| page | version | {' | '.join(titles)} |", "| --- " * 4 + "|"]
    for name, found in results()["hosts"].items():
        worst = [
            max(abs(time - results()["reference"][scene][event]) for event, time in events.items())
            for scene, events in found["events"].items()
        ]
        cells = [f"[{name}](hosts/{name}.md)", found["version"], *(f"{w:.1g}" for w in worst)]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"
