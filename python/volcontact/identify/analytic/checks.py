# SPDX-License-Identifier: Apache-2.0
"""Ranges of what formulas take."""

from __future__ import annotations

import math

_MOST_POISSON = 0.5


def above_zero(name: str, value: float, unit: str) -> float:
    """The value, if it is a finite number above 0.

    Raises:
        ValueError: it is not.
    """
    if not (math.isfinite(value) and value > 0.0):
        raise ValueError(f"{name} = {value:g} [{unit}]: must be a finite number above 0")
    return float(value)


def poisson(value: float) -> float:
    """Poisson's ratio, if it is one.

    Raises:
        ValueError: it is not.
    """
    if not -1.0 < value <= _MOST_POISSON:
        raise ValueError(f"poisson_ratio = {value:g} [-]: must be above -1 and at most 0.5")
    return float(value)


def restitution(value: float) -> float:
    """A coefficient of restitution, if it is one.

    Raises:
        ValueError: it is not.
    """
    if not 0.0 < value <= 1.0:
        raise ValueError(
            f"restitution = {value:g} [-]: must be above 0 and at most 1; it is the speed after "
            "over the speed before"
        )
    return float(value)
