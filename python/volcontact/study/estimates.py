# SPDX-License-Identifier: Apache-2.0
"""Probabilities with their intervals, and sensitivity indices, from the rows of a study."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from volcontact.study.designs import BLOCK
from volcontact.study.file.settings import Settings

if TYPE_CHECKING:
    import pyarrow as pa

    from volcontact.study.designs import Design


def wilson(successes: int, trials: int, confidence: float = 0.95) -> tuple[float, float]:
    """The interval of a probability of which successes were seen in some trials [Wilson1927].

    Args:
        successes: how many.
        trials: of how many; at least 1.
        confidence: share of such intervals that hold the probability.
    """
    from scipy.special import ndtri

    score = float(ndtri(0.5 + 0.5 * confidence))
    share = successes / trials
    scale = 1.0 + score**2 / trials
    middle = (share + score**2 / (2.0 * trials)) / scale
    half = score / scale * math.sqrt(share * (1.0 - share) / trials + (score / (2.0 * trials)) ** 2)
    # At both ends the formula is exact but for rounding.
    low = 0.0 if successes == 0 else middle - half
    high = 1.0 if successes == trials else middle + half
    return low, high


@dataclass(frozen=True)
class RareEvent:
    """The probability of a rare event.

    Attributes:
        probability: the estimate.
        low, high: its 95 % interval, by the scatter of the weighted events.
        events: trials of the last level in which it happened.
        trials: in all levels.
    """

    probability: float
    low: float
    high: float
    events: int
    trials: int


def rare_event(rows: pa.Table, response: str, threshold: float) -> RareEvent:
    """The probability that a response is above a threshold, from importance sampling.

    Args:
        rows: of the study; the trials of its last level count.
        response: column.
        threshold: of it.
    """
    level = rows["level"].to_numpy()
    weight = rows["weight"].to_numpy()
    values = np.nan_to_num(rows[response].to_numpy(), nan=-np.inf)
    last = level == level.max()
    counted = np.where(values[last] >= threshold, weight[last], 0.0)
    probability = float(counted.mean())
    error = float(counted.std(ddof=1)) / math.sqrt(len(counted)) if len(counted) > 1 else math.inf
    half = 1.96 * error / probability if probability > 0.0 else math.inf
    # On a logarithmic scale: the interval of so small a number is not symmetric.
    low, high = probability * math.exp(-half), min(probability * math.exp(half), 1.0)
    return RareEvent(probability, low, high, int(np.count_nonzero(counted)), len(rows))


@dataclass(frozen=True)
class Indices:
    """How much of a response each input decides.

    Attributes:
        method: `saltelli`, `morris` or `given data`.
        response: column.
        names: of the inputs, the most important first.
        values: total index (Saltelli), mean of the absolute elementary effects (Morris), or first
            order index by bins (given data).
        errors: half of the 95 % intervals.
    """

    method: str
    response: str
    names: tuple[str, ...]
    values: np.ndarray
    errors: np.ndarray


def sensitivity(settings: Settings, rows: pa.Table, response: str) -> Indices | None:
    """Sensitivity indices of a response by the design of the study; None where there is none.

    Args:
        settings: of the study.
        rows: all of its trials.
        response: column, a number or a truth value.
    """
    numbers = np.asarray(rows[response].to_pylist(), float)
    method = settings.sample.method
    if method in ("saltelli", "morris"):
        from volcontact.study.designs import Design

        design = Design(settings)
        if len(numbers) != design.trials or not np.isfinite(numbers).all():
            return None
        values, errors = _by_design(settings, design, numbers)
        names = [each.name for each in settings.inputs]
    else:
        names = [n for n in settings.columns if len(set(rows[n].to_pylist())) > 1]
        names = [n for n in names if not isinstance(rows[n][0].as_py(), str)]
        good = np.isfinite(numbers)
        if good.sum() < 100 or numbers[good].std() == 0.0 or not names:
            return None
        inputs = [rows[n].to_numpy()[good] for n in names]
        values, errors = first_order(inputs, numbers[good])
        method = "given data"
    order = np.argsort(-values, kind="stable")
    return Indices(method, response, tuple(names[i] for i in order), values[order], errors[order])


def _by_design(settings: Settings, design: Design, numbers: np.ndarray) -> tuple[Any, Any]:
    problem = design.problem()
    seed = settings.sample.seed % 2**32
    if settings.sample.method == "saltelli":
        from SALib.analyze import sobol

        second = settings.sample.options["second_order"]
        found = sobol.analyze(problem, numbers, calc_second_order=second, seed=seed)
        return np.asarray(found["ST"], float), np.asarray(found["ST_conf"], float)
    from SALib.analyze import morris

    cube = np.concatenate([design.cube(i) for i in range(-(-design.trials // BLOCK))])
    levels = settings.sample.options["levels"]
    found = morris.analyze(problem, cube, numbers, num_levels=levels, seed=seed)
    return np.asarray(found["mu_star"], float), np.asarray(found["mu_star_conf"], float)


def first_order(inputs: list[np.ndarray], response: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First order indices of inputs of any sample: share of the variance between bins.

    Bins hold equally many trials. What chance alone puts between bins, (bins - 1) / (n - 1) of the
    variance, is taken off. Intervals are of 200 bootstrap samples.
    """
    generator = np.random.default_rng(0)
    n = len(response)
    bins = int(np.clip(n // 40, 2, 24))
    values, errors = [], []
    for column in inputs:
        member = np.argsort(np.argsort(column, kind="stable"), kind="stable") * bins // n

        def share(picked: np.ndarray, member: np.ndarray = member) -> float:
            sizes = np.bincount(member[picked], minlength=bins)
            sums = np.bincount(member[picked], response[picked], minlength=bins)
            means = sums / np.maximum(sizes, 1)
            whole = response[picked]
            between = float((sizes * (means - whole.mean()) ** 2).sum())
            total = float(((whole - whole.mean()) ** 2).sum())
            ratio = between / total if total > 0.0 else 0.0
            chance = (bins - 1) / (n - 1)
            return (ratio - chance) / (1.0 - chance)

        values.append(share(np.arange(n)))
        again = [share(generator.integers(0, n, n)) for _ in range(200)]
        errors.append(1.96 * float(np.std(again)))
    return np.array(values), np.array(errors)
