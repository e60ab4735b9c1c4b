# SPDX-License-Identifier: Apache-2.0
"""What the data tell and what they cannot, in words."""

from __future__ import annotations

import math

import numpy as np

from volcontact.identify.estimators.scales import Box
from volcontact.identify.estimators.uncertainty import Known
from volcontact.identify.settings import Parameter, Settings

CORRELATED = 0.98  # of two parameters that only their combination is known of
_WIDE = 0.5  # part of the range that an interval may fill
_EDGE = 1e-3  # part of the range that is at a bound


def told(settings: Settings, box: Box, point: np.ndarray, known: Known) -> dict[str, bool]:
    """Whether the data tell each parameter."""
    found = {}
    for place, each in enumerate(settings.parameters):
        low, high = known.low[place], known.high[place]
        inside = max(low, 0.0), min(high, 1.0)
        wide = not np.isfinite([low, high]).all() or inside[1] - inside[0] > _WIDE
        found[each.name] = not wide
    return found


def findings(settings: Settings, box: Box, point: np.ndarray, known: Known) -> list[str]:
    """Sentences on each parameter that is not plainly known."""
    lines = [known.chain.finding()] if known.chain and not known.chain.enough else []
    percent = f"{100 * settings.uncertainty.level:g} %"
    names = [each.name for each in settings.parameters]
    for place, each in enumerate(settings.parameters):
        line = _of_one(box, place, each, point, known, percent)
        if line:
            lines.append(line)
    for i, first in enumerate(names):
        for j in range(i):
            r = float(known.correlation[i, j])
            if abs(r) > CORRELATED:
                way = "rise together" if r > 0.0 else "make up for each other"
                lines.append(
                    f"{names[j]} and {first} are known in combination only: they {way} "
                    f"(correlation {r:.4f}). Hold one, or measure what tells them apart."
                )
    if settings.uncertainty.scale and known.method == "covariance" and known.noise > 3.0:
        lines.append(
            f"The errors are {known.noise:.3g} times what the given sigmas say: the model misses "
            "something, or the sigmas are too small. Intervals are widened by that."
        )
    return lines


def _of_one(
    box: Box, place: int, each: Parameter, point: np.ndarray, known: Known, percent: str
) -> str:
    low, high = float(known.low[place]), float(known.high[place])
    ends = [each.low if low <= 0.0 else _at(box, place, low)]
    ends.append(each.high if high >= 1.0 else _at(box, place, high))
    name, value = each.name, _at(box, place, float(point[place]))
    inside = min(high, 1.0) - max(low, 0.0)
    if inside > _WIDE and low <= 0.0 and high >= 1.0:
        return f"{name} cannot be told from these data: anything within its bounds fits."
    if inside > _WIDE and high >= 1.0:
        return f"{name} above {ends[0]:.3g} cannot be told from these data."
    if inside > _WIDE and low <= 0.0:
        return f"{name} below {ends[1]:.3g} cannot be told from these data."
    if inside > _WIDE:
        return (
            f"{name} is hardly told by these data: its {percent} interval, {ends[0]:.3g} to "
            f"{ends[1]:.3g}, fills more than half of its range."
        )
    if min(point[place], 1.0 - point[place]) < _EDGE:
        bound = "lower" if point[place] < 0.5 else "upper"
        return f"{name} = {value:.4g} lies at its {bound} bound: widen the bounds, or hold it."
    return ""


def _at(box: Box, place: int, share: float) -> float:
    each = box.parameters[place]
    if not math.isfinite(share):
        return each.low if share < 0.0 else each.high
    point = np.full(len(box.parameters), 0.5)
    point[place] = min(max(share, 0.0), 1.0)
    return box.values(point)[each.name]


def interval(box: Box, place: int, known: Known) -> tuple[float | None, float | None]:
    """Ends of the interval of a parameter; None beyond its bounds."""
    low, high = float(known.low[place]), float(known.high[place])
    return (
        None if low < 0.0 or not math.isfinite(low) else _at(box, place, low),
        None if high > 1.0 or not math.isfinite(high) else _at(box, place, high),
    )
