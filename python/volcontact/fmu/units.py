# SPDX-License-Identifier: Apache-2.0
"""Units of measurement as modelDescription.xml defines them: exponents of the base units."""

from __future__ import annotations

import re
from collections import Counter

_BASE = {
    "m": {"m": 1},
    "kg": {"kg": 1},
    "s": {"s": 1},
    "rad": {"rad": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
}

# Names of physical quantities by their units, as far as a unit tells.
_QUANTITIES = {
    "m": "Length", "m^2": "Area", "m^3": "Volume", "m^5": "SecondMomentOfVolume", "s": "Time",
    "m/s": "Velocity", "m/s^2": "Acceleration", "rad": "Angle", "rad/s": "AngularVelocity",
    "rad/s^2": "AngularAcceleration", "N": "Force", "N m": "Torque", "J": "Energy", "W": "Power",
    "N/m": "Stiffness", "N s/m": "Damping", "N/m^3": "VolumetricStiffness", "N/m^2": "Pressure",
}  # fmt: skip


def quantity(unit: str) -> str | None:
    """The physical quantity that has a unit; None where that is not clear."""
    return _QUANTITIES.get(unit)


def exponents(unit: str) -> dict[str, int]:
    """Of the base units, in a unit such as "N s/m^3".

    Raises:
        ValueError: a part of it is unknown.
    """
    total: Counter[str] = Counter()
    for place, side in enumerate(unit.split("/")):
        for part in side.split():
            if part == "1":
                continue
            match = re.fullmatch(r"([A-Za-z]+)(?:\^(\d+))?", part)
            if match is None or match[1] not in _BASE:
                raise ValueError(f"unit {unit!r}: {part!r} is unknown")
            power = int(match[2] or 1) * (-1 if place else 1)
            for base, exponent in _BASE[match[1]].items():
                total[base] += power * exponent
    return {base: power for base, power in total.items() if power}


def limits(text: str) -> tuple[float | None, float | None]:
    """Smallest and largest allowed value of a range such as "> 0" or "0 to 1"; None: none."""
    numbers = [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", text)]
    if re.match(r"-?\d+(\.\d+)? to ", text):
        return numbers[0], numbers[1]
    low = next(iter(re.findall(r">=? (-?\d+(?:\.\d+)?)", text)), None)
    high = next(iter(re.findall(r"<=? (-?\d+(?:\.\d+)?)", text)), None)
    return (None if low is None else float(low)), (None if high is None else float(high))
