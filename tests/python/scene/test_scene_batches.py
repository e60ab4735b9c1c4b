# SPDX-License-Identifier: Apache-2.0
"""Many simulations, and scenes put together."""

import importlib.util
import threading

import mujoco
import numpy as np
import pytest
from balls import ball

import volcontact as vc


def test_changed_numbers_act_at_once():
    model = vc.load(ball(0.049))
    model.opt.timestep = 1e-4  # explicit: the force is k V
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        before = data.qfrc_applied[2]
        model.numeric("volcontact/material/rubber/stiffness").data[0] *= 3
        mujoco.mj_forward(model, data)
        assert data.qfrc_applied[2] == pytest.approx(3 * before)
        (pair,) = contact.description["pairs"]
        assert pair["stiffness"] == 3e8


def test_invalid_numbers_are_reported_once_and_the_last_valid_stay(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its warnings into a file here
    model = vc.load(ball(0.049))
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        before = data.qfrc_applied[2]
        assert contact.live_error() == ""
        model.numeric("volcontact/material/rubber/stiffness").data[0] = -1
        mujoco.mj_forward(model, data)
        assert data.qfrc_applied[2] == before
        with pytest.warns(RuntimeWarning, match=r"stiffness = -1 \[N/m\^3\] is out of range"):
            contact.sites(data)
        contact.sites(data)
        assert "must be > 0" in contact.live_error()


def test_python_threads_equal_a_single_run():
    model = vc.load(ball(0.08))

    def steps(data):
        for _ in range(500):
            mujoco.mj_step(model, data)

    with vc.attach(model):
        single = mujoco.MjData(model)
        steps(single)
        data = [mujoco.MjData(model) for _ in range(4)]
        threads = [threading.Thread(target=steps, args=(d,)) for d in data]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    for d in data:
        assert np.array_equal(d.qpos, single.qpos)
        assert np.array_equal(d.userdata, single.userdata)


@pytest.mark.skipif(importlib.util.find_spec("mujoco.batch") is None, reason="no Batch here")
def test_batch_equals_single_runs():
    from mujoco.batch import Batch

    model = vc.load(ball(0.06))
    forces = np.linspace(-3.0, 3.0, 8)
    with vc.attach(model):
        batch = Batch(model, nsim=len(forces), nthread=3)
        batch.bind("qfrc_applied")[:, 0] = forces
        for _ in range(300):
            batch.step()
        qpos = batch.bind("qpos")
        for i, force in enumerate(forces):
            data = mujoco.MjData(model)
            data.qfrc_applied[0] = force
            for _ in range(300):
                mujoco.mj_step(model, data)
            assert data.qpos[2] < 0.06
            assert np.array_equal(qpos[i], data.qpos)


@pytest.mark.skipif(importlib.util.find_spec("mujoco.batch") is None, reason="no Batch here")
def test_simulations_of_a_batch_may_have_materials_of_their_own():
    from mujoco.batch import Batch

    model = vc.load(ball(0.049))
    model.opt.timestep = 1e-4  # explicit: the force is k V
    with vc.attach(model):
        batch = Batch(model, nsim=4, nthread=2)
        numbers = batch.expand("numeric_data")
        (address,) = model.numeric_adr[[model.numeric("volcontact/material/rubber/stiffness").id]]
        numbers[:, address] = 1e8, 2e8, 3e8, 4e8
        for _ in range(3):
            batch.forward()
            force = batch.bind("qfrc_applied")[:, 2]
            assert force == pytest.approx(force[0] * np.arange(1, 5))


@pytest.mark.skipif(not hasattr(mujoco, "MjSpec"), reason="no MjSpec here")
def test_scenes_put_together_keep_their_materials_apart():
    spec = mujoco.MjSpec()
    spec.option.timestep = 1e-3
    for i, stiffness in enumerate(("1e8", "3e8")):
        child = mujoco.MjSpec.from_string(ball(0.049).replace("2e8", stiffness))
        frame = spec.worldbody.add_frame(pos=[10 * i, 0, 0])
        spec.attach(child, frame=frame, prefix=f"c{i}_")
    plain = spec.compile()
    with pytest.raises(ValueError, match="userdata is too small"):
        vc.attach(plain)
    model = vc.load(spec.to_xml())
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        sites = contact.sites(data)
        materials = contact.description["materials"]
    assert materials["c0_rubber"]["key"] == "c0_volcontact/material/rubber"
    assert materials["c1_rubber"]["stiffness"] == 3e8
    force = {
        (a, b): f
        for a, b, f in zip(sites["geom_a"], sites["geom_b"], sites["normal_force"], strict=True)
    }
    ids = [tuple(model.geom(f"c{i}_{name}").id for name in ("floor", "ball")) for i in (0, 1)]
    assert force[ids[1]] == pytest.approx(3 * force[ids[0]])


def test_listed_pairs_alone_are_volumetric_and_the_rest_stays_native():
    text = """
    <mujoco><worldbody><geom name="floor" type="plane" size="1 1 1"/>
      <body pos="0 0 .049"><freejoint/><geom name="ours" type="sphere" size=".05"/></body>
      <body pos=".5 0 .049"><freejoint/><geom name="native" type="sphere" size=".05"/></body>
    </worldbody><custom><numeric name="volcontact/option/pairs/listed" data="1"/>
      <tuple name="volcontact/pair/p"><element objtype="geom" objname="floor"/>
        <element objtype="geom" objname="ours"/></tuple></custom></mujoco>"""
    model = vc.load(text)
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        assert data.ncon == 1
        assert (contact.sites(data)["geom_b"] == [1]).all()
    mujoco.mj_forward(model, data)
    assert data.ncon == 2
