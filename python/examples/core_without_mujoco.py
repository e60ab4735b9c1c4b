# SPDX-License-Identifier: Apache-2.0
"""The contact model alone, in a simulator of twelve lines: a ball drops on a floor.

./run python python/examples/core_without_mujoco.py
"""

import numpy as np

import volcontact as vc

MASS, RADIUS, GRAVITY = 1.0, 0.05, 9.81  # [kg], [m], [m/s^2]
STEP = 1e-4  # [s]


def main() -> None:
    """Steps by the symplectic Euler rule until the ball is at rest."""
    contact = vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(radius=RADIUS), vc.HalfSpace())],
        normal=vc.HuntCrossley(stiffness=1e8, damping=2.0),
        friction=vc.RegularizedCoulomb(friction=0.3, slip_speed=1e-2),
    )
    X_WA, V_WA = np.eye(4), np.zeros(6)  # pose and (angular, linear) velocity of the ball
    X_WA[2, 3] = 0.1
    for _ in range(20_000):
        report = contact.evaluate(X_WA=X_WA, V_WA=V_WA)
        force = report.force_on_A - [0.0, 0.0, MASS * GRAVITY]
        V_WA[:3] += STEP * report.torque_on_A / (0.4 * MASS * RADIUS**2)
        V_WA[3:] += STEP * force / MASS
        X_WA[:3, 3] += STEP * V_WA[3:]  # a ball looks the same however it turns
    depth = RADIUS - X_WA[2, 3]
    weight = 1e8 * np.pi * depth**2 * (3 * RADIUS - depth) / 3
    print(f"at rest {1e3 * depth:.6f} mm deep, where the cap carries {weight:.6f} N")


if __name__ == "__main__":
    main()
