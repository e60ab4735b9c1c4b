# SPDX-License-Identifier: Apache-2.0
"""Numbers as people write them: three digits and a unit of fitting size."""

from __future__ import annotations

import math

import volcontact._volcontact as core

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))


def _written(unit: str) -> str:
    """A unit of the core's tables as people write it: "N s/m^3" is "N·s/m³"."""
    return unit.replace("^2", "²").replace("^3", "³").replace(" ", "·")


# Fields of laws, of options and of reports, with the units of docs and MJCF.
FIELD_UNITS = {name: _written(unit) for name, unit in core.units_of_law_fields().items()} | {
    "tolerance": "-",
    "timestep": "s",
    "volume": "m³",
}


def quantity(value: float, unit: str) -> str:
    """Three significant digits with a prefix: `quantity(0.00123, "m")` is "1.23 mm"."""
    if value == 0.0 or not math.isfinite(value):
        return f"{value:g} {unit}"
    for scale, prefix in _PREFIXES:
        if abs(value) >= 0.9995 * scale:
            return f"{digits(value / scale)} {prefix}{unit}"
    return f"less than 1 {_PREFIXES[-1][1]}{unit}"


def nominal(value: float, unit: str) -> str:
    """A chosen value such as a tolerance, without padding: `nominal(1e-3, "m")` is "1 mm"."""
    number, _, rest = quantity(value, unit).partition(" ")
    return f"{number.rstrip('0').rstrip('.') if '.' in number else number} {rest}"


def angle(degrees: float) -> str:
    """An angle given in degrees; below a thousandth nobody cares how little."""
    return f"{digits(degrees)}°" if degrees == 0.0 or degrees >= 1e-3 else "less than 0.001°"


def area(value: float) -> str:
    """An area given in m^2, in the unit that suits it."""
    for scale, unit in ((1.0, "m²"), (1e-4, "cm²")):
        if value >= scale:
            return f"{digits(value / scale)} {unit}"
    return f"{digits(value / 1e-6)} mm²"


def digits(value: float) -> str:
    """Three significant digits without exponent for numbers of everyday size."""
    if value == 0.0:
        return "0"
    if not (math.isfinite(value) and 1e-4 <= abs(value) < 1e6):
        return f"{value:.3g}"
    rounded = abs(float(f"{value:.2e}"))  # so that 9.999 counts as 10.0, not as 10.00
    places = max(0, 2 - math.floor(math.log10(rounded)))
    return f"{value:.{places}f}"


def ratio(a: float, b: float) -> str:
    """How many times a is larger or smaller than b, in words."""
    if a <= 0.0 or b <= 0.0:
        return "not comparable"
    if 0.98 <= a / b <= 1.02:
        return "about the same"
    if a > b:
        return f"{digits(a / b)} times as large"
    return f"{digits(b / a)} times smaller"
