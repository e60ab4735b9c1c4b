# SPDX-License-Identifier: Apache-2.0
"""Sites as forces at points, for hosts of flexible bodies: together they are the wrenches."""

import numpy as np
import pytest

import volcontact as vc

ALONG_Y = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, -1.0, 0, 0], [0, 0, 0, 1.0]])


def turned(angle, position):
    """A pose turned about x."""
    X = np.eye(4)
    X[1:3, 1:3] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    X[:3, 3] = position
    return X


def shifted(x):
    return turned(0.0, (x, 0.0, 0.0))


SCENES = {
    "ball on plane": ([vc.Pair(vc.Sphere(0.05), vc.HalfSpace())], turned(0.0, (3, -1, 0.049)), 1),
    "tilted box": (
        [vc.Pair(vc.Box((0.1, 0.08, 0.05)), vc.Box((0.5, 0.5, 0.05)))],
        turned(0.02, (0.1, 0.0, 0.0985)),
        1,
    ),
    "dumbbell": (
        [vc.Pair(vc.Sphere(0.05), vc.HalfSpace(), X_Aa=shifted(x)) for x in (-0.2, 0.0, 0.2)],
        turned(0.0, (0, 0, 0.0495)),
        3,
    ),
    "peg jammed in a bore": (
        [
            vc.Pair(
                vc.Cylinder(radius=0.02, half_length=0.04),
                vc.Box((0.06, 0.06, 0.03)) - vc.Cylinder(radius=0.0205, half_length=0.05),
            )
        ],
        turned(0.03, (0, 0, 0)),
        2,
    ),
    "ball in a bore": (
        [
            vc.Pair(
                vc.Sphere(0.1),
                vc.Box((1.2, 1.0, 1.2)) - vc.Cylinder(radius=1.0, half_length=1.1).posed(ALONG_Y),
            )
        ],
        turned(0.0, (0.1, 0.2, -np.sqrt(0.905**2 - 0.01))),
        1,
    ),
}
FRICTION = {
    "quadrature": vc.RegularizedCoulomb(friction=0.3, coupling="quadrature"),
    "bristle": vc.Bristle(friction=0.3, static_friction=0.4, coupling="ellipsoid"),
    "elastic": vc.ElasticCoulomb(friction=0.3),
    "none": None,
}


@pytest.mark.parametrize("law", FRICTION)
@pytest.mark.parametrize("name", SCENES)
def test_forces_at_points_sum_to_the_wrenches(name, law):
    pairs, X_WA, count = SCENES[name]
    model = vc.ContactModel(
        pairs=pairs, normal=vc.HuntCrossley(stiffness=1e8, damping=0.5), friction=FRICTION[law]
    )
    X_WB = np.eye(4)
    V_WA = np.array([0.3, -0.2, 2.0, 0.1, 0.05, -0.02])
    V_WB = np.array([0.0, 0.1, 0.0, 0.0, 0.01, 0.0])
    state = None
    for step in range(3):
        X = X_WA.copy()
        X[0, 3] += 1e-5 * step
        report = model.evaluate(
            X_WA=X, X_WB=X_WB, V_WA=V_WA, V_WB=V_WB, state=state, elapsed=1e-4 if step else 0.0
        )
        state = report.state
        assert len(report.sites) == count
        for origin, sign, force, torque in (
            (X[:3, 3], 1.0, report.force_on_A, report.torque_on_A),
            (X_WB[:3, 3], -1.0, report.force_on_B, report.torque_on_B),
        ):
            forces = np.array([sign * site.force_on_A for site in report.sites])
            arms = np.array([site.metrics.centroid - origin for site in report.sites])
            own = np.array([sign * site.torque_on_A for site in report.sites])
            moments = np.cross(arms, forces)
            scale = np.abs(forces).sum()
            assert np.abs(forces.sum(0) - force).max() <= 1e-12 * scale
            scale = np.abs(moments).sum() + np.abs(own).sum()
            assert np.abs((moments + own).sum(0) - torque).max() <= 1e-12 * scale
        assert all(site.normal_force > 0.0 for site in report.sites)


def test_second_moment_of_a_cap_is_its_closed_form():
    """Of a spherical cap of height h, about its centroid: a solid of revolution."""
    radius, depth = 0.05, 0.004
    report = vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(radius), vc.HalfSpace())], normal=vc.VolumeSpring()
    ).evaluate(X_WA=turned(0.0, (0, 0, radius - depth)))
    (site,) = report.sites
    # Discs of radius rho^2 = R^2 - z^2 from z = R - h to R: int rho^4 pi/4 dz and int z^k rho^2 pi.
    z, weights = np.polynomial.legendre.leggauss(12)
    z, weights = radius + 0.5 * depth * (z - 1.0), 0.5 * depth * weights
    squared = radius**2 - z**2
    across = np.pi / 4 * weights @ squared**2
    volume, first, second = (np.pi * weights @ (squared * z**k) for k in range(3))
    along = second - first**2 / volume
    expected = np.diag([across, across, along])
    assert np.abs(site.metrics.second_moment - expected).max() < 1e-10 * across
