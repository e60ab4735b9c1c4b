# SPDX-License-Identifier: Apache-2.0
"""What the data sheets of the bench tests have."""

from __future__ import annotations

import math

from volcontact.identify.direct.sheets import Item, Layout

_LOAD = Item("normal force", "force", "N", "that presses the two together", above_zero=True)
_A = Item("a", "text", "", "the solid that moves, as sphere:radius=0.02 [m] or the file of a mesh")
_B = Item("b", "text", "", "the solid below it; half_space where it is left out")
_GRAVITY = Item("gravity", "acceleration", "m/s^2", "9.80665 where left out", above_zero=True)
_STIFFNESS = Item("stiffness", "stiffness", "N/m^3", "k_v of the pair (press)", above_zero=True)
_FRICTION = Item("friction", "number", "-", "mu_C, kinetic (pull)", above_zero=True)
_STRIBECK = Item("stribeck speed", "speed", "m/s", "v_s (pull)", above_zero=True)
_RUN = Item("run", "label", "", "of repetitions")
_INERTIA = Item(
    "inertia", "inertia", "kg m^2", "of the body about the axis of its turn", above_zero=True
)
_MASS = Item("mass", "mass", "kg", "of the body", above_zero=True)


def _loops() -> list[str]:
    """Two loops of a sled of 1 kg on 1e5 N/m and 602 N s/m."""
    rows = []
    for loop, frequency in ((1, 5.0), (2, 20.0)):
        w = 2.0 * math.pi * frequency
        stiffness = complex(1e5 - w * w, 602.0 * w)
        for sample in range(48):
            turn = complex(
                math.cos(sample / 16.0 * 2.0 * math.pi), math.sin(sample / 16.0 * 2.0 * math.pi)
            )
            x, force = 2e-6 * turn.imag, (2e-6 * stiffness * turn).imag
            rows.append(f"{loop},{sample / 16.0 / frequency:.6g},{1e6 * x:.5g},{force:.5g}")
    return rows


def _decay(rate: float, linear: float, constant: float, step: float = 1.0) -> list[str]:
    """Rates of a body that slows down with linear * rate + constant."""
    rows = []
    for sample in range(9):
        t = step * sample
        left = rate * math.exp(-linear * t) if linear else rate - constant * t
        rows.append(f"{t:.4g},{left:.5g}")
    return rows


PRESS = Layout(
    "press",
    "stiffness k_v and the offset of the depth gauge, from force over depth",
    (
        Item("depth", "length", "mm", "of the gauge, rising as A goes in", needed=True),
        Item("force", "force", "N", "of the load cell, zero in the air", needed=True),
        Item("speed", "speed", "mm/s", "at which A goes in, 0 at rest"),
        _RUN,
    ),
    (
        _A,
        _B,
        Item("offset", "length", "mm", "reading of the gauge at touch, where it is known"),
    ),
    (
        "depth [mm],force [N]",
        "0.357,1",
        "0.4263,5",
        "0.4786,10",
        "0.5828,25",
        "0.7001,50",
        "0.7906,75",
        "0.8669,100",
    ),
    {"a": "sphere:radius=0.02", "b": "half_space"},
)
DROP = Layout(
    "drop",
    "damping a, or restitution e with its floor, from bounce heights or the times between bounces",
    (
        Item("drop", "label", "", "one fall with its bounces; rows follow each other"),
        Item(
            "height",
            "length",
            "mm",
            "over the height at rest: release, then each peak",
            above_zero=True,
        ),
        Item("interval", "time", "ms", "from an impact to the next", above_zero=True),
    ),
    (
        _GRAVITY,
        Item("contact time", "time", "ms", "how long an impact lasts, taken off the intervals"),
        _A,
        _B,
        _MASS,
        _STIFFNESS,
    ),
    (
        "drop,height [mm]",
        "1,500",
        "1,246.7",
        "1,146.6",
        "1,97.4",
        "1,69",
        "2,200",
        "2,124.5",
        "2,85.2",
        "2,61.7",
    ),
)
TILT = Layout(
    "tilt",
    "static and kinetic friction and the dwell time, from angles at which a sled breaks away",
    (
        Item(
            "rest",
            "time",
            "s",
            "from setting down, or the end of a slide, to the breakaway",
            above_zero=True,
        ),
        Item(
            "angle", "angle", "deg", "of the table at the breakaway", needed=True, above_zero=True
        ),
        Item("acceleration", "acceleration", "m/s^2", "of the slide, the table held at this angle"),
        _RUN,
    ),
    (_GRAVITY,),
    (
        "rest [s],angle [deg],acceleration [m/s^2]",
        "0.5,17.89,0.21",
        "1,18.97,0.39",
        "2,20.2,0.63",
        "4,21.26,0.81",
        "10,21.77,0.91",
    ),
)
PULL = Layout(
    "pull",
    "mu_S, mu_C, v_s, sigma_2 and tau_dw, from breakaway forces and the friction at steady speeds",
    (
        Item(
            "rest",
            "time",
            "s",
            "from the end of a slide to the breakaway; empty in rows of speeds",
            above_zero=True,
        ),
        Item(
            "speed",
            "speed",
            "mm/s",
            "of steady sliding; empty in rows of breakaways",
            above_zero=True,
        ),
        Item(
            "force",
            "force",
            "N",
            "at the breakaway, or the mean of the slide",
            needed=True,
            above_zero=True,
        ),
        _RUN,
    ),
    (
        _LOAD,
        Item("bristle damping", "viscosity", "N s/m", "sigma_1 (slip)", above_zero=True),
    ),
    (
        "rest [s],speed [mm/s],force [N]",
        "0.5,,3.17",
        "1,,3.34",
        "2,,3.57",
        "4,,3.8",
        "10,,3.92",
        ",1,3.91",
        ",3,3.85",
        ",7,3.56",
        ",10,3.33",
        ",15,3.08",
        ",20,3",
        ",50,3.04",
        ",100,3.14",
    ),
    {"normal force": "9.81"},
)
SLIP = Layout(
    "slip",
    "bristle stiffness sigma_0 and damping sigma_1, from micro-slip loops at several frequencies",
    (
        Item("loop", "label", "", "one frequency and amplitude, over at least two periods"),
        Item("time", "time", "s", "of the sample", needed=True),
        Item("displacement", "length", "um", "of the sled against its base", needed=True),
        Item("force", "force", "N", "along the plane, between shaker and sled", needed=True),
    ),
    (
        _MASS,
        Item("viscous friction", "viscosity", "N s/m", "sigma_2 (pull)"),
        _LOAD,
        _FRICTION,
        _STRIBECK,
    ),
    ("loop,time [s],displacement [um],force [N]", *_loops()),
    {"mass": "1"},
)
ROLL = Layout(
    "roll",
    "rolling resistance, so the damping a, from how a body that rolls slows down",
    (
        _RUN,
        Item("time", "time", "s", "of the sample", needed=True),
        Item("distance", "length", "mm", "rolled"),
        Item("angle", "angle", "rad", "turned"),
        Item("speed", "speed", "mm/s", "of the middle"),
        Item("rate", "angular speed", "rad/s", "of the turn"),
    ),
    (_A, _B, _MASS, _INERTIA, _LOAD, _STIFFNESS, _GRAVITY),
    ("time [s],rate [rad/s]", *_decay(20.0, 0.05, 0.0)),
    {
        "a": "sphere:radius=0.05",
        "b": "half_space",
        "mass": "1",
        "inertia": "0.001",
        "stiffness": "1e8",
    },
)
SPIN = Layout(
    "spin",
    "friction against spin and its coupling, from how a body that spins on the spot slows down",
    (
        _RUN,
        Item("time", "time", "s", "of the sample", needed=True),
        Item("angle", "angle", "rad", "turned"),
        Item("rate", "angular speed", "rad/s", "of the spin"),
    ),
    (_A, _B, _INERTIA, _MASS, _LOAD, _STIFFNESS, _FRICTION, _STRIBECK, _GRAVITY),
    ("time [s],rate [rad/s]", *_decay(60.0, 0.0, 78.48, 0.08)),
    {
        "a": "cylinder:radius=0.05,half_length=0.01",
        "b": "half_space",
        "mass": "1",
        "inertia": "0.00125",
        "stiffness": "1e9",
        "friction": "0.3",
    },
)
LAYOUTS = {each.test: each for each in (PRESS, DROP, TILT, PULL, SLIP, ROLL, SPIN)}
