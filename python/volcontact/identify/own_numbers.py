# SPDX-License-Identifier: Apache-2.0
"""The numbers of each trial at given parameters: a small problem of its own for every trial."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from volcontact.identify.least_squares import Residuals

_HORIZONS = (0.3, 0.6, 1.0)  # parts of a trial that are fitted one after the other
_MOST = 15  # iterations of each
_STILL = 1e-3  # of a cost, below which a trial has settled
_DAMPING, _EASED, _RAISED = 1e-3, 0.2, 8.0  # of Levenberg and Marquardt, each trial with its own


def settled(residuals: Residuals, unknowns: np.ndarray) -> np.ndarray:
    """Unknowns whose parameters stay, and whose numbers of trials fit as well as they can.

    Trials know nothing of each other once the parameters are given: each gets its own damping, so
    that one that is hard to fit holds up no other. All move at the same time, since the columns of
    the Jacobian are the same runs. [Marquardt1963] The beginnings of the trials are fitted first: a
    start that is wrong meets an impact elsewhere, and what follows pulls it the wrong way.

    Args:
        residuals: of the study.
        unknowns: to begin at, shape (n,).
    """
    if not len(residuals.active):
        return unknowns
    place = unknowns
    for horizon in _HORIZONS:
        place = _fitted(residuals, place, [times <= horizon for times in residuals.shares()])
    return place


def _fitted(residuals: Residuals, unknowns: np.ndarray, masks: list[np.ndarray]) -> np.ndarray:
    """Of the samples that count alone."""

    def counted(parts: list[np.ndarray]) -> list[np.ndarray]:
        return [part[mask] for part, mask in zip(parts, masks, strict=True)]

    width = len(residuals.active)
    place = unknowns.copy()
    errors = counted(residuals.by_trial(place))
    costs = _costs(errors, _own(residuals, place))
    damping = np.full(residuals.trials, _DAMPING)
    moving = np.ones(residuals.trials, bool)
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
