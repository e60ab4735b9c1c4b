# SPDX-License-Identifier: Apache-2.0
"""Models of others: no key, no room in userdata, data that exist already."""

import copy
import threading
import warnings

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact.running.simulation import simulate

SCENE = """
<mujoco model="theirs">
  <option timestep="2e-3" {option}>{flag}</option>
  <worldbody>
    <geom name="table" type="box" size=".5 .5 .02"/>
    <body pos="0 0 .0599"><freejoint/>
      <geom name="cup" type="cylinder" size=".03 .04" mass=".2"/></body>
    <body pos=".2 0 .08"><freejoint/>
      <geom name="die" type="box" size=".02 .02 .02" mass=".1" friction=".4 0 0"/></body>
  </worldbody>
</mujoco>"""
STIFF = {"stiffness": 1e9, "damping": 1.0}


def theirs(option="", flag=""):
    return mujoco.MjModel.from_xml_string(SCENE.format(option=option, flag=flag))


def run(model, data, steps=500):
    data.qvel[6] = 0.3  # the die slides
    for _ in range(steps):
        mujoco.mj_step(model, data)
    return np.concatenate([data.qpos, data.qvel])


def with_room(material):
    """The same scene with room, forces in the same array."""
    passive = {"target": "passive"}
    model = vc.load(SCENE.format(option="", flag=""), material=material, options=passive)
    with vc.attach(model, material=material, options=passive) as contact:
        data = mujoco.MjData(model)
        return run(model, data), contact.energy(data)


@pytest.fixture
def reference():
    return with_room(STIFF)


def test_steps_as_with_room_to_the_last_bit(reference):
    model = theirs()
    assert model.nuserdata == 0
    data = mujoco.MjData(model)  # before attach, as an environment has it
    with vc.attach(model, material=STIFF) as contact:
        assert contact.description["userdata"]["state"] == "beside mjData"
        state = run(model, data)
        assert np.array_equal(state, reference[0])
        assert contact.energy(data) == reference[1]
        assert sum(contact.sites(data)["normal_force"]) == pytest.approx(0.3 * 9.81, rel=1e-6)
        assert not data.qfrc_applied.any()
    assert not any(w.number for w in data.warning)
    mujoco.mj_step(model, data)
    assert data.ncon > 0  # native again


@pytest.mark.parametrize("law", ["elastic_coulomb", "regularized_coulomb"])
def test_resets_copies_and_extra_evaluations_change_nothing(law):
    material = {**STIFF, "friction_law": law}
    reference = with_room(material)
    model = theirs()
    data = mujoco.MjData(model)
    with vc.attach(model, material=material) as contact:
        run(model, data, 77)
        mujoco.mj_resetData(model, data)
        assert contact.energy(data).dissipated == contact.energy(mujoco.MjData(model)).dissipated
        data.qvel[6] = 0.3
        for i in range(500):
            if i == 200:
                kept = data  # so that its address is not that of the copy
                data = copy.copy(data)
            if mujoco.__version__ != "2.2.2":  # which normalises quaternions at each mj_forward
                mujoco.mj_forward(model, data)
            mujoco.mj_step(model, data)
        assert kept.time < data.time
        state = np.concatenate([data.qpos, data.qvel])
    # A copy begins without what sticking friction remembers: a hair's breadth, not a bit.
    if law == "regularized_coulomb":
        assert np.array_equal(state, reference[0])
    assert state == pytest.approx(reference[0], abs=1e-9)


def test_energy_account_begins_anew_after_a_reset():
    model = theirs()
    data = mujoco.MjData(model)
    with vc.attach(model, material=STIFF) as contact:
        run(model, data)
        spent = contact.energy(data).dissipated
        assert spent > 0.0
        mujoco.mj_resetData(model, data)
        run(model, data)
        assert contact.energy(data).dissipated == spent


def test_threads_with_data_of_their_own(reference):
    model = theirs()
    with vc.attach(model, material=STIFF):
        states = [None] * 4

        def work(i):
            states[i] = run(model, mujoco.MjData(model))

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert all(np.array_equal(state, reference[0]) for state in states)


def test_material_is_that_of_all_geoms_and_the_rest_stays():
    material = {"stiffness": 6e8, "friction_law": "bristle"}
    model = vc.load(SCENE.format(option="", flag=""), material=material)
    with vc.attach(model, material=material) as contact:
        for pair in contact.description["pairs"]:
            assert pair["stiffness"] == 3e8
            assert pair["friction_law"] == "bristle"
            assert pair["friction"] == 1.0  # the table's own
        assert contact.description["materials"]["given"]["stiffness"] == 6e8
    with vc.attach(model) as contact:
        assert contact.description["pairs"][0]["stiffness"] == 5e6


@pytest.mark.filterwarnings("error")
def test_laws_with_a_memory_are_warned_of():
    with pytest.warns(RuntimeWarning, match="not copied, reset or restored with it"):
        vc.attach(theirs(), material={"friction_law": "bristle"}).close()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        vc.attach(theirs(), material=STIFF).close()


def test_options_come_before_those_of_the_file():
    keys = '<custom><numeric name="volcontact/option/target/xfrc" data="1"/></custom></mujoco>'
    text = SCENE.format(option="", flag="").replace("</mujoco>", keys)
    for options, target in (({}, "xfrc"), ({"target": "applied"}, "applied")):
        model = vc.load(text, options=options)
        with vc.attach(model, options=options) as contact:
            assert contact.description["options"]["target"] == target


WRONG = {
    "spelling": (
        dict(material={"stifness": 1e9}),
        r"material\['stifness'\]: unknown key.*did you mean 'material\['stiffness'\]'",
    ),
    "range": (
        dict(material={"stiffness": -1}),
        r"^material: stiffness = -1 \[N/m\^3\] is out of range: must be > 0",
    ),
    "word": (dict(options={"mesh": "hul"}), "did you mean 'volcontact/option/mesh/hull'"),
    "number for a word": (dict(options={"mesh": 1}), "comes one of exact, hull, exact_or_hull"),
    "no room": (dict(options={"target": "applied"}), "without room there is .*target/passive"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_values_are_explained(name):
    keys, message = WRONG[name]
    with pytest.raises(ValueError, match=message):
        vc.attach(theirs(), **keys)


@pytest.mark.parametrize("wrong", [dict(material=3), dict(options={"mesh": None})])
def test_values_are_numbers_or_words(wrong):
    with pytest.raises(TypeError, match="takes a"):
        vc.attach(theirs(), **wrong)


def test_sleep_is_refused_where_nobody_can_wake():
    if not hasattr(mujoco.mjtEnableBit, "mjENBL_SLEEP"):
        pytest.skip("this MuJoCo has no sleep")
    if int(mujoco.__version__.split(".")[0]) >= 4:
        pytest.skip("test_sleep.py")
    with pytest.raises(ValueError, match="never wakes a sleeping body; disable it"):
        vc.attach(theirs(flag='<flag sleep="enable"/>'))


@pytest.mark.parametrize("implicit", ["auto", "on"])
def test_runge_kutta_takes_stiff_contact(implicit):
    run = simulate(
        theirs('integrator="RK4"'), duration=1.0, material=STIFF, options={"implicit": implicit}
    )
    assert run.site_count[-1] > 0
    assert np.max(run.made) < 1e-6
    assert run.kinetic[-1] < 1e-9


def test_simulate_takes_a_model_as_it_is():
    model = theirs()
    volumetric = simulate(model, duration=0.2, material=STIFF)
    native = simulate(model, contact="native", duration=0.2)
    assert model.nuserdata == 0
    assert volumetric.site_count.max() > 0 and native.site_count.max() > 0
    assert not volumetric.warnings and not native.warnings
    assert volumetric.description["options"]["target"] == "applied"  # its copy has room


def test_number_in_quotes_is_told():
    model = mujoco.MjModel.from_xml_string("<mujoco/>")
    with pytest.raises(TypeError, match=r"material\['stiffness'\] takes a number, got the text '1"):
        vc.attach(model, material={"stiffness": "1e9"})
