# SPDX-License-Identifier: Apache-2.0
"""Which samples of a trial count: up to a time, up to an impact, in segments."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np

from volcontact.identify.measurements import Samples, Trial
from volcontact.identify.settings import Settings, StudyError, Window

_ROUNDING = 1e-9  # of times [s]


def windowed(settings: Settings, trials: list[Trial]) -> list[Trial]:
    """Trials as the window of the study cuts them; segments are trials of their own.

    Raises:
        StudyError: nothing is left of one.
    """
    found = []
    for trial in trials:
        cut = _until(trial, window_end(settings, trial, settings.window))
        if settings.window.segment:
            found += _segments(cut, settings.window.segment)
        else:
            found.append(cut)
    return found


def window_end(settings: Settings, trial: Trial, window: Window) -> float:
    """Where the window of a trial ends [s]."""
    end = min(window.duration, float(trial.times[-1]))
    if window.impacts:
        times = impacts(settings, trial)
        if len(times) > window.impacts:
            end = min(end, float(times[window.impacts]))
    return end


def impacts(settings: Settings, trial: Trial) -> np.ndarray:
    """Times just before impacts: where the measured velocity jumps, shape (n,) [s].

    Raises:
        StudyError: neither velocity nor position of a body is measured.
    """
    by_kind = {each.kind: each for each in reversed(settings.measures)}
    if "velocity" in by_kind:
        samples = trial.samples[by_kind["velocity"].name]
        times, speeds = trial.times[samples.index], samples.values
    elif "position" in by_kind:
        samples = trial.samples[by_kind["position"].name]
        places = trial.times[samples.index]
        speeds = np.diff(samples.values, axis=0) / np.diff(places)[:, None]
        times = 0.5 * (places[1:] + places[:-1])
    elif "joint" in by_kind:
        samples = trial.samples[by_kind["joint"].name]
        places = trial.times[samples.index]
        speeds = np.diff(samples.values, axis=0) / np.diff(places)[:, None]
        times = 0.5 * (places[1:] + places[:-1])
    else:
        raise StudyError("[window] impacts: needs a measured velocity, position or joint")
    if len(times) < 2:
        return np.empty(0)
    jump = np.linalg.norm(np.diff(speeds, axis=0), axis=1) / np.diff(times)
    hits: np.ndarray = times[:-1][jump > settings.window.acceleration]
    if not len(hits):
        return hits
    steps = np.diff(times).mean()
    first = np.concatenate([[True], np.diff(hits) > settings.window.gap + steps * 1e-6])
    result: np.ndarray = hits[first]
    return result


def _until(trial: Trial, end: float) -> Trial:
    count = int(np.searchsorted(trial.times, end + _ROUNDING, side="right"))
    if count < 2:
        raise StudyError(
            f"[window]: trial {trial.label} has less than two samples before {end:.4g} s"
        )
    return _part(trial, trial.label, 0, count)


def _segments(trial: Trial, length: float) -> list[Trial]:
    edges = np.arange(0.0, float(trial.times[-1]), length)
    places = np.searchsorted(trial.times, edges - _ROUNDING)
    places = np.unique(np.append(places, len(trial.times) - 1))
    found = []
    for number, (first, last) in enumerate(itertools.pairwise(places)):
        # The node between two segments belongs to both: it starts the one and ends the other.
        found.append(_part(trial, f"{trial.label}:{number}", int(first), int(last) + 1))
    return found


def _part(trial: Trial, label: str, first: int, last: int) -> Trial:
    times = trial.times[first:last]
    samples = {}
    for name, each in trial.samples.items():
        keep = (each.index >= first) & (each.index < last)
        samples[name] = Samples(each.index[keep] - first, each.values[keep])
    return replace(trial, label=label, times=times - times[0], samples=samples)
