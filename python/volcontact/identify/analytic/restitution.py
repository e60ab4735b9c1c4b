# SPDX-License-Identifier: Apache-2.0
"""Damping a of `hunt_crossley` from coefficients of restitution.

A free impact at the speed v leaves with e v, ln((1 + A) / (1 - e A)) = A (1 + e), A = a v:
docs/theory.md, "Restitution".
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np

from volcontact.identify.analytic import checks
from volcontact.identify.estimators import regression
from volcontact.identify.estimators.regression import Fit
from volcontact.identify.readings import LEVEL, Curve, Quantity, Reading

_SLOW = 1e-5  # of A: below it the next term of the series is below rounding
_HALVINGS = 80
_WORSE = 2.0  # times the other law's error: it does not fit
_MISFIT = 0.02  # of e


def restitution_at(damping: float | np.ndarray, speed: float | np.ndarray) -> np.ndarray:
    """Coefficient of restitution e [-] of free impacts.

    Args:
        damping: a [s/m], at least 0.
        speed: of the impact [m/s], of the same shape or one number.
    """
    number = np.asarray(np.multiply(damping, speed), float)
    safe = np.maximum(number, _SLOW)
    # With e A = 1 - exp(-c): c - (1 - exp(-c)) = A - ln(1 + A). Newton from above cannot fail.
    wanted = safe - np.log1p(safe)
    c = wanted + np.sqrt(2.0 * wanted)
    for _ in range(50):
        gone = -np.expm1(-c)
        step = (c - gone - wanted) / gone
        c = c - step
        if not np.any(step > 1e-15 * c):
            break
    exact = -np.expm1(-c) / safe
    found: np.ndarray = np.where(number < _SLOW, 1.0 - 2.0 / 3.0 * number, exact)
    return found


def restitution_of(number: float) -> float:
    """E [-] of A = a v [-], one number: quicker than `restitution_at`."""
    if number < _SLOW:
        return 1.0 - 2.0 / 3.0 * number
    wanted = number - math.log1p(number)
    c = wanted + math.sqrt(2.0 * wanted)
    for _ in range(50):
        gone = -math.expm1(-c)
        step = (c - gone - wanted) / gone
        c -= step
        if not step > 1e-15 * c:
            break
    return -math.expm1(-c) / number


@functools.lru_cache(maxsize=256)
def damping_number(restitution: float) -> float:
    """A = a v [-] that gives a coefficient of restitution e [-]."""
    e = restitution
    if e >= 1.0:
        return 0.0
    low, high = 0.0, 1.0 / e
    for _ in range(_HALVINGS):
        A = 0.5 * (low + high)
        # Below the root the left side of the relation is less than the right one.
        if e * A < 1.0 and math.log1p(A) - math.log1p(-e * A) < A * (1.0 + e):
            low = A
        else:
            high = A
    return 0.5 * (low + high)


def damping_from_restitution(restitution: float, speed: float) -> Reading:
    """Damping from one restitution.

    Args:
        restitution: e [-], above 0 and at most 1.
        speed: at which it was measured [m/s].

    Returns:
        `damping` a [s/m], and `restitution`, which is the same where this speed alone matters.

    Raises:
        ValueError: a number is out of range.
    """
    e = checks.restitution(restitution)
    v = checks.above_zero("speed", speed, "m/s")
    a = damping_number(e) / v
    slow, fast = (float(restitution_at(a, factor * v)) for factor in (0.5, 2.0))
    return Reading(
        "damping from a restitution",
        {"damping": Quantity(a, "s/m"), "restitution": Quantity(e, "-")},
        validity=(
            f"Exact for free impacts at {v:.4g} m/s. With this damping e is {slow:.3g} at half "
            f"this speed and {fast:.3g} at twice it; with the key restitution it is {e:.3g} at all "
            "speeds above restitution_speed_floor.",
            "Weight and drives that act during the impact are left out: its force must be far "
            "larger.",
        ),
        written=("damping",),
    )


def damping_from_table(
    speeds: Sequence[float] | np.ndarray,
    restitutions: Sequence[float] | np.ndarray,
    *,
    level: float = LEVEL,
) -> Reading:
    """Damping from restitutions at several speeds, and how well the law e(v) fits them.

    Both laws are fitted by least squares: a constant `damping`, under which e falls with the speed,
    and a constant `restitution`. The one with the smaller residual is written to MJCF.

    Args:
        speeds: of the impacts [m/s], shape (n,).
        restitutions: e of each [-], shape (n,).
        level: of the intervals.

    Returns:
        `damping` [s/m] and `restitution` [-] with intervals; `residual_of_damping` and
        `residual_of_restitution`, the root mean squares of the errors of e under either law.

    Raises:
        ValueError: the two have different lengths, or a number is out of range.
    """
    v, e = np.asarray(speeds, float), np.asarray(restitutions, float)
    if v.shape != e.shape or v.ndim != 1:
        raise ValueError(
            f"speeds have the shape {v.shape} and restitutions {e.shape}: give one restitution for "
            "each speed"
        )
    for one in v:
        checks.above_zero("speed", float(one), "m/s")
    for one in e:
        checks.restitution(float(one))
    middle = int(np.argsort(v)[len(v) // 2])
    guess = max(damping_number(float(e[middle])) / float(v[middle]), 1e-6)
    by_damping = regression.fit(
        lambda x: restitution_at(x[0], v) - e, [guess], ["damping"], low=[0.0]
    )
    by_constant = regression.linear(np.ones((len(e), 1)), e, ["restitution"])
    return reading_of_laws(
        "damping from a table of restitutions", v, e, by_damping, by_constant, level
    )


def reading_of_laws(
    name: str, v: np.ndarray, e: np.ndarray, by_damping: Fit, by_constant: Fit, level: float
) -> Reading:
    """Which of two laws of the restitution fits, and both of them."""
    a, constant = by_damping["damping"], by_constant["restitution"]
    errors = restitution_at(a, v) - e, constant - e
    misfits = [float(np.sqrt(np.mean(error**2))) for error in errors]
    values = {
        "damping": by_damping.quantity("damping", "s/m", level),
        "restitution": by_constant.quantity("restitution", "-", level),
        "residual_of_damping": Quantity(misfits[0], "-"),
        "residual_of_restitution": Quantity(misfits[1], "-"),
    }
    is_constant = misfits[1] < misfits[0]
    findings = compared(v, misfits, is_constant)
    findings += (by_constant if is_constant else by_damping).untold()
    grid = np.linspace(0.0, 1.1 * float(v.max()), 200)
    law = np.full(200, constant) if is_constant else restitution_at(a, grid)
    return Reading(
        name,
        values,
        validity=(
            f"Speeds from {v.min():.3g} to {v.max():.3g} m/s; beyond them the law extrapolates.",
            "Free impacts: weight and drives that act during an impact are left out.",
        ),
        findings=tuple(findings),
        written=("restitution",) if is_constant else ("damping",),
        curves=(
            Curve("Restitution over speed", "speed of the impact [m/s]", "e [-]", v, e, grid, law),
        ),
        converged=by_damping.converged,
        level=level,
    )


def compared(v: np.ndarray, misfits: Sequence[float], is_constant: bool) -> list[str]:
    """Sentences on which law of the restitution fits."""
    better, worse = (1, 0) if is_constant else (0, 1)
    names = ("damping", "restitution")
    lines = []
    if float(v.max()) < 1.5 * float(v.min()):
        lines.append(
            "All impacts have about the same speed: whether damping or restitution is constant "
            "cannot be told from these data. Drop from other heights."
        )
    elif misfits[worse] < _WORSE * misfits[better]:
        lines.append(
            "A constant damping and a constant restitution fit these data about equally well: "
            "which of the two holds cannot be told. Drop from other heights."
        )
    if misfits[better] > _MISFIT:
        lines.append(
            f"The errors of e are {misfits[better]:.2g} even with a constant {names[better]}: the "
            "law misses something, such as plastic flow, air or a plate that swings."
        )
    return lines
