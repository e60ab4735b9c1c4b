# SPDX-License-Identifier: Apache-2.0
"""Contact makes no energy: what bodies have at any time is at most what they started with."""

import copy
import itertools

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact._mujoco_views import dense

ROUNDING = 1.001  # what any cell may have more than at its start


def scene(bodies, step, gravity=0.0, options=""):
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{step}" gravity="0 0 {-gravity}" {options}>'
        "</option><worldbody>"
        f'<geom type="plane" size="1 1 1"/>{bodies}</worldbody></mujoco>'
    )


def free_box(height, step, **more):
    body = (
        f'<body pos="0 0 {height}"><freejoint/><geom type="box" size=".1 .1 .1" mass="2"/></body>'
    )
    return scene(body, step, **more)


def kinetic(model, data):
    """v' M v/2 [J]."""
    momentum = np.zeros(model.nv)
    mujoco.mj_mulM(model, data, momentum, data.qvel)
    return 0.5 * momentum @ data.qvel


def largest_kinetic(model, data, steps, **material):
    """The largest kinetic energy of a run over that of its start."""
    with vc.attach(model, material=material):
        mujoco.mj_forward(model, data)
        start = largest = kinetic(model, data)
        for _ in range(steps):
            mujoco.mj_step(model, data)
            largest = max(largest, kinetic(model, data))
    assert np.isfinite(data.qvel).all()
    return largest / start


@pytest.mark.parametrize(
    ("speed", "damping", "step"),
    [(10.0, 1.0, 2e-3), (10.0, 5.0, 2e-3), (3.0, 3.0, 2e-3), (30.0, 10.0, 5e-3)],
)
def test_stiff_damping_does_not_throw_back(speed, damping, step):
    model = free_box(0.1001, step)
    data = mujoco.MjData(model)
    data.qvel[2] = -speed
    assert largest_kinetic(model, data, 20, stiffness=1e7, damping=damping) <= ROUNDING


def test_box_on_a_plane_at_any_speed_damping_stiffness_and_step():
    worst = {}
    random = np.random.default_rng(1)
    for speed, damping, stiffness, step in itertools.product(
        (0.1, 1.0, 30.0), (0.0, 0.3, 10.0), (1e5, 1e7, 1e9, 1e12), (2e-4, 2e-3, 1e-2)
    ):
        model = free_box(0.1 + random.uniform() * speed * step, step)
        data = mujoco.MjData(model)
        data.qvel[2] = -speed
        cell = speed, damping, stiffness, step
        worst[cell] = largest_kinetic(model, data, 200, stiffness=stiffness, damping=damping)
    assert max(worst.values()) <= ROUNDING, max(worst, key=worst.get)


def grazing(step, speed, depth, heavy, light):
    """A small block that flies past the edge of a large one, into which it has sunk by `depth`."""
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{step}" gravity="0 0 0"></option>'
        '<worldbody><body><joint type="slide" axis="0 0 1"/>'
        f'<geom type="box" size=".1 .1 .1" mass="{heavy}"/></body>'
        f'<body pos="-.1201 0 {0.12 - depth}"><joint type="slide" axis="1 0 0"/>'
        f'<geom type="box" size=".02 .02 .02" mass="{light}"/></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    data.qvel[1] = speed
    return model, data


@pytest.mark.parametrize("stiffness", [1e8, 1e9, 1e10])
@pytest.mark.parametrize("ratio", [1.0, 1e3, 1e6])
@pytest.mark.parametrize(
    ("step", "speed", "depth", "friction", "damping"),
    [(5e-3, 10.0, 0.01, 0.0, 0.0), (2e-3, 2.0, 1e-3, 0.5, 1.0)],
)
def test_a_heavy_body_is_not_thrown_by_a_light_one_in_it(
    stiffness, ratio, step, speed, depth, friction, damping
):
    model, data = grazing(step, speed, depth, 10.0, 10.0 / ratio)
    energy = largest_kinetic(
        model, data, 80, stiffness=stiffness, friction=friction, damping=damping
    )
    assert energy <= ROUNDING


@pytest.mark.parametrize("depth", [0.001, 0.02, 0.15])
def test_an_overlap_at_the_start_comes_out_slowly(depth):
    model = free_box(0.1 - depth, 2e-3, gravity=9.81)
    data = mujoco.MjData(model)
    fastest = 0.0
    with vc.attach(model, material={"stiffness": 1e9, "damping": 1.0}) as contact:
        for _ in range(3000):
            mujoco.mj_step(model, data)
            fastest = max(fastest, data.qvel[2])
        weight = contact.sites(data)["normal_force"].sum()
    # 0.1 m/s are the default of volcontact/option/exit_speed.
    assert fastest < 0.11
    assert weight == pytest.approx(2 * 9.81, rel=1e-6)
    # m g / (k A), the two layers in series.
    assert 0.1 - data.qpos[2] == pytest.approx(2 * 9.81 / (0.5e9 * 0.04), rel=1e-3)


def test_exit_speed_is_an_option():
    model = free_box(0.08, 2e-3, gravity=9.81)
    heights = []
    for speed in (0.02, 0.1, 0.5):
        data = mujoco.MjData(model)
        with vc.attach(model, material={"stiffness": 1e9}, options={"exit_speed": speed}):
            for _ in range(10):
                mujoco.mj_step(model, data)
        assert data.qvel[2] < 1.1 * speed
        heights.append(data.qpos[2])
    assert heights == sorted(heights)
    assert heights[0] < heights[-1]


@pytest.mark.parametrize("flag", ["contact", "constraint"])
def test_a_model_that_has_no_contact_is_left_without(flag):
    body = '<body pos="0 0 .09"><freejoint/><geom type="box" size=".1 .1 .1" mass="2"/></body>'
    text = (
        f'<mujoco><option><flag {flag}="disable"/></option><worldbody>'
        f'<geom type="plane" size="1 1 1"/>{body}</worldbody></mujoco>'
    )
    for options, touches in (({}, False), ({"disabled": "ignore"}, True)):
        model = mujoco.MjModel.from_xml_string(text)
        data = mujoco.MjData(model)
        with vc.attach(model, options=options) as contact:
            told = " ".join(contact.description["warnings"])
            mujoco.mj_step(model, data)
            assert bool(len(contact.sites(data))) == touches
        assert (f'<flag {flag}="disable"/>' in told) != touches


@pytest.mark.parametrize("stiffness", [1e7, 1e9, 1e11])
@pytest.mark.parametrize("step", [5e-4, 2e-3, 1e-2])
@pytest.mark.parametrize("speed", [0.1, 1.0, 10.0])
def test_runge_kutta_steps_stiff_contact(speed, step, stiffness):
    body = '<body pos="0 0 .1001"><freejoint/><geom type="box" size=".1 .1 .1" mass="2"/></body>'
    model = scene(body, step, 9.81, 'integrator="RK4"')
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    data = mujoco.MjData(model)
    data.qvel[[0, 2]] = 0.3, -speed
    with vc.attach(model, material={"stiffness": stiffness}) as contact:
        mujoco.mj_forward(model, data)
        start = most = np.sum(dense(data.energy))
        for _ in range(round(1.0 / step)):
            mujoco.mj_step(model, data)
            most = max(most, np.sum(dense(data.energy)))
        assert most <= start * (1.0 + 1e-12)
        both = 0.5 * stiffness * 0.04  # in series [N/m]
        rests = both * step**2 / 2.0 > 0.5  # else it hops on, as explicit steps do
        if rests and step > 5e-4:
            depth = 2.0 * 9.81 / both
            assert data.qpos[2] == pytest.approx(0.1 - depth, abs=1e-3 * depth)
            np.testing.assert_allclose(data.qvel, 0.0, atol=1e-9)
        # What damping has taken is not in the book of the pair; an edge that comes up slowly draws
        # a little of it, and at rest nothing more is drawn.
        if rests:
            released = contact.energy(data).released
            assert released <= 2e-3 * start
            for _ in range(100):
                mujoco.mj_step(model, data)
            assert contact.energy(data).released == pytest.approx(released, abs=1e-9 * start)


def test_runge_kutta_drains_what_emerges_within_a_step():
    """A ball in a box, off its centre, held back by nothing."""
    model = scene(
        '<geom type="box" size=".2 .2 .2"/><body pos=".12 .02 0"><freejoint/>'
        '<geom type="sphere" size=".05" mass="1"/></body>',
        1e-3,
        0.0,
        'integrator="RK4"',
    )
    data = mujoco.MjData(model)
    data.qvel[0] = 2.0
    with vc.attach(model, material={"stiffness": 1e7, "damping": 0.0}) as contact:
        for _ in range(200):
            mujoco.mj_step(model, data)
        assert contact.energy(data).made <= 1e-9
    assert data.qpos[0] > 0.3
    assert np.linalg.norm(data.qvel[:3]) < 2.2  # 2 m/s, and a slow exit


def test_runge_kutta_goes_on_from_a_copy():
    model = vc.load(
        '<mujoco><option timestep="2e-3" integrator="RK4"/><worldbody>'
        '<geom type="plane" size="1 1 1"/><body pos="0 0 .1"><freejoint/>'
        '<geom type="box" size=".1 .1 .1" mass="2"/></body></worldbody></mujoco>',
        material={"stiffness": 1e10},
    )
    data = mujoco.MjData(model)
    data.qvel[:] = 0.2, 0.0, -0.5, 0.3, 1.0, 0.0
    with vc.attach(model) as contact:
        for _ in range(60):
            mujoco.mj_step(model, data)
        assert len(contact.sites(data))
        twin = copy.copy(data)
        for _ in range(100):
            mujoco.mj_step(model, data)
            mujoco.mj_step(model, twin)
    np.testing.assert_array_equal(data.qpos, twin.qpos)
    np.testing.assert_array_equal(data.qvel, twin.qvel)


def run_carried(speed, integrator, material, steps=400, warm=100):
    """A box on a plate that is lifted by hand: plate and box after it, energies."""
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep=".002" integrator="{integrator}"/><worldbody>'
        '<body mocap="true" pos="0 0 -.01"><geom type="box" size=".2 .2 .01"/></body>'
        '<body pos="0 0 .05"><freejoint/><geom type="box" size=".05 .05 .05" mass="1"/></body>'
        "</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    with vc.attach(model, material=material) as contact:
        for i in range(warm + steps):
            if i >= warm:
                data.mocap_pos[0, 2] += speed * model.opt.timestep
            mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        return data, contact.energy(data)


@pytest.mark.parametrize("integrator", ["Euler", "implicit"])
@pytest.mark.parametrize("speed", [0.05, 0.2, 2.0])
@pytest.mark.parametrize(
    "material", [{"restitution": 0.5}, {"stiffness": 1e9, "damping": 0.5, "friction": 0.5}]
)
@pytest.mark.filterwarnings("ignore:the model has no room")
def test_a_mocap_body_carries_what_lies_on_it(speed, integrator, material):
    data, energy = run_carried(speed, integrator, material)
    top, bottom = data.mocap_pos[0, 2] + 0.01, data.qpos[2] - 0.05
    assert abs(bottom - top) < 2.5 * speed * 2e-3 + 2e-4  # seen first where it stands, then moving
    assert data.qvel[2] == pytest.approx(speed, rel=1e-3)
    # Books: what the hand did is in the height and the speed of the box, or was dissipated.
    gained = 9.81 * bottom + 0.5 * speed**2
    assert energy.work == pytest.approx(gained, rel=0.02)
    assert energy.driven == pytest.approx(energy.work + energy.dissipated, rel=2e-3)
    assert abs(energy.numerical) < 1e-3 * energy.driven
    assert 0.0 <= energy.dissipated < 0.51 * speed**2 + 0.01  # the blow at the start


@pytest.mark.parametrize("restitution", [0.5, 0.9])
@pytest.mark.filterwarnings("ignore:the model has no room")
def test_a_mocap_paddle_hits_as_a_heavy_body_on_a_joint_does(restitution):
    speeds = []
    for start in ('mocap="true"', ""):
        joint = "" if start else '<joint type="slide" axis="1 0 0"/>'
        model = mujoco.MjModel.from_xml_string(
            '<mujoco><option timestep=".0005" gravity="0 0 0"/><worldbody>'
            f'<body {start} pos="-.1 0 0">{joint}<geom type="box" size=".02 .1 .1" mass="1e6"/>'
            '</body><body><freejoint/><geom type="sphere" size=".05" mass="1"/></body>'
            "</worldbody></mujoco>"
        )
        data = mujoco.MjData(model)
        if not start:
            data.qvel[0] = 1.0
        with vc.attach(model, material={"restitution": restitution}):
            for _ in range(400):
                if start:
                    data.mocap_pos[0, 0] += model.opt.timestep
                mujoco.mj_step(model, data)
        speeds.append(data.qvel[-6])
    assert speeds[0] == pytest.approx(speeds[1], rel=1e-3)
    assert speeds[0] == pytest.approx(1.0 + restitution, rel=0.02)


@pytest.mark.filterwarnings("ignore:the model has no room")
def test_a_mocap_body_that_is_put_elsewhere_hits_nobody():
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>'
        '<body mocap="true" pos="0 0 -1"><geom type="box" size=".2 .2 .01"/></body>'
        '<body><freejoint/><geom type="box" size=".05 .05 .05" mass="1"/></body>'
        "</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        for _ in range(10):
            mujoco.mj_step(model, data)
        data.mocap_pos[0, 2] = -0.055  # 5 mm into the box, 0.5 m from where it was
        for _ in range(50):
            mujoco.mj_step(model, data)
            assert abs(data.qvel[2]) <= 0.11  # exit_speed
        assert contact.energy(data).driven == pytest.approx(0.0, abs=1e-12)


def test_a_mocap_body_moves_on_in_copies_of_the_data():
    scene = (
        '<mujoco><option timestep=".002"/><worldbody>'
        '<body mocap="true" pos="0 0 -.01"><geom type="box" size=".2 .2 .01"/></body>'
        '<body pos="0 0 .05"><freejoint/><geom type="box" size=".05 .05 .05" mass="1"/></body>'
        "</worldbody></mujoco>"
    )
    model = vc.load(scene)
    data = mujoco.MjData(model)
    with vc.attach(model):

        def lift(data, steps):
            for _ in range(steps):
                data.mocap_pos[0, 2] += 4e-4
                mujoco.mj_step(model, data)

        lift(data, 50)
        other = copy.copy(data)
        lift(data, 20)
        lift(other, 20)
        assert (data.qpos == other.qpos).all()
        assert data.qvel[2] == pytest.approx(0.2, rel=1e-3)
