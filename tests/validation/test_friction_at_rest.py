# SPDX-License-Identifier: Apache-2.0
"""Friction that is too stiff for explicit steps, where bodies chatter: steps turn implicit.

Viscous friction is where h mu g > 2 v_s. With MuJoCo's own friction of 1 and the default slip speed
of 1 mm/s that is every step above 0.2 ms, whatever the mass. Bristles are where their spring and
damper are, as the default ones under a kilogram at 2 ms.
"""

import re

import mujoco
import numpy as np
import pytest

import volcontact as vc

SCENE = """
<mujoco>
  <option timestep="{step}"><flag energy="enable"/></option>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1" friction="{friction}"/>
    <body pos="0 0 .15" euler="20 30 10"><freejoint/>
      <geom name="body" type="{shape}" size=".05 .05 .05" friction="{friction}" mass="{mass}"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/option/implicit/{implicit}" data="1"/>
    <numeric name="volcontact/material/both/friction_law/{law}" data="1"/>
    <tuple name="volcontact/material/both">
      <element objtype="geom" objname="floor"/><element objtype="geom" objname="body"/>
    </tuple>
  </custom>
</mujoco>
"""
# A ball that falls straight does not slip: its steps may be explicit, and it bounces for longer.
SECONDS = {"box": 4.0, "sphere": 6.0}


def thrown(*, step, friction, shape="box", mass=1.0, implicit="auto", law="regularized_coulomb"):
    """Largest speed over the last tenth of a second; energy at the start, and all at the end."""
    text = SCENE.format(
        step=step, friction=friction, shape=shape, mass=mass, implicit=implicit, law=law
    )
    model = vc.load(text)
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        first = float(np.sum(data.energy[:1]))
        speed = 0.0
        steps = round(SECONDS[shape] / step)
        for i in range(steps):
            mujoco.mj_step(model, data)
            if i > 0.975 * steps:
                speed = max(speed, np.abs(data.qvel).max())
        energy = contact.energy(data)
    return speed, first, energy.elastic + energy.dissipated + mass * 9.81 * data.qpos[2]


@pytest.mark.parametrize("friction", [0.3, 1.0])
@pytest.mark.parametrize(("step", "shape", "mass"), [(2e-3, "box", 1.0), (1e-3, "sphere", 0.1)])
def test_thrown_body_comes_to_rest_on_viscous_friction(step, shape, mass, friction):
    speed, first, last = thrown(step=step, friction=friction, shape=shape, mass=mass)
    assert speed < 1e-9
    assert last == pytest.approx(first, rel=0.1)  # first impacts are as long as a few steps
    if shape == "sphere":
        return  # it may roll to rest without chatter
    # What happens without: it never rests, and friction seems to dissipate for ever.
    chattering, _, _ = thrown(step=step, friction=friction, shape=shape, mass=mass, implicit="off")
    assert chattering > 1e-3


@pytest.mark.parametrize("mass", [0.001, 0.1, 1.0])
def test_thrown_body_comes_to_rest_on_bristles(mass):
    speed, _, _ = thrown(step=2e-3, friction=0.5, mass=mass, law="bristle")
    assert speed < 1e-9
    if mass == 1.0:  # lighter ones are implicit by their patch, or gone when they are not
        chattering, _, _ = thrown(step=2e-3, friction=0.5, mass=mass, law="bristle", implicit="off")
        assert chattering > 1e-3


@pytest.mark.parametrize("law", ["regularized_coulomb", "bristle"])
@pytest.mark.parametrize(("integrator", "implicit"), [("RK4", "off"), ("Euler", "off")])
@pytest.mark.parametrize("shape", ["box", "sphere"])
def test_explicit_steps_shake_beyond_what_the_warning_says(integrator, implicit, law, shape):
    """Pushed at 1 mm/s, or rolling at that: below the step named it rests, above it does not."""

    def model_at(step):
        text = SCENE.format(
            step=step, friction=0.5, shape=shape, mass=1.0, implicit=implicit, law=law
        )
        model = vc.load(text)
        model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
        return model

    with vc.attach(model_at(1e-2)) as contact:
        (longest,) = (
            float(found[1])
            for warning in contact.description["warnings"]
            if (found := re.search(r"hold it up to (\S+) s", warning))
        )
    slips = []
    for factor in (0.8, 1.6):
        model = model_at(factor * longest)
        data = mujoco.MjData(model)
        data.qpos[:] = 0.0, 0.0, 0.0499, 1.0, 0.0, 0.0, 0.0
        data.qvel[0] = 1e-3
        with vc.attach(model) as contact:
            told = any("shakes them at rest" in text for text in contact.description["warnings"])
            assert told == (factor > 1.0)
            mujoco.mj_step(model, data, round(3.8 / model.opt.timestep))
            slip = 0.0
            for _ in range(round(0.2 / model.opt.timestep)):
                mujoco.mj_step(model, data)
                slip = max(slip, abs(data.qvel[0] - 0.05 * data.qvel[4]))
            slips.append(slip)
    assert slips[0] < 3e-5  # a ball still rolls
    assert slips[1] > 1e-4


def creep(law, mass):
    """How far a box moves in 4 s on a slope of half the cone, once it is at rest [m]."""
    text = SCENE.format(step=2e-3, friction=0.5, shape="box", mass=mass, implicit="auto", law=law)
    model = vc.load(text)
    model.opt.gravity[:] = 9.81 * np.array([0.25, 0.0, -1.0]) / np.hypot(0.25, 1.0)
    data = mujoco.MjData(model)
    data.qpos[:] = 0.0, 0.0, 0.0499, 1.0, 0.0, 0.0, 0.0
    with vc.attach(model):
        mujoco.mj_step(model, data, 2000)
        before = data.qpos[0]
        mujoco.mj_step(model, data, 2000)
    return abs(float(data.qpos[0] - before))


@pytest.mark.parametrize("mass", [0.001, 0.1, 1.0])
def test_default_friction_creeps_and_bristles_do_not(mass):
    assert 1e-3 < creep("regularized_coulomb", mass) < 5e-3
    assert creep("bristle", mass) < 1e-12


@pytest.mark.parametrize("step", [5e-4, 1e-3, 2e-3])
@pytest.mark.parametrize("load", [0.5, 0.9, 0.99])
def test_implicit_steps_creep_as_the_law_says(load, step):
    """A box on a slope of `load` times the cone: f = mu f_n x (3 - x^2)/2 at x slip speeds."""
    text = SCENE.format(
        step=step, friction=0.5, shape="box", mass=1.0, implicit="on", law="regularized_coulomb"
    )
    model = vc.load(text)
    model.opt.gravity[:] = 9.81 * 0.5 * load, 0.0, -9.81
    data = mujoco.MjData(model)
    data.qpos[:] = 0.0, 0.0, 0.0499, 1.0, 0.0, 0.0, 0.0
    (x,) = (r.real for r in np.roots([-0.5, 0.0, 1.5, -load]) if 0.0 < r.real < 1.0)
    with vc.attach(model):
        mujoco.mj_step(model, data, round(8.0 / step))
        assert data.qvel[0] == pytest.approx(1e-3 * x, rel=1e-2)
