# SPDX-License-Identifier: Apache-2.0
"""Least squares of a curve, with the uncertainty of its parameters.

The covariance is that of the linearized model, s^2 (J^T J)^-1 with s^2 the sum of squares over the
degrees of freedom; intervals are Student's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from volcontact.identify.readings import LEVEL, Quantity

CORRELATED = 0.98
_HALF = 0.5  # of the value: a wider interval tells nothing
_REWEIGHTED = 3
_LEAST_NOISE = 0.1  # of all samples: that of one kind is not taken for less
_SINGULAR = 1e-10  # of the largest singular value


@dataclass(frozen=True)
class Fit:
    """A curve that was fitted.

    Attributes:
        names: of the parameters.
        values: of the parameters, shape (p,).
        covariance: shape (p, p); infinite where the data do not tell a parameter.
        residuals: shape (n,), in the unit of the data, or in standard deviations.
        noise: root mean square of the residuals for the degrees of freedom.
        freedom: samples less parameters.
        converged: whether the search ended by itself.
    """

    names: tuple[str, ...]
    values: np.ndarray
    covariance: np.ndarray
    residuals: np.ndarray
    noise: float
    freedom: int
    converged: bool

    def __getitem__(self, name: str) -> float:
        return float(self.values[self.names.index(name)])

    def deviation(self, name: str) -> float:
        """Standard deviation of a parameter; NaN without a degree of freedom."""
        place = self.names.index(name)
        return math.sqrt(self.covariance[place, place]) if self.freedom > 0 else math.nan

    def quantity(self, name: str, unit: str, level: float = LEVEL) -> Quantity:
        """A parameter with its interval."""
        return quantity(self[name], unit, self.deviation(name), self.freedom, level)

    def derived(self, gradient: dict[str, float]) -> float:
        """Standard deviation of what changes with parameters as the gradient says."""
        if self.freedom <= 0:
            return math.nan
        row = np.array([gradient.get(name, 0.0) for name in self.names])
        used = row != 0.0
        part = self.covariance[np.ix_(used, used)]
        return math.sqrt(max(float(row[used] @ part @ row[used]), 0.0))

    def untold(self) -> list[str]:
        """Sentences on parameters that the data hardly tell."""
        lines = []
        for place, name in enumerate(self.names):
            known = self.quantity(name, "-")
            if known.told:
                continue
            partner = self._partner(place)
            why = (
                f" It and {partner} make up for each other: give one of the two." if partner else ""
            )
            lines.append(f"{name} cannot be told from these data.{why}")
        if self.freedom <= 0:
            lines.append(
                "There are no more samples than numbers to find: no interval can be given. Repeat "
                "the test."
            )
        return lines

    def _partner(self, place: int) -> str:
        """The parameter that this one is known in combination with only."""
        deviations = np.sqrt(np.diag(self.covariance))
        if not np.isfinite(deviations).all():
            return ""
        with np.errstate(invalid="ignore", divide="ignore"):
            r = np.abs(self.covariance[place] / (deviations[place] * deviations))
        r[place] = 0.0
        best = int(np.nanargmax(r))
        return self.names[best] if r[best] > CORRELATED else ""


def quantity(
    value: float, unit: str, deviation: float, freedom: int, level: float = LEVEL
) -> Quantity:
    """A number with Student's interval for so many degrees of freedom."""
    from scipy import stats

    if freedom <= 0 or math.isnan(deviation):
        return Quantity(value, unit)
    if math.isinf(deviation):
        return Quantity(value, unit, math.nan, math.nan, math.nan, told=False)
    half = float(stats.t.ppf(0.5 + 0.5 * level, freedom)) * deviation
    told = half <= _HALF * abs(value)
    return Quantity(value, unit, deviation, value - half, value + half, told)


def fit(
    residuals: Callable[[np.ndarray], np.ndarray],
    start: Sequence[float],
    names: Sequence[str],
    *,
    low: Sequence[float] | None = None,
    high: Sequence[float] | None = None,
    groups: np.ndarray | None = None,
) -> Fit:
    """Fits a curve by least squares.

    Args:
        residuals: of parameters, shape (p,) -> (n,).
        start: first guess, shape (p,), of the size that is expected.
        names: of the parameters.
        low: bounds of the parameters; without them there are none.
        high: likewise.
        groups: numbers of kinds of samples, shape (n,), each with a noise of its own, which is
            estimated from the residuals.

    Raises:
        ValueError: there are fewer samples than parameters.
    """
    if groups is not None and len(np.unique(groups)) > 1:
        return _fit_groups(residuals, start, names, low, high, groups)
    from scipy import optimize

    first = np.asarray(start, float)
    bottom = np.full(len(first), -np.inf) if low is None else np.asarray(low, float)
    top = np.full(len(first), np.inf) if high is None else np.asarray(high, float)
    first = np.clip(first, bottom, top)
    size = np.where(first == 0.0, 1.0, np.abs(first))
    count = len(np.atleast_1d(residuals(first)))
    if count < len(first):
        raise ValueError(
            f"{count} samples are too few to find {', '.join(names)}: measure at least {len(first)}"
        )
    found = optimize.least_squares(
        lambda x: residuals(x * size),
        first / size,
        bounds=(bottom / size, top / size),
        x_scale="jac" if len(first) > 1 else 1.0,
        jac="3-point",
        xtol=1e-13,
        ftol=1e-14,
        gtol=1e-14,
        max_nfev=100,
    )
    freedom = count - len(first)
    noise = math.sqrt(2.0 * found.cost / freedom) if freedom > 0 else math.nan
    covariance = covariance_of(found.jac) * np.outer(size, size)
    if freedom > 0:
        with np.errstate(invalid="ignore"):
            covariance = noise**2 * covariance
        covariance[np.isnan(covariance)] = np.inf
    return Fit(
        tuple(names), found.x * size, covariance, found.fun, noise, freedom, found.status > 0
    )


def _fit_groups(
    residuals: Callable[[np.ndarray], np.ndarray],
    start: Sequence[float],
    names: Sequence[str],
    low: Sequence[float] | None,
    high: Sequence[float] | None,
    groups: np.ndarray,
) -> Fit:
    """Weights and fit in turn."""
    sigmas = np.ones(len(groups))
    found = fit(residuals, start, names, low=low, high=high)
    for _ in range(_REWEIGHTED):
        errors = found.residuals * sigmas
        share = max(1.0 - len(names) / len(groups), 0.1)  # of the noise that is left in residuals
        whole = math.sqrt(float(np.mean(errors**2)) / share)
        for group in np.unique(groups):
            own = groups == group
            size = math.sqrt(float(np.mean(errors[own] ** 2)) / share)
            sigmas[own] = max(size, _LEAST_NOISE * whole, 1e-300)
        weights = 1.0 / sigmas
        found = fit(
            lambda x, weights=weights: weights * residuals(x),  # type: ignore[misc]
            found.values.tolist(),
            names,
            low=low,
            high=high,
        )
    return found


def linear(matrix: np.ndarray, data: np.ndarray, names: Sequence[str]) -> Fit:
    """The same where the data are linear in the parameters: data = matrix x.

    Raises:
        ValueError: there are fewer samples than parameters.
    """
    count, width = matrix.shape
    if count < width:
        raise ValueError(
            f"{count} samples are too few to find {', '.join(names)}: measure at least {width}"
        )
    size = np.linalg.norm(matrix, axis=0)
    size[size == 0.0] = 1.0
    found = np.linalg.lstsq(matrix / size, data, rcond=_SINGULAR)[0] / size
    errors = matrix @ found - data
    freedom = count - width
    noise = math.sqrt(float(errors @ errors) / freedom) if freedom > 0 else math.nan
    covariance = covariance_of(matrix)
    if freedom > 0:
        with np.errstate(invalid="ignore"):
            covariance = noise**2 * covariance
        covariance[np.isnan(covariance)] = np.inf
    return Fit(tuple(names), found, covariance, errors, noise, freedom, True)


def covariance_of(jacobian: np.ndarray) -> np.ndarray:
    """(J^T J)^-1; infinite for parameters that lie in its null space."""
    size = np.linalg.norm(jacobian, axis=0)
    size[size == 0.0] = 1.0
    _, sizes, rows = np.linalg.svd(jacobian / size, full_matrices=False)
    kept = sizes > _SINGULAR * sizes[0] if len(sizes) and sizes[0] > 0.0 else sizes > 0.0
    covariance: np.ndarray = (rows[kept].T / sizes[kept] ** 2) @ rows[kept] / np.outer(size, size)
    lost = np.abs(rows[~kept]).max(axis=0, initial=0.0) > 1e-6
    covariance[lost, :] = np.inf
    covariance[:, lost] = np.inf
    return covariance
