# SPDX-License-Identifier: Apache-2.0
"""Ten tosses without noise give every number back that they can tell, and name the others."""

import pytest
from synthetic_tosses import STARTS, parameter, scene, slides, tosses, write

from volcontact.identify.reading import read_settings
from volcontact.identify.run import run

ONE = "[estimator]\nstarts = 1\n"
LAW = "regularized_coulomb"
PAIR = {"stiffness": 5e8, "damping": 4.0, "friction": 0.18}
BRISTLE = {
    "friction": 0.18,
    "static_friction": 0.24,
    "bristle_stiffness": 2e4,
    "bristle_damping": 60.0,
    "viscous_friction": 0.3,
    "stribeck_speed": 0.05,
    "dwell_time": 0.02,
}
GUESS = {
    "friction": 0.19,
    "static_friction": 0.25,
    "bristle_stiffness": 2.2e4,
    "bristle_damping": 66.0,
    "viscous_friction": 0.25,
    "stribeck_speed": 0.055,
    "dwell_time": 0.022,
}
TABLES = {
    "stiffness": parameter("stiffness", 1e8, 5e9),
    "damping": parameter("damping", 0.4, 40.0),
    "restitution": parameter("restitution", 0.1, 0.9, "linear"),
    "friction": parameter("friction", 0.05, 0.23, "linear"),
    "slip_speed": parameter("slip_speed", 0.01, 1.0),
    "static_friction": parameter("static_friction", 0.2, 0.5, "linear"),
    "bristle_stiffness": parameter("bristle_stiffness", 3e3, 3e5),
    "bristle_damping": parameter("bristle_damping", 10.0, 1000.0),
    "viscous_friction": parameter("viscous_friction", 0.0, 1.0, "linear"),
    "stribeck_speed": parameter("stribeck_speed", 0.005, 0.5),
    "dwell_time": parameter("dwell_time", 0.002, 0.5),
}


def identified(folder, true, guess, law, rows, estimator=ONE):
    study = STARTS + "".join(TABLES[name] for name in guess) + estimator
    path = write(folder, scene(true | guess, law), rows, study)
    return run(read_settings(path), None, workers=1)


@pytest.mark.parametrize(
    ("true", "guess"),
    [
        ({"slip_speed": 0.01}, {"stiffness": 1e9, "damping": 2.0, "friction": 0.21}),
        ({"slip_speed": 0.1}, {"friction": 0.2, "slip_speed": 0.15}),
    ],
)
def test_hunt_crossley_and_coulomb_are_recovered(tmp_path, true, guess):
    true = PAIR | true
    found = identified(tmp_path, true, guess, LAW, tosses(scene(true, LAW)))
    assert found.converged
    for name in guess:
        assert found.values[name] == pytest.approx(true[name], rel=1e-3)
    assert found.findings == []


def test_restitution_is_recovered(tmp_path):
    true = {"stiffness": 5e8, "restitution": 0.35, "friction": 0.18, "slip_speed": 0.01}
    guess = {"stiffness": 7e8, "restitution": 0.45, "friction": 0.2}
    starts = "[estimator]\nstarts = 4\n"
    found = identified(tmp_path, true, guess, LAW, tosses(scene(true, LAW)), starts)
    for name in guess:
        assert found.values[name] == pytest.approx(true[name], rel=1e-3)


def test_all_seven_numbers_of_bristles_are_recovered_from_tosses_that_slide_and_stop(tmp_path):
    true = PAIR | BRISTLE
    found = identified(tmp_path, true, GUESS, "bristle", slides(scene(true, "bristle")))
    assert found.converged
    for name, value in BRISTLE.items():
        assert found.values[name] == pytest.approx(value, rel=1e-3)


def test_what_tosses_on_a_corner_cannot_tell_of_bristles_is_named(tmp_path):
    """They slide while they touch: of what holds at rest there is nothing in them."""
    true = PAIR | BRISTLE
    rows = tosses(scene(true, "bristle"))
    told = {name: GUESS[name] for name in ("friction", "viscous_friction", "bristle_damping")}
    found = identified(tmp_path, true, told, "bristle", rows)
    for name in told:
        assert found.values[name] == pytest.approx(BRISTLE[name], rel=1e-3)
    few = ONE + "evaluations = 20\n"
    every = identified(tmp_path, true, GUESS, "bristle", rows, few)
    named = " ".join(every.findings)
    for name in ("static_friction", "stribeck_speed", "dwell_time"):
        assert not every.summary["parameters"][name]["told"] or name in named
        assert name in named
