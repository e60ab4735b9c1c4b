# SPDX-License-Identifier: Apache-2.0
"""Methods whose trials follow from the results of earlier ones.

Each is a generator: it gives the values of a round, and is sent the responses of its trials, in
their order. So the trials depend on the seed and on results alone, and `resume` walks the same way
again over the rows that are there.
"""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from volcontact.study.file.settings import Settings
from volcontact.study.inputs import Quantiles

Values = dict[str, np.ndarray]
Steps = Generator[Values, np.ndarray, None]

_ELITE = 0.1  # share of a round that the next level is chosen by
_MOST_LEVELS = 20
_SHARES = (0.5, 0.4, 0.1)  # of the mixture: followed, of unit deviations, nominal


def optimise(settings: Settings) -> Steps:
    """Search for the largest or smallest response, by optuna's tree of Parzen estimators."""
    import optuna

    optuna.logging.set_verbosity(optuna.logging.WARNING)
    quantiles = Quantiles(settings)
    options = settings.sample.options
    direction = options["direction"].replace("ise", "ize")
    sampler = optuna.samplers.TPESampler(seed=settings.sample.seed % 2**32)
    study = optuna.create_study(direction=direction, sampler=sampler)
    level = 0
    while True:
        asked = [study.ask() for _ in range(options["round"])]
        cube = np.array(
            [
                [trial.suggest_float(f"u{i}", 0.0, 1.0) for i in range(quantiles.dimension)]
                for trial in asked
            ]
        )
        responses = yield _labelled(quantiles.values(cube), level, np.ones(len(cube)))
        for trial, response in zip(asked, responses, strict=False):
            finite = np.isfinite(response)
            state = optuna.trial.TrialState.COMPLETE if finite else optuna.trial.TrialState.FAIL
            study.tell(trial, float(response) if finite else None, state=state)
        level += 1


def importance(settings: Settings) -> Steps:
    """Importance sampling of a response above a threshold, by the cross-entropy method.

    Inputs are independent standard normal scores u. Rounds are drawn from a normal density q whose
    mean and deviations follow the weighted elite of the round before, until the threshold is
    reached; the rounds then left are drawn from a mixture of it with a normal density of the same
    mean and unit deviations, whose tails are those of the nominal density p, and with a tenth of p
    itself, so that no weight is large. The weight of a trial is p/q. The probability is the mean of
    weight times event over the trials of the last level, whose number is `level` of them
    [Rubinstein2004].
    """
    quantiles = Quantiles(settings)
    options = settings.sample.options
    threshold, count = options["threshold"], options["round"]
    dimension = quantiles.dimension
    mean, spread = np.zeros(dimension), np.ones(dimension)
    for level in range(_MOST_LEVELS):
        generator = _generator(settings, level)
        scores = mean + spread * generator.standard_normal((count, dimension))
        log_weight = _log_density(scores, 0.0, 1.0) - _log_density(scores, mean, spread)
        values = quantiles.normal_values(scores)
        responses = yield _labelled(values, level, np.exp(log_weight))
        if len(responses) < count:
            return
        responses = np.where(np.isfinite(responses), responses, -np.inf)
        reached = min(float(np.quantile(responses, 1.0 - _ELITE)), threshold)
        elite = responses >= reached
        weight = np.exp(log_weight[elite] - log_weight[elite].max())
        weight /= weight.sum()
        mean = weight @ scores[elite]
        spread = np.sqrt(weight @ (scores[elite] - mean) ** 2)
        spread = np.clip(spread, 0.1, 5.0)
        if reached >= threshold:
            break
    last = level + 1
    part = 0
    while True:
        generator = _generator(settings, _MOST_LEVELS + part)
        which = generator.choice(3, count, p=_SHARES)[:, None]
        normal = generator.standard_normal((count, dimension))
        scores = np.choose(which, [mean + spread * normal, mean + normal, normal])
        outer = _log_density(scores, 0.0, 1.0)
        parts = [_log_density(scores, mean, spread), _log_density(scores, mean, 1.0), outer]
        log_mixture = np.logaddexp.reduce(
            [np.log(share) + each for share, each in zip(_SHARES, parts, strict=True)]
        )
        values = quantiles.normal_values(scores)
        responses = yield _labelled(values, last, np.exp(outer - log_mixture))
        if len(responses) < count:
            return
        part += 1


def _labelled(values: Values, level: int, weight: np.ndarray) -> Values:
    return {**values, "level": np.full(len(weight), level), "weight": weight}


def _generator(settings: Settings, part: int) -> np.random.Generator:
    seed = np.random.SeedSequence([settings.sample.seed, 2, part])
    return np.random.Generator(np.random.PCG64(seed))


def _log_density(
    scores: np.ndarray, mean: np.ndarray | float, spread: np.ndarray | float
) -> np.ndarray:
    reduced = (scores - mean) / spread
    wide = np.broadcast_to(np.log(spread), scores.shape[1:])
    return np.asarray(-0.5 * (reduced**2).sum(axis=1) - wide.sum())
