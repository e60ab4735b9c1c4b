# SPDX-License-Identifier: Apache-2.0
"""`Contact.surface`: the shape of a contact site, for pictures."""

import mujoco
import numpy as np
import pytest

import volcontact as vc

SCENE = """
<mujoco>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body pos="0 0 0.049"><freejoint/><geom type="sphere" size="0.05" mass="1"/></body>
    <body pos="1 0 0.0995" euler="0 0 30"><freejoint/><geom type="box" size=".2 .1 .1"/></body>
  </worldbody>
</mujoco>
"""


def volume(points, faces):
    a, b, c = (points[faces[:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0


def area(points, faces):
    a, b, c = (points[faces[:, i]] for i in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


@pytest.fixture
def scene():
    model = vc.load(SCENE)
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        yield contact, data


def test_body_and_patch_have_the_volume_and_the_area_of_the_site(scene):
    contact, data = scene
    sites = contact.sites(data)
    assert len(sites) == 2
    for i, site in enumerate(sites):
        surface = contact.surface(data, i, resolution=48)
        assert volume(*surface.body()) == pytest.approx(site["volume"], rel=0.01)
        assert volume(*surface.body(stretch=20)) == pytest.approx(20 * site["volume"], rel=0.01)
        assert area(*surface.patch) == pytest.approx(site["area"], rel=0.01)
        points, _ = surface.patch
        assert np.allclose(points[:, 2], -0.5 * site["depth"], atol=0.6 * site["depth"])


@pytest.mark.parametrize(
    ("site", "options", "message"),
    [
        (2, {}, "site = 2 must be from 0 to 1: there are 2 sites"),
        (-1, {}, "site = -1 must be from 0"),
        (0, {"resolution": 1}, "resolution = 1 must be from 2 to 256"),
        (0, {"resolution": 257}, "resolution = 257 must be"),
    ],
)
def test_wrong_numbers_are_named(scene, site, options, message):
    contact, data = scene
    with pytest.raises(ValueError, match=message):
        contact.surface(data, site, **options)


def test_where_nothing_touches_no_site_has_a_surface():
    model = vc.load(
        "<mujoco><worldbody><geom size='1'/><body pos='0 0 9'><freejoint/>"
        "<geom size='1'/></body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        with pytest.raises(ValueError, match="site = 0: nothing touches"):
            contact.surface(data, 0)


@pytest.mark.parametrize("stretch", [0.0, -1.0, float("nan")])
def test_stretch_is_above_zero(scene, stretch):
    contact, data = scene
    with pytest.raises(ValueError, match="stretch = "):
        contact.surface(data, 0).body(stretch)
