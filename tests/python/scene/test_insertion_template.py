# SPDX-License-Identifier: Apache-2.0
"""The template `insertion` against the statics of its wrist and of Coulomb friction."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

import volcontact
from volcontact.running.driving import Drive
from volcontact.running.simulation import simulate

FOLDER = Path(volcontact.__file__).parent / "templates" / "insertion"
FRICTION = 0.47
LATERAL, TILT, ARM = 5e4, 50.0, 0.04  # springs of the wrist [N/m, N m/rad], to the tip [m]
OFFSET, CLEARANCE = 0.3e-3, 0.02e-3  # of the holder, and of the diameters [m]


@pytest.fixture(scope="module", params=["scene.xml", "scene_mesh.xml"])
def run(request):
    # The press stops at 4.6 mm: on the chamfer, then one line of contact in the bore.
    times = np.array([0.0, 0.23])
    drive = Drive(table=volcontact_table(times, -0.02 * times))
    return simulate(FOLDER / request.param, duration=0.23, drive=drive, frame_interval=None)


def volcontact_table(times, press):
    from volcontact.running.control_table import ControlTable

    return ControlTable(times, {"press": press})


def test_force_on_the_chamfer_is_that_of_a_wedge(run):
    # On a slope of 45 degrees a contact that slides down has F_z / F_x = (1 + mu) / (1 - mu). The
    # patch goes round the edge of the shaft, and the wider it is the less it pushes sideways.
    depth = run.signals["joint.press.position"].values
    force = run.wrench_on["shaft"]
    rows = np.flatnonzero((depth < -0.0018) & (depth > -0.00195))
    assert len(rows) > 20
    ratio = -force[rows, 2] / force[rows, 0]
    wedge = (1.0 + FRICTION) / (1.0 - FRICTION)
    assert ratio.min() > 0.999 * wedge
    assert ratio.max() < 1.15 * wedge
    # With the normal that the patch has, the cone is met.
    for row, found in zip(rows, ratio, strict=True):
        (site,) = run.sites[run.sites["row"] == row]
        across, up = np.abs(site["normal"][[0, 2]])
        assert found == pytest.approx((up + FRICTION * across) / (across - FRICTION * up), rel=0.01)


def test_sideways_force_in_the_bore_is_that_of_the_wrist(run):
    # The tip is 0.29 mm aside of where the springs want it, by shift and tilt in series.
    depth = run.signals["joint.press.position"].values
    force = run.wrench_on["shaft"]
    row = int(np.argmin(np.abs(depth + 0.0025)))
    arm = ARM - 0.0005  # the contact is at the edge of the chamfer, 0.5 mm above the tip
    stiffness = 1.0 / (1.0 / LATERAL + arm**2 / TILT)
    expected = -(OFFSET - 0.5 * CLEARANCE) * stiffness
    assert force[row, 0] == pytest.approx(expected, rel=0.05)
    # Coulomb: the wall leans by the tilt of the shaft, 4 mrad.
    assert -force[row, 2] / force[row, 0] == pytest.approx(FRICTION + 0.0044, rel=0.02)
    assert abs(force[row, 1]) < 1e-3


def test_stiffness_is_that_of_a_press_fit_after_lame():
    model = mujoco.MjModel.from_xml_path(str(FOLDER / "scene.xml"))
    steel, aluminium = (
        float(model.numeric(f"volcontact/material/{name}/stiffness").data[0])
        for name in ("steel", "aluminium")
    )
    a, b = 5e-3, 20e-3  # bore, and half the width of the block [m]
    # Radial displacement under the pressure p: p a (1 - nu) / E of a full shaft, and
    # p a ((b^2 + a^2) / (b^2 - a^2) + nu) / E of a tube.
    shaft = 207e9 / (a * (1.0 - 0.29))
    tube = 69e9 / (a * ((b**2 + a**2) / (b**2 - a**2) + 0.33))
    assert steel == pytest.approx(shaft, rel=3e-3)
    assert aluminium == pytest.approx(tube, rel=3e-3)
