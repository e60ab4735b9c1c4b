# SPDX-License-Identifier: Apache-2.0
"""MuJoCo's `noslip` iterations: after its solver, friction of native constraints is made stiff."""

import math

import mujoco
import numpy as np
import pytest

import volcontact as vc

STEP = 2e-3  # [s]
STIFFNESS = 1e9  # of each of the two that touch [N/m^3]
NOSLIP = 'noslip_iterations="30" noslip_tolerance="0" tolerance="1e-12" iterations="300"'
GRAVITY = 9.81
CONES = ("pyramidal", "elliptic")


def on_a_slope(cone, option, degrees=10.0):
    """A box on the floor by volume, one on it as in MuJoCo, where gravity leans."""
    lean = math.radians(degrees)
    down = f"{GRAVITY * math.sin(lean)} 0 {-GRAVITY * math.cos(lean)}"
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{STEP}" cone="{cone}" gravity="{down}" {option}/>'
        '<size nuserdata="6000"/><worldbody><geom name="floor" type="plane" size="2 2 .1"/>'
        '<body pos="0 0 .1"><freejoint/>'
        '<geom name="low" type="box" size=".1 .1 .1" mass="12"/></body>'
        '<body pos=".02 .01 .25"><freejoint/>'
        '<geom name="high" type="box" size=".05 .05 .05" mass="4"/></body></worldbody>'
        '<custom><numeric name="volcontact/option/pairs/listed" data="1"/>'
        '<tuple name="volcontact/pair/p"><element objtype="geom" objname="floor"/>'
        '<element objtype="geom" objname="low"/></tuple></custom></mujoco>'
    ), lean


def fastest_at_rest(model, data, contact):
    """The largest speed in the last 100 steps of four seconds."""
    for _ in range(1900):
        mujoco.mj_step(model, data)
    fastest = 0.0
    for _ in range(100):
        mujoco.mj_step(model, data)
        fastest = max(fastest, np.abs(data.qvel).max())
    assert contact.dropped(data) == 0
    return fastest


@pytest.mark.parametrize("cone", CONES)
def test_a_box_that_noslip_holds_on_a_slope_loads_the_one_below_with_all_its_weight(cone):
    """N = (m + M) g cos, F = (m + M) g sin: native friction creeps without noslip, and not with."""
    for option, moves in (("", True), (NOSLIP, False)):
        model, lean = on_a_slope(cone, option)
        data = mujoco.MjData(model)
        with vc.attach(model, material={"stiffness": STIFFNESS, "friction": 0.5}) as contact:
            speed = fastest_at_rest(model, data, contact)
            assert (speed > 1e-4) if moves else (speed < 1e-8)
            if moves:
                continue
            force = contact.sites(data)["force"].sum(axis=0)
            assert abs(force[2]) == pytest.approx(16 * GRAVITY * math.cos(lean), rel=1e-7)
            assert abs(force[0]) == pytest.approx(16 * GRAVITY * math.sin(lean), rel=1e-7)
            assert force[1] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("push", [5.0, 60.0])
def test_friction_of_a_joint_that_noslip_makes_stiff_shares_the_load_with_contact(push):
    """The floor and the friction of the joint, at most 3 N, bear weight and push together."""
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{STEP}" {NOSLIP}/><worldbody>'
        '<geom type="plane" size="2 2 .1"/><body pos="0 0 .1"><joint name="j" type="slide" '
        'axis="0 0 1" frictionloss="3"/><geom type="box" size=".1 .1 .1" mass="2"/></body>'
        '</worldbody><actuator><motor joint="j"/></actuator></mujoco>'
    )
    data = mujoco.MjData(model)
    data.ctrl[0] = -push
    with vc.attach(model, material={"stiffness": STIFFNESS}) as contact:
        assert fastest_at_rest(model, data, contact) < 1e-10
        force = contact.sites(data)["normal_force"].sum()
        friction = data.qfrc_constraint[0]
        assert abs(friction) <= 3.0 + 1e-9
        assert force + friction == pytest.approx(2 * GRAVITY + push, rel=1e-9)
        assert force == pytest.approx(-0.5 * STIFFNESS * 0.04 * data.qpos[0], rel=1e-6)
        assert abs(contact.energy(data).numerical) < 1e-3 * contact.energy(data).elastic + 1e-4
