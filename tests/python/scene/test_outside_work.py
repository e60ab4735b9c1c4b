# SPDX-License-Identifier: Apache-2.0
"""Work of actuators, dampers, limits and native contact against closed forms and the books."""

import mujoco
import numpy as np
import pytest

from volcontact.report.findings import findings
from volcontact.running.control_table import ControlTable
from volcontact.running.driving import Drive
from volcontact.running.outside_work import CHANNELS
from volcontact.running.simulation import simulate

HAS_IMPLICIT = hasattr(mujoco.mjtIntegrator, "mjINT_IMPLICITFAST")
INTEGRATORS = ["Euler", "RK4", *(["implicit", "implicitfast"] if HAS_IMPLICIT else [])]
CART = """
<mujoco>
  <option timestep="{step}" gravity="0 0 0" integrator="{integrator}"/>
  <worldbody>
    <geom name="floor" type="plane" size="9 9 0.1"/>
    <body name="cart" pos="0 0 1">
      <joint name="rail" type="slide" axis="1 0 0" damping="{damping}" stiffness="{stiffness}"/>
      <geom name="cart" type="box" size="0.1 0.1 0.1" mass="2"/>
    </body>
  </worldbody>
  <actuator>{actuator}</actuator>
</mujoco>
"""
MOTOR = '<motor name="push" joint="rail"/>'


def cart(drive=None, **changes):
    values = dict(step=1e-3, integrator="Euler", damping=0, stiffness=0, actuator=MOTOR)
    contact = changes.pop("contact", "volumetric")
    text = CART.format(**{**values, **changes})
    drive = drive or Drive(controls={"push": 1.0})
    return simulate(text, duration=1.0, contact=contact, frame_interval=None, drive=drive)


def of(run, channel):
    return run.outside_work[:, CHANNELS.index(channel)]


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("contact", ["volumetric", "native"])
def test_motor_puts_in_what_the_cart_has(integrator, contact):
    # F t^2 / 2 m = 0.25 m under 1 N: 0.25 J, all of it kinetic.
    run = cart(integrator=integrator, contact=contact)
    assert of(run, "actuators")[-1] == pytest.approx(0.25, rel=1e-9)
    assert run.kinetic[-1] == pytest.approx(0.25, rel=1e-9)
    assert np.abs(run.unbalance()).max() < 1e-12
    assert not run.work.any()


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_damper_and_spring_and_motor_leave_nothing_over(integrator):
    run = cart(integrator=integrator, damping=3.0, stiffness=20.0)
    # Oracle: the speeds of the run itself, c integral of v^2 dt by Simpson's rule.
    v, h = run.qvel[:, 0], run.timestep
    lost = (
        3.0
        * h
        / 3.0
        * (v[0] ** 2 + v[-1] ** 2 + 4 * (v[1:-1:2] ** 2).sum() + 2 * (v[2:-1:2] ** 2).sum())
    )
    assert of(run, "dampers")[-1] == pytest.approx(-lost, rel=3e-3)
    # What is left is the spring's: MuJoCo takes it explicitly, an error of the step.
    coarse = np.abs(run.unbalance()).max()
    fine = np.abs(cart(integrator=integrator, damping=3.0, stiffness=20.0, step=2.5e-4).unbalance())
    assert coarse < 1e-3 * of(run, "actuators").max()
    assert fine.max() < 0.3 * coarse


@pytest.mark.skipif(not HAS_IMPLICIT, reason="no such integrator in this MuJoCo")
@pytest.mark.parametrize("integrator", ["implicit", "implicitfast"])
def test_stiff_servo_is_counted_as_the_step_took_it(integrator):
    # Time constant m / kv = 2 ms, two steps: the force at the start of a step is 1.5 times off.
    servo = '<velocity name="push" joint="rail" kv="1000"/>'
    run = cart(integrator=integrator, actuator=servo)
    assert run.kinetic[-1] == pytest.approx(1.0, rel=1e-6)  # 2 kg at 1 m/s
    assert np.abs(run.unbalance()).max() < 1e-12


def test_controls_that_jump_are_held_over_a_step_of_runge_kutta():
    times = np.linspace(0.0, 1.0, 51)
    table = ControlTable(times, {"push": np.where(np.arange(51) % 2, 5.0, -4.0)})
    run = cart(Drive(table=table), integrator="RK4", step=0.02)
    assert np.abs(run.unbalance()).max() < 1e-12


def test_limit_and_native_contact_have_their_own_channels():
    ball = """
    <mujoco><option timestep="0.0005"/><worldbody>
      <geom name="floor" type="plane" size="1 1 0.1"/>
      <body name="ball" pos="0 0 0.2"><freejoint/>
        <geom name="ball" type="sphere" size="0.05" mass="1"/></body>
    </worldbody></mujoco>"""
    run = simulate(ball, duration=1.5, contact="native", frame_interval=None)
    fall = 9.81 * (0.2 - run.qpos[-1, 2])
    assert of(run, "native")[-1] == pytest.approx(-fall, rel=1e-2)
    assert not of(run, "limits").any()
    # From rest to rest, gravity of semi-implicit Euler: g h v / 2 a step.
    assert np.abs(run.unbalance()[-1]) < 1e-3 * fall
    hung = CART.format(step=1e-3, integrator="Euler", damping=0, stiffness=0, actuator=MOTOR)
    hung = hung.replace('axis="1 0 0"', 'axis="1 0 0" limited="true" range="-1 0.1"')
    run = simulate(
        hung,
        duration=1.5,
        contact="native",
        frame_interval=None,
        drive=Drive(controls={"push": 1.0}),
    )
    assert of(run, "limits")[-1] < -0.05
    assert not of(run, "native").any()
    assert np.abs(run.unbalance()).max() < 1e-6


def test_report_does_not_blame_contact_for_a_motor():
    from volcontact.report import Comparison

    runs = [cart(contact=kind) for kind in ("volumetric", "native")]
    made = Comparison("cart.xml", *runs, None, "", "")
    (energy,) = (f.text for f in findings(made) if f.title == "Energy")
    assert energy == (
        "Volumetric contact does nothing. Actuators put in 250 mJ. Unaccounted for: less than 1 nJ "
        "at most, less than 1 nJ at the end. Native contact does nothing. Actuators put in 250 mJ. "
        "Unaccounted for: less than 1 nJ at most, less than 1 nJ at the end."
    )
