# SPDX-License-Identifier: Apache-2.0
"""The contact model without MuJoCo."""

from __future__ import annotations

import numpy as np
import pytest

import volcontact as vc


def sphere_on_plane() -> vc.ContactModel:
    return vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(0.05), vc.HalfSpace())],
        normal=vc.HuntCrossley(stiffness=1e8, damping=0.3),
        friction=vc.RegularizedCoulomb(friction=0.4, slip_speed=1e-3),
    )


def resting_pose() -> np.ndarray:
    pose = np.eye(4)
    pose[2, 3] = 0.05 - 0.792364e-3
    return pose


def test_static_depth_carries_the_weight() -> None:
    report = sphere_on_plane().evaluate(X_WA=resting_pose(), X_WB=np.eye(4))
    # k pi h^2 (3R - h)/3 = m g for m = 1 kg at h = 0.792364 mm, six digits of depth.
    assert report.force_on_A[2] == pytest.approx(9.81, rel=2e-6)
    np.testing.assert_allclose(report.force_on_A, -report.force_on_B, atol=1e-12)


def test_sliding_friction_opposes_the_slip() -> None:
    report = sphere_on_plane().evaluate(
        X_WA=resting_pose(), V_WA=np.array([0.0, 0.0, 0.0, 0.3, 0.4, 0.0])
    )
    site = report.sites[0]
    assert site.normal_force == pytest.approx(9.81, rel=2e-6)
    tangential = site.force_on_A - site.normal_force * site.normal
    np.testing.assert_allclose(tangential, -0.4 * site.normal_force * np.array([0.6, 0.8, 0.0]))
    assert report.power.slide == pytest.approx(0.4 * site.normal_force * 0.5)


def test_wrong_state_size_is_named() -> None:
    with pytest.raises(ValueError, match="rows of state have 3 numbers, those of the model have 0"):
        sphere_on_plane().evaluate(state=np.zeros((1, 3)))


def test_forced_engine_must_serve() -> None:
    with pytest.raises(ValueError, match="engine clip does not serve the pair sphere - half_space"):
        vc.ContactModel(
            pairs=[vc.Pair(vc.Sphere(0.05), vc.HalfSpace())],
            normal=vc.VolumeSpring(stiffness=1.0),
            engine="clip",
        )
