# SPDX-License-Identifier: Apache-2.0
"""The friction of `bristle` where it is measured: at the breakaway, and in steady sliding.

From docs/theory.md, "Bristles", with f the normal force and s(u) = exp(-u^2 / v_s^2):

* after a rest t the bristles hold f (mu_C + (mu_S - mu_C) (1 - exp(-t / tau_dw)));
* at a steady speed u the deflection rests at sigma_0 z = mu_C f + sigma_1 u s / (1 - s) unless its
  bound f (mu_C + (mu_S - mu_C) s) is less, so friction is the smaller one, plus sigma_2 u.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from volcontact.identify.estimators import regression
from volcontact.identify.estimators.regression import Fit

_LEAST = (
    1.57  # least of x / (1 - exp(-x^2)) over x, times sigma_1 v_s: where the bound always rules
)
_GRID = 14  # first guesses of tau_dw and of v_s each
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
    """Mu at the breakaway after a rest."""
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
    """Mu at a steady speed; viscous and damping are over the normal force [s/m]."""
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

    start = _start(breakaways, slides)
    low = [-math.inf if name == "viscous_friction" else 1e-9 for name in names]
    return regression.fit(residuals, [start[name] for name in names], names, low=low)


def _start(breakaways: Breakaways, slides: Slides) -> dict[str, float]:
    """First guesses: at each tau_dw and v_s of a grid the rest is linear."""
    data = np.concatenate([breakaways.friction, slides.friction])
    taus, speeds = np.array([1.0]), np.array([1.0])
    if len(breakaways.rest):
        taus = np.geomspace(0.2 * breakaways.rest.min(), breakaways.rest.max(), _GRID)
    if len(slides.speed):
        speeds = np.geomspace(0.7 * slides.speed.min(), 0.7 * slides.speed.max(), _GRID)
    best = math.inf
    found = {"friction": float(data.min()), "static_friction": float(data.max())}
    found |= {"viscous_friction": 0.0, "dwell_time": float(taus[-1])}
    found["stribeck_speed"] = float(speeds[len(speeds) // 2])
    still = np.zeros(len(breakaways.rest))
    for tau in taus:
        risen = -np.expm1(-breakaways.rest / tau)
        for speed in speeds:
            share = np.concatenate([risen, np.exp(-((slides.speed / speed) ** 2))])
            matrix = np.stack(
                [np.ones(len(data)), share, np.concatenate([still, slides.speed])], axis=1
            )
            if not len(slides.speed):
                matrix = matrix[:, :2]
            numbers = np.linalg.lstsq(matrix, data, rcond=None)[0]
            cost = float(np.sum((matrix @ numbers - data) ** 2))
            if cost < best and numbers[0] > 0.0 and numbers[1] > 0.0:
                best = cost
                found = {
                    "friction": float(numbers[0]),
                    "static_friction": float(numbers[0] + numbers[1]),
                    "viscous_friction": float(numbers[2]) if len(numbers) > 2 else 0.0,
                    "dwell_time": float(tau),
                    "stribeck_speed": float(speed),
                }
    return found
