# SPDX-License-Identifier: Apache-2.0
"""Head-on impacts of a ball without gravity: the restitution of a damping, and that asked for."""

from __future__ import annotations

from case import Case, Figure, load, simulate
from scenes import over_floor

# a v_i with e, from ln((1 + A)/(1 - e A)) = A (1 + e): docs/theory.md, "Restitution".
TABLE = {
    0.01: 0.993377,
    0.05: 0.967739,
    0.1: 0.937476,
    0.2: 0.882190,
    0.5: 0.748435,
    1.0: 0.593624,
    2.0: 0.410720,
    5.0: 0.196980,
    10.0: 0.099982,
}


def rebound(key: str, value: float, speed: float, case: Case, *, native: bool = False) -> float:
    """Speed after the impact over that before it [-]."""
    scene = over_floor(
        'size="0.05"', height=0.0500001, step=1e-5, speed=speed, stiffness=1e9, **{key: value}
    )
    run = simulate(load(scene), 0.06, lambda m, d: (d.qvel[2], d.qpos[2]), every=50, native=native)
    assert native or run.rows[-1, 2] > 0.05, "still in contact"
    if not native:
        case.account(run)
    return float(run.rows[-1, 1]) / speed


def measure() -> Case:
    """All impacts."""
    case = Case(
        "Restitution",
        "A ball hits a floor without gravity. The restitution e follows from the damping a and "
        "the impact speed alone, whatever the stiffness, the shape and the mass; and a "
        "restitution that is asked for is had at every speed.",
    )
    own = rebound("damping", 0.0, 0.7, case, native=True)  # whatever the damping
    for product, expected in TABLE.items():
        measured = rebound("damping", product / 0.7, 0.7, case)
        name = f"e at a v = {product:g}"
        case.figures.append(Figure(name, "-", expected, 1e-4 / expected, measured, own))
    for asked in (0.9, 0.8, 0.5):
        for speed in (0.1, 1.0, 3.0):
            measured = rebound("restitution", asked, speed, case)
            native = rebound("restitution", asked, speed, case, native=True)
            name = f"e = {asked:g} asked for, at {speed:g} m/s"
            case.figures.append(Figure(name, "-", asked, 1e-3, measured, native))
    return case


def test_restitution() -> None:
    measure().check()
