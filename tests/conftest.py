# SPDX-License-Identifier: Apache-2.0
"""Which tests run in `./run test` and in `./run soak`, and which begin first."""

import gc

import pytest
from soaking import SOAKING

# Files with the longest tests are begun first: one that is begun last keeps one core waiting.
BEGUN_FIRST = (
    "test_public_names.py",
    "test_fmu_sources.py",
    "test_adaptor_build.py",
    "test_host_scenes.py",
    "test_models.py",
    "test_study_run.py",
    "test_view_steering.py",
    "test_own_laws.py",
    "test_host_examples.py",
)
LEFT_OUT = pytest.StashKey()


def pytest_addoption(parser):
    parser.addoption(
        "--again",
        action="store_true",
        help="everything ran on another MuJoCo release: leave out what is marked `once`",
    )


def pytest_collection_modifyitems(config, items):
    """The order within a file, and of all others, stays."""
    place = {name: number for number, name in enumerate(BEGUN_FIRST)}
    items.sort(key=lambda item: place.get(item.path.name, len(place)))
    if SOAKING:
        return
    left_out = {"soak", "once"} if config.getoption("again") else {"soak"}
    kept, config.stash[LEFT_OUT] = [], []
    for item in items:
        marks = {mark.name for mark in item.iter_markers()}
        (config.stash[LEFT_OUT] if marks & left_out else kept).append(item)
    config.hook.pytest_deselected(items=config.stash[LEFT_OUT])
    items[:] = kept


def pytest_collection_finish():
    """What is imported and collected stays to the end: no search for garbage goes through it."""
    gc.freeze()


def pytest_unconfigure():
    """At its end Python looks through everything, and nanobind for what is left."""
    gc.unfreeze()


def pytest_terminal_summary(terminalreporter, config):
    if count := len(config.stash.get(LEFT_OUT, [])):
        terminalreporter.write_line(f"{count} long tests left out: ./run soak runs them, too")
