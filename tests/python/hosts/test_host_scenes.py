# SPDX-License-Identifier: Apache-2.0
"""The two scenes of python/examples/hosts in other simulators: times of closed forms and MuJoCo."""

import importlib

import mujoco
import numpy as np
import pytest
from host_runs import EXAMPLES, FREE_FALL, HOSTS, in_host, in_mujoco, module

SCENES = ("ball_in_cylinder", "tippe_top")
TOUCH, LATER = 1e-5, 1e-3  # relative; docs/validation.md asks the same of the touch, 5e-3 later


@pytest.fixture(scope="module")
def reference():
    """MuJoCo's runs."""
    return {name: in_mujoco(name) for name in SCENES}


def needed(package):
    """Skips where the simulator is missing, and says so."""
    try:
        importlib.import_module(package)
    except ImportError as error:
        pytest.skip(
            f"{package} is missing: ./run installs the group `hosts` for the newest MuJoCo"
            f" ({error})"
        )


def test_reference_touches_after_free_fall(reference):
    assert reference["ball_in_cylinder"].events["touches"] == pytest.approx(FREE_FALL, rel=TOUCH)


def test_reference_has_the_events_of_the_validation_page(reference):
    events = reference["tippe_top"].events
    assert events["upright"] == pytest.approx(0.186, abs=2e-3)
    assert events["stem touches"] == pytest.approx(1.49062, rel=1e-2)
    assert events["beyond 150 degrees"] - events["stem touches"] == pytest.approx(0.1134, rel=0.05)


# Of the slow ones the other scene is enough in `./run test`.
SLOW = ("drake", "tippe_top"), ("basilisk", "ball_in_cylinder")
RUNS = [
    pytest.param(host, name, marks=[pytest.mark.soak] if (host, name) in SLOW else [])
    for name in SCENES
    for host in HOSTS
]


@pytest.mark.parametrize(("host", "name"), RUNS)
def test_events_are_those_of_mujoco(host, name, reference):
    needed(HOSTS[host])
    run = in_host(host, name)
    assert np.isfinite(run.poses).all()
    assert list(run.events) == list(reference[name].events)
    if name == "ball_in_cylinder":
        assert run.events["touches"] == pytest.approx(FREE_FALL, rel=TOUCH)
    for event, time in reference[name].events.items():
        # Upright is the best of samples 1 ms apart.
        allowed = {"abs": 2e-3} if event == "upright" else {"rel": LATER}
        assert run.events[event] == pytest.approx(time, **allowed), event


def test_solve_ivp_finds_the_touches_as_events(reference):
    needed("scipy")
    from scipy.interpolate import CubicSpline

    (touch, *_) = in_host("scipy", "ball_in_cylinder").touches
    assert touch == pytest.approx(FREE_FALL, rel=1e-8)
    # The stem nods at the rate of the spin: between samples 1 ms apart its gap is no line.
    run = reference["tippe_top"]
    near = np.abs(run.times - run.events["stem touches"]) < 0.01
    gap = module("two_scenes").stem_gap(run.poses)
    roots = CubicSpline(run.times[near], gap[near]).roots(extrapolate=False)
    (touch, *_) = in_host("scipy", "tippe_top").touches
    assert touch == pytest.approx(roots[0], abs=3e-6)


@pytest.mark.skipif(
    int(mujoco.__version__.split(".")[0]) < 3,
    reason="MuJoCo 2 integrates bodies that turn to second order",
)
@pytest.mark.parametrize(("name", "bound"), [("ball_in_cylinder", 2e-4), ("tippe_top", 1e-7)])
def test_solver_of_high_order_repeats_the_run_of_mujoco(name, bound, reference):
    """Whole poses, through impacts and with bristles: the contact is the same function there."""
    needed("scipy")
    run = in_host("scipy", name)
    assert np.abs(run.poses - reference[name].poses).max() < bound


def test_programs_are_short():
    programs = sorted(EXAMPLES.glob("*_scenes.py"))
    assert {path.stem.removesuffix("_scenes") for path in programs} == {*HOSTS, "two"}
    for path in programs:
        if path.stem != "two_scenes":
            assert len(path.read_text(encoding="utf-8").splitlines()) <= 60, path.name
