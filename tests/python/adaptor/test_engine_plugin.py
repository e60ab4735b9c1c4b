# SPDX-License-Identifier: Apache-2.0
"""The engine plugin: scenes that say themselves that their contact is volumetric."""

import subprocess
import sys

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact import _adaptor

RELEASE = tuple(int(word) for word in mujoco.__version__.split("."))
if RELEASE < (3,):
    pytest.skip("MuJoCo 2 has no engine plugins to rely on", allow_module_level=True)

SCENE = """
<mujoco>
  <extension><plugin plugin="volcontact"><instance name="contact"/></plugin></extension>
  <option timestep="1e-3"/>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body pos="0 0 .0499"><freejoint/><geom type="sphere" size=".05" mass="1"/></body>
    <body pos=".3 0 .0499"><freejoint/><geom type="box" size=".05 .05 .05" mass="1"/></body>
  </worldbody>
</mujoco>"""
PLAIN = SCENE.replace(
    '<extension><plugin plugin="volcontact"><instance name="contact"/></plugin>', "<extension>"
)


@pytest.fixture(scope="module", autouse=True)
def plugin():
    """Loaded as soon as anything asks for the adaptor."""
    _adaptor.adaptor()


def run(model, data, steps):
    for _ in range(steps):
        mujoco.mj_step(model, data)
    return np.concatenate([data.qpos, data.qvel])


def pushed(model):
    data = mujoco.MjData(model)
    data.qvel[[0, 6]] = 0.2
    return data


def test_contact_is_volumetric_without_a_call():
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = pushed(model)
    state = run(model, data, 500)
    assert data.ncon == 0
    options = {"target": "passive"}
    plain = vc.load(PLAIN, options=options)
    with vc.attach(plain, options=options):
        assert np.array_equal(run(plain, pushed(plain), 500), state)


def test_attach_takes_over_and_reads_what_the_plugin_keeps():
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = pushed(model)
    state = run(model, data, 300)
    other = pushed(model)
    with vc.attach(model) as contact:
        assert contact.description["userdata"]["state"] == "in plugin_state"
        assert np.array_equal(run(model, other, 300), state)
        energy = contact.energy(data)
        assert energy == contact.energy(other)
        assert energy.dissipated > 0.0
        assert len(contact.sites(data)) == 2
        with pytest.raises(ValueError, match="attached already"):
            vc.attach(model)
    assert np.array_equal(run(model, other, 50), run(model, data, 50))


def test_full_physics_state_has_all_of_it():
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = pushed(model)
    run(model, data, 100)
    spec = mujoco.mjtState.mjSTATE_FULLPHYSICS
    state = np.empty(mujoco.mj_stateSize(model, spec))
    mujoco.mj_getState(model, data, state, spec)
    other = mujoco.MjData(model)
    run(model, other, 7)
    mujoco.mj_setState(model, other, state, spec)
    run(model, data, 100)
    run(model, other, 100)
    assert np.array_equal(data.qpos, other.qpos)
    assert np.array_equal(data.plugin_state, other.plugin_state)


def test_scene_that_cannot_be_read_does_not_compile():
    key = '<custom><numeric name="volcontact/option/tolerence" data="1"/></custom></mujoco>'
    with pytest.raises((ValueError, mujoco.FatalError), match="did you mean"):
        mujoco.MjModel.from_xml_string(SCENE.replace("</mujoco>", key))


@pytest.mark.skipif(RELEASE < (4,), reason="entry points came with MuJoCo 4")
def test_import_of_mujoco_alone_is_enough():
    program = (
        "import sys, mujoco\n"
        "model = mujoco.MjModel.from_xml_string(sys.argv[1])\n"
        "data = mujoco.MjData(model)\n"
        "mujoco.mj_step(model, data, 200)\n"
        "print(data.ncon, data.qfrc_passive[2] > 0)"
    )
    command = [sys.executable, "-W", "error", "-c", program, SCENE]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.split() == ["0", "True"]
