# SPDX-License-Identifier: Apache-2.0
"""Probabilities with their intervals, and sensitivity indices, from the rows of a study."""

from __future__ import annotations

import math


def wilson(successes: int, trials: int, confidence: float = 0.95) -> tuple[float, float]:
    """The interval of a probability of which successes were seen in some trials [Wilson1927].

    Args:
        successes: how many.
        trials: of how many; at least 1.
        confidence: share of such intervals that hold the probability.
    """
    from scipy.special import ndtri

    score = float(ndtri(0.5 + 0.5 * confidence))
    share = successes / trials
    scale = 1.0 + score**2 / trials
    middle = (share + score**2 / (2.0 * trials)) / scale
    half = score / scale * math.sqrt(share * (1.0 - share) / trials + (score / (2.0 * trials)) ** 2)
    # At both ends the formula is exact but for rounding.
    low = 0.0 if successes == 0 else middle - half
    high = 1.0 if successes == trials else middle + half
    return low, high
