# SPDX-License-Identifier: Apache-2.0
"""Tables of the validation page from results that are kept, since they take long to make."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from parts.validation_peers import number

CASES = Path(__file__).resolve().parents[3] / "tests" / "validation" / "support"
EVENTS = {
    "upright": "upright",
    "touch": "stem touches",
    "beyond_150": "over 150 degrees",
    "falls": "falls",
}
OPEN = {
    "stiffness": "k_v [N/m^3]",
    "friction": "mu",
    "damping": "a [s/m]",
    "coupling": "coupling",
    "speed": "spin [rad/s]",
    "tilt": "tilt [rad]",
}


def whole_runs() -> str:
    """What every scene comes to, engine by engine."""
    lines = ["### What the runs come to\n"]
    for scene, record in _read("whole_runs.json").items():
        runs = record["runs"]
        lines += [
            f"| {' | '.join((scene, 'unit', *runs, 'asked'))} |",
            "| --- " * (len(runs) + 3) + "|",
        ]
        for name, about in record["outcomes"].items():
            values = [number(run[name]) for run in runs.values()]
            asked = number(about["tolerance"] or about["floor"])
            lines.append(f"| {' | '.join((name, about['unit'], *values, asked))} |")
        lines.append("")
    return "\n".join(lines)


def tippe_top() -> str:
    """Which stiffness, friction and start come closest to the paper's events."""
    results = _read("tippe_top.json")
    frictions = sorted({row["friction"] for row in results["grid"]})
    cells = {(row["stiffness"], row["friction"]): _cell(row) for row in results["grid"]}
    lines = [
        "### Parameters against the paper's events\n",
        "The paper has 0.15 s, 1.7 s and about 4 s, and no parameters. Upright / the stem touches "
        "/ falls [s], friction integrated over the patch:\n",
        f"| k_v [N/m^3] | {' | '.join(f'mu = {mu:g}' for mu in frictions)} |",
        "| --- " * (len(frictions) + 1) + "|",
    ]
    for stiffness in dict.fromkeys(row["stiffness"] for row in results["grid"]):
        row = (f"{stiffness:g}", *(cells[stiffness, mu] for mu in frictions))
        lines.append(f"| {' | '.join(row)} |")
    lines += ["\nThe first row is the closest of these; below it, one other number at a time:\n"]
    lines += _rows(results["others"])
    lines += [
        "\nWith stiffness, friction, spin and tilt at the start free, steps that come closer by "
        "the sum of squared logarithms of the three ratios end here:\n"
    ]
    return "\n".join(lines + _rows(results["closest"])) + "\n"


def _rows(rows: list[dict[str, Any]]) -> list[str]:
    head = (*OPEN.values(), *(f"{name} [s]" for name in EVENTS.values()))
    lines = [f"| {' | '.join(head)} |", "| --- " * len(head) + "|"]
    for row in rows:
        numbers = (f"{row[name]:g}" if name != "coupling" else row[name] for name in OPEN)
        lines.append(f"| {' | '.join((*numbers, *(_time(row[name]) for name in EVENTS)))} |")
    return lines


def _cell(row: dict[str, Any]) -> str:
    return " / ".join(_time(row[name]) for name in ("upright", "touch", "falls"))


def _time(time: float | None) -> str:
    return "-" if time is None else f"{time:.3f}"


def _read(name: str) -> dict[str, Any]:
    results: dict[str, Any] = json.loads((CASES / name).read_text(encoding="utf-8"))
    return results
