# SPDX-License-Identifier: Apache-2.0
"""The drawn surface of solids against volumes in closed form; pictures with open holes."""

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact.report.solids_drawing import solids_of, surface

SCENE = """
<mujoco>
  <statistic center="0 0 0" extent="0.3"/>
  <worldbody>
    <camera name="above" pos="0 0 0.5" fovy="40"/>
    <body name="block">
      <geom name="block" type="box" size="0.1 0.08 0.03"/>
      <geom name="bore" type="cylinder" size="0.04 0.05" mass="0"/>
      <geom name="knob" type="sphere" pos="0.1 0 0" size="0.02" mass="0"/>
    </body>
    <body name="peg" pos="0 0 0.3">
      <freejoint/><geom name="peg" type="{peg}" size="0.02 0.03 0.04"/>
    </body>
  </worldbody>
  <custom>
    <tuple name="volcontact/solid/bored">
      <element objtype="geom" objname="block" prm="1"/>
      <element objtype="geom" objname="bore" prm="-1"/>
      <element objtype="geom" objname="knob" prm="1"/>
    </tuple>
    <numeric name="volcontact/material/brass/stiffness" data="1e9"/>
    <tuple name="volcontact/material/brass"><element objtype="body" objname="peg"/></tuple>
  </custom>
</mujoco>
"""


def volume(triangles):
    points, faces = triangles
    a, b, c = (points[faces[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0


def surfaces(scene):
    model = vc.load(scene)
    with vc.attach(model) as contact:
        (pair,) = contact.description["pairs"]
        return [surface(steps) for _, steps in solids_of(contact._pair_text(pair["pair"]))]


def test_composed_solid_is_closed_and_faces_out():
    block, _ = surfaces(SCENE.format(peg="sphere"))
    # Box less a 32-sided prism that stands for the bore, and the half of a ball outside of it.
    prism = 0.5 * 32 * np.sin(2 * np.pi / 32) * 0.04**2 * 0.06
    knob = 0.5 * 4.0 / 3.0 * np.pi * 0.02**3
    assert volume(block) == pytest.approx(8 * 0.1 * 0.08 * 0.03 - prism + knob, rel=2e-3)


@pytest.mark.parametrize(
    ("peg", "expected"),
    [
        ("sphere", 4 / 3 * np.pi * 0.02**3),
        ("ellipsoid", 4 / 3 * np.pi * 0.02 * 0.03 * 0.04),
        ("capsule", 4 / 3 * np.pi * 0.02**3 + 2 * np.pi * 0.02**2 * 0.03),
        ("cylinder", 2 * np.pi * 0.02**2 * 0.03),
        ("box", 8 * 0.02 * 0.03 * 0.04),
    ],
)
def test_volume_of_the_shapes(peg, expected):
    _, drawn = surfaces(SCENE.format(peg=peg))
    assert volume(drawn) == pytest.approx(expected, rel=0.02)  # of 32 chords


def test_hole_is_open_in_the_picture():
    from volcontact.report.palette import MATERIALS, rgb
    from volcontact.report.solids_picture import draw_solids
    from volcontact.running.probes import recorded_sites

    model = vc.load(SCENE.format(peg="sphere").replace('pos="0 0 0.3"', 'pos="0.3 0 0.3"'))
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        mujoco.mj_forward(model, data)
        sites = recorded_sites(contact.sites(data))
        picture = draw_solids(contact, data, sites, width=160, height=120, camera="above")
    middle, beside = picture[60, 80].astype(int), picture[60, 55].astype(int)
    assert middle.min() > 180  # the background shines through
    assert beside.max() < 180
    # The legend begins with the one material that has a name.
    swatch = np.array(rgb(MATERIALS[0])) * 255
    np.testing.assert_allclose(picture[14, 14], swatch, atol=1.5)
