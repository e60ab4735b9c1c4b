# SPDX-License-Identifier: Apache-2.0
"""The friction of `bristle` where it is measured: at the breakaway, and in steady sliding.

From docs/theory.md, "Bristles", with f the normal force and s(u) = exp(-u^2 / v_s^2):

* after a rest t the bristles hold f (mu_C + (mu_S - mu_C) (1 - exp(-t / tau_dw)));
* at a steady speed u the deflection rests at sigma_0 z = mu_C f + sigma_1 u s / (1 - s) unless its
  bound f (mu_C + (mu_S - mu_C) s) is less, so friction is the smaller one, plus sigma_2 u.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from volcontact.identify import regression
from volcontact.identify.regression import Fit

_LEAST = 1.57  # least of x / (1 - exp(-x^2)) over x, times sigma_1 v_s: where the bound always rules
_TAUS = (0.1, 0.3, 0.7, 1.5)  # of the longest rest: first guesses of tau_dw
_SPEEDS = (0.15, 0.3, 0.5, 0.7, 0.85)  # quantiles of the speeds: first guesses of v_s
_RULES = 1e-6


@dataclass(frozen=True)
class Breakaways:
    """Friction over normal force at the end of rests.

    Attributes:
        rest: [s], shape (n,).
        friction: [-], shape (n,).
    """

    rest: np.ndarray
    friction: np.ndarray


@dataclass(frozen=True)
class Slides:
    """Friction over normal force at steady speeds.

    Attributes:
        speed: [m/s], shape (n,).
        friction: [-], shape (n,).
    """

    speed: np.ndarray
    friction: np.ndarray


def held(rest: np.ndarray, kinetic: float, static: float, dwell: float) -> np.ndarray:
    """mu at the breakaway after a rest."""
    found: np.ndarray = kinetic - (static - kinetic) * np.expm1(-rest / dwell)
    return found


def sliding(
    speed: np.ndarray,
    kinetic: float,
    static: float,
    stribeck: float,
    viscous: float,
    damping: float = math.inf,
) -> np.ndarray:
    """mu at a steady speed; viscous and damping are over the normal force [s/m]."""
    ratio = (speed / stribeck) ** 2
    share = np.exp(-ratio)
    bound = (static - kinetic) * share
    if math.isfinite(damping):
        with np.errstate(over="ignore"):
            free = damping * speed / np.expm1(np.maximum(ratio, 1e-300))
        bound = np.minimum(bound, free)
    found: np.ndarray = kinetic + bound + viscous * speed
    return found


def bound_rules(kinetic: float, static: float, stribeck: float, damping: float) -> bool:
    """Whether steady friction is its bound at every speed; damping over the normal force [s/m]."""
    return _LEAST * damping * stribeck >= static - kinetic - _RULES


def fit_friction(breakaways: Breakaways, slides: Slides, damping: float = math.inf) -> Fit:
    """Least squares over both tables at once.

    What a table cannot tell is left out of the names: without slides there are no `stribeck_speed`
    and no `viscous_friction`, without breakaways no `dwell_time`.

    Raises:
        ValueError: there are too few rows.
    """
    has_rest, has_speed = len(breakaways.rest) > 0, len(slides.speed) > 0
    names = ["friction", "static_friction"]
    names += ["dwell_time"] * has_rest + ["stribeck_speed", "viscous_friction"] * has_speed
    data = np.concatenate([breakaways.friction, slides.friction])

    def residuals(x: np.ndarray) -> np.ndarray:
        value = dict(zip(names, x, strict=True))
        kinetic, static = value["friction"], value["static_friction"]
        parts = []
        if has_rest:
            parts.append(held(breakaways.rest, kinetic, static, value["dwell_time"]))
        if has_speed:
            stribeck, viscous = value["stribeck_speed"], value["viscous_friction"]
            parts.append(sliding(slides.speed, kinetic, static, stribeck, viscous, damping))
        found: np.ndarray = np.concatenate(parts) - data
        return found

    best: Fit | None = None
    for start in _starts(breakaways, slides):
        values = [start[name] for name in names]
        low = [-math.inf if name == "viscous_friction" else 1e-9 for name in names]
        found = regression.fit(residuals, values, names, low=low)
        if best is None or found.residuals @ found.residuals < best.residuals @ best.residuals:
            best = found
    assert best is not None
    return best


def _starts(breakaways: Breakaways, slides: Slides) -> list[dict[str, float]]:
    every = np.concatenate([breakaways.friction, slides.friction])
    low, high = float(every.min()), float(every.max())
    taus = [float(breakaways.rest.max()) * part for part in _TAUS] if len(breakaways.rest) else [1.0]
    speeds: Sequence[float] = [1.0]
    if len(slides.speed):
        speeds = [float(np.quantile(slides.speed, part)) for part in _SPEEDS]
        top = slides.speed >= np.quantile(slides.speed, 0.7)
        low = float(slides.friction[top].min())
    size = float(slides.speed.max()) if len(slides.speed) else 1.0
    return [
        {
            "friction": low,
            "static_friction": high,
            "dwell_time": tau,
            "stribeck_speed": speed,
            "viscous_friction": 0.01 * low / size,
        }
        for tau in taus[: 1 if len(slides.speed) and len(taus) > 4 else None]
        for speed in speeds
    ]
