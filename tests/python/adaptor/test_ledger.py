# SPDX-License-Identifier: Apache-2.0
"""Forces of the user beside those of the contact: what each target promises, row by row.

Target `passive` is the reference: MuJoCo clears qfrc_passive before every evaluation, so nothing a
user writes elsewhere can disturb it. `applied` and `xfrc` must give the same motion through arrays
that MuJoCo never clears and the user writes as well. docs/plugin.md, "Applied forces".
"""

import copy

import mujoco
import numpy as np
import pytest
from checkpoints import checkpoint, restore

import volcontact as vc

STEPS = 400
SOFT, STIFF = "2e6", "1e11"  # k_v [N/m^3]: steps are explicit, and implicit
INTEGRATORS = [
    name
    for name in ("Euler", "RK4", "implicit", "implicitfast", "discrete")
    if hasattr(mujoco.mjtIntegrator, f"mjINT_{name.upper()}")
]

# A tilted box that drops onto a floor without friction: the contact never pushes along x and y,
# where the user does. So no sum is rounded differently and `applied` must agree to the last bit.
SCENE = """
<mujoco>
  <option timestep="1e-3" integrator="{integrator}"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body pos="0 0 .12" euler="8 -5 3"><freejoint/>
      <geom name="box" type="box" size=".1 .1 .1" mass="1"/></body>
  </worldbody>
  <custom>
    <numeric name="volcontact/option/target/{target}" data="1"/>
    <numeric name="volcontact/material/ice/stiffness" data="{stiffness}"/>
    <numeric name="volcontact/material/ice/damping" data="0.5"/>
    <numeric name="volcontact/material/ice/friction" data="0"/>
    <tuple name="volcontact/material/ice">
      <element objtype="geom" objname="floor"/><element objtype="geom" objname="box"/>
    </tuple>
  </custom>
  <keyframe><key qpos="0 0 .11 1 0 0 0" qvel="0 0 -.5 0 .3 0"/></keyframe>
</mujoco>
"""


def run(target, integrator, behaviour, stiffness=SOFT):
    """Final qpos and qvel after STEPS steps of `behaviour`."""
    model = vc.load(SCENE.format(target=target, integrator=integrator, stiffness=stiffness))
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        (pair,) = contact.description["pairs"]
        # A whole face makes it stiff, the corners that it lands on do not.
        assert ("where a patch" in pair["implicit"]) == (stiffness == STIFF)
        touched = False
        for i in range(STEPS):
            data = behaviour(model, data, i) or data
            touched = touched or len(contact.sites(data)) > 0
    assert touched
    return np.concatenate([data.qpos, data.qvel])


def error(target, integrator, behaviour, stiffness=SOFT):
    reference = run("passive", integrator, behaviour, stiffness)
    return np.abs(run(target, integrator, behaviour, stiffness) - reference).max()


KEPT = {}


def does_nothing(model, data, i):
    mujoco.mj_step(model, data)


def resets_midway(model, data, i):
    if i == STEPS // 2:
        mujoco.mj_resetData(model, data)
    mujoco.mj_step(model, data)


def sets_a_constant_force_once(model, data, i):
    if i == 0:
        data.qfrc_applied[0] = 0.3
    mujoco.mj_step(model, data)


def calls_forward_again(model, data, i):
    if i == 0:
        data.qfrc_applied[0] = 0.3
    mujoco.mj_forward(model, data)
    mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    mujoco.mj_inverse(model, data)


def takes_finite_differences(model, data, i):
    if i == 0:
        data.qfrc_applied[0] = 0.3
    if i % 10 == 0:
        n = 2 * model.nv + model.na
        a, b = np.zeros((n, n)), np.zeros((n, model.nu))
        mujoco.mjd_transitionFD(model, data, 1e-6, True, a, b, None, None)
    mujoco.mj_step(model, data)


def assigns_every_step(model, data, i):
    data.qfrc_applied[:2] = 0.3 * np.sin(0.1 * i), 0.2
    mujoco.mj_step(model, data)


def goes_on_with_a_copy(model, data, i):
    if i == 0:
        data.qfrc_applied[0] = 0.3
    if i == STEPS // 2:
        data = copy.copy(data)
    mujoco.mj_step(model, data)
    return data


def assigns_xfrc_every_step(model, data, i):
    data.xfrc_applied[1, 0] = 0.3 * np.sin(0.1 * i)
    mujoco.mj_step(model, data)


def goes_to_a_keyframe_midway(model, data, i):
    if i == STEPS // 2:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_step(model, data)


def goes_back_to_a_checkpoint(model, data, i):
    # The state is kept at one step, put back into data that have run on, twice.
    if i == 0:
        data.qfrc_applied[0] = 0.3
    if i == STEPS // 4:
        KEPT[id(model)] = checkpoint(data)
    if i in (STEPS // 2, 3 * STEPS // 4):
        restore(data, KEPT[id(model)])
    mujoco.mj_step(model, data)


def steps_in_two_halves(model, data, i):
    if i == 0:
        data.qfrc_applied[0] = 0.3
    mujoco.mj_step1(model, data)
    mujoco.mj_step2(model, data)


EXACT = [
    does_nothing,
    resets_midway,
    goes_to_a_keyframe_midway,
    goes_back_to_a_checkpoint,
    steps_in_two_halves,
    sets_a_constant_force_once,
    calls_forward_again,
    takes_finite_differences,
    assigns_every_step,
    goes_on_with_a_copy,
    assigns_xfrc_every_step,
]


# MuJoCo refuses finite differences under Runge-Kutta, from some release on, and its two halves of
# a step know none.
CASES = [
    pytest.param(behaviour, integrator, id=f"{behaviour.__name__}-{integrator}")
    for behaviour in EXACT
    for integrator in INTEGRATORS
    if integrator != "RK4" or behaviour not in (takes_finite_differences, steps_in_two_halves)
]


@pytest.mark.parametrize(("behaviour", "integrator"), CASES)
def test_applied_equals_passive_to_the_last_bit(behaviour, integrator):
    assert error("applied", integrator, behaviour) == 0.0


@pytest.mark.parametrize(("behaviour", "integrator"), CASES)
def test_xfrc_equals_passive_to_rounding(behaviour, integrator):
    # MuJoCo turns xfrc_applied into joint forces by other sums than ours.
    assert error("xfrc", integrator, behaviour) < 1e-11


IMPLICIT = [case for case in CASES if "RK4" not in case.id]


@pytest.mark.parametrize(("behaviour", "integrator"), IMPLICIT)
def test_targets_equal_passive_under_implicit_steps(behaviour, integrator):
    # The solver of the contact is told the user's forces, wherever they stand.
    assert error("applied", integrator, behaviour, STIFF) == 0.0
    assert error("xfrc", integrator, behaviour, STIFF) < 1e-11


# Writes after the callback has run, the one thing a shared array cannot survive. mj_step1 and
# mj_step2 know no Runge-Kutta.
WITHOUT_RK4 = [name for name in INTEGRATORS if name != "RK4"]


def assigns_between_step1_and_step2(model, data, i):
    mujoco.mj_step1(model, data)
    data.qfrc_applied[:] = (0.3, 0, 0, 0, 0, 0)
    mujoco.mj_step2(model, data)


def adds_between_step1_and_step2(model, data, i):
    mujoco.mj_step1(model, data)
    data.qfrc_applied[0] += 0.3
    mujoco.mj_step2(model, data)
    data.qfrc_applied[0] -= 0.3


@pytest.mark.parametrize("integrator", WITHOUT_RK4)
def test_force_assigned_after_the_callback_replaces_applied_contact(integrator):
    # The documented limit: the box falls through the floor. The other targets keep it.
    assert error("applied", integrator, assigns_between_step1_and_step2) > 0.1
    assert error("xfrc", integrator, assigns_between_step1_and_step2) < 1e-11


@pytest.mark.parametrize("integrator", WITHOUT_RK4)
def test_force_added_and_taken_back_is_exact_where_no_contact_acts(integrator):
    assert error("applied", integrator, adds_between_step1_and_step2) < 1e-12


@pytest.mark.parametrize("target", ["passive", "xfrc"])
def test_force_from_a_control_callback_leaves_other_targets_alone(target):
    def control(model, data):
        data.qfrc_applied[:] = (0.3, 0, 0, 0, 0, 0)

    constant = run(target, "Euler", sets_a_constant_force_once)
    model = vc.load(SCENE.format(target=target, integrator="Euler", stiffness=SOFT))
    data = mujoco.MjData(model)
    mujoco.set_mjcb_control(control)
    try:
        with vc.attach(model):
            for _ in range(STEPS):
                mujoco.mj_step(model, data)
    finally:
        mujoco.set_mjcb_control(None)
    assert np.abs(np.concatenate([data.qpos, data.qvel]) - constant).max() == 0.0


@pytest.mark.parametrize("target", ["applied", "xfrc"])
def test_array_holds_user_force_plus_contact(target):
    model = vc.load(SCENE.format(target=target, integrator="Euler", stiffness=SOFT))
    data = mujoco.MjData(model)
    data.qpos[2] = 0.1
    array = data.qfrc_applied if target == "applied" else data.xfrc_applied[1]
    array[2] = 5.0
    with vc.attach(model) as contact:
        for _ in range(5):
            mujoco.mj_forward(model, data)
        force = -contact.sites(data)["force"].sum(axis=0)[2]  # the box is geom b
        assert force > 0.1
        assert array[2] == pytest.approx(5.0 + force, rel=1e-14)
        contact.release(data)
        assert array[2] == 5.0
        assert not array[[0, 1, 3, 4, 5]].any()


def test_finite_differences_see_the_contact_and_leave_no_trace():
    matrices, dissipated = {}, {}
    keeps_time = True
    for target in ("passive", "applied", "undisturbed"):
        model = vc.load(
            SCENE.format(
                target=target.replace("undisturbed", "applied"),
                integrator="Euler",
                stiffness=SOFT,
            )
        )
        data = mujoco.MjData(model)
        a = np.zeros((2 * model.nv, 2 * model.nv))
        b = np.zeros((2 * model.nv, 0))
        with vc.attach(model) as contact:
            for i in range(STEPS):
                mujoco.mj_step(model, data)
                if i % 20 == 0 and target != "undisturbed":
                    time = data.time
                    mujoco.mjd_transitionFD(model, data, 1e-7, True, a, b, None, None)
                    keeps_time = keeps_time and data.time == time
            matrices[target] = a
            dissipated[target] = contact.energy(data).dissipated
    assert np.array_equal(matrices["passive"], matrices["applied"])
    assert np.abs(matrices["applied"][8, 2]) > 0.1  # stiffness: vertical speed by height
    # MuJoCo 2.2.2 puts back the state but not the time, and an account is kept in time.
    if keeps_time:
        assert dissipated["applied"] > 0.0
        assert dissipated["applied"] == pytest.approx(dissipated["undisturbed"], rel=1e-9)


def test_inverse_dynamics_take_passive_contact_as_known():
    # A body held by contact needs no other force under `passive`; under `applied` the contact is an
    # applied force and inverse dynamics find it.
    needed = {}
    for target in ("passive", "applied"):
        model = vc.load(SCENE.format(target=target, integrator="Euler", stiffness=SOFT))
        data = mujoco.MjData(model)
        data.qpos[:7] = 0, 0, 0.0999, 1, 0, 0, 0
        with vc.attach(model) as contact:
            mujoco.mj_forward(model, data)
            mujoco.mj_inverse(model, data)
            force = contact.sites(data)["normal_force"].sum()
        needed[target] = data.qfrc_inverse[2]
    assert needed["passive"] == pytest.approx(0.0, abs=1e-12)
    assert needed["applied"] == pytest.approx(force, rel=1e-12)
