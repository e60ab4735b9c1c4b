# SPDX-License-Identifier: Apache-2.0
"""Units of measurements: what one of them is in SI."""

from __future__ import annotations

import math

_LENGTH = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "in": 0.0254, "ft": 0.3048}
_ANGLE = {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180.0, "rev": 2.0 * math.pi}
_TIME = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0}
_FORCE = {"N": 1.0, "mN": 1e-3, "kN": 1e3, "lbf": 4.4482216152605}


def _rates(units: dict[str, float]) -> dict[str, float]:
    return {f"{unit}/s": factor for unit, factor in units.items()}


_SENSOR = {
    "1": 1.0,
    **_LENGTH,
    **_ANGLE,
    **_rates(_LENGTH),
    **_rates(_ANGLE),
    "rpm": 2.0 * math.pi / 60.0,
    **_FORCE,
    **{f"{unit} m": factor for unit, factor in _FORCE.items()},
    "N mm": 1e-3,
    "m/s^2": 1.0,
    "g": 9.80665,
}
# By the kind of measure. The first of each is the default.
UNITS = {
    "time": _TIME,
    "position": _LENGTH,
    "orientation": {"1": 1.0},
    "velocity": _rates(_LENGTH),
    "angular_velocity": {**_rates(_ANGLE), "rpm": 2.0 * math.pi / 60.0},
    "joint": {**_ANGLE, **_LENGTH},
    "joint_velocity": {**_rates(_ANGLE), **_rates(_LENGTH), "rpm": 2.0 * math.pi / 60.0},
    "sensor": _SENSOR,
}
# What errors of a kind are given and told in, where that is not the unit of the columns.
SIGMA_UNITS = {"orientation": _ANGLE}
SI = {
    "position": "m",
    "orientation": "rad",
    "velocity": "m/s",
    "angular_velocity": "rad/s",
    "joint": "rad or m",
    "joint_velocity": "rad/s or m/s",
    "sensor": "",
}
