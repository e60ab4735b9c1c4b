# SPDX-License-Identifier: Apache-2.0
"""The contact model in scipy's `solve_ivp`: a ball bounces, skids and rolls, with events."""

from collections.abc import Callable

import numpy as np
from scipy import integrate, optimize

import volcontact as vc

MASS, RADIUS, GRAVITY = 1.0, 0.05, 9.81  # [kg], [m], [m/s^2]
WEIGHT, INERTIA = MASS * GRAVITY, 0.4 * MASS * RADIUS**2  # [N], [kg m^2]
UP, LOAD = np.eye(10)[2], np.array([0.0, 0.0, WEIGHT])
CONTACT = vc.ContactModel(
    pairs=[vc.Pair(vc.Sphere(radius=RADIUS), vc.HalfSpace())],
    normal=vc.VolumeSpring(stiffness=1e8),
    friction=vc.RegularizedCoulomb(friction=0.3, slip_speed=1e-4),
    rolling=False,
)


def report_of(y: np.ndarray) -> vc.ContactReport:
    """Of the state y: position [m], angular velocity [rad/s], velocity [m/s], energy lost [J]."""
    X_WA = np.eye(4)  # a ball looks the same however it turns
    X_WA[:3, 3] = y[:3]
    return CONTACT.evaluate(X_WA=X_WA, V_WA=y[3:9])


def slopes(_: float, y: np.ndarray) -> np.ndarray:
    """dy/dt."""
    r = report_of(y)
    return np.r_[y[6:9], r.torque_on_A / INERTIA, (r.force_on_A - LOAD) / MASS, r.power.sum]


def energy(y: np.ndarray) -> float:
    """What the ball has, the floor stores and friction has taken [J]: constant."""
    moves = 0.5 * (MASS * y[6:9] @ y[6:9] + INERTIA * y[3:6] @ y[3:6])
    return moves + WEIGHT * y[2] + report_of(y).elastic_energy + y[9]


def run(start: np.ndarray, event: Callable, direction: int) -> tuple[float, np.ndarray]:
    """Solves until event(t, y) crosses zero in `direction`; returns the time and the state."""
    event.terminal, event.direction = True, direction
    go = integrate.solve_ivp(slopes, (0, 2), start, "LSODA", events=event, rtol=1e-9, atol=1e-11)
    return go.t[-1], go.y[:, -1]


def main() -> None:
    """Prints the times of touch, release and rolling, and what the energy account misses."""
    fall, touch = run(0.1 * UP, lambda _, y: y[2] - RADIUS, -1)
    lasts, leave = run(touch, lambda _, y: y[2] - RADIUS, 1)
    print(f"touch {fall:.9f} s, for {lasts:.9f} s, misses {energy(leave) - energy(0.1 * UP):.1e} J")
    skid = RADIUS * UP + np.eye(10)[6]  # at 1 m/s along x, as deep as its weight presses it
    skid[2] -= optimize.brentq(lambda h: report_of(skid - h * UP).force_on_A[2] - WEIGHT, 0, 0.01)
    time, rolls = run(skid, lambda _, y: report_of(y).sites[0].slip[0] - 1e-2, -1)
    print(f"rolls {time:.9f} s, {rolls[6]:.6f} m/s, misses {energy(rolls) - energy(skid):.1e} J")


if __name__ == "__main__":
    main()
