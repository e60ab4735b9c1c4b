# SPDX-License-Identifier: Apache-2.0
"""Errors of trials as people quote them: mean sizes over whole trials and after n impacts."""

from __future__ import annotations

from typing import Any

import numpy as np

from volcontact.identify.measurements import Trial
from volcontact.identify.settings import Settings, StudyError
from volcontact.identify.units import SI
from volcontact.identify.windows import impacts

_IMPACTS = 3


def sizes(raw: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Size of the error of each sample, by measure [SI]."""
    return {name: np.linalg.norm(error, axis=1) for name, error in raw.items()}


def table(settings: Settings, trials: list[Trial], raw: list[dict[str, np.ndarray]]) -> Any:
    """Means and medians over trials of the mean error of each, by measure.

    Returns:
        By measure `mean`, `median`, `unit`, the errors by trial, and where impacts can be seen the
        means of what lies before the first one and after each of the first three.
    """
    found: dict[str, Any] = {}
    hits = [_impacts(settings, trial) for trial in trials]
    for each in settings.measures:
        if not each.weight:
            continue
        errors = [sizes(one)[each.name] for one in raw]
        whole = np.array([float(np.mean(e)) if len(e) else np.nan for e in errors])
        parts = []
        for number in range(_IMPACTS + 1):
            means = []
            for trial, hit, error in zip(trials, hits, errors, strict=True):
                begin = 0.0 if number == 0 else (hit[number - 1] if len(hit) >= number else np.inf)
                end = hit[number] if len(hit) > number else np.inf
                times = trial.times[trial.samples[each.name].index]
                chosen = error[(times >= begin - 1e-9) & (times < end - 1e-9)]
                if len(chosen) and np.isfinite(begin):
                    means.append(float(np.mean(chosen)))
            parts.append(float(np.mean(means)) if means else None)
        found[each.name] = {
            "unit": SI[each.kind],
            "mean": float(np.nanmean(whole)),
            "median": float(np.nanmedian(whole)),
            "after_impacts": parts,
            "by_trial": whole.tolist(),
        }
    return found


def _impacts(settings: Settings, trial: Trial) -> np.ndarray:
    try:
        return impacts(settings, trial)
    except StudyError:
        return np.empty(0)


def ranking(settings: Settings, raw: list[dict[str, np.ndarray]]) -> np.ndarray:
    """Mean size of the errors of each trial over all measures that count [sigma]."""
    found = np.zeros(len(raw))
    for each in settings.measures:
        if each.weight:
            for place, one in enumerate(raw):
                size = sizes(one)[each.name]
                found[place] += (
                    each.weight * (float(np.mean(size)) if len(size) else 0) / each.sigma
                )
    return found
