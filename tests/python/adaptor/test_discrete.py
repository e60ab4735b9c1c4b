# SPDX-License-Identifier: Apache-2.0
"""MuJoCo's integrator `discrete`, which takes springs and servos implicitly, beside contact."""

import math

import mujoco
import numpy as np
import pytest

import volcontact as vc

pytestmark = pytest.mark.skipif(
    not hasattr(mujoco.mjtIntegrator, "mjINT_DISCRETE"), reason="no `discrete`"
)

STEP = 2e-3  # [s]
MASS = 2.0  # of the box, half a side of which is 0.1 m [kg]
WEIGHT = MASS * 9.81  # [N]
REST = 1e-10  # [m/s]
BALANCE = 1e-7  # relative: K h times that speed over the force
AREA = 0.04  # [m^2]
STIFFNESS = 1e9  # k_v of each of the two that touch [N/m^3]
CONTACT = 0.5 * STIFFNESS * AREA  # of the pair [N/m]


def scene(joint, more="", gravity=9.81):
    """A box over a floor, on a joint."""
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{STEP}" integrator="discrete" gravity="0 0 {-gravity}"/>'
        f'<worldbody><geom type="plane" size="1 1 1"/><body name="box" '
        f'pos="0 0 .1"><joint name="j" {joint}/><geom type="box" size=".1 .1 .1" mass="{MASS}"/>'
        f"</body></worldbody>{more}</mujoco>"
    )


def settled(model, target=0.0):
    """The data and the normal force after six seconds, in the first of which the target comes."""
    data = mujoco.MjData(model)
    with vc.attach(model, material={"stiffness": STIFFNESS}) as contact:
        for step in range(round(6.0 / STEP)):
            data.ctrl[:] = target * min(1.0, step * STEP)
            mujoco.mj_step(model, data)
        return data, contact.sites(data)["normal_force"].sum()


def test_native_constraints_are_those_of_the_present_step():
    """A box with friction in its joint and a limit rests on stiff contact, the same each time."""
    model = scene('type="slide" axis="0 0 1" range="-.0005 1" limited="true" frictionloss=".5"')
    ends = set()
    data = mujoco.MjData(model)
    material = {"stiffness": STIFFNESS, "damping": 1, "friction": 0.5}
    with vc.attach(model, material=material) as contact:
        for _ in range(3):
            mujoco.mj_resetData(model, data)
            data.qvel[0] = -1.0
            for _ in range(300):
                mujoco.mj_step(model, data)
            ends.add((data.qpos[0], data.qvel[0]))
            assert contact.dropped(data) == 0
            assert contact.sites(data)["normal_force"].sum() == pytest.approx(WEIGHT, rel=3e-2)
    assert len(ends) == 1


@pytest.mark.parametrize("spring", [1e2, 1e5, 1e7])
def test_a_box_on_a_spring_rests_where_floor_and_spring_balance_its_weight(spring):
    """K d = m g + k (r - z) with z = -d, whatever the spring is against m/h^2 = 5e5 N/m."""
    reference = -1e-6
    model = scene(f'type="slide" axis="0 0 1" stiffness="{spring}" springref="{reference}"')
    data, force = settled(model)
    depth = (WEIGHT - spring * reference) / (CONTACT + spring)
    assert data.qpos[0] == pytest.approx(-depth, rel=1e-9)
    assert force == pytest.approx(CONTACT * depth, rel=1e-9)
    assert abs(data.qvel[0]) < REST


@pytest.mark.parametrize("gain", [1e3, 1e5, 1e7])
@pytest.mark.parametrize("damping", [0.0, 1.0])
def test_a_servo_presses_with_its_gain_times_what_it_lacks(gain, damping):
    servo = (
        f'<actuator><position joint="j" kp="{gain}" kv="{damping * math.sqrt(gain * MASS)}"/>'
        "</actuator>"
    )
    target = -2e-3
    data, force = settled(scene('type="slide" axis="0 0 1"', servo), target=target)
    push = gain * (data.qpos[0] - target)
    assert data.actuator_force[0] == pytest.approx(-push, rel=1e-9)
    assert force == pytest.approx(WEIGHT + push, rel=BALANCE)
    assert force == pytest.approx(-CONTACT * data.qpos[0], rel=BALANCE)
    assert abs(data.qvel[0]) < REST


@pytest.mark.parametrize("spring", [1e3, 2e6])
def test_a_tendon_that_pulls_one_box_down_on_another_loads_what_is_between_them(spring):
    """K d = m g + K_s (s - d) between the boxes, and the floor bears both weights and no more."""
    shorter = 1e-5
    box = '<geom type="box" size=".1 .1 .1" mass="2"/>'
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{STEP}" integrator="discrete"/><worldbody>'
        '<geom type="plane" size="1 1 1"/>'
        f'<body pos="0 0 .1"><joint name="a" type="slide" axis="0 0 1"/>{box}</body>'
        f'<body pos="0 0 .3"><joint name="b" type="slide" axis="0 0 1"/>{box}</body></worldbody>'
        f'<tendon><fixed stiffness="{spring}" damping="{1e-3 * spring}" springlength="{-shorter}">'
        '<joint joint="a" coef="-1"/><joint joint="b" coef="1"/></fixed></tendon></mujoco>'
    )
    data, _ = settled(model)
    depth = (WEIGHT + spring * shorter) / (CONTACT + spring)
    assert data.qpos[0] - data.qpos[1] == pytest.approx(depth, rel=BALANCE)
    assert -data.qpos[0] == pytest.approx(2 * WEIGHT / CONTACT, rel=BALANCE)
    assert np.abs(data.qvel).max() < REST


@pytest.mark.parametrize("spring", [1e5, 1e7])
def test_a_bounce_on_a_spring_gains_nothing(spring):
    """Kinetic energy, that of the spring and that of the floor never exceed the start's."""
    model = scene(f'type="slide" axis="0 0 1" stiffness="{spring}"', gravity=0.0)
    data = mujoco.MjData(model)
    data.qvel[0] = -1.0
    material = {"stiffness": 1e10, "damping": 0.0}
    with vc.attach(model, material=material) as contact:
        for _ in range(200):
            mujoco.mj_step(model, data)
            mujoco.mj_forward(model, data)
            energy = 0.5 * MASS * data.qvel[0] ** 2 + 0.5 * spring * data.qpos[0] ** 2
            assert energy + contact.energy(data).elastic <= 0.5 * MASS * 1.001
