# SPDX-License-Identifier: Apache-2.0
"""Intervals of bench tests under the noise of instruments: 95 % hold the truth, neither fewer."""

import numpy as np
import pytest
from bench_sheets import kept_sheet, noisy, read, repeated, simulations
from soaking import cases

REPETITIONS = cases(40, soak=200)
# Of 40, chance alone may leave 100 %.
LEAST, MOST = 0.90 * REPETITIONS, cases(1.0, soak=0.99) * REPETITIONS
# What instruments of a workshop leave, standard deviations [SI].
NOISE = {
    "press": {"force": 0.1, "depth": 2e-7},
    "drop": {"height": 5e-4},
    "tilt": {"angle": np.deg2rad(0.05), "acceleration": 0.03},
    "pull": {"force": 0.01},
    "slip": {"displacement": 2e-8, "force": 2e-3},
    "roll": {"rate": 0.01},
    "spin": {"rate": 0.1},
}
FOUND = {
    "press": ("stiffness",),
    "drop": ("damping",),
    "tilt": ("friction", "static_friction", "dwell_time"),
    "pull": ("friction", "static_friction", "dwell_time", "stribeck_speed", "viscous_friction"),
    "slip": ("bristle_stiffness", "bristle_damping"),
    "roll": ("damping",),
    "spin": ("lever",),
}


@pytest.mark.parametrize("test", NOISE)
def test_intervals_hold_the_truth(test):
    sheet = kept_sheet(test)
    if test == "tilt":  # five angles alone say little of their own scatter
        sheet = repeated(sheet, 3)
    true = simulations().truth(test) | {"lever": 0.05 * 2.0 / 3.0}
    held = dict.fromkeys(FOUND[test], 0)
    for seed in range(REPETITIONS):
        found = read(noisy(sheet, NOISE[test], seed))
        for name in held:
            each = found.values[name]
            held[name] += each.low <= true[name] <= each.high
    for name, count in held.items():
        assert LEAST <= count <= MOST, (name, count)
