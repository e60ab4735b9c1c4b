# SPDX-License-Identifier: Apache-2.0
"""Flush boxes are told as what they are: one solid of several geoms."""

import math

import mujoco
import numpy as np
import pytest

import volcontact as vc

SCENE = """
<mujoco>
  <worldbody>
    <geom name="left" type="box" size=".2 .2 .05" pos="-.2 0 -.05"/>
    <geom name="right" type="box" size=".2 .2 .05" pos=".2 0 -.05"/>
    <geom name="apart" type="box" size=".2 .2 .05" pos=".8 0 -.05"/>
    <body name="ball" pos="0 0 .049"><freejoint/>
      <geom name="ball" type="sphere" size=".05" mass="1"/></body>
  </worldbody>
</mujoco>"""


@pytest.fixture
def scene():
    material = {"stiffness": 1e8, "damping": 0.0, "friction": 0.0}
    options = {"implicit": "off"}  # forces are those of the pose
    model = vc.load(SCENE, material=material, options=options)
    with vc.attach(model, material=material, options=options) as contact:
        yield model, mujoco.MjData(model), contact


def test_description_names_the_geoms_that_are_one_solid(scene):
    _, _, contact = scene
    assert contact.description["flush_solids"] == [{"geoms": ["left", "right"]}]


def test_one_solid_has_nothing_that_is_flush():
    model = vc.load(SCENE.replace('pos=".2 0 -.05"', 'pos=".201 0 -.05"'))
    with vc.attach(model) as contact:
        assert contact.description["flush_solids"] == []


@pytest.mark.parametrize("x", [-0.02, -0.003, 0.003, 0.02])
def test_a_site_across_the_seam_is_that_of_one_floor(scene, x):
    model, data, contact = scene
    data.qpos[0] = x
    mujoco.mj_forward(model, data)
    (site,) = contact.sites(data)
    h, radius = 0.001, 0.05  # cap of a ball
    volume = math.pi * h * h * (3 * radius - h) / 3
    assert site["volume"] == pytest.approx(volume, rel=1e-9)
    assert site["area"] == pytest.approx(math.pi * h * (2 * radius - h), rel=1e-9)
    assert site["depth"] == pytest.approx(h, rel=1e-9)
    assert site["normal"] == pytest.approx([0.0, 0.0, -1.0], abs=1e-12)
    assert site["centroid"][:2] == pytest.approx([x, 0.0], abs=1e-12)
    # Two equal sides in series: half the stiffness.
    assert site["force"] == pytest.approx([0.0, 0.0, -5e7 * volume], rel=1e-9, abs=1e-9)
    # Told with the geom in which its centroid lies, and with the pair of that.
    left, right, ball = (
        mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, name)
        for name in ("left", "right", "ball")
    )
    assert (site["geom_a"], site["geom_b"]) == (left if x < 0 else right, ball)
    (pair,) = (p for p in contact.description["pairs"] if p["pair"] == site["pair"])
    assert pair["geom_a"] == ("left" if x < 0 else "right")
    assert pair["geom_b"] == "ball"


def test_what_sites_contacts_and_arrays_say_is_one_force(scene):
    model, data, contact = scene
    data.qpos[:3] = 0.003, 0.01, 0.049
    mujoco.mj_forward(model, data)
    (site,) = contact.sites(data)
    assert data.qfrc_applied[:3] == pytest.approx(-site["force"], rel=1e-12, abs=1e-12)
    stored = 5e7 * math.pi * (0.05 * 0.001**3 / 3 - 0.001**4 / 12)  # k int int V dh, of the cap
    assert contact.energy(data).elastic == pytest.approx(site["elastic_energy"], rel=1e-12)
    assert site["elastic_energy"] == pytest.approx(stored, rel=1e-6)


def test_a_ball_rolls_over_seams_as_over_one_floor():
    places = [(-0.45 + 0.1 * i, -0.15 + 0.1 * j) for i in range(10) for j in range(4)]
    tiles = "".join(
        f'<geom type="box" size=".05 .05 .02" pos="{x:.2f} {y:.2f} -.02"/>' for x, y in places
    )
    ends = []
    for floor in (tiles, '<geom type="box" size=".5 .2 .02" pos="0 0 -.02"/>'):
        model = vc.load(
            '<mujoco><option timestep="2e-3"/><worldbody>' + floor + '<body pos="-.4 .01 .0499">'
            '<freejoint/><geom size=".05" mass="1"/></body></worldbody></mujoco>'
        )
        data = mujoco.MjData(model)
        data.qvel[:] = 0.8, 0.05, 0.0, 0.0, 2.0, 30.0
        with vc.attach(model):
            mujoco.mj_step(model, data, 400)
        ends.append(np.concatenate([data.qpos, data.qvel]))
    assert ends[0] == pytest.approx(ends[1], abs=1e-9)
    assert ends[0][0] > 0.0  # over at least four seams
