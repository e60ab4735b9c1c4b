# SPDX-License-Identifier: Apache-2.0
"""How well parameters are known: covariance, profiles, bootstrap over trials."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from volcontact.identify.estimators.least_squares import Fit, Residuals, noise, solve
from volcontact.identify.estimators.mcmc import Chain
from volcontact.identify.estimators.scales import Box
from volcontact.identify.estimators.search import Evaluations, Progress, total
from volcontact.identify.pool import Pool
from volcontact.identify.settings import Settings

_CLOSE = 1e-6  # of the range: nearer points of a profile differ by rounding alone
_FLAT = 1e-10  # of the largest curvature: a direction that moves nothing


@dataclass(frozen=True)
class Profile:
    """The least cost with one parameter held.

    Attributes:
        points: of the parameter, in the box, rising.
        rises: of the cost, in its own noise: where they are below half the quantile of chi^2 with
            one degree of freedom, the parameter can be.
        low, high: where it meets the level; None beyond the bounds.
    """

    points: np.ndarray
    rises: np.ndarray
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Known:
    """What is known of all parameters, in the box.

    Attributes:
        deviations: standard deviations, shape (n,); inf where nothing is known.
        correlation: shape (n, n).
        low, high: ends of the intervals, shape (n,); may lie beyond the box.
        method: how they were found.
        noise: factor of the given sigmas that the residuals ask for.
        profiles: by parameter.
        samples: of the bootstrap, shape (b, n); none: empty.
        chain: of MCMC; None: there was none.
    """

    deviations: np.ndarray
    correlation: np.ndarray
    low: np.ndarray
    high: np.ndarray
    method: str
    noise: float
    profiles: dict[str, Profile] = field(default_factory=dict)
    samples: np.ndarray = field(default_factory=lambda: np.empty((0, 0)))
    chain: Chain | None = None


def normal_quantile(level: float) -> float:
    """How many standard deviations an interval of this level reaches to each side."""
    from scipy import stats

    return float(stats.norm.ppf(0.5 + 0.5 * level))


def of_fit(
    settings: Settings, pool: Pool, box: Box, fitted: Fit, progress: Progress | None = None
) -> Known:
    """Of least squares."""
    count = len(settings.parameters)
    curvature = _reduced(fitted, count, np.ones(len(fitted.sizes)))[0]
    factor = noise(settings, fitted)
    covariance = factor**2 * _inverse(curvature)
    deviations = np.sqrt(np.diag(covariance))
    reach = normal_quantile(settings.uncertainty.level) * deviations
    point = fitted.found.point
    low, high = point - reach, point + reach
    profiles = {}
    for name in settings.uncertainty.profile:
        place = [each.name for each in settings.parameters].index(name)
        profiles[name] = _profile(settings, pool, box, fitted, place, deviations[place], factor)
        low[place] = -np.inf if profiles[name].low is None else profiles[name].low
        high[place] = np.inf if profiles[name].high is None else profiles[name].high
        if progress is not None:
            progress(len(profiles), len(settings.uncertainty.profile), "profiles")
    samples = _one_step_bootstrap(settings, fitted, count)
    return Known(
        deviations, correlation_of(covariance), low, high, "covariance", factor, profiles, samples
    )


def _blocks(fitted: Fit, count: int) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Of each trial: rows of parameters, rows of its own numbers, residuals."""
    own = (len(fitted.unknowns) - count) // len(fitted.sizes)
    rows = len(fitted.residuals) - (len(fitted.unknowns) - count)
    found, begin = [], 0
    for trial, size in enumerate(fitted.sizes):
        columns = slice(count + trial * own, count + (trial + 1) * own)
        block = fitted.jacobian[begin : begin + size]
        errors = fitted.residuals[begin : begin + size]
        left, right = _dense(block[:, :count]), _dense(block[:, columns])
        if own:
            prior = slice(rows + trial * own, rows + (trial + 1) * own)
            left = np.concatenate([left, np.zeros((own, count))])
            right = np.concatenate([right, np.eye(own)])
            errors = np.concatenate([errors, fitted.residuals[prior]])
        found.append((left, right, errors))
        begin += size
    return found


def _dense(block: Any) -> np.ndarray:
    return block.toarray() if hasattr(block, "toarray") else np.asarray(block)


def _reduced(fitted: Fit, count: int, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Curvature and slope of the cost by the parameters, the trials' own numbers at their best."""
    curvature, slope = np.zeros((count, count)), np.zeros(count)
    for weight, (left, right, errors) in zip(weights, _blocks(fitted, count), strict=True):
        if right.shape[1]:
            basis, _ = np.linalg.qr(right)
            left = left - basis @ (basis.T @ left)
            errors = errors - basis @ (basis.T @ errors)
        curvature += weight * left.T @ left
        slope += weight * left.T @ errors
    first = sum(fitted.sizes)
    last = len(fitted.residuals) - (len(fitted.unknowns) - count)
    prior = _dense(fitted.jacobian[first:last])[:, :count]
    curvature += prior.T @ prior
    slope += prior.T @ fitted.residuals[first:last]
    return curvature, slope


def _inverse(curvature: np.ndarray) -> np.ndarray:
    """Inverse, with variances without end along directions that move nothing."""
    scale = np.sqrt(np.maximum(np.diag(curvature), 1e-300))
    values, vectors = np.linalg.eigh(curvature / np.outer(scale, scale))
    flat = values < _FLAT * max(values.max(), 1e-300)
    good = np.where(flat, 1.0, values)
    inverse: np.ndarray = (vectors[:, ~flat] / good[~flat]) @ vectors[:, ~flat].T
    for each in vectors[:, flat].T:
        moved = np.abs(each) > 1e-3
        inverse[moved, moved] = np.inf
    result: np.ndarray = inverse / np.outer(scale, scale)
    return result


def correlation_of(covariance: np.ndarray) -> np.ndarray:
    """Correlations; none with what has no end."""
    deviations = np.sqrt(np.diag(covariance))
    known = np.isfinite(deviations) & (deviations > 0.0)
    safe = np.where(known, deviations, 1.0)
    finite = np.where(np.isfinite(covariance), covariance, 0.0)
    found: np.ndarray = finite / np.outer(safe, safe)
    found[~known] = 0.0
    found[:, ~known] = 0.0
    np.fill_diagonal(found, 1.0)
    return found


def _one_step_bootstrap(settings: Settings, fitted: Fit, count: int) -> np.ndarray:
    """Trials drawn anew, and one Gauss-Newton step to where they would lead."""
    draws = settings.uncertainty.bootstrap
    trials = len(fitted.sizes)
    if not draws or trials < 2:
        return np.empty((0, count))
    generator = np.random.default_rng([settings.estimator.seed, 1])
    found = np.empty((draws, count))
    for row in found:
        weights = np.bincount(generator.integers(0, trials, trials), minlength=trials)
        curvature, slope = _reduced(fitted, count, weights.astype(float))
        row[:] = fitted.found.point - np.linalg.lstsq(curvature, slope, rcond=_FLAT)[0]
    return found


def _profile(
    settings: Settings,
    pool: Pool,
    box: Box,
    fitted: Fit,
    place: int,
    deviation: float,
    factor: float,
) -> Profile:
    from scipy import stats

    at = fitted.found.point[place]
    level = 0.5 * float(stats.chi2.ppf(settings.uncertainty.level, 1))
    points, rises = [at], [0.0]
    ends: dict[int, float | None] = {}
    for side in (-1, 1):
        room = at if side < 0 else 1.0 - at
        unknowns, last = fitted.unknowns.copy(), (at, 0.0)
        ends[side] = None
        for reach in _reaches(deviation, room, settings.uncertainty.points):
            there = at + side * reach
            residuals = Residuals(settings, pool, box)
            unknowns[place] = there
            unknowns[: residuals.count] = np.clip(unknowns[: residuals.count], 0.0, 1.0)
            result = solve(settings, residuals, unknowns, fixed=place)
            unknowns = np.insert(result.x, place, there)
            rise = max(float(result.cost) - fitted.found.cost, 0.0) / max(factor, 1e-150) ** 2
            points.append(there)
            rises.append(rise)
            if rise >= level and ends[side] is None:
                before = np.sqrt(last[1] / rise)
                wanted = np.sqrt(level / rise)
                part = (wanted - before) / max(1.0 - before, 1e-12)
                ends[side] = last[0] + part * (there - last[0])
                break
            last = there, rise
    order = np.argsort(points)
    return Profile(np.array(points)[order], np.array(rises)[order], ends[-1], ends[1])


def _reaches(deviation: float, room: float, points: int) -> list[float]:
    """How far from the best value a profile looks: over three deviations, then ever farther."""
    unit = max(deviation, _CLOSE) if np.isfinite(deviation) else room
    found = [3.0 * unit * number / points for number in range(1, points + 1)]
    while found[-1] < room:
        found.append(2.0 * found[-1])
    inside = [reach for reach in found if reach < room]
    return [*inside, room] if len(inside) < len(found) else inside


def of_search(settings: Settings, box: Box, log: Evaluations, point: np.ndarray) -> Known:
    """Of an estimator that sees costs alone: trials drawn anew choose among all points evaluated.

    The spread of the choices is the uncertainty. It cannot be finer than the points lie, and a
    search that has drawn in lies densely where its best points are.
    """
    points, costs = np.array(log.points), np.array(log.costs)
    count, trials = points.shape[1], costs.shape[1]
    draws = max(settings.uncertainty.bootstrap, 200)
    generator = np.random.default_rng([settings.estimator.seed, 1])
    prior = np.array([total(settings, box, p, np.zeros(trials)) for p in points])
    samples = np.empty((draws, count))
    for row in samples:
        weights = np.bincount(generator.integers(0, trials, trials), minlength=trials)
        sums = costs @ weights
        if settings.estimator.loss == "absolute":
            sums = sums / trials
        row[:] = points[int(np.argmin(sums + prior))]
    tail = 0.5 * (1.0 - settings.uncertainty.level)
    low, high = np.quantile(samples, [tail, 1.0 - tail], axis=0)
    covariance = np.atleast_2d(np.cov(samples.T))
    return Known(
        deviations=np.sqrt(np.diag(covariance)),
        correlation=correlation_of(covariance),
        low=np.minimum(low, point),
        high=np.maximum(high, point),
        method="bootstrap over trials",
        noise=1.0,
        samples=samples,
    )
