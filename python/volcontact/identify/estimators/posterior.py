# SPDX-License-Identifier: Apache-2.0
"""Parameters given the measurements: the density that a chain walks in, and what it then knows."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from volcontact.identify.estimators.costs import rho
from volcontact.identify.estimators.least_squares import Fit, Residuals
from volcontact.identify.estimators.mcmc import Chain, Request, walk
from volcontact.identify.estimators.scales import Box
from volcontact.identify.estimators.search import Progress, signature
from volcontact.identify.estimators.uncertainty import Known, correlation_of
from volcontact.identify.pool import Pool
from volcontact.identify.settings import Settings

_LEAST = 1e-300  # sum of squares
_UNKNOWN = 0.2  # spread of first walkers along what a fit does not tell, as a part of the range


class Posterior:
    """Logarithm of the density of all unknowns of a fit, up to a constant.

    Errors are normal with the given sigmas, or with these times one common factor that is
    integrated over with the prior 1/factor: the density is then that of Student, -n/2 ln S of n
    samples with the sum of squares S. A robust loss takes the place of the squares. The prior is
    flat in the box of the bounds, but for the priors given; numbers of trials are normal with their
    deviations.

    Args:
        settings: of the study.
        pool: that runs the trials.
        box: of the parameters.
    """

    def __init__(self, settings: Settings, pool: Pool, box: Box) -> None:
        self._settings, self._pool, self._box = settings, pool, box
        self._residuals = Residuals(settings, pool, box)

    def __call__(self, unknowns: np.ndarray) -> np.ndarray:
        """Of points of shape (m, n), as of `Fit.unknowns`: (m,)."""
        count = self._residuals.count
        found = np.full(len(unknowns), -np.inf)
        inside = np.all((unknowns[:, :count] >= 0.0) & (unknowns[:, :count] <= 1.0), axis=1)
        places = np.flatnonzero(inside)
        asked = [
            (self._box.values(each[:count]), self._residuals.moved(each))
            for each in unknowns[places]
        ]
        if not asked:
            return found
        for place, parts in zip(places, self._pool.run("errors", asked), strict=True):
            known = [self._box.prior(unknowns[place, :count]), unknowns[place, count:]]
            before = float(sum(each @ each for each in known))
            found[place] = self._likelihood(np.concatenate(parts)) - 0.5 * before
        return found

    def _likelihood(self, errors: np.ndarray) -> float:
        scale = self._settings.estimator.loss_scale
        loss = self._settings.estimator.loss
        squares = scale**2 * float(np.sum(rho(loss, (errors / scale) ** 2)))
        if self._settings.uncertainty.scale:
            return -0.5 * len(errors) * float(np.log(max(squares, _LEAST)))
        return -0.5 * squares


def of_chain(
    settings: Settings,
    pool: Pool,
    box: Box,
    fitted: Fit,
    known: Known,
    file: Path | None = None,
    progress: Progress | None = None,
) -> Known:
    """What a chain that begins at a fit knows; of a chain that is too short nothing but its length.

    Args:
        settings: of the study.
        pool: that runs the trials.
        box: of the parameters.
        fitted: where it begins.
        known: of the fit.
        file: that keeps the chain, so that an interrupted study goes on.
        progress: called with steps done, in all, and a note.

    Raises:
        StudyError: too few walkers, or the file is of another study.
        ModuleNotFoundError: emcee is not installed.
    """
    asked = settings.uncertainty
    count = len(settings.parameters)
    own = len(fitted.unknowns) - count
    spread = np.append(np.clip(known.deviations, 1e-9, _UNKNOWN), np.full(own, 0.1))
    walkers = asked.walkers or max(32, 4 * len(fitted.unknowns))
    request = Request(
        steps=asked.mcmc,
        walkers=walkers,
        burn=asked.burn if asked.burn is not None else asked.mcmc // 4,
        seed=settings.estimator.seed,
        file=file,
        sign=signature(settings),
    )
    middle = fitted.unknowns.copy()
    middle[:count] = np.clip(middle[:count], 1e-9, 1.0 - 1e-9)
    chain = walk(Posterior(settings, pool, box), middle, spread, request, progress)
    if not chain.enough:
        return replace(known, chain=chain)
    return replace(known, chain=chain, **_of_samples(settings, chain, count))


def _of_samples(settings: Settings, chain: Chain, count: int) -> dict[str, Any]:
    samples = chain.samples[..., :count].reshape(-1, count)
    covariance = np.atleast_2d(np.cov(samples.T))
    tail = 0.5 * (1.0 - settings.uncertainty.level)
    low, high = np.quantile(samples, [tail, 1.0 - tail], axis=0)
    return {
        "deviations": np.sqrt(np.diag(covariance)),
        "correlation": correlation_of(covariance),
        "low": low,
        "high": high,
        "method": "MCMC",
    }
