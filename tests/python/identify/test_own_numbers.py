# SPDX-License-Identifier: Apache-2.0
"""Starts of trials that are taken from noisy poses are found before anything else."""

import numpy as np
from synthetic_tosses import FRAMES, NUISANCE, noisy, parameter, scene, tosses, write

from volcontact.identify.estimators.least_squares import Residuals
from volcontact.identify.estimators.own_numbers import settled, standing_out
from volcontact.identify.estimators.scales import Box
from volcontact.identify.measurements import read_trials
from volcontact.identify.pool import Pool
from volcontact.identify.reading import read_settings

TRUE = {"stiffness": 5e8, "damping": 4.0, "friction": 0.18, "slip_speed": 0.01}


def test_each_trial_comes_down_to_its_noise(tmp_path):
    """At the true parameters errors are noise: chi^2 with a row's worth of freedom each."""
    rows = noisy(tosses(scene(TRUE), count=3), 1)
    study = parameter("friction", 0.05, 0.5, "linear") + NUISANCE + "[estimator]\nstarts = 1\n"
    settings = read_settings(write(tmp_path, scene(TRUE), rows, study))
    with Pool(settings, read_trials(settings), 1) as pool:
        residuals = Residuals(settings, pool, Box(settings.parameters))
        first = residuals.first(np.clip(Box(settings.parameters).point(pool.start), 0.0, 1.0))
        before = [float(e @ e) for e in residuals.by_trial(first)]
        after = [float(e @ e) for e in residuals.by_trial(settled(residuals, first))]
    free = 6 * FRAMES
    assert min(before) > 2.0 * free  # the impact is met elsewhere
    assert max(after) < free + 5.0 * np.sqrt(2.0 * free)


def test_impact_beside_the_last_sample_makes_two_valleys(tmp_path):
    """The third toss lands on its next corner there; who misses it fits four times as badly."""
    rows = noisy(tosses(scene(TRUE)), 110)
    study = parameter("friction", 0.05, 0.5, "linear") + NUISANCE + "[estimator]\nstarts = 1\n"
    path = write(tmp_path, scene(TRUE), rows[rows[:, 0] < 3], study)
    settings = read_settings(path)
    with Pool(settings, read_trials(settings), 1) as pool:
        residuals = Residuals(settings, pool, Box(settings.parameters))
        first = residuals.first(np.clip(Box(settings.parameters).point(pool.start), 0.0, 1.0))
        after = [float(e @ e) for e in residuals.by_trial(settled(residuals, first))]
    free = 6 * FRAMES
    assert max(after) < free + 5.0 * np.sqrt(2.0 * free)


def test_trials_that_stand_out_do_so_whatever_the_noise():
    costs, rows = np.array([80.0, 95.0, 250.0, 40.0]), np.array([84, 84, 84, 42])
    for noise in (1e-6, 1.0, 1e6):
        assert standing_out(noise * costs, rows).tolist() == [False, False, True, False]
    assert not standing_out(np.array([250.0]), np.array([84])).any()  # nothing to compare it with


def test_study_without_such_numbers_stays_as_it_is(tmp_path):
    study = parameter("friction", 0.05, 0.5, "linear") + "[estimator]\nstarts = 1\n"
    settings = read_settings(write(tmp_path, scene(TRUE), tosses(scene(TRUE), count=1), study))
    with Pool(settings, read_trials(settings), 1) as pool:
        residuals = Residuals(settings, pool, Box(settings.parameters))
        first = residuals.first(np.array([0.5]))
        assert settled(residuals, first) is first
