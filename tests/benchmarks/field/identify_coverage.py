# SPDX-License-Identifier: Apache-2.0
"""How often 95 % intervals hold the truth: writes results/identify_coverage.json.

    ./run python tests/benchmarks/field/identify_coverage.py [--until N] [--seconds S]

Ten tosses of a cube with the noise of the real ones, identified again and again with other noise;
their starts are looked for as well. Goes on where it was stopped.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "python" / "support"))

from synthetic_tosses import NUISANCE, noisy, parameter, scene, tosses, write  # noqa: E402

from volcontact.identify.reading import read_settings  # noqa: E402
from volcontact.identify.run import run  # noqa: E402

RESULT = Path(__file__).parent / "results" / "identify_coverage.json"
REPETITIONS = 200
TRUE = {"stiffness": 5e8, "damping": 4.0, "friction": 0.18}
GUESS = TRUE  # from elsewhere it takes the search longer, and the intervals are the same
HELD = {"slip_speed": 0.01}
STUDY = (
    parameter("stiffness", 1e8, 5e9)
    + parameter("damping", 0.4, 40.0)
    + parameter("friction", 0.05, 0.5, "linear")
    + NUISANCE
    + "[estimator]\nstarts = 1\nevaluations = 40\ntolerance = 1e-5\n[uncertainty]\nscale = false\n"
)


def repetition(number: int, rows: Any, folder: Path) -> dict[str, Any]:
    """One identification, with noise of its own: values, ends of intervals, what it came to."""
    study = write(folder, scene(GUESS | HELD), noisy(rows, number), STUDY)
    found = run(read_settings(study), None, workers=1)
    told = found.summary["parameters"]
    return {
        "number": number,
        "converged": found.converged,
        "cost": found.summary["cost"],
        "values": found.values,
        "intervals": {name: [each["low"], each["high"]] for name, each in told.items()},
    }


def held(results: list[dict[str, Any]], name: str) -> int:
    """How many intervals of a parameter hold the truth."""
    ends = [each["intervals"][name] for each in results]
    return sum(
        low is not None and high is not None and low <= TRUE[name] <= high for low, high in ends
    )


def main() -> None:
    """Repeats."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--until", type=int, default=REPETITIONS)
    parser.add_argument("--seconds", type=float, default=float("inf"))
    asked = parser.parse_args()
    results: list[dict[str, Any]] = []
    if RESULT.exists():
        results = json.loads(RESULT.read_text(encoding="utf-8"))
    rows, begin = tosses(scene(TRUE | HELD)), time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        for number in range(len(results), asked.until):
            if time.monotonic() - begin > asked.seconds:
                break
            results.append(repetition(number, rows, Path(folder)))
            RESULT.write_text(json.dumps(results) + "\n", encoding="utf-8")
    print(len(results), {name: held(results, name) for name in TRUE})


if __name__ == "__main__":
    main()
