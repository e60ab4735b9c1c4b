# SPDX-License-Identifier: Apache-2.0
"""The numbers of each trial at given parameters: a small problem of its own for every trial."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from volcontact.identify.estimators.least_squares import Residuals

_HORIZONS = (0.3, 0.6, 1.0)  # parts of a trial that are fitted one after the other
_MOST = 15  # iterations of each
_STILL = 1e-3  # of a cost, below which a trial has settled
_DAMPING, _EASED, _RAISED = 1e-3, 0.2, 8.0  # of Levenberg and Marquardt, each trial with its own
_DRAWS, _TRIED = 32, 3  # starts that are drawn for a trial that stands out, and fitted
_OUT = 5.0  # standard deviations of its cost above that of the others


def settled(residuals: Residuals, unknowns: np.ndarray) -> np.ndarray:
    """Unknowns whose parameters stay, and whose numbers of trials fit as well as they can.

    Trials know nothing of each other once the parameters are given: each gets its own damping, so
    that one that is hard to fit holds up no other. All move at the same time, since the columns of
    the Jacobian are the same runs. [Marquardt1963] The beginnings of the trials are fitted first: a
    start that is wrong meets an impact elsewhere, and what follows pulls it the wrong way. A trial
    that fits far worse than the others do is looked at again, from starts that its beginning leaves
    open: an impact just before a sample or just after it makes two valleys.

    Args:
        residuals: of the study.
        unknowns: to begin at, shape (n,).
    """
    if not len(residuals.active):
        return unknowns
    place = unknowns
    shares = residuals.shares()
    for horizon in _HORIZONS:
        place = _fitted(residuals, place, [times <= horizon for times in shares])
    return _looked_again(residuals, place, shares)


def _looked_again(
    residuals: Residuals, unknowns: np.ndarray, shares: list[np.ndarray]
) -> np.ndarray:
    """Numbers of trials that stand out, from other starts where these fit better."""
    place = unknowns.copy()
    own = _own(residuals, place)  # a view: what is written there is in `place`
    costs = _costs(residuals.by_trial(place), own)
    out = np.flatnonzero(standing_out(costs, np.array([len(each) for each in shares])))
    if not len(out):
        return place
    drawn = _drawn(residuals, place, [times <= _HORIZONS[1] for times in shares], out)
    rated = np.array([_costs(residuals.by_trial(each), _own(residuals, each)) for each in drawn])
    whole = [np.ones(len(each), bool) for each in shares]
    moving = np.isin(np.arange(residuals.trials), out)
    for number in range(_TRIED):
        begin = place.copy()
        for trial in out:
            best = drawn[np.argsort(rated[:, trial])[number]]
            _own(residuals, begin)[trial] = _own(residuals, best)[trial]
        ended = _fitted(residuals, begin, whole, moving)
        found = _costs(residuals.by_trial(ended), _own(residuals, ended))
        for trial in out[found[out] < costs[out]]:
            own[trial], costs[trial] = _own(residuals, ended)[trial], found[trial]
    return place


def standing_out(costs: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Which trials fit worse than noise explains.

    The trial in the middle tells the noise, so that no sigma needs to be right.

    Args:
        costs: sums of squares, shape (t,).
        rows: how many there are of each, shape (t,).
    """
    each = costs / rows
    middle = np.sort(each)[(len(each) - 1) // 2]
    outside: np.ndarray = each > middle * (1.0 + _OUT * np.sqrt(2.0 / rows))
    return outside


def _drawn(
    residuals: Residuals, unknowns: np.ndarray, masks: list[np.ndarray], trials: np.ndarray
) -> list[np.ndarray]:
    """Starts of trials, as the samples that count leave them open."""
    generator = np.random.default_rng(1)
    slopes = residuals.own_slopes(unknowns)
    drawn = [unknowns.copy() for _ in range(_DRAWS)]
    for trial in trials:
        slope = slopes[trial][masks[trial]]
        root = np.linalg.cholesky(slope.T @ slope + np.eye(slope.shape[1]))
        for each in drawn:
            move = np.linalg.solve(root.T, generator.standard_normal(len(root)))
            row = _own(residuals, each)
            row[trial] = residuals.bounded(row[trial] + move)
    return drawn


def _fitted(
    residuals: Residuals,
    unknowns: np.ndarray,
    masks: list[np.ndarray],
    moving: np.ndarray | None = None,
) -> np.ndarray:
    """Of the samples that count alone; of some trials or of all."""

    def counted(parts: list[np.ndarray]) -> list[np.ndarray]:
        return [part[mask] for part, mask in zip(parts, masks, strict=True)]

    width = len(residuals.active)
    place = unknowns.copy()
    errors = counted(residuals.by_trial(place))
    costs = _costs(errors, _own(residuals, place))
    damping = np.full(residuals.trials, _DAMPING)
    moving = np.ones(residuals.trials, bool) if moving is None else moving.copy()
    slopes = counted(residuals.own_slopes(place))
    for _ in range(_MOST):
        steps = np.zeros((residuals.trials, width))
        own = _own(residuals, place)
        for trial in np.flatnonzero(moving):
            curvature = slopes[trial].T @ slopes[trial] + np.eye(width)
            down = slopes[trial].T @ errors[trial] + own[trial]
            ridge = damping[trial] * np.diag(np.diag(curvature))
            steps[trial] = -np.linalg.solve(curvature + ridge, down)
        there = place.copy()
        there[residuals.count :] = residuals.bounded(own + steps).ravel()
        tried = counted(residuals.by_trial(there))
        new = _costs(tried, _own(residuals, there))
        better = moving & (new < costs)
        gain = np.where(better, (costs - new) / np.maximum(costs, 1e-300), 0.0)
        for trial in np.flatnonzero(better):
            errors[trial], costs[trial] = tried[trial], new[trial]
        mixed = own.copy()
        mixed[better] = _own(residuals, there)[better]
        place[residuals.count :] = mixed.ravel()
        damping *= np.where(better, _EASED, _RAISED)
        moving &= ~(better & (gain < _STILL)) & (damping < 1e8)
        if not moving.any():
            break
        if better.any():
            slopes = counted(residuals.own_slopes(place))
    return place


def _own(residuals: Residuals, unknowns: np.ndarray) -> np.ndarray:
    return unknowns[residuals.count :].reshape(residuals.trials, -1)


def _costs(errors: list[np.ndarray], own: np.ndarray) -> np.ndarray:
    return np.array([e @ e + o @ o for e, o in zip(errors, own, strict=True)])
