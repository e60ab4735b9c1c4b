# SPDX-License-Identifier: Apache-2.0
"""Scenes: load, attach, sites, energy, description."""

import copy
import gc
import importlib.util
import math
import threading

import mujoco
import numpy as np
import pytest

import volcontact as vc

BALL = """
<mujoco>
  <option timestep="1e-3"/>
  {size}
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body pos="0 0 {height}"><freejoint/>
      <geom name="ball" type="sphere" size=".05" mass="1"/></body>
  </worldbody>
  <custom>
    <numeric name="volcontact/option/tolerance" data="1e-4"/>
    <numeric name="volcontact/material/rubber/stiffness" data="2e8"/>
    <numeric name="volcontact/material/rubber/damping" data="10"/>
    <numeric name="volcontact/material/rubber/friction" data="0.3"/>
    <tuple name="volcontact/material/rubber">
      <element objtype="geom" objname="floor"/><element objtype="geom" objname="ball"/>
    </tuple>
  </custom>
</mujoco>
"""


def ball(height=0.0493, size=""):
    return BALL.format(height=height, size=size)


# Load.


def test_loads_text_and_files_of_every_kind(tmp_path):
    path = tmp_path / "scene.xml"
    path.write_text(ball())
    binary = tmp_path / "scene.mjb"
    mujoco.mj_saveModel(mujoco.MjModel.from_xml_string(ball()), str(binary), None)
    models = [vc.load(ball()), vc.load(path), vc.load(str(path)), vc.load(binary)]
    assert len({model.nuserdata for model in models}) == 1
    for model in models:
        with vc.attach(model):
            data = mujoco.MjData(model)
            mujoco.mj_step(model, data)
            assert data.qfrc_applied[2] > 0.0


def test_keeps_the_users_part_of_userdata():
    plain = vc.load(ball()).nuserdata
    assert vc.load(ball(size='<size nuserdata="7"/>')).nuserdata == plain + 7


def test_missing_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="no such scene"):
        vc.load(tmp_path / "nowhere.xml")


@pytest.mark.parametrize("wrong", [None, 3, b"<mujoco/>"])
def test_load_takes_a_path_or_text(wrong):
    with pytest.raises(TypeError, match="a path or MJCF text"):
        vc.load(wrong)


# Attach.


def test_native_contact_is_off_inside_and_on_again_after():
    model = vc.load(ball())
    data = mujoco.MjData(model)
    with vc.attach(model):
        mujoco.mj_forward(model, data)
        assert data.ncon == 0
        assert data.qfrc_applied[2] > 0.0
    mujoco.mj_forward(model, data)
    assert data.ncon == 1


def test_closing_twice_does_nothing_and_close_ends_reading():
    model = vc.load(ball())
    contact = vc.attach(model)
    assert contact.is_installed() and contact.is_open
    contact.close()
    contact.close()
    assert not contact.is_installed() and not contact.is_open
    with pytest.raises(ValueError, match="closed"):
        contact.sites(mujoco.MjData(model))


def test_stays_attached_when_the_object_is_forgotten():
    model = vc.load(ball())
    vc.attach(model)
    gc.collect()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.qfrc_applied[2] > 0.0
    with pytest.raises(ValueError, match="attached already"):
        vc.attach(model)
    vc.Contact._open[model._address].close()


def test_error_inside_the_block_detaches_too():
    model = vc.load(ball())
    with pytest.raises(ZeroDivisionError), vc.attach(model):
        raise ZeroDivisionError
    with vc.attach(model) as contact:
        assert contact.is_installed()


def test_models_may_be_attached_at_a_time():
    first, second = vc.load(ball(0.0495)), vc.load(ball(0.049))
    data = [mujoco.MjData(first), mujoco.MjData(second)]
    with vc.attach(first) as outer:
        with vc.attach(second) as inner:
            mujoco.mj_forward(first, data[0])
            mujoco.mj_forward(second, data[1])
            shallow, deep = outer.sites(data[0])["volume"][0], inner.sites(data[1])["volume"][0]
            assert 0.0 < shallow < deep
        mujoco.mj_forward(first, data[0])
        assert outer.is_installed()
        assert outer.sites(data[0])["volume"][0] == shallow
        mujoco.mj_forward(second, data[1])
        assert data[1].ncon == 1


def test_user_callback_from_before_keeps_being_called():
    model = vc.load(ball(0.049))
    data = mujoco.MjData(model)

    def push(model, data):
        data.qfrc_passive[0] += 2.0

    mujoco.set_mjcb_passive(push)
    try:
        with vc.attach(model):
            mujoco.mj_forward(model, data)
            assert data.qfrc_passive[0] == 2.0
            assert data.qfrc_applied[2] > 0.0
        mujoco.mj_forward(model, data)
        assert data.qfrc_passive[0] == 2.0
    finally:
        mujoco.set_mjcb_passive(None)


def test_replaced_callback_is_noticed():
    model = vc.load(ball())
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        mujoco.set_mjcb_passive(None)
        assert not contact.is_installed()
        with pytest.warns(RuntimeWarning, match="replaced"):
            contact.sites(data)


def test_copies_of_an_attached_model_have_contact():
    model = vc.load(ball())
    with vc.attach(model):
        other = copy.copy(model)
        data = mujoco.MjData(other)
        mujoco.mj_forward(other, data)
        assert data.ncon == 0
        assert data.qfrc_applied[2] > 0.0


# Sites and energy.


def test_sites_have_the_documented_fields_and_one_row_a_site():
    model = vc.load(ball(0.1))
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        assert contact.sites(data).shape == (0,)  # before the first evaluation
        mujoco.mj_forward(model, data)
        apart = contact.sites(data)
        data.qpos[2] = 0.049
        mujoco.mj_forward(model, data)
        touching = contact.sites(data)
    assert apart.shape == (0,)
    assert apart.dtype == touching.dtype
    fields = """pair geom_a geom_b volume centroid normal area depth force torque normal_force
        slip spin elastic_energy flatness volume_error status"""
    assert sorted(touching.dtype.names) == sorted(fields.split())
    assert touching.shape == (1,)
    (site,) = touching
    # Cap of height h = 1 mm of a ball of radius R = 50 mm.
    h, radius = 0.001, 0.05
    assert site["volume"] == pytest.approx(math.pi * h * h * (3 * radius - h) / 3, rel=1e-9)
    assert site["area"] == pytest.approx(math.pi * h * (2 * radius - h), rel=1e-9)
    assert site["depth"] == pytest.approx(h, rel=1e-9)
    assert (site["geom_a"], site["geom_b"], site["pair"], site["status"]) == (0, 1, 0, 0)
    assert site["normal"] == pytest.approx([0, 0, -1])  # on the floor
    assert site["normal_force"] == pytest.approx(1e8 * site["volume"])
    assert site["force"] == pytest.approx([0, 0, -site["normal_force"]])
    assert site["flatness"] == pytest.approx(1.0)


def test_slip_and_spin_are_of_the_bodies():
    model = vc.load(ball(0.049))
    data = mujoco.MjData(model)
    data.qvel[:] = 0.3, 0.4, 0, 0, 0, 7
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        (site,) = contact.sites(data)
    assert site["slip"] == pytest.approx(0.5)
    # Of the floor against the ball about the normal on the floor, which points down.
    assert site["spin"] == pytest.approx(7.0)


def test_ball_rests_at_the_depth_that_carries_it():
    # k V(h) = m g with V = pi h^2 (3 R - h) / 3 has h = 0.792364 mm.
    model = vc.load(ball())
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        for _ in range(1000):
            mujoco.mj_step(model, data)
        energy = contact.energy(data)
    assert 0.05 - data.qpos[2] == pytest.approx(0.792364e-3, rel=1e-6)
    # Elastic energy k int L^2/2 dA of a cap: k pi h^3 (R/3 - h/12).
    h = 0.05 - data.qpos[2]
    assert energy.elastic == pytest.approx(1e8 * math.pi * h**3 * (0.05 / 3 - h / 12), rel=1e-6)


def test_energy_is_accounted_by_channel():
    model = vc.load(ball(0.08))
    data = mujoco.MjData(model)
    data.qvel[0], data.qvel[5] = 1.0, 20.0
    with vc.attach(model) as contact:
        before = contact.energy(data)
        for _ in range(300):
            mujoco.mj_step(model, data)
        energy = contact.energy(data)
        assert contact.dropped(data) == 0
    assert before.elastic == before.dissipated == 0.0
    assert energy.by_channel._fields == ("normal", "roll", "slide", "spin")
    assert energy.dissipated == pytest.approx(sum(energy.by_channel))
    assert energy.by_channel.normal > 0.1
    assert energy.by_channel.slide > 0.0
    assert energy.by_channel.spin > 0.0
    assert len(energy.power) == 4


def test_many_sites_are_all_returned():
    balls = "".join(
        f'<body pos="{0.2 * i} {0.2 * j} .049"><freejoint/><geom type="sphere" size=".05"/></body>'
        for i in range(10)
        for j in range(10)
    )
    model = vc.load(
        f'<mujoco><worldbody><geom type="plane" size="1 1 1"/>{balls}</worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        sites = contact.sites(data)
        again = contact.sites(data)
    assert len(sites) == 100
    assert sites["pair"].tolist() == sorted(sites["pair"])
    assert (sites == again).all()


def test_reset_starts_the_account_anew():
    model = vc.load(ball(0.08))
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        for _ in range(200):
            mujoco.mj_step(model, data)
        assert contact.energy(data).dissipated > 0.0
        mujoco.mj_resetData(model, data)
        assert contact.energy(data).dissipated == 0.0
        assert len(contact.sites(data)) == 0


@pytest.mark.parametrize("wrong", [None, 3, "data"])
def test_reading_takes_data(wrong):
    with vc.attach(vc.load(ball())) as contact, pytest.raises(TypeError, match="MjData"):
        contact.sites(wrong)


def test_data_of_another_model_are_refused():
    with vc.attach(vc.load(ball())) as contact:
        other = mujoco.MjModel.from_xml_string("<mujoco/>")
        with pytest.raises(ValueError, match="not of the attached model"):
            contact.energy(mujoco.MjData(other))


# Numbers that change in the compiled model.


def test_changed_numbers_act_at_once():
    model = vc.load(ball(0.049))
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


# Description.


def test_description_says_what_was_understood():
    with vc.attach(vc.load(ball())) as contact:
        description = contact.description
    assert description["options"] == {
        "mesh": "exact",
        "tolerance": 1e-4,
        "engine": "auto",
        "target": "applied",
        "pairs": "native",
        "formulation": "gonthier",
        "threads": 0,
    }
    assert description["materials"]["rubber"]["geoms"] == ["floor", "ball"]
    assert description["materials"]["rubber"]["stiffness"] == 2e8
    assert description["materials"]["default"]["geoms"] == []
    floor, sphere = description["solids"]
    assert (floor["geom"], floor["shape"], floor["volume"]) == ("floor", "half_space", None)
    assert sphere["volume"] == pytest.approx(4 / 3 * math.pi * 0.05**3)
    (pair,) = description["pairs"]
    assert (pair["geom_a"], pair["geom_b"]) == ("floor", "ball")
    assert pair["engine"] == "closed_form"
    assert pair["because"] == "contype/conaffinity"
    assert pair["stiffness"] == 1e8
    assert pair["sources"]["stiffness"] == "in series: volcontact/material/rubber (both)"
    assert description["warnings"] == []
    userdata = description["userdata"]
    assert userdata["needed"] == userdata["present"]


def test_description_warns_of_what_cannot_touch():
    text = '<mujoco><worldbody><geom type="box" size="1 1 1"/></worldbody></mujoco>'
    with vc.attach(vc.load(text)) as contact:
        (warning,) = contact.description["warnings"]
    assert "no two geoms can touch" in warning


# Threads.


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
