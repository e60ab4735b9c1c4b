# SPDX-License-Identifier: Apache-2.0
"""Tables of docs/hosts.md and docs/hosts/ from tests/benchmarks/results/hosts.json."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

RESULT = Path(__file__).parents[2] / "tests" / "benchmarks" / "results" / "hosts.json"
SCENE = {"ball_in_cylinder": "ball in a cylinder", "tippe_top": "tippe-top"}
FREE_FALL = 0.390596  # to the wall of the bore, sqrt(2 sqrt(0.9^2 - 0.5^2)/g) [s]


@functools.cache
def results() -> dict[str, Any]:
    """What `make_hosts.py` measured."""
    return json.loads(RESULT.read_text(encoding="utf-8"))


def host(name: str) -> str:
    """Events of one simulator beside MuJoCo's."""
    found, reference = results()["hosts"][name], results()["reference"]
    lines = [
        f"| scene | event | MuJoCo {results()['mujoco']} [s] | {found['version']} [s] | difference [s] |",
        "| --- " * 5 + "|",
    ]
    for scene, events in found["events"].items():
        for event, time in events.items():
            expected = reference[scene][event]
            lines.append(
                f"| {SCENE[scene]} | {event} | {expected:.6f} | {time:.6f} | {time - expected:.1g} |"
            )
    seconds = found["seconds"]
    lines.append(
        f"\nFree fall takes the ball to the wall in {FREE_FALL} s. The runs took "
        f"{seconds['ball_in_cylinder']:g} s and {seconds['tippe_top']:g} s of one core."
    )
    return "\n".join(lines) + "\n"


def hosts(_: str) -> str:
    """All simulators: the largest difference of each scene."""
    lines = [
        "| page | version | ball in a cylinder, largest difference [s] | tippe-top, largest difference [s] |",
        "| --- " * 4 + "|",
    ]
    for name, found in results()["hosts"].items():
        worst = [
            max(abs(time - results()["reference"][scene][event]) for event, time in events.items())
            for scene, events in found["events"].items()
        ]
        cells = [f"[{name}](hosts/{name}.md)", found["version"], *(f"{w:.1g}" for w in worst)]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"
