# SPDX-License-Identifier: Apache-2.0
"""Watched steps say what a program finds that looks at the scene after every single step."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact._mujoco_views import dense
from volcontact.running.probes import native_sites
from volcontact.running.watched import Kind, Range, Watch, number, read

SCENE = """\
<mujoco>
  <option timestep="0.002" integrator="{integrator}"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="ball" pos="0 0 0.1">
      <joint name="x" type="slide" axis="1 0 0"/>
      <joint name="z" type="slide" axis="0 0 1"/>
      <joint name="turn" type="ball"/>
      <geom name="ball" size="0.05" density="1000"/>
    </body>
    <body name="box" pos="0.3 0 0.03">
      <freejoint name="box"/>
      <geom name="box" type="box" size="0.02 0.03 0.029" density="1000"/>
    </body>
  </worldbody>
  <actuator><motor joint="x"/></actuator>
  <sensor><framelinvel objtype="body" objname="ball"/></sensor>
  <custom>
    <numeric name="volcontact/material/all/stiffness" data="1e8"/>
    <numeric name="volcontact/material/all/damping" data="5"/>
    <numeric name="volcontact/material/all/friction" data="0.3"/>
    <tuple name="volcontact/material/all">
      <element objtype="geom" objname="floor"/>
      <element objtype="geom" objname="ball"/>
      <element objtype="geom" objname="box"/>
    </tuple>
  </custom>
</mujoco>
"""
INTEGRATORS = ["Euler", "RK4", "implicit"]
if hasattr(mujoco.mjtIntegrator, "mjINT_IMPLICITFAST"):
    INTEGRATORS.append("implicitfast")
START = np.array([0.8, -1.0, 3.0, 2.0, 1.0, 0.1, 0.2, 0.0, 0.0, 0.0, 4.0])


def _started(model):
    data = mujoco.MjData(model)
    data.qvel[:] = START
    data.ctrl[:] = 0.7
    return data


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("kind", ["volumetric", "native"])
def test_watching_is_looking_after_every_step(integrator, kind):
    """The same motion, and the same sums, peaks and places as found site by site."""
    text = SCENE.format(integrator=integrator)
    is_native = kind == "native"
    model = mujoco.MjModel.from_xml_string(text) if is_native else vc.load(text)
    contact = None if is_native else vc.attach(model)
    watched, stepped = _started(model), _started(model)
    places = np.zeros((2, model.ngeom), bool)
    places[0, 1] = places[1, 0] = True
    watch = Watch(places=places, peaks=[number(Kind.SPEED, 1), number(Kind.QPOS, 0)])
    largest = np.zeros(7)
    fastest = furthest = -math.inf
    first = math.nan
    for _ in range(150):
        began = stepped.time
        mujoco.mj_step(model, stepped)
        sites = native_sites(model, stepped) if contact is None else contact.sites(stepped)
        forces = np.linalg.norm(sites["force"], axis=1)
        torques = np.linalg.norm(sites["torque"], axis=1)
        of_ball = (sites["geom_a"] == 1) | (sites["geom_b"] == 1)
        of_floor = (sites["geom_a"] == 0) | (sites["geom_b"] == 0)
        felt = [forces.sum(), torques.sum(), forces.max(initial=0.0), len(sites)]
        felt += [forces[of_ball].sum(), forces[of_floor].sum(), 0.0]
        largest = np.maximum(largest, felt)
        if len(sites) and math.isnan(first):
            first = began
        velocity = np.zeros(6)
        mujoco.mj_objectVelocity(model, stepped, mujoco.mjtObj.mjOBJ_XBODY, 1, velocity, 0)
        fastest = max(fastest, float(np.linalg.norm(velocity[3:])))
        furthest = max(furthest, float(stepped.qpos[0]))
        assert watch.step(model, watched, 1) == 1
        assert watch.felt.force == pytest.approx(forces.sum(), rel=1e-9, abs=1e-9)
        assert watch.felt.sites == len(sites)
    again, once = _started(model), Watch()
    assert once.step(model, again, 150) == 150 and once.outcome == ""
    if contact is not None:
        contact.close()
    assert np.array_equal(watched.qpos, stepped.qpos) and np.array_equal(again.qpos, stepped.qpos)
    felt = watch.felt
    found = [felt.peak_force, felt.peak_torque, felt.peak_site_force, felt.most_sites]
    assert found == pytest.approx(largest[:4], rel=1e-9) and largest[0] > 10.0
    assert watch.place_peaks == pytest.approx(largest[4:6], rel=1e-9)
    assert watch.peaks == pytest.approx([fastest, furthest], rel=1e-12)
    assert felt.first_touch == pytest.approx(first, abs=1e-12) and first >= 0.0
    assert once.felt.peak_force == felt.peak_force


def test_numbers_of_a_scene():
    """Each kind reads what its name says."""
    model = vc.load(SCENE.format(integrator="Euler"))
    with vc.attach(model):
        data = _started(model)
        mujoco.mj_step(model, data, 120)
        mujoco.mj_forward(model, data)
        turn = np.array([math.cos(0.4), 0.0, math.sin(0.4), 0.0])
        away = np.linalg.norm(data.xpos[2] - [0.1, 0.2, 0.3])
        angle = 2.0 * math.acos(abs(float(dense(data.xquat)[1] @ turn)))
        expected = [
            (number(Kind.TIME), data.time),
            (number(Kind.QPOS, 3), data.qpos[3]),
            (number(Kind.QVEL, 2), data.qvel[2]),
            (number(Kind.CTRL, 0), 0.7),
            (number(Kind.SENSOR, 2), data.sensordata[2]),
            (number(Kind.POSITION, 5), data.xpos[1, 2]),
            (number(Kind.DISTANCE, 2, [0.1, 0.2, 0.3]), away),
            (number(Kind.ANGLE, 1, turn), math.degrees(angle)),
            (number(Kind.SPEED, 2), np.linalg.norm(data.qvel[5:8])),
            (number(Kind.SPIN, 2), np.linalg.norm(data.qvel[8:11])),
        ]
        values = read(model, data, [each for each, _ in expected], None)
        assert values == pytest.approx([value for _, value in expected], rel=1e-9, abs=1e-12)
        felt = read(model, data, [number(Kind.SITES), number(Kind.SITE_FORCE)], None)
        assert np.isnan(felt).all()


def test_a_run_ends_at_the_very_step():
    """Conditions that have held for long enough, and limits, end it; the limit sees each step."""
    model = vc.load(SCENE.format(integrator="Euler"))
    with vc.attach(model):
        late = Range(number(Kind.TIME), 0.05, 1.0)
        watch = Watch(success=[late], hold=0.01)
        data = _started(model)
        assert watch.step(model, data, 1000) == round(0.06 / 0.002)
        assert watch.outcome == "success" and watch.step(model, data, 10) == 0
        outside = Watch(success=[late], judged_outside=True)
        assert outside.step(model, _started(model), 40) == 40
        assert outside.outcome == "" and outside.felt.is_good
        jams = Watch(success=[Range(number(Kind.TIME), 5, 6)], jammed=[late], jam_time=0.02)
        assert jams.step(model, _started(model), 1000) == round(0.07 / 0.002)
        assert jams.outcome == "jammed"
        whole = Watch()
        whole.step(model, _started(model), 200)
        limit = 0.999 * whole.felt.peak_force
        limited = Watch(force_limit=limit)
        steps = limited.step(model, _started(model), 200)
        assert limited.outcome == "force_limit" and 0 < steps < 200
        assert limited.felt.force > limit and limited.felt.peak_force == limited.felt.force
        axes = [number(Kind.SENSOR, i) for i in range(3)]
        by_sensor = Watch(force=axes, force_limit=0.1)
        assert by_sensor.step(model, _started(model), 200) == 1
        assert by_sensor.felt.force > 0.1 and by_sensor.outcome == "force_limit"


def test_a_bad_state_ends_a_run():
    """MuJoCo resets such a state: what comes after it is no part of the run."""
    model = vc.load(SCENE.format(integrator="Euler"))
    with vc.attach(model):
        data = _started(model)
        data.qvel[0] = math.nan
        watch = Watch(success=[Range(number(Kind.TIME), 5, 6)])
        assert watch.step(model, data, 100) == 1 and watch.outcome == "diverged"
        assert math.isfinite(watch.felt.peak_force)
