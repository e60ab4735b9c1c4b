# SPDX-License-Identifier: Apache-2.0
"""A simulation that is stopped, kept and gone on with is the same simulation, to the last bit."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
from checkpoints import checkpoint, restore, state_vector

import volcontact as vc

SCENE = Path(__file__).parents[3] / "mjcf_models/battery_box/scene.xml"
STEPS = 400  # from first touch on; it is seated by then, but under RK4
CHECKPOINTS = 100
AHEAD = 12  # steps compared after each of them


def with_bristles(tmp_path):
    """The battery box with friction that remembers."""
    for path in SCENE.parent.glob("*.xml"):
        text = path.read_text().replace("friction_law/regularized_coulomb", "friction_law/bristle")
        (tmp_path / path.name).write_text(text.replace("/slip_speed", "/stribeck_speed"))
    return tmp_path / SCENE.name


def everything(data):
    """What a step leaves that the next one starts from."""
    kept = checkpoint(data)
    return np.concatenate([np.ravel(kept[name]) for name in sorted(kept)])


@pytest.mark.parametrize("integrator", ["Euler", "RK4", "implicitfast"])
@pytest.mark.parametrize("friction", ["regularized_coulomb", "bristle"])
def test_battery_box_goes_on_from_a_hundred_checkpoints(friction, integrator, tmp_path):
    kind = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}", None)
    if kind is None:
        pytest.skip(f"this MuJoCo has no {integrator}")
    model = vc.load(SCENE if friction != "bristle" else with_bristles(tmp_path))
    chosen = np.random.default_rng(5).choice(STEPS, CHECKPOINTS, replace=False)
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        while len(contact.sites(data)) == 0:
            mujoco.mj_step(model, data)
        model.opt.integrator = kind
        if integrator == "RK4":  # explicit
            model.opt.timestep = 1e-4
        kept, course, touched = {}, [], 0
        for i in range(STEPS + AHEAD):
            if i in chosen:
                kept[i] = checkpoint(data)
            course.append(everything(data))
            mujoco.mj_step(model, data)
            touched += len(contact.sites(data)) > 0
        assert touched > 100
        # Into data that have seen other things, and in any order.
        other = mujoco.MjData(model)
        for i in np.random.default_rng(6).permutation(chosen):
            restore(other, kept[i])
            for k in range(i, i + AHEAD):
                assert np.array_equal(everything(other), course[k]), (i, k - i)
                mujoco.mj_step(model, other)


@pytest.mark.skipif(not hasattr(mujoco, "mj_getState"), reason="no mj_getState here")
def test_integration_state_of_mujoco_has_all_of_it(tmp_path):
    model = vc.load(with_bristles(tmp_path))
    data, other = mujoco.MjData(model), mujoco.MjData(model)
    spec = mujoco.mjtState.mjSTATE_INTEGRATION
    with vc.attach(model):
        for _ in range(250):
            mujoco.mj_step(model, data)
        state = state_vector(model, data)
        for _ in range(3):
            mujoco.mj_step(model, other)
        mujoco.mj_setState(model, other, state, spec)
        for _ in range(50):
            mujoco.mj_step(model, data)
            mujoco.mj_step(model, other)
        assert np.array_equal(everything(data), everything(other))
