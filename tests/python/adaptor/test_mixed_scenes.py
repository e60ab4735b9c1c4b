# SPDX-License-Identifier: Apache-2.0
"""Volumetric and native contact, constraints, tendons, actuators and sensors in one model."""

import mujoco
import numpy as np
import pytest

import volcontact as vc

LISTED = '<numeric name="volcontact/option/pairs/listed" data="1"/>'

# Joint limits, an equality, a tendon with a limit, a spring and actuators; a ball far away from it.
MECHANISM = """
<mujoco>
  <option timestep="1e-3"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 1"/>
    <body name="upper" pos="0 0 1"><joint name="shoulder" axis="0 1 0" damping=".1" range="-.5 .6"
        limited="true"/>
      <geom name="upper" type="capsule" fromto="0 0 0 0 0 -.3" size=".03" mass="1"/>
      <body name="lower" pos="0 0 -.3"><joint name="elbow" axis="0 1 0" stiffness="5"/>
        <geom name="lower" type="capsule" fromto="0 0 0 .2 0 -.2" size=".02" mass=".5"/></body>
    </body>
    <body name="other" pos=".5 .5 1"><joint name="slide" type="slide" axis="0 0 1" range="-.2 .2"
        limited="true"/><geom name="other" type="box" size=".05 .05 .05" mass="2"/></body>
    <body name="ball" pos="2 0 {height}"><freejoint/>
      <geom name="ball" type="sphere" size=".05" mass="1"/></body>
  </worldbody>
  <equality><joint joint1="slide" joint2="elbow" polycoef="0 .05 0 0 0"/></equality>
  <tendon><fixed name="rope" limited="true" range="-.4 .4" stiffness="3">
    <joint joint="shoulder" coef="1"/><joint joint="elbow" coef="-.5"/></fixed></tendon>
  <actuator><motor joint="shoulder" gear="2"/><position joint="elbow" kp="20"/>
    <motor tendon="rope"/></actuator>
  <custom>{custom}</custom>
</mujoco>
"""
PAIR = """<tuple name="volcontact/pair/p"><element objtype="geom" objname="floor"/>
  <element objtype="geom" objname="ball"/></tuple>"""


def course(text, *, attached, steps=600):
    """qpos and qvel after every step, driven by the actuators."""
    model = vc.load(text)
    data = mujoco.MjData(model)
    contact = vc.attach(model) if attached else None
    rows = []
    try:
        for i in range(steps):
            data.ctrl[:] = 0.8 * np.sin(0.02 * i), 0.5 * np.cos(0.03 * i), 0.3
            mujoco.mj_step(model, data)
            rows.append(np.concatenate([data.qpos, data.qvel]))
        assert data.nefc > 0
    finally:
        if contact is not None:
            contact.close()
    return np.array(rows)


@pytest.mark.parametrize("custom", ["", LISTED + PAIR], ids=["all", "listed"])
@pytest.mark.parametrize("integrator", ["Euler", "RK4", "implicit"])
def test_attached_scene_without_touch_is_plain_mujoco_to_the_bit(custom, integrator):
    # The ball stays in the air; limits, equality, tendon, actuators work.
    text = MECHANISM.format(height=4.0, custom=custom)
    text = text.replace("<option ", f'<option integrator="{integrator}" ')
    assert np.array_equal(course(text, attached=True), course(text, attached=False))


@pytest.mark.parametrize("target", ["applied", "passive", "xfrc"])
def test_contact_of_one_body_leaves_the_constraints_of_others_alone(target):
    # The solver takes all trees together, so that they agree to what it converges to.
    key = f'<numeric name="volcontact/option/target/{target}" data="1"/>'
    text = MECHANISM.format(height=0.0502, custom=key)
    alone = course(MECHANISM.format(height=4.0, custom=""), attached=False)
    touching = course(text, attached=True)
    assert abs(touching[-1, 5] - 0.05) < 5e-3  # the ball lies on the floor
    mechanism = [0, 1, 2, 10, 11, 12]  # qpos and qvel of the three joints
    np.testing.assert_allclose(touching[:, mechanism], alone[:, mechanism], rtol=0, atol=1e-6)


TABLE = """
<mujoco>
  <option timestep="1e-3"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 1"/>
    <body name="table" pos="0 0 .0995"><freejoint/>
      <geom name="top" type="box" size=".2 .2 .01" pos="0 0 .05" mass="4" contype="0"
        conaffinity="0"/>
      <geom name="f0" type="sphere" size=".02" pos=".15 .15 -.08" mass=".1"/>
      <geom name="f1" type="sphere" size=".02" pos="-.15 .15 -.08" mass=".1"/>
      <geom name="f2" type="sphere" size=".02" pos=".15 -.15 -.08" mass=".1"/>
      <geom name="f3" type="sphere" size=".02" pos="-.15 -.15 -.08" mass=".1"/>
      <site name="under" type="box" size=".3 .3 .05" pos="0 0 -.08"/>
      <site name="left" type="box" size=".1 .3 .05" pos="-.15 0 -.08"/>
      <site name="above" type="box" size=".3 .3 .01" pos="0 0 .1"/></body>
  </worldbody>
  <sensor><touch name="under" site="under"/><touch name="left" site="left"/>
    <touch name="above" site="above"/><touch name="cut" site="under" cutoff="5"/></sensor>
  <custom>{custom}</custom>
</mujoco>
"""
WEIGHT = 4.4 * 9.81


def two_feet():
    tuples = "".join(
        f'<tuple name="volcontact/pair/{foot}"><element objtype="geom" objname="floor"/>'
        f'<element objtype="geom" objname="{foot}"/></tuple>'
        for foot in ("f0", "f1")
    )
    # Friction soft enough for explicit steps: h mu f_n / v_s < m.
    keys = "".join(
        f'<numeric name="volcontact/pair/{foot}/{key}" data="{number}"/>'
        for foot in ("f0", "f1")
        for key, number in (("stiffness", 1e8), ("damping", 100), ("slip_speed", 0.05))
    )
    return LISTED + tuples + keys


def settled(custom, target="applied", steps=3000):
    key = f'<numeric name="volcontact/option/target/{target}" data="1"/>'
    model = vc.load(TABLE.format(custom=custom + key))
    data = mujoco.MjData(model)
    return model, data, steps


@pytest.mark.parametrize("target", ["applied", "passive", "xfrc"])
@pytest.mark.parametrize(("custom", "ours"), [("", 4), (two_feet(), 2)], ids=["all", "mixed"])
def test_contact_forces_of_all_kinds_carry_the_weight(custom, ours, target):
    model, data, steps = settled(custom, target)
    with vc.attach(model) as contact:
        for _ in range(steps):
            mujoco.mj_step(model, data)
        assert np.abs(data.qvel).max() < 1e-5
        forces = vc.contact_forces(data)
        assert len(forces) == 4
        assert np.count_nonzero(forces["is_native"] == 0) == ours
        assert (forces["geom_a"] == 0).all()  # the floor, which is pushed down
        np.testing.assert_allclose(forces["force"].sum(axis=0), (0, 0, -WEIGHT), atol=1e-2)
        np.testing.assert_allclose(forces["normal"], np.tile((0, 0, -1.0), (4, 1)), atol=1e-5)
        # No moment about the middle, where the weight is.
        arms = forces["position"] - data.xipos[1]
        moment = np.cross(arms, forces["force"]).sum(axis=0)
        assert np.abs(moment[:2]).max() < 1e-3
        assert np.array_equal(
            forces["force"][forces["is_native"] == 0], contact.sites(data)["force"]
        )


@pytest.mark.parametrize("target", ["applied", "passive", "xfrc"])
@pytest.mark.parametrize("custom", ["", two_feet()], ids=["all", "mixed"])
def test_touch_sensors_measure_every_contact_once_written(custom, target):
    model, data, steps = settled(custom, target)
    with vc.attach(model) as contact:
        for _ in range(steps):
            mujoco.mj_step(model, data)
        for _ in range(2):  # a second time changes nothing
            contact.update_touch(data)
            under, left, above, cut = data.sensordata
            assert under == pytest.approx(WEIGHT, rel=1e-3)
            assert left == pytest.approx(WEIGHT / 2, rel=1e-2)
            assert above == 0.0
            assert cut == 5.0


def test_native_contacts_alone_read_as_mujoco_reads_them():
    # Listed pairs, none of which touches: what we write is what MuJoCo wrote.
    pair = '<tuple name="volcontact/pair/p"><element objtype="geom" objname="floor"/>'
    pair += '<element objtype="geom" objname="top"/></tuple>'
    model, data, steps = settled(LISTED + pair)
    with vc.attach(model) as contact:
        for _ in range(steps):
            mujoco.mj_step(model, data)
        before = data.sensordata.copy()
        assert before[0] > 40.0
        contact.update_touch(data)
        np.testing.assert_allclose(data.sensordata, before, rtol=1e-12)


# An arm of 7 kg in two links whose tip rests on the floor: what its joints carry is statics.
CHAIN = """
<mujoco>
  <option timestep="1e-3"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 1"/>
    <body name="base" pos="0 0 .1"><joint type="slide" axis="0 0 1"/>
      <geom name="base" type="box" size=".05 .05 .05" mass="5" contype="0" conaffinity="0"/>
      <body name="foot" pos="0 0 -.0501"><site name="ankle"/>
        <geom name="foot" type="sphere" size=".05" mass="2"/></body></body>
  </worldbody>
  <sensor><force name="ankle" site="ankle"/><torque name="twist" site="ankle"/></sensor>
  <custom><numeric name="volcontact/option/target/{target}" data="1"/></custom>
</mujoco>
"""


def test_force_sensor_sees_the_contact_under_xfrc_only():
    read = {}
    for target in ("native", "xfrc", "applied", "passive"):
        model = vc.load(CHAIN.format(target=target.replace("native", "xfrc")))
        data = mujoco.MjData(model)
        contact = vc.attach(model) if target != "native" else None
        for _ in range(4000):
            mujoco.mj_step(model, data)
        read[target] = data.sensordata[2]
        if contact is not None:
            warned = "".join(contact.description["warnings"])
            assert ("force and torque sensors" in warned) == (target != "xfrc")
            contact.close()
    # The 5 kg above rest on the foot; without the contact it would hang on them with its 2 kg.
    assert read["native"] == pytest.approx(-5 * 9.81, rel=1e-3)
    assert read["xfrc"] == pytest.approx(-5 * 9.81, rel=1e-6)
    for target in ("applied", "passive"):
        assert read[target] == pytest.approx(2 * 9.81, rel=1e-6)


def test_forces_of_data_that_are_nobodys_are_refused():
    model = vc.load(TABLE.format(custom=""))
    data = mujoco.MjData(model)
    with pytest.raises(ValueError, match="no attached model has data of this size"):
        vc.contact_forces(data)
    with pytest.raises(TypeError, match=r"takes a mujoco\.MjData"):
        vc.contact_forces(model)
    second = vc.load(TABLE.format(custom=""))
    with vc.attach(model) as contact, vc.attach(second):
        with pytest.raises(ValueError, match="2 attached models have"):
            vc.contact_forces(data)
        assert len(contact.contact_forces(data)) == 0  # nothing evaluated yet


def stack(seed):
    """Five boxes thrown on a sixth; MuJoCo's contact but for the lowest two and the floor."""
    rng = np.random.default_rng(seed)
    boxes = "".join(
        f'<body pos="{rng.uniform(-0.1, 0.1)} {rng.uniform(-0.1, 0.1)} {0.3 + 0.16 * i}" '
        f'euler="{rng.uniform(0, 90)} {rng.uniform(0, 90)} 0"><freejoint/>'
        f'<geom name="n{i}" type="box" size=".05 .05 .05" mass="1"/></body>'
        for i in range(5)
    )
    pairs = "".join(
        f'<tuple name="volcontact/pair/{name}"><element objtype="geom" objname="{name}"/>'
        '<element objtype="geom" objname="low"/></tuple>'
        f'<numeric name="volcontact/pair/{name}/stiffness" data="5e10"/>'
        f'<numeric name="volcontact/pair/{name}/damping" data="0"/>'
        for name in ("floor", "n0")
    )
    return f"""<mujoco><option timestep="2e-3"><flag energy="enable"/></option><worldbody>
      <geom name="floor" type="plane" size="2 2 .1"/><body pos="0 0 .1"><freejoint/>
      <geom name="low" type="box" size=".15 .15 .1" mass="12"/></body>{boxes}</worldbody>
      <custom>{LISTED}{pairs}</custom></mujoco>"""


@pytest.mark.parametrize("cone", [mujoco.mjtCone.mjCONE_PYRAMIDAL, mujoco.mjtCone.mjCONE_ELLIPTIC])
def test_implicit_contact_under_native_contact_gains_nothing_and_bears_what_is_on_it(cone):
    model = vc.load(stack(1))
    model.opt.cone, model.opt.tolerance, model.opt.iterations = cone, 1e-13, 300
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        first = most = data.energy.sum()
        for step in range(8000):  # a box on the stack may lean on its edge for ten seconds
            mujoco.mj_step(model, data)
            most = max(most, data.energy.sum())
            if step > 1500 and np.abs(data.qvel).max() < 1e-6:
                break
        assert most <= 1.000001 * first
        assert np.abs(data.qvel[:6]).max() < 1e-6  # MuJoCo's own contacts creep
        on_floor = contact.sites(data)[contact.sites(data)["geom_a"] == 0]
        above = sum(model.body_mass[i] for i in range(1, 7) if np.hypot(*data.xipos[i, :2]) < 0.25)
        assert on_floor["normal_force"].sum() == pytest.approx(9.81 * above, rel=1e-6)
        assert (5e10 * on_floor["volume"]).sum() == pytest.approx(9.81 * above, rel=1e-5)
        # Impacts among elliptic cones may end the rounds before the forces agree.
        assert abs(contact.energy(data).numerical) < 1e-4 * first
