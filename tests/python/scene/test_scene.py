# SPDX-License-Identifier: Apache-2.0
"""Scenes: load and attach."""

import copy
import gc

import mujoco
import pytest
from balls import ball

import volcontact as vc


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


def test_native_contact_is_off_inside_and_on_again_after():
    model = vc.load(ball())
    data = mujoco.MjData(model)
    with vc.attach(model):
        mujoco.mj_forward(model, data)
        assert data.ncon == 0
        assert data.qfrc_applied[2] > 0.0
    mujoco.mj_forward(model, data)
    assert data.ncon == 1


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
