# SPDX-License-Identifier: Apache-2.0
"""Intervals of ten noisy tosses hold the truth as often as they say; the page has many more."""

import sys
from pathlib import Path

from scipy import stats
from soaking import cases
from synthetic_tosses import scene, tosses

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks" / "field"))
import identify_coverage as bench

REPETITIONS = cases(1, soak=10)


def test_intervals_hold_the_truth(tmp_path):
    """As many as binomial chance leaves them, but for 1 in 1000: of 3 at least 1, of 30 24."""
    rows = tosses(scene(bench.TRUE | bench.HELD))
    # Noise of its own: the page's begins at 0.
    results = [bench.repetition(1000 + n, rows, tmp_path) for n in range(REPETITIONS)]
    assert all(each["converged"] for each in results)
    held = sum(bench.held(results, name) for name in bench.TRUE)
    least = int(stats.binom.ppf(1e-3, REPETITIONS * len(bench.TRUE), 0.95))
    assert held >= least
    for each in results:  # intervals that are narrow enough to say something
        for name, (low, high) in each["intervals"].items():
            assert high - low < 0.1 * bench.TRUE[name]
