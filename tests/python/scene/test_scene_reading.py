# SPDX-License-Identifier: Apache-2.0
"""What an attached scene tells: sites, energy, description."""

import math

import mujoco
import numpy as np
import pytest
from balls import ball

import volcontact as vc


def test_closing_twice_does_nothing_and_close_ends_reading():
    model = vc.load(ball())
    contact = vc.attach(model)
    assert contact.is_installed() and contact.is_open
    contact.close()
    contact.close()
    assert not contact.is_installed() and not contact.is_open
    with pytest.raises(ValueError, match="closed"):
        contact.sites(mujoco.MjData(model))


def test_sites_have_the_documented_fields_and_one_row_a_site():
    model = vc.load(ball(0.1))
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        assert contact.sites(data).shape == (0,)  # before the first evaluation
        mujoco.mj_forward(model, data)
        apart = contact.sites(data)
        data.qpos[2] = 0.049
        mujoco.mj_forward(model, data)
        touching = contact.sites(data)
    assert apart.shape == (0,)
    assert apart.dtype == touching.dtype
    fields = """pair geom_a geom_b volume centroid normal area depth force torque normal_force
        slip spin elastic_energy flatness volume_error status"""
    assert sorted(touching.dtype.names) == sorted(fields.split())
    assert touching.shape == (1,)
    (site,) = touching
    # Cap of height h = 1 mm of a ball of radius R = 50 mm.
    h, radius = 0.001, 0.05
    assert site["volume"] == pytest.approx(math.pi * h * h * (3 * radius - h) / 3, rel=1e-9)
    assert site["area"] == pytest.approx(math.pi * h * (2 * radius - h), rel=1e-9)
    assert site["depth"] == pytest.approx(h, rel=1e-9)
    assert (site["geom_a"], site["geom_b"], site["pair"], site["status"]) == (0, 1, 1, 0)
    assert site["normal"] == pytest.approx([0, 0, -1])  # on the floor
    assert site["normal_force"] == pytest.approx(1e8 * site["volume"])
    assert site["force"] == pytest.approx([0, 0, -site["normal_force"]])
    assert site["flatness"] == pytest.approx(1.0)


def test_slip_and_spin_are_of_the_bodies():
    model = vc.load(ball(0.049))
    data = mujoco.MjData(model)
    data.qvel[:] = 0.3, 0.4, 0, 0, 0, 7
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        (site,) = contact.sites(data)
    assert site["slip"] == pytest.approx(0.5)
    # Of the floor against the ball about the normal on the floor, which points down.
    assert site["spin"] == pytest.approx(7.0)


def test_ball_rests_at_the_depth_that_carries_it():
    # k V(h) = m g with V = pi h^2 (3 R - h) / 3 has h = 0.792364 mm.
    model = vc.load(ball())
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        for _ in range(1000):
            mujoco.mj_step(model, data)
        energy = contact.energy(data)
    assert 0.05 - data.qpos[2] == pytest.approx(0.792364e-3, rel=1e-6)
    # Elastic energy k int L^2/2 dA of a cap: k pi h^3 (R/3 - h/12).
    h = 0.05 - data.qpos[2]
    assert energy.elastic == pytest.approx(1e8 * math.pi * h**3 * (0.05 / 3 - h / 12), rel=1e-6)


def test_energy_is_accounted_by_channel():
    model = vc.load(ball(0.08))
    data = mujoco.MjData(model)
    data.qvel[0], data.qvel[5] = 1.0, 20.0
    with vc.attach(model) as contact:
        before = contact.energy(data)
        for _ in range(300):
            mujoco.mj_step(model, data)
        energy = contact.energy(data)
        assert contact.dropped(data) == 0
    assert before.elastic == before.dissipated == 0.0
    assert energy.by_channel._fields == ("normal", "roll", "slide", "spin")
    assert energy.dissipated == pytest.approx(sum(energy.by_channel))
    assert energy.by_channel.normal > 0.1
    assert energy.by_channel.slide > 0.0
    assert energy.by_channel.spin > 0.0
    assert len(energy.power) == 4
    assert before.work == before.numerical == 0.0
    assert energy.work < -0.1
    books = energy.work + energy.elastic + energy.dissipated + energy.numerical
    assert books == pytest.approx(0.0, abs=1e-12)


def test_many_sites_are_all_returned():
    balls = "".join(
        f'<body pos="{0.2 * i} {0.2 * j} .049"><freejoint/><geom type="sphere" size=".05"/></body>'
        for i in range(10)
        for j in range(10)
    )
    model = vc.load(
        f'<mujoco><worldbody><geom type="plane" size="1 1 1"/>{balls}</worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        sites = contact.sites(data)
        again = contact.sites(data)
    assert len(sites) == 100
    assert sites["pair"].tolist() == sorted(sites["pair"])
    assert (sites == again).all()


def test_reset_starts_the_account_anew():
    model = vc.load(ball(0.08))
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        for _ in range(200):
            mujoco.mj_step(model, data)
        assert contact.energy(data).dissipated > 0.0
        mujoco.mj_resetData(model, data)
        assert contact.energy(data).dissipated == 0.0
        assert len(contact.sites(data)) == 0


@pytest.mark.parametrize("wrong", [None, 3, "data"])
def test_reading_takes_data(wrong):
    with vc.attach(vc.load(ball())) as contact, pytest.raises(TypeError, match="MjData"):
        contact.sites(wrong)


def test_data_of_another_model_are_refused():
    with vc.attach(vc.load(ball())) as contact:
        other = mujoco.MjModel.from_xml_string("<mujoco/>")
        with pytest.raises(ValueError, match="not of the attached model"):
            contact.energy(mujoco.MjData(other))


def test_description_says_what_was_understood():
    with vc.attach(vc.load(ball())) as contact:
        description = contact.description
    assert description["options"] == {
        "mesh": "exact",
        "tolerance": 1e-4,
        "engine": "auto",
        "disabled": "respect",
        "exit_speed": 0.1,
        "target": "applied",
        "pairs": "native",
        "formulation": "gonthier",
        "implicit": "auto",
        "threads": 0,
    }
    assert description["materials"]["rubber"]["geoms"] == ["floor", "ball"]
    assert description["materials"]["rubber"]["stiffness"] == 2e8
    assert description["materials"]["default"]["geoms"] == []
    floor, sphere = description["solids"]
    assert (floor["geom"], floor["shape"], floor["volume"]) == ("floor", "half_space", None)
    assert sphere["volume"] == pytest.approx(4 / 3 * math.pi * 0.05**3)
    (pair,) = description["pairs"]
    assert (pair["geom_a"], pair["geom_b"]) == ("floor", "ball")
    assert pair["engine"] == "closed_form"
    assert pair["because"] == "contype/conaffinity"
    assert pair["implicit"] == "where a patch is larger than 0.0005 m^2"  # h^2 k A/m = 0.05
    assert pair["stiffness"] == 1e8
    assert pair["sources"]["stiffness"] == "in series: volcontact/material/rubber (both)"
    assert description["warnings"] == []
    userdata = description["userdata"]
    assert userdata["needed"] == userdata["present"]


def test_description_warns_of_what_cannot_touch():
    text = '<mujoco><worldbody><geom type="box" size="1 1 1"/></worldbody></mujoco>'
    with vc.attach(vc.load(text)) as contact:
        (warning,) = contact.description["warnings"]
    assert "no two geoms can touch" in warning


def test_a_scene_asks_auto_at_every_pose():
    """Where one face of the table alone cuts the rod there is a formula; at its corner `lines` is
    asked, which the description names."""
    model = vc.load("""<mujoco><worldbody>
      <geom name="table" type="box" size="0.7 0.4 0.46" pos="0 0 -0.46"/>
      <body pos="0 0 0.01498" euler="0 90 0">
        <freejoint/><geom name="rod" type="capsule" size="0.015 0.02"/>
      </body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    floor, rod, X_FR = vc.HalfSpace(), vc.Capsule(radius=0.015, half_length=0.02), np.eye(4)

    def volume(engine: str) -> float:
        with vc.attach(model, options={"engine": engine}) as contact:
            mujoco.mj_forward(model, data)
            (site,) = contact.sites(data)
            (pair,) = contact.description["pairs"]
        assert pair["engine"] == "lines"
        return site["volume"]

    def volume_on_floor() -> float:
        X_FR[:3, :3], X_FR[:3, 3] = data.geom_xmat[1].reshape(3, 3), data.geom_xpos[1]
        return vc.interference(floor, rod, X_FR).volume

    assert volume("auto") == pytest.approx(volume_on_floor(), rel=1e-11, abs=0)
    assert volume("lines") != pytest.approx(volume_on_floor(), rel=1e-9, abs=0)
    data.qpos[0] = 0.7  # half of it is over the edge: two faces cut it
    assert volume("auto") == pytest.approx(0.5 * volume_on_floor(), rel=1e-3)
    assert volume("auto") == pytest.approx(volume("lines"), rel=1e-4, abs=0)
    assert volume("auto") != volume("lines")
    data.qpos[1] = 0.4  # and of that half
    assert volume("auto") == volume("lines") == pytest.approx(0.25 * volume_on_floor(), rel=1e-3)
