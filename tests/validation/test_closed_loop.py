# SPDX-License-Identifier: Apache-2.0
"""A box is led round a closed path in a floor: the work of the contact is zero."""

from __future__ import annotations

import math

import numpy as np
from case import NO_FIELD, Bounds, Case

import volcontact as vc

STIFFNESS, SAMPLES = 2e6, 20000


def measure() -> Case:
    """Work round loops of height and tilt, over the largest stored energy."""
    case = Case(
        "Closed loop",
        "A box with its edge or corner in a half-space is moved along a closed path in height and "
        "tilt. The force k_v V at the centroid of the volume is conservative there, so its work is "
        "zero, up to the error of summing it over 20000 points; at the centroid of the footprint "
        "it would be 9 % of the stored energy, at the deepest point 17 %.",
    )
    model = vc.ContactModel(
        pairs=[vc.Pair(vc.Box(half_sizes=(0.1, 0.08, 0.05)), vc.HalfSpace())],
        normal=vc.VolumeSpring(stiffness=STIFFNESS),
    )
    for name, roll in (("edge", 0.0), ("corner", 0.3)):
        work, stored = 0.0, 0.0
        for i in range(SAMPLES):
            s = 2.0 * math.pi * i / SAMPLES
            height, tilt = 0.055 + 0.004 * math.cos(s), 0.35 + 0.12 * math.sin(s)
            c, t = math.cos(tilt), math.sin(tilt)
            about_y = np.array([[c, 0.0, t], [0.0, 1.0, 0.0], [-t, 0.0, c]])
            c, t = math.cos(roll), math.sin(roll)
            about_x = np.array([[1.0, 0.0, 0.0], [0.0, c, -t], [0.0, t, c]])
            pose = np.eye(4)
            pose[:3, :3] = about_y @ about_x
            pose[2, 3] = height
            report = model.evaluate(X_WA=pose)
            step = 2.0 * math.pi / SAMPLES
            work += step * report.force_on_A[2] * -0.004 * math.sin(s)
            work += step * report.torque_on_A[1] * 0.12 * math.cos(s)
            stored = max(stored, report.elastic_energy)
        name = f"{name}: work over stored energy"
        case.figures.append(Bounds(name, "-", 0.0, 1e-12, abs(work) / stored, NO_FIELD))
    return case


def test_closed_loop() -> None:
    measure().check()
