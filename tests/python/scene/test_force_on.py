# SPDX-License-Identifier: Apache-2.0
"""Contact forces by name of a body or geom: weight, Newton's third law, signed torque."""

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact.running.simulation import simulate

GRAVITY, MASS = 9.81, 2.0
SCENE = f"""
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <body name="table" pos="0 0 -0.1"><geom name="top" type="box" size="1 1 0.1"/></body>
    <body name="box" pos="0.3 0.2 0.0999">
      <freejoint/>
      <geom name="box" type="box" size="0.1 0.1 0.1" mass="{MASS}"/>
    </body>
    <body name="lid" pos="0.3 0.2 0.2498">
      <freejoint/>
      <geom name="cover" type="box" size="0.1 0.1 0.05" mass="{MASS}"/>
    </body>
  </worldbody>
</mujoco>
"""
TARGETS = ["passive", "applied", "xfrc"]


@pytest.fixture(params=TARGETS)
def settled(request):
    options = {"target": request.param}
    model = vc.load(SCENE, options=options)
    data = mujoco.MjData(model)
    with vc.attach(model, material={"stiffness": 1e9}, options=options) as contact:
        mujoco.mj_step(model, data, 2000)
        mujoco.mj_forward(model, data)
        yield contact, data


def test_weight_is_carried(settled):
    contact, data = settled
    for name, load in (("lid", 1.0), ("box", 1.0), ("cover", 1.0)):
        wrench = contact.force_on(data, name)
        expected = [0.0, 0.0, load * MASS * GRAVITY]
        np.testing.assert_allclose(wrench.force, expected, atol=1e-3 * MASS * GRAVITY)
        np.testing.assert_allclose(wrench.torque, 0.0, atol=1e-4 * MASS * GRAVITY)
    wrench = contact.force_on(data, "top")
    expected = [0.0, 0.0, -2.0 * MASS * GRAVITY]
    np.testing.assert_allclose(wrench.force, expected, atol=1e-3 * MASS * GRAVITY)
    # 39.24 N down at (0.3, 0.2, 0), about the centre of the table at (0, 0, -0.1).
    np.testing.assert_allclose(wrench.point, [0.0, 0.0, -0.1])
    np.testing.assert_allclose(
        wrench.torque, np.cross([0.3, 0.2, 0.1], expected), atol=2e-3 * MASS * GRAVITY
    )


def test_action_is_reaction(settled):
    contact, data = settled
    data.qvel[:] = np.random.default_rng(3).normal(0.0, 0.05, 12)
    mujoco.mj_forward(contact.model, data)
    wrenches = [contact.force_on(data, name) for name in ("table", "box", "lid")]
    size = max(float(np.linalg.norm(w.force)) for w in wrenches)
    assert size > 1.0
    np.testing.assert_allclose(sum(w.force for w in wrenches), 0.0, atol=1e-12 * size)
    about_origin = sum(w.torque + np.cross(w.point, w.force) for w in wrenches)
    np.testing.assert_allclose(about_origin, 0.0, atol=1e-12 * size)


def test_unknown_name_is_matched(settled):
    contact, data = settled
    with pytest.raises(ValueError, match="no body or geom 'bx'; did you mean 'box'"):
        contact.force_on(data, "bx")


def test_recorded_wrench_is_about_the_frame_of_the_body():
    run = simulate(SCENE, duration=2.0, frame_interval=None, material={"stiffness": 1e9})
    assert set(run.wrench_on) == {"box", "lid"}
    expected = [0.0, 0.0, MASS * GRAVITY]
    np.testing.assert_allclose(run.wrench_on["lid"][-1, :3], expected, atol=1e-3 * MASS * GRAVITY)
    np.testing.assert_allclose(run.wrench_on["lid"][-1, 3:], 0.0, atol=1e-4 * MASS * GRAVITY)
