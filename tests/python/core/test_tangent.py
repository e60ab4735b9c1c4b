# SPDX-License-Identifier: Apache-2.0
"""How the wrenches change with the motion, as Python sees it."""

import numpy as np
import pytest

import volcontact as vc

RADIUS, DEPTH, STIFFNESS, DAMPING = 0.05, 0.002, 1e8, 0.5


def ball(friction=None):
    return vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(RADIUS), vc.HalfSpace())],
        normal=vc.HuntCrossley(stiffness=STIFFNESS, damping=DAMPING),
        friction=friction,
    )


def at(height):
    X = np.eye(4)
    X[:3, 3] = 0.3, -0.1, height
    return X


def wrenches(report):
    return np.r_[report.torque_on_A, report.force_on_A, report.torque_on_B, report.force_on_B]


def test_is_none_unless_asked_for():
    assert ball().evaluate(X_WA=at(RADIUS - DEPTH)).tangent is None


def test_ball_on_plane_has_the_stiffness_of_its_cap():
    report = ball().evaluate(X_WA=at(RADIUS - DEPTH), tangent=True)
    area = np.pi * DEPTH * (2.0 * RADIUS - DEPTH)  # dV/dz
    volume = np.pi * DEPTH**2 * (RADIUS - DEPTH / 3.0)
    assert report.tangent.by_motion[5, 5] == pytest.approx(-STIFFNESS * area, rel=1e-9)
    assert report.tangent.by_speed[5, 5] == pytest.approx(-STIFFNESS * volume * DAMPING, rel=1e-9)


@pytest.mark.parametrize("coupling", ["none", "ellipsoid", "quadrature"])
def test_change_with_speed_is_that_of_differences(coupling):
    model = ball(vc.RegularizedCoulomb(friction=0.3, slip_speed=1e-2, coupling=coupling))
    V_WA, X_WA = np.array([0.2, 1.0, 3.0, 0.1, -0.05, -0.02]), at(RADIUS - DEPTH)
    tangent = model.evaluate(X_WA=X_WA, V_WA=V_WA, tangent=True).tangent.by_speed
    step, found = 1e-6, np.empty((12, 6))
    for i in range(6):
        more, less = (
            wrenches(model.evaluate(X_WA=X_WA, V_WA=V_WA + sign * step * np.eye(6)[i]))
            for sign in (1.0, -1.0)
        )
        found[:, i] = (more - less) / (2.0 * step)
    assert np.abs(found - tangent[:, :6]).max() < 1e-4 * np.abs(found).max()


def test_asking_changes_no_other_number():
    model = ball(vc.Bristle(friction=0.3, static_friction=0.4))
    state = None
    V_WA = np.array([0.0, 0.5, 1.0, 0.01, 0.0, 0.0])
    for step in range(4):
        X_WA = at(RADIUS - DEPTH)
        X_WA[0, 3] += 1e-5 * step
        motion = dict(X_WA=X_WA, V_WA=V_WA, state=state, elapsed=1e-3)
        plain, asked = model.evaluate(**motion), model.evaluate(**motion, tangent=True)
        assert np.array_equal(wrenches(plain), wrenches(asked))
        assert np.array_equal(plain.state, asked.state)
        state = plain.state


def test_bodies_that_move_together_keep_their_forces():
    friction = vc.RegularizedCoulomb(friction=0.3, slip_speed=1e-2)
    report = ball(friction).evaluate(
        X_WA=at(RADIUS - DEPTH), V_WA=np.array([0.0, 1.0, 0.0, 0.1, 0.0, 0.0]), tangent=True
    )
    together = report.tangent.by_motion[:, 3:6] + report.tangent.by_motion[:, 9:12]
    scale = np.abs(report.tangent.by_motion).max()
    assert np.abs(together).max() < 1e-12 * scale
    forces = report.tangent.by_motion[3:6] + report.tangent.by_motion[9:12]
    assert np.abs(forces).max() < 1e-12 * scale
