# SPDX-License-Identifier: Apache-2.0
"""A disc slides and spins: both end at once, and where they end tells how they are coupled."""

from __future__ import annotations

import numpy as np
from case import Case, Curve, Figure, Plot, Run, load, simulate

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
        "A flat disc slides at 1 m/s and spins at 20 rad/s. Friction integrated over its patch "
        "lets it slide on further than plain Coulomb friction would, and ends both at once with v "
        "= 0.653 R w; the ellipsoid is an approximation of that.",
    )
    native = slide("quadrature", native=True)
    curves = []
    for coupling, (time, way, tolerance) in EXPECTED.items():
        run = slide(coupling)
        case.closures.append(run.closure)
        of_native = coupling == "quadrature"
        case.figures += [
            Figure(
                f"{coupling}: rest",
                "s",
                time,
                tolerance,
                rest(run.rows, spins=coupling != "none"),
                rest(native.rows, spins=True) if of_native else None,
            ),
            Figure(
                f"{coupling}: way",
                "m",
                way,
                tolerance,
                run.rows[-1, 3],
                native.rows[-1, 3] if of_native else None,
            ),
        ]
        if of_native:  # m v^2 / 2 and I w^2 / 2 of the start, each through its own channel
            case.figures += [
                Figure("dissipated by sliding", "J", 0.5, 1e-6, float(run.dissipated[2])),
                Figure("dissipated by spinning", "J", 0.25, 1e-6, float(run.dissipated[3])),
            ]
        curves.append(Curve(coupling, run.rows[:, 0], run.rows[:, 1]))
    fast = slide("quadrature", 40.0)
    case.closures.append(fast.closure)
    case.figures += [
        Figure("quadrature, 40 rad/s: rest", "s", 0.64669, 3e-3, rest(fast.rows, spins=True)),
        Figure("quadrature, 40 rad/s: way", "m", 0.33418, 3e-3, fast.rows[-1, 3]),
    ]
    fast = slide("ellipsoid", 40.0)
    case.closures.append(fast.closure)
    case.figures += [
        Figure("ellipsoid, 40 rad/s: rest", "s", 0.58853, 1e-3, rest(fast.rows, spins=True)),
        Figure("ellipsoid, 40 rad/s: way", "m", 0.29427, 1e-3, fast.rows[-1, 3]),
    ]
    curves.append(Curve("native", native.rows[:, 0], native.rows[:, 1], "--"))
    case.plots.append(Plot("speed", "time [s]", "speed [m/s]", tuple(curves)))
    return case


def test_spinning_disc() -> None:
    measure().check()
