# SPDX-License-Identifier: Apache-2.0
"""Recordings of free fall and of a resting ball against closed forms."""

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact.running.recording import CHANNELS
from volcontact.running.simulation import SimulationError, simulate

GRAVITY = 9.81
MASS = 1.0
RADIUS = 0.05
STIFFNESS = 1e8
REST_DEPTH = 0.792364e-3  # [m] depth at which k_v V(depth) = m g for this ball (spherical cap)

KINDS = ("volumetric", "native")


def ball(height: float, integrator: str = "Euler") -> str:
    return f"""
    <mujoco>
      <option timestep="0.0005" integrator="{integrator}"/>
      <worldbody>
        <geom name="floor" type="plane" size="1 1 0.1"/>
        <body name="ball" pos="0 0 {height}">
          <freejoint/>
          <geom name="ball" type="sphere" size="{RADIUS}" mass="{MASS}"/>
        </body>
      </worldbody>
      <custom>
        <numeric name="volcontact/material/steel/stiffness" data="{2 * STIFFNESS}"/>
        <numeric name="volcontact/material/steel/damping" data="10"/>
        <tuple name="volcontact/material/steel">
          <element objtype="geom" objname="ball"/>
          <element objtype="geom" objname="floor"/>
        </tuple>
      </custom>
    </mujoco>
    """


@pytest.mark.parametrize("kind", KINDS)
def test_row_holds_the_state_its_step_began_with(kind):
    # Semi-implicit Euler in free fall: v_i = -g h i, z_i = z_0 - g h^2 i (i + 1) / 2.
    run = simulate(ball(2.0), contact=kind, duration=0.1)
    h, i = 0.0005, np.arange(201)
    speed = GRAVITY * h * i
    height = 2.0 - GRAVITY * h**2 * i * (i + 1) / 2
    assert run.steps == 200
    np.testing.assert_allclose(run.time, h * i, atol=1e-12)
    np.testing.assert_allclose(run.height[:, 0], height, atol=1e-12)
    np.testing.assert_allclose(run.qpos[:, 2], height, atol=1e-12)
    np.testing.assert_allclose(run.speed[:, 0], speed, atol=1e-12)
    np.testing.assert_allclose(run.kinetic, 0.5 * MASS * speed**2, atol=1e-12)
    np.testing.assert_allclose(run.potential, MASS * GRAVITY * height, atol=1e-12)
    assert run.site_count.max() == 0
    assert not run.dissipated.any()


@pytest.mark.parametrize("kind", KINDS)
def test_scene_starts_at_its_keyframe(kind):
    key = '<keyframe><key name="start" qpos="0.1 0 3 1 0 0 0" qvel="1 0 0 0 0 0"/></keyframe>'
    run = simulate(ball(2.0).replace("</mujoco>", f"{key}</mujoco>"), contact=kind, duration=0.01)
    assert run.qpos[0].tolist() == [0.1, 0.0, 3.0, 1.0, 0.0, 0.0, 0.0]
    assert run.qvel[0].tolist() == [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]


@pytest.mark.parametrize("kind", KINDS)
def test_runge_kutta_rows_lie_on_the_parabola(kind):
    # The last stage of a step is not its beginning: energies read there would not add up.
    run = simulate(ball(2.0, integrator="RK4"), contact=kind, duration=0.05)
    np.testing.assert_allclose(run.height[:, 0], 2.0 - 0.5 * GRAVITY * run.time**2, atol=1e-12)
    np.testing.assert_allclose(run.energy, MASS * GRAVITY * 2.0, atol=1e-11)


@pytest.mark.parametrize("kind", KINDS)
def test_resting_ball_is_carried_by_one_upward_force(kind):
    run = simulate(ball(RADIUS), contact=kind, duration=1.0)
    assert run.bodies == ("ball",)
    assert run.weight == pytest.approx(MASS * GRAVITY)
    assert run.contact_force[-1] == pytest.approx(run.weight, rel=1e-6)
    assert run.largest_site_force[-1] == run.contact_force[-1]
    assert run.site_count[-1] == 1
    (site,) = run.frames[-1].sites
    on_ball = site["force"] if site["geom_a"] == 1 else -site["force"]
    outward = site["normal"] if site["geom_a"] == 1 else -site["normal"]
    np.testing.assert_allclose(on_ball, [0.0, 0.0, run.weight], atol=1e-5)
    np.testing.assert_allclose(outward, [0.0, 0.0, 1.0], atol=1e-9)
    np.testing.assert_allclose(site["position"][:2], 0.0, atol=1e-9)
    assert site["depth"] == pytest.approx(RADIUS - run.height[-1, 0], rel=1e-6)
    assert run.penetration[-1] == site["depth"]
    assert not run.warnings
    assert run.stopped is None


def test_volumetric_ball_rests_at_the_depth_of_the_spherical_cap():
    run = simulate(ball(RADIUS), contact="volumetric", duration=1.0)
    assert run.penetration[-1] == pytest.approx(REST_DEPTH, rel=1e-6)
    (site,) = run.frames[-1].sites
    # Area of the circle in which the plane cuts the sphere.
    area = np.pi * REST_DEPTH * (2 * RADIUS - REST_DEPTH)
    assert site["area"] == pytest.approx(area, rel=1e-5)


def test_volumetric_energy_account_closes_as_the_step_shrinks():
    # Energy put in = kinetic + stored + dissipated; what is left is the integrator's, first order.
    gaps = []
    for timestep in (2e-4, 5e-5):
        run = simulate(ball(0.1), contact="volumetric", duration=0.3, timestep=timestep)
        account = run.energy + run.dissipated.sum(axis=1)
        gaps.append(np.abs(account - account[0]).max() / (MASS * GRAVITY * 0.05))
        assert run.dissipated[-1, CHANNELS.index("normal")] > 0.1
        assert np.all(np.diff(run.dissipated.sum(axis=1)) >= -1e-12)
        # With what the step made, only what Euler makes of free fall is left: m g h v / 2.
        made = np.abs(account + run.numerical - account[0]).max()
        assert made <= 0.51 * MASS * GRAVITY * timestep * np.abs(run.qvel[:, 2]).max()
    assert gaps[1] < 0.4 * gaps[0]
    assert gaps[1] < 0.02


def test_native_contact_has_points_without_area_or_stored_energy():
    run = simulate(ball(RADIUS), contact="native", duration=0.2)
    assert run.frames[-1].sites["area"].max() == 0.0
    assert not run.elastic.any()
    assert run.description == {}


def test_frames_have_the_shape_of_every_site():
    run = simulate(ball(RADIUS), duration=0.2)
    (surface,) = run.frames[-1].surfaces
    (site,) = run.frames[-1].sites
    points, triangles = surface.patch
    sides = points[triangles[:, 1:]] - points[triangles[:, :1]]
    area = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum()
    assert area == pytest.approx(site["area"], rel=0.1)
    native = simulate(ball(RADIUS), contact="native", duration=0.2)
    assert native.frames[-1].surfaces == ()


def test_sensors_are_magnitudes_with_the_parts_of_one_name_together():
    sensors = '<framepos name="place" objtype="body" objname="ball"/>'
    sensors += '<clock name="time_x"/><clock name="time_y"/>'
    scene = ball(1.0).replace("</mujoco>", f"<sensor>{sensors}</sensor></mujoco>")
    run = simulate(scene, contact="native", duration=0.3)
    assert set(run.sensors) == {"place", "time"}
    np.testing.assert_allclose(run.sensors["place"], np.linalg.norm(run.position[:, 0], axis=1))
    np.testing.assert_allclose(run.sensors["time"], np.sqrt(2.0) * run.time)


def test_frames_are_evenly_spaced_and_include_both_ends():
    run = simulate(ball(1.0), contact="native", duration=0.4, frame_interval=0.1)
    np.testing.assert_allclose([frame.time for frame in run.frames], [0.0, 0.1, 0.2, 0.3, 0.4])
    np.testing.assert_allclose([run.time[f.row] for f in run.frames], [f.time for f in run.frames])
    none = simulate(ball(1.0), contact="native", duration=0.1, frame_interval=None)
    assert none.frames == ()


def test_timestep_can_be_chosen_and_leaves_the_model_alone():
    model = mujoco.MjModel.from_xml_string(ball(1.0))
    run = simulate(model, contact="native", duration=0.1, timestep=1e-3)
    assert run.steps == 100
    assert run.timestep == 1e-3
    assert len(run.step_microseconds) == 100
    assert run.microseconds_per_step > 0.0
    assert model.opt.timestep == 0.0005
    assert model.opt.enableflags == 0


def test_progress_rises_to_the_number_of_steps():
    calls = []
    simulate(
        ball(1.0), contact="native", duration=0.5, progress=lambda done, total: calls.append(done)
    )
    assert calls[-1] == 1000
    assert calls == sorted(calls)
    assert 50 <= len(calls) <= 300


@pytest.mark.parametrize("kind", KINDS)
def test_unusable_state_stops_the_run_and_is_reported(kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its log into the current folder
    model = mujoco.MjModel.from_xml_string(
        ball(1.0).replace("<worldbody>", '<size nuserdata="1000"/><worldbody>')
    )
    model.opt.gravity[2] = -1e13  # beyond what MuJoCo accepts as an acceleration
    run = simulate(model, contact=kind, duration=0.1)
    assert run.warnings == {"BADQACC": 1}
    assert "BADQACC" in run.stopped
    assert run.steps == 0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"duration": 0.0}, "duration 0 s must be at least one timestep"),
        ({"duration": float("nan")}, "duration nan s"),
        ({"duration": 1.0, "timestep": -1.0}, "timestep -1 s must be positive"),
        ({"duration": 1.0, "frame_interval": 0.0}, "frame interval 0 s must be positive"),
        ({"duration": 1.0, "contact": "rubber"}, "'rubber' must be 'volumetric' or 'native'"),
    ],
)
def test_bad_requests_say_what_is_wrong(options, message):
    with pytest.raises(SimulationError, match=message):
        simulate(ball(1.0), **{"contact": "native", **options})


def test_missing_scene_is_named():
    for kind in KINDS:
        with pytest.raises(FileNotFoundError, match=r"no such scene: nowhere\.xml"):
            simulate("nowhere.xml", contact=kind, duration=1.0)


def test_binary_models_run_too(tmp_path):
    path = tmp_path / "ball.mjb"
    mujoco.mj_saveModel(mujoco.MjModel.from_xml_string(ball(1.0)), str(path), None)
    assert simulate(path, contact="native", duration=0.01).steps == 20


def test_jointed_bodies_are_followed_where_none_is_free():
    pendulum = """
    <mujoco><worldbody><body name="rod"><joint axis="0 1 0"/>
      <geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.02"/></body></worldbody></mujoco>
    """
    run = simulate(pendulum, contact="native", duration=0.2)
    assert run.bodies == ("rod",)
    assert run.spin[-1, 0] == pytest.approx(abs(run.qvel[-1, 0]))


def test_body_that_another_carries_is_followed_on_demand():
    """As a box in the grasp of a carrier: it has no joint of its own."""
    text = """<mujoco><option gravity="0 0 0"/><worldbody><body name="carrier">
      <joint type="slide" axis="1 0 0"/><geom size=".1" mass="1"/>
      <body name="held" pos="0 0 .5"><geom size=".1" mass="1"/></body></body></worldbody>
      </mujoco>"""
    run = simulate(text, duration=0.01, frame_interval=None, follow=["held", "nobody"])
    assert run.bodies == ("held", "carrier")
    np.testing.assert_allclose(run.position[-1], [[0, 0, 0.5], [0, 0, 0]])


TWO_BALLS = """
<mujoco>
  <option timestep="1e-3"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 1"/>
    <body name="ours" pos="0 0 .0505"><freejoint/><geom name="ours" size=".05" mass="1"/></body>
    <body name="theirs" pos="1 2 .0505"><freejoint/><geom name="theirs" size=".05" mass="1"/></body>
  </worldbody>
  <keyframe><key name="start" qpos="0 0 .0505 1 0 0 0  1 2 .0505 1 0 0 0"
    qvel=".2 0 0 0 5 1  0 .3 0 2 0 4"/></keyframe>
  <custom>
    <numeric name="volcontact/option/pairs/listed" data="1"/>
    <tuple name="volcontact/pair/p"><element objtype="geom" objname="floor"/>
      <element objtype="geom" objname="ours"/></tuple>
  </custom>
</mujoco>
"""


def test_rows_have_what_contact_tells_after_each_step_of_both_kinds_of_contact():
    run = simulate(TWO_BALLS, duration=0.1, frame_interval=None)
    assert (run.wrench_on["ours"][-1, 2] > 0.0) and (run.wrench_on["theirs"][-1, 2] > 0.0)
    model = vc.load(TWO_BALLS)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    velocity = np.zeros(6)
    with vc.attach(model) as contact:
        for row in range(len(run.time) - 1):
            mujoco.mj_step(model, data)
            sites, n = contact.sites(data), run.site_count[row]
            forces = [np.linalg.norm(force) for force in sites["force"]]
            assert n == len(sites) == np.count_nonzero(run.sites["row"] == row)
            assert run.contact_force[row] == pytest.approx(sum(forces), rel=1e-14)
            assert run.largest_site_force[row] == pytest.approx(max(forces, default=0.0), rel=1e-14)
            assert run.penetration[row] == max(sites["depth"], default=0.0)
            for i, name in enumerate(run.bodies):
                wrench, kind = np.zeros(6), mujoco.mjtObj.mjOBJ_XBODY
                for touch in contact.contact_forces(data):
                    sign = int(touch["geom_a"] == i + 1) - int(touch["geom_b"] == i + 1)
                    arm = touch["position"] - data.body(name).xpos
                    wrench[:3] += sign * touch["force"]
                    wrench[3:] += sign * (touch["torque"] + np.cross(arm, touch["force"]))
                size = 1e-14 * np.linalg.norm(wrench)
                np.testing.assert_allclose(run.wrench_on[name][row], wrench, atol=size)
                mujoco.mj_objectVelocity(model, data, kind, i + 1, velocity, 0)
                assert run.spin[row, i] == pytest.approx(np.linalg.norm(velocity[:3]), rel=1e-14)
                assert run.speed[row, i] == pytest.approx(np.linalg.norm(velocity[3:]), rel=1e-14)


@pytest.mark.parametrize("kind", KINDS)
def test_run_that_stops_under_runge_kutta_has_the_sites_of_its_rows_once(kind):
    text = ball(0.049, "RK4").replace(
        "<custom>", '<keyframe><key name="start" qvel="0 0 1e300 0 0 0"/></keyframe><custom>'
    )
    run = simulate(text, contact=kind, duration=0.01, frame_interval=None)
    assert run.stopped is not None
    assert len(run.time) == len(run.contact_force) == len(run.site_count) == 1
    assert run.site_count[0] == len(run.sites) <= 1
