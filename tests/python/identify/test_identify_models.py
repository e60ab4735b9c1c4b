# SPDX-License-Identifier: Apache-2.0
"""Scenes of mjcf_models/identification: they load as they are, and beat guesses on real motions."""

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact.identify.bench import Bench
from volcontact.identify.estimators.costs import trial_cost
from volcontact.identify.measurements import read_trials
from volcontact.identify.reading import read_settings

FOLDER = Path(__file__).parents[3] / "mjcf_models" / "identification"
CUBE = FOLDER / "cube_tosses"


def cost(study, scene, **given):
    """Mean over the tosses of the sample of position [% of the width] plus rotation [degree]."""
    settings = read_settings(CUBE / study, measurements=[CUBE / "sample.parquet"])
    settings = replace(settings, scene=CUBE / scene)
    bench = Bench(settings, read_trials(settings))
    values = bench.start_values() | given
    found = [
        trial_cost(settings, bench.raw_errors(values, place)) for place in range(len(bench.trials))
    ]
    bench.close()
    return float(np.mean(found))


@pytest.mark.parametrize("scene", ["scene.xml", "identified.xml", "identified_native.xml"])
def test_scene_runs_as_it_is(scene):
    model = vc.load(CUBE / scene)
    assert model.opt.timestep == pytest.approx(1.0 / 148.0 / 14.0, rel=1e-9)
    for volumetric in (False, True):
        data = mujoco.MjData(model)
        data.joint("cube").qpos[2] = 0.06
        contact = vc.attach(model) if volumetric else None
        for _ in range(1000):
            mujoco.mj_step(model, data)
        assert 0.049 < data.joint("cube").qpos[2] < 0.053  # it lies on the board
        if contact is not None:
            contact.close()


def test_identified_scenes_are_nearer_to_the_real_cube_than_wrong_numbers():
    """Eight tosses tell such numbers apart; which of two fits is the better one they do not."""
    ours = cost("study.toml", "identified.xml")
    assert ours < 0.8 * cost("study.toml", "identified.xml", friction=0.4)
    assert ours < 0.8 * cost("study.toml", "identified.xml", damping=0.1)
    theirs = cost("study_native.toml", "identified_native.xml")
    assert theirs < 0.8 * cost("study_native.toml", "identified_native.xml", friction=0.4)


def test_sample_has_its_licence():
    assert "Redistribution and use in source and binary forms" in " ".join(
        (CUBE / "LICENSE-tosses").read_text().split()
    )
