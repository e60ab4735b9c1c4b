# SPDX-License-Identifier: Apache-2.0
"""The breakaway in a record of load and displacement."""

import numpy as np
import pytest

from volcontact.identify.direct import breakaway

RATE, SIGMA, MASS = 2.0, 1e5, 1.5  # of the load [N/s], of the bristles [N/m], [kg]


def record(begin=1.3, step=1e-3, until=1.6, noise=0.0):
    t = np.arange(0.0, until, step)
    x = RATE * t / SIGMA + RATE * np.maximum(t - begin, 0.0) ** 3 / (6.0 * MASS)
    x = x + noise * np.random.default_rng(0).standard_normal(len(t))
    return t, RATE * t, x


def test_it_is_found_to_a_fraction_of_a_sample():
    found = breakaway(*record(), threshold=2e-6)
    assert found.time == pytest.approx(1.3, abs=1e-4)
    assert found.load == pytest.approx(2.6, abs=2e-4)
    assert found.slope == pytest.approx(1.0 / SIGMA, rel=1e-6)


def test_noise_below_the_threshold_does_little():
    found = breakaway(*record(noise=5e-7), threshold=5e-6)
    assert found.load == pytest.approx(2.6, rel=0.01)


def test_springing_back_at_the_start_is_no_breakaway():
    t, F, x = record()
    found = breakaway(t, F, x - 3e-5 * np.exp(-t / 0.01), threshold=2e-6)
    assert found.load == pytest.approx(2.6, rel=2e-3)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda t, F, x: (t, F, x[:-1]), "give as many of each"),
        (lambda t, F, x: (t[:5], F[:5], x[:5]), "is too short"),
        (lambda t, F, x: (t, F, F / SIGMA), "has no breakaway"),
        (lambda t, F, x: (t[::100], F[::100], x[::100]), "sample faster"),
    ],
)
def test_records_that_cannot_be_are_told(change, said):
    with pytest.raises(ValueError, match=said):
        breakaway(*change(*record()), threshold=2e-6)


def test_threshold_is_above_zero():
    with pytest.raises(ValueError, match=r"threshold = 0 \[m\]: must be above 0"):
        breakaway(*record(), threshold=0.0)
