# SPDX-License-Identifier: Apache-2.0
"""A disc slides and spins: both end at once, and where they end tells how they are coupled."""

from __future__ import annotations

import numpy as np
import pytest
from case import NO_ACCOUNT, Case, Curve, Figure, Plot, Run, load, simulate

RADIUS = 0.05
# Time [s] and way [m] until rest; independent integrations of the motion with the elliptic
# integrals of a uniform disc, with the ellipsoid, and with plain Coulomb friction.
EXPECTED = {
    "quadrature": (0.45542, 0.21658, 3e-3),
    "ellipsoid": (0.41616, 0.20808, 1e-3),
    "none": (0.33979, 0.16989, 1e-3),
}


def slide(coupling: str, spin: float = 20.0, *, native: bool = False) -> Run:
    """Rows of time, speed, spin, way."""
    choices = {f"pair__disc__coupling__{name}": float(name == coupling) for name in EXPECTED}
    model = load("spinning_disc/scene.xml", **choices)

    def spin_up(_, data) -> None:
        data.qvel[5] = spin

    return simulate(
        model,
        0.7,
        lambda _, d: (d.qvel[0], d.qvel[5], d.qpos[0]),
        every=4,
        setup=spin_up,
        native=native,
    )


def rest(rows: np.ndarray, *, spins: bool) -> float:
    """When the motion ends [s]: the line through two late samples, extended to zero."""
    speed = np.hypot(rows[:, 1], RADIUS * rows[:, 2]) if spins else np.abs(rows[:, 1])
    if speed.min() > 0.01:
        return float("nan")
    i, j = int(np.argmax(speed < 0.06)), int(np.argmax(speed < 0.03))
    return float(rows[j, 0] + (rows[j, 0] - rows[i, 0]) * speed[j] / (speed[i] - speed[j]))


def measure() -> Case:
    """Three couplings, and a second spin for the exact one."""
    case = Case(
        "Disc that slides and spins",
        "A flat disc slides at 1 m/s and spins at 20 rad/s. With friction integrated over its "
        "patch it slides further than with plain Coulomb friction, and both motions end together "
        "with v = 0.653 R w; the ellipsoid approximates that.",
    )
    native, native_fast = slide("none", native=True), slide("none", 40.0, native=True)
    own = rest(native.rows, spins=True), native.rows[-1, 3]  # whatever the coupling
    fast_own = rest(native_fast.rows, spins=True), native_fast.rows[-1, 3]
    curves = []
    for coupling, (time, way, tolerance) in EXPECTED.items():
        run = slide(coupling)
        case.account(run)
        case.figures += [
            Figure(
                f"{coupling}: rest",
                "s",
                time,
                tolerance,
                rest(run.rows, spins=coupling != "none"),
                own[0],
            ),
            Figure(
                f"{coupling}: way",
                "m",
                way,
                tolerance,
                run.rows[-1, 3],
                own[1],
            ),
        ]
        if (
            coupling == "quadrature"
        ):  # m v^2 / 2 and I w^2 / 2 of the start, each through its own channel
            case.figures += [
                Figure(f"dissipated by {kind}", "J", energy, 1e-6, float(spent), NO_ACCOUNT)
                for kind, energy, spent in (
                    ("sliding", 0.5, run.dissipated[2]),
                    ("spinning", 0.25, run.dissipated[3]),
                )
            ]
        curves.append(Curve(coupling, run.rows[:, 0], run.rows[:, 1]))
    for coupling, time, way, tolerance in (
        ("quadrature", 0.64669, 0.33418, 3e-3),
        ("ellipsoid", 0.58853, 0.29427, 1e-3),
    ):
        fast = slide(coupling, 40.0)
        case.account(fast)
        ends, name = rest(fast.rows, spins=True), f"{coupling}, 40 rad/s"
        case.figures += [
            Figure(f"{name}: rest", "s", time, tolerance, ends, fast_own[0]),
            Figure(f"{name}: way", "m", way, tolerance, fast.rows[-1, 3], fast_own[1]),
        ]
    curves.append(Curve("native", native.rows[:, 0], native.rows[:, 1], "--"))
    case.plots.append(Plot("speed", "time [s]", "speed [m/s]", tuple(curves)))
    return case


@pytest.mark.once
def test_spinning_disc() -> None:
    measure().check()
