# SPDX-License-Identifier: Apache-2.0
"""Sixteen simulations at once, by every way there is, are sixteen single ones to the last bit."""

import copy
import importlib.util
import multiprocessing
import threading

import mujoco
import numpy as np
import pytest
from simulations import final_state, pushed_box

import volcontact as vc

RUNS = 16
STEPS = 300
FORCES = np.linspace(0.0, 6.0, RUNS)  # [N]; the box sticks, slides, or is pushed against the wall


def has(module):
    try:
        return importlib.util.find_spec(module) is not None
    except ModuleNotFoundError:
        return False


@pytest.fixture(scope="module")
def single():
    """Final qpos, qvel, forces and userdata of each run."""
    made = [final_state((pushed_box(), force, STEPS)) for force in FORCES]
    positions = [run[0] for run in made]
    assert positions[0] < positions[5] < positions[-1]
    assert positions[-1] < 0.04  # the wall holds it
    return made


def state_of(data):
    return np.concatenate([data.qpos, data.qvel, data.qfrc_applied, data.userdata])


@pytest.mark.skipif(not has("mujoco.rollout"), reason="no rollout here")
def test_rollout_equals_single_runs(single):
    from mujoco import rollout

    spec = getattr(getattr(mujoco, "mjtState", None), "mjSTATE_QFRC_APPLIED", None)
    if spec is None or not hasattr(rollout, "Rollout"):
        pytest.skip("rollout takes no applied forces here")
    model = vc.load(pushed_box())
    start = np.zeros(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
    mujoco.mj_getState(model, mujoco.MjData(model), start, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    control = np.zeros((RUNS, STEPS, model.nv))
    control[:, :, 0] = FORCES[:, None]
    workers = [mujoco.MjData(model) for _ in range(4)]
    with vc.attach(model):
        for _ in range(2):  # also with data that have been through others
            states, _ = rollout.rollout(
                model, workers, np.tile(start, (RUNS, 1)), control, control_spec=int(spec)
            )
            for i in range(RUNS):
                end = states[i, -1, 1 : 1 + model.nq + model.nv]  # after the time
                assert np.array_equal(end, single[i][: model.nq + model.nv]), i


@pytest.mark.skipif(not has("mujoco.batch"), reason="no Batch here")
@pytest.mark.parametrize("workers", [1, 4])
def test_batch_equals_single_runs(single, workers):
    from mujoco.batch import Batch

    model = vc.load(pushed_box())
    with vc.attach(model):
        batch = Batch(model, nsim=RUNS, nthread=workers)
        batch.bind("qfrc_applied")[:, 0] = FORCES
        for _ in range(STEPS):
            batch.step()
        parts = [batch.bind(name) for name in ("qpos", "qvel", "qfrc_applied", "userdata")]
        for i in range(RUNS):
            assert np.array_equal(np.concatenate([part[i] for part in parts]), single[i]), i


def test_python_threads_equal_single_runs(single):
    model = vc.load(pushed_box())
    data = [mujoco.MjData(model) for _ in FORCES]

    def steps(mine, force):
        mine.qfrc_applied[0] = force
        for _ in range(STEPS):
            mujoco.mj_step(model, mine)

    with vc.attach(model):
        threads = [
            threading.Thread(target=steps, args=pair) for pair in zip(data, FORCES, strict=True)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    for i, mine in enumerate(data):
        assert np.array_equal(state_of(mine), single[i]), i


def test_threads_with_models_of_their_own_equal_single_runs(single):
    # Each attaches a copy: scenes come and go while others step.
    model = vc.load(pushed_box())
    ends = {}

    def whole_run(i):
        mine = copy.copy(model)
        data = mujoco.MjData(mine)
        data.qfrc_applied[0] = FORCES[i]
        with vc.attach(mine):
            for _ in range(STEPS):
                mujoco.mj_step(mine, data)
        ends[i] = state_of(data)

    threads = [threading.Thread(target=whole_run, args=(i,)) for i in range(RUNS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for i in range(RUNS):
        assert np.array_equal(ends[i], single[i]), i


def test_spawned_processes_equal_single_runs(single):
    chosen = (0, 7, 15)
    work = [(pushed_box(), FORCES[i], STEPS) for i in chosen]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        ends = pool.map_async(final_state, work).get(timeout=120)
    for i, end in zip(chosen, ends, strict=True):
        assert np.array_equal(end, single[i]), i


# Python 3.12 and later warn of forks in processes with threads; that is what is tried here.
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="no fork here")
def test_forked_processes_stay_serial_and_equal_single_runs():
    # The octree takes long enough for the scene to share its work among threads. Those of OpenMP
    # do not live on in a child: one that asked for them would hang.
    text = pushed_box(threads=2).replace(
        "<custom>", '<custom><numeric name="volcontact/option/engine/octree" data="1"/>'
    )
    work = [(text, FORCES[i], 20) for i in (0, 7, 15)]
    here = [final_state(item) for item in work]
    with multiprocessing.get_context("fork").Pool(2) as pool:
        ends = pool.map_async(final_state, work).get(timeout=120)
    for end, mine in zip(ends, here, strict=True):
        assert np.array_equal(end, mine)


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="no fork here")
def test_attached_model_goes_on_in_a_forked_child(single):
    model = vc.load(pushed_box())
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = FORCES[7]
    with vc.attach(model):
        for _ in range(STEPS // 2):
            mujoco.mj_step(model, data)
        receiver, sender = multiprocessing.get_context("fork").Pipe(duplex=False)

        def rest_of_the_run():
            for _ in range(STEPS - STEPS // 2):
                mujoco.mj_step(model, data)
            sender.send(state_of(data))

        child = multiprocessing.get_context("fork").Process(target=rest_of_the_run)
        child.start()
        assert receiver.poll(60)
        assert np.array_equal(receiver.recv(), single[7])
        child.join()
        assert child.exitcode == 0
