# SPDX-License-Identifier: Apache-2.0
"""What must not matter: engine, threads and release of MuJoCo. All scenes of the validation.

Whole runs under all engines are kept in support/whole_runs.json. Made anew are those under the
scene's own engine and of the octree the first steps, and on one release those on two threads and
those of other quick engines.
"""

from __future__ import annotations

import functools
import json

import mujoco
import numpy as np
import pytest
from case import Bounds, Case, load, start, varied
from whole_runs import RESULTS, SCENES, engines_of, kept, under

import volcontact as vc
from volcontact._mujoco_views import dense

FIRST_STEPS = 60  # from the first contact on
VOLUME_TOLERANCE = 5e-5  # asked of the octree
STATE_TOLERANCE = 1e-4


def share(scene: str, values: dict[str, float]) -> float:
    """Largest difference of a run from that of the scene's own engine, over what is allowed [-]."""
    return max(
        (abs(outcome.value - values[outcome.name]) / outcome.allowed for outcome in kept(scene)),
    )


def measure() -> Case:
    """Whole runs as they were kept."""
    case = Case(
        "Engines, threads and releases",
        "Complete runs of every scene with every engine that supports its pairs, and on MuJoCo "
        "2.2.2. The figure is the largest difference of any result from that of the scene's own "
        "engine on the newest release, relative to the tolerance of its case. Between one thread "
        "and two not a single bit differs. For comparison, the rows called rounding show the "
        "effect of increasing all masses by 1e-14: where this is as large, the motion is chaotic "
        "and no engine can do better. The octree runs at its default tolerance, a thousandth of "
        "the volume, and for the ball in the cylinder at 5e-5: by default its normal is tilted by "
        "4e-5, and down such a slope a rolling ball creeps at 0.3 mm/s for the rest of the run. "
        "Energy is not compared: with the octree the tumbling box moves in the same way, but the "
        "account of elastic energy leaves out columns that end early, and balances only to 8 %.",
    )
    for scene, record in json.loads(RESULTS.read_text()).items():
        for name, values in record["runs"].items():
            if name == record["engine"]:
                continue
            most = 0.0 if name == "2 threads" else 1.0
            figure = f"{scene}, {name} for {record['engine']}"
            case.figures.append(Bounds(figure, "-", 0.0, most, share(scene, values), "one engine"))
    return case


def test_kept_runs_agree() -> None:
    measure().check()
    records = json.loads(RESULTS.read_text())
    assert set(records) == set(SCENES)
    for scene, record in records.items():
        assert set(record["runs"]) > {"2 threads", "rounding", "MuJoCo 2.2.2", "octree"}, scene


@functools.cache
def outcomes(scene: str) -> dict[str, float]:
    """Of the scene as it is."""
    return {outcome.name: outcome.value for outcome in SCENES[scene]()}


@pytest.mark.parametrize("scene", SCENES)
def test_whole_runs_come_to_what_was_kept(scene: str) -> None:
    assert share(scene, outcomes(scene)) <= 1.0


@pytest.mark.once
@pytest.mark.parametrize("scene", SCENES)
def test_whole_runs_do_not_depend_on_threads_and_engines(scene: str) -> None:
    with varied(threads=2):
        two = {outcome.name: outcome.value for outcome in SCENES[scene]()}
    assert two == outcomes(scene)
    for engine in engines_of(scene)[1:]:
        if engine == "octree":
            continue
        with varied(**under(engine, scene)):
            assert share(scene, {out.name: out.value for out in SCENES[scene]()}) <= 1.0, engine


@pytest.mark.parametrize("scene", SCENES)
def test_octree_begins_as_the_own_engine_goes_on(scene: str) -> None:
    model = load(f"{scene}/scene.xml")
    first = start(model)
    with vc.attach(model) as contact:
        while len(contact.sites(first)) == 0:
            mujoco.mj_step(model, first, 10)
    states = []
    for variation in ({}, under("octree", scene) | {"tolerance": VOLUME_TOLERANCE}):
        with varied(**variation):
            model = load(f"{scene}/scene.xml")
        data = start(model)
        data.qpos[:], data.qvel[:] = first.qpos, first.qvel
        with vc.attach(model):
            mujoco.mj_step(model, data, FIRST_STEPS)
        states.append(np.concatenate([dense(data.qpos), dense(data.qvel)]))
    own, other = states
    assert np.abs(own - other).max() <= STATE_TOLERANCE * np.abs(own).max()
