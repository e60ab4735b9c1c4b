# SPDX-License-Identifier: Apache-2.0
"""What is read off a curve or a formula: values with intervals, range of validity, MJCF lines."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from volcontact.identify.ranges import DEFAULTS

LEVEL = 0.95  # of intervals


@dataclass(frozen=True)
class Quantity:
    """A number with its unit and its interval.

    Attributes:
        value: in `unit`.
        unit: SI, "-" for none.
        deviation: standard deviation, NaN where it is not known.
        low, high: ends of the interval, NaN where it is not known.
        told: whether the data tell it.
    """

    value: float
    unit: str
    deviation: float = math.nan
    low: float = math.nan
    high: float = math.nan
    told: bool = True

    def as_dict(self) -> dict[str, Any]:
        """For JSON, with None for what is not known."""
        numbers = {"deviation": self.deviation, "low": self.low, "high": self.high}
        known = {key: value if math.isfinite(value) else None for key, value in numbers.items()}
        return {"value": self.value, "unit": self.unit, **known, "told": self.told}


def scaled(known: Quantity, factor: float, unit: str) -> Quantity:
    """A multiple of a quantity, its interval with it."""
    return Quantity(
        factor * known.value,
        unit,
        factor * known.deviation,
        factor * known.low,
        factor * known.high,
        known.told,
    )


@dataclass(frozen=True)
class Curve:
    """What was measured beside what the law says, for the report.

    Attributes:
        title: of the figure.
        x_label, y_label: of its axes, with units.
        x, y: measured, shape (n,).
        line_x, line_y: of the law, shape (m,).
    """

    title: str
    x_label: str
    y_label: str
    x: np.ndarray
    y: np.ndarray
    line_x: np.ndarray
    line_y: np.ndarray


@dataclass(frozen=True)
class Reading:
    """What a formula or a bench test gives.

    Attributes:
        name: of the formula or test.
        values: quantities by name; names of laws' parameters are those of MJCF.
        validity: the range in which the formula holds, in sentences.
        findings: what lies outside of it, and what the data cannot tell, in sentences.
        choices: words for MJCF keys that belong to the values, such as "friction_law/bristle".
        written: names of the values that go to MJCF; None takes all that are fields of laws.
        curves: for the report.
        converged: whether the regression ended by itself.
        level: of the intervals.
    """

    name: str
    values: dict[str, Quantity]
    validity: tuple[str, ...] = ()
    findings: tuple[str, ...] = ()
    choices: tuple[str, ...] = ()
    written: tuple[str, ...] | None = None
    curves: tuple[Curve, ...] = field(default=(), repr=False)
    converged: bool = True
    level: float = LEVEL

    def __getitem__(self, name: str) -> float:
        """The value of a quantity."""
        return self.values[name].value

    def parameters(self) -> dict[str, float]:
        """Values that are fields of laws, and told."""
        names = self.values if self.written is None else self.written
        return {
            name: self.values[name].value
            for name in names
            if name in DEFAULTS and self.values[name].told
        }

    def mjcf(self, pair: str = "NAME") -> str:
        """Lines to paste below `<custom>`, one a parameter, with its unit and interval.

        Args:
            pair: name of the pair of geoms in the scene.
        """
        lines = [
            f'<numeric name="volcontact/pair/{pair}/{choice}" data="1"/>' for choice in self.choices
        ]
        for name, value in self.parameters().items():
            each = self.values[name]
            unit = "" if each.unit == "-" else f" [{each.unit}]"
            known = f" {each.low:.6g} to {each.high:.6g}" if math.isfinite(each.low) else ""
            note = f"  <!--{known}{unit} -->" if unit or known else ""
            data = f'data="{value:.9g}"/>'
            lines.append(f'<numeric name="volcontact/pair/{pair}/{name}" {data}{note}')
        return "\n".join(lines)

    def as_dict(self) -> dict[str, Any]:
        """Content of `identified.json`."""
        return {
            "name": self.name,
            "converged": self.converged,
            "level": self.level,
            "parameters": {name: each.as_dict() for name, each in self.values.items()},
            "choices": list(self.choices),
            "validity": list(self.validity),
            "findings": list(self.findings),
            "mjcf": self.mjcf().splitlines(),
        }
