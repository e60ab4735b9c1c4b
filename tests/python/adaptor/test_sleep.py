# SPDX-License-Identifier: Apache-2.0
"""Bodies that MuJoCo lets sleep: what touches sleeps together, and wakes what it touches."""

import mujoco
import numpy as np
import pytest

import volcontact as vc

pytestmark = pytest.mark.skipif(
    int(mujoco.__version__.split(".")[0]) < 4, reason="this MuJoCo has no sleep that we can wake"
)

HALF = 0.1
STIFF = {"stiffness": 1e8, "damping": 2.0}


def stacks(more: str = "", sleep: str = "enable", option: str = "") -> str:
    """Two stacks of three boxes, two metres apart, and a ball high over the first."""
    boxes = "".join(
        f'<body name="{name}{i}" pos="{x} 0 {HALF * (2 * i + 1)}"><freejoint/>'
        f'<geom type="box" size="{HALF} {HALF} {HALF}" mass="1"/></body>'
        for name, x in (("a", 0.0), ("b", 2.0))
        for i in range(3)
    )
    return (
        f'<mujoco><option timestep="0.002" {option}><flag sleep="{sleep}"/></option><worldbody>'
        f'<geom type="plane" size="9 9 1"/>{boxes}{more}</worldbody></mujoco>'
    )


BALL = '<body name="ball" pos="0.02 0.01 3"><freejoint/><geom size="0.08" mass="2"/></body>'


def awake(model: mujoco.MjModel, data: mujoco.MjData) -> set[str]:
    """Names of the bodies that are awake."""
    return {
        model.body(i).name
        for i in range(1, model.nbody)
        if model.body_treeid[i] >= 0 and data.tree_awake[model.body_treeid[i]]
    }


def run_until(model, data, condition, most: int = 4000) -> int:
    """Steps until it holds; how many it took."""
    for step in range(most):
        mujoco.mj_step(model, data)
        if condition():
            return step
    raise AssertionError(f"not within {most} steps; awake: {awake(model, data)}")


def test_stacks_fall_asleep_are_hit_and_wake():
    model = mujoco.MjModel.from_xml_string(stacks(BALL))
    data = mujoco.MjData(model)
    first, second = {"a0", "a1", "a2"}, {"b0", "b1", "b2"}
    slept_at = {}
    with vc.attach(model, material=STIFF):
        for step in range(200):  # while the ball falls
            mujoco.mj_step(model, data)
            for name in (first | second) - awake(model, data):
                slept_at.setdefault(name, step)
        assert awake(model, data) == {"ball"}
        # What touches fell asleep at once.
        assert len({slept_at[name] for name in first}) == 1
        assert len({slept_at[name] for name in second}) == 1
        lying = data.qpos.copy()
        run_until(model, data, lambda: "a2" in awake(model, data))
        assert awake(model, data) == first | {"ball"}  # as far as it is felt, and no further
        assert 0.5 < data.time < 1.0
        hit = model.body("a2").dofadr[0]
        run_until(model, data, lambda: abs(data.qvel[hit + 2]) > 1e-3)
        of_second = model.jnt_qposadr[model.body("b0").jntadr[0]]
        assert np.array_equal(data.qpos[of_second : of_second + 21], lying[of_second:][:21])
        run_until(model, data, lambda: awake(model, data) <= {"ball"})  # which rolls on
        boxes = data.qvel.reshape(-1, 6)[:-1]
        assert np.all(boxes == 0.0)


def test_a_hit_is_that_of_bodies_that_never_slept():
    """The blow of the ball: the same motion but for what sleep took of the last speeds."""
    ends = []
    for sleep in ("enable", "disable"):
        model = mujoco.MjModel.from_xml_string(stacks(BALL, sleep))
        data = mujoco.MjData(model)
        # `passive` in both.
        with vc.attach(model, material=STIFF, options={"target": "passive"}) as contact:
            for _ in range(380):  # 0.76 s: the ball touches at 0.71 s
                mujoco.mj_step(model, data)
            ends.append((data.qpos.copy(), data.qvel.copy(), contact.energy(data)))
    (qpos, qvel, energy), (qpos_awake, qvel_awake, energy_awake) = ends
    assert np.abs(qvel_awake).max() > 0.1
    assert np.abs(qpos - qpos_awake).max() < 1e-6
    assert np.abs(qvel - qvel_awake).max() < 1e-3
    assert energy.elastic == pytest.approx(energy_awake.elastic, rel=1e-2, abs=1e-6)
    assert energy.dissipated == pytest.approx(energy_awake.dissipated, rel=1e-3)


def test_energy_does_not_leap_when_bodies_fall_asleep():
    model = mujoco.MjModel.from_xml_string(stacks())
    data = mujoco.MjData(model)
    with vc.attach(model, material=STIFF) as contact:
        run_until(model, data, lambda: not awake(model, data))
        last = contact.energy(data)  # at the begin of the step, all awake
        energies = []
        for _ in range(500):
            mujoco.mj_step(model, data)
            energies.append(contact.energy(data))
    assert last.elastic > 1e-5
    for name in ("elastic", "numerical", "dissipated", "released", "owed"):
        values = [getattr(energy, name) for energy in energies]
        # What the step itself still did: the last speeds are below 1e-4 m/s.
        assert values[0] == pytest.approx(getattr(last, name), abs=1e-3 * last.elastic)
        assert set(values[1:]) == set(values[:1]), name


def test_a_copy_of_data_that_sleep_goes_on_alike():
    model = vc.load(stacks(BALL), material=STIFF)
    data = mujoco.MjData(model)
    with vc.attach(model, material=STIFF):
        for _ in range(300):
            mujoco.mj_step(model, data)
        assert awake(model, data) == {"ball"}
        other = mujoco.MjData(model)
        mujoco.mj_copyData(other, model, data)
        for _ in range(300):
            mujoco.mj_step(model, data)
            mujoco.mj_step(model, other)
        assert {"a0", "a2"} <= awake(model, data)
        assert np.array_equal(data.qpos, other.qpos)
        assert np.array_equal(data.qvel, other.qvel)


def test_a_mocap_body_wakes_when_it_moves_and_not_while_it_stands():
    table = (
        '<body name="table" mocap="true" pos="4 0 0.5"><geom type="box" size=".3 .3 .05"/></body>'
        '<body name="cup" pos="4 0 .6"><freejoint/><geom type="box" size=".05 .05 .05" mass=".1"/>'
        "</body>"
    )
    model = mujoco.MjModel.from_xml_string(stacks(table))
    data = mujoco.MjData(model)
    with vc.attach(model, material=STIFF):
        run_until(model, data, lambda: not awake(model, data))
        for _ in range(100):
            mujoco.mj_step(model, data)
        assert not awake(model, data)
        for _ in range(100):
            data.mocap_pos[0, 0] += 1e-4
            mujoco.mj_step(model, data)
        assert awake(model, data) == {"cup"}
        cup = model.jnt_qposadr[model.body("cup").jntadr[0]]
        assert data.qpos[cup] == pytest.approx(4.01, abs=2e-4)  # it rode along


def test_forces_that_are_applied_keep_bodies_awake():
    model = mujoco.MjModel.from_xml_string(stacks())
    with pytest.raises(ValueError, match="nothing that lies would fall asleep"):
        vc.attach(model, options={"target": "applied"})


def test_a_batch_that_sleeps_equals_single_runs():
    from mujoco.batch import Batch

    model = vc.load(stacks(BALL), material=STIFF)
    heights = (1.0, 1.4, 1.8)
    ball = model.jnt_qposadr[model.body("ball").jntadr[0]]
    with vc.attach(model, material=STIFF):
        batch = Batch(model, nsim=len(heights), nthread=2, persistent=True)
        batch.bind("qpos")[:, ball + 2] = heights
        asleep = 0
        for _ in range(450):
            batch.step()
        qpos, qvel = batch.bind("qpos"), batch.bind("qvel")
        for i, height in enumerate(heights):
            data = mujoco.MjData(model)
            data.qpos[ball + 2] = height
            for _ in range(450):
                mujoco.mj_step(model, data)
                asleep += len(awake(model, data)) < 7
            assert np.array_equal(qpos[i], data.qpos), i
            assert np.array_equal(qvel[i], data.qvel), i
    assert asleep > 100
