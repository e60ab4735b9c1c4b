# SPDX-License-Identifier: Apache-2.0
"""Which stiffness, friction and start of the tippe-top come closest to the CSA paper's events.

`./run python tests/validation/support/sweep_tippe_top.py` makes some hundred runs, in a quarter of
an hour, and writes tippe_top.json, from which docs/validation.md has its tables.
"""

from __future__ import annotations

import itertools
import json
import math
import sys
from dataclasses import asdict, replace
from pathlib import Path

import mujoco

sys.path.append(str(Path(__file__).parents[1]))  # where the cases are

from test_tippe_top import PAPER, Setting, spin

RESULTS = Path(__file__).with_name("tippe_top.json")
STEP, DURATION = 1e-4, 6.5  # [s]; half the step changes no event by a millisecond
STIFFNESSES = (1e8, 1.5e8, 2e8, 3e8, 5e8, 1e9, 2e9, 1.66e10)
FRICTIONS = (0.225, 0.25, 0.275, 0.3, 0.325, 0.35)
# One at a time, about the closest of the grid.
OTHERS = {
    "damping": (0.1, 1.0, 10.0),
    "coupling": ("ellipsoid",),
    "speed": (160.0, 170.0, 190.0, 200.0),
    "tilt": (0.05, 0.075, 0.125, 0.15),
}
# All together: each is moved by its step up and down as long as that comes closer.
MOVES = {"stiffness": 1.15, "friction": 1.02, "speed": 1.02, "tilt": 1.05}


def measured(setting: Setting) -> dict[str, float | str | None]:
    """A row of the results: the setting and its events [s], None for never."""
    top = spin(setting, step=STEP, duration=DURATION)
    events = {name: getattr(top, name) for name in ("upright", "touch", "beyond_150", "falls")}
    return asdict(setting) | {n: None if math.isnan(t) else round(t, 6) for n, t in events.items()}


def distance(row: dict[str, float | str | None]) -> float:
    """From the paper's events: the sum of the squared logarithms of the ratios."""
    if any(row[name] is None for name in PAPER):
        return math.inf
    return sum(math.log(row[name] / time) ** 2 for name, time in PAPER.items())


class Sweep:
    """Runs that were made, each once."""

    def __init__(self) -> None:
        self._rows: dict[Setting, dict[str, float | str | None]] = {}

    def run(self, setting: Setting) -> dict[str, float | str | None]:
        """The row of a setting."""
        if setting not in self._rows:
            self._rows[setting] = row = measured(setting)
            print(len(self._rows), row, f"{distance(row):.4f}", flush=True)
        return self._rows[setting]

    def closest(self) -> Setting:
        """The setting that comes closest."""
        return min(self._rows, key=lambda setting: distance(self._rows[setting]))

    def descend(self, start: Setting) -> Setting:
        """From a setting to one that no single move brings closer."""
        best, scale = start, dict.fromkeys(MOVES, 4.0)
        while max(scale.values()) >= 1.0:
            for name, factor in MOVES.items():
                tries = [
                    replace(best, **{name: float(f"{getattr(best, name) * factor**s:.4g}")})
                    for s in (scale[name], -scale[name])
                ]
                least = min((best, *tries), key=lambda setting: distance(self.run(setting)))
                if least == best:
                    scale[name] *= 0.5
                best = least
        return best


def main() -> None:
    """Writes the results."""
    sweep = Sweep()
    grid = [Setting(k, mu) for k, mu in itertools.product(STIFFNESSES, FRICTIONS)]
    results = {"mujoco": mujoco.__version__, "step": STEP, "grid": [sweep.run(s) for s in grid]}
    best = sweep.closest()
    others = [replace(best, **{name: v}) for name, values in OTHERS.items() for v in values]
    results["others"] = [sweep.run(setting) for setting in (best, *others)]
    ends = {sweep.descend(start) for start in (best, sweep.closest(), replace(best, tilt=0.06))}
    results["closest"] = sorted((sweep.run(setting) for setting in ends), key=distance)
    RESULTS.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
