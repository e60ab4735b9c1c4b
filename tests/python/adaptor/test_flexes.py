# SPDX-License-Identifier: Apache-2.0
"""Flexes keep MuJoCo's own contact beside volumetric contact of geoms."""

import mujoco
import numpy as np
import pytest

import volcontact as vc

pytestmark = pytest.mark.skipif(not hasattr(mujoco, "MjSpec"), reason="this MuJoCo has no flexes")

CLOTH = """
<mujoco><option timestep="0.002" solver="CG" tolerance="1e-6"/><size memory="20M"/><worldbody>
  <geom name="floor" type="plane" size="3 3 .1"/>
  <geom name="table" type="box" size=".2 .2 .1" pos="0 0 .1"/>
  <flexcomp name="cloth" type="grid" dim="2" count="5 5 1" spacing=".06 .06 .06" pos="0 0 .25"
            mass=".2" radius=".01"><contact selfcollide="none"/><edge equality="true"/></flexcomp>
  <body name="cube" pos="1 0 .0999"><freejoint/><geom name="cube" type="box" size=".1 .1 .1"
    mass="1"/></body>
</worldbody></mujoco>"""


def lowest(data: mujoco.MjData) -> float:
    """Height of the lowest vertex of the cloth [m]."""
    return float(data.flexvert_xpos.reshape(-1, 3)[:, 2].min())


def test_a_cloth_lies_as_without_volumetric_contact():
    heights = []
    for volumetric in (True, False):
        model = mujoco.MjModel.from_xml_string(CLOTH)
        data = mujoco.MjData(model)
        contact = vc.attach(model, material={"stiffness": 1e8}) if volumetric else None
        for _ in range(500):
            mujoco.mj_step(model, data)
        heights.append(lowest(data))
        geoms = np.asarray([tuple(c.geom) for c in data.contact[: data.ncon]])
        if contact:
            with contact:
                # The cube lies on volumetric contact alone, the cloth on MuJoCo's.
                assert len(contact.sites(data)) == 1
                assert data.ncon > 0
                assert np.all((geoms < 0).any(axis=1))
        else:
            assert np.all(geoms >= 0, axis=1).any()
    assert heights[0] == pytest.approx(heights[1], abs=1e-6)
    assert 0.19 < heights[0] < 0.22


def test_check_says_that_flexes_stay_native():
    model = mujoco.MjModel.from_xml_string(CLOTH)
    with vc.attach(model) as contact:
        warnings = contact.description["warnings"]
    assert any("flexes have no volumetric contact: they keep MuJoCo's own" in w for w in warnings)
