# SPDX-License-Identifier: Apache-2.0
"""Between values of parameters and the unit box that estimators search in."""

from __future__ import annotations

import math

import numpy as np

from volcontact.identify.bench import Values
from volcontact.identify.settings import Parameter


class Box:
    """The box of the bounds of all parameters, from 0 to 1 in each."""

    def __init__(self, parameters: tuple[Parameter, ...]) -> None:
        self.parameters = parameters
        self._low = np.array([_scaled(p, p.low) for p in parameters])
        self._range = np.array([_scaled(p, p.high) for p in parameters]) - self._low

    def values(self, point: np.ndarray) -> Values:
        """Values at a point; beyond the box those of its edge."""
        scaled = self._low + self._range * np.clip(point, 0.0, 1.0)
        return {
            p.name: min(max(math.exp(x) if p.log else float(x), p.low), p.high)
            for p, x in zip(self.parameters, scaled, strict=True)
        }

    def point(self, values: Values) -> np.ndarray:
        """The point of values, shape (n,)."""
        scaled = np.array([_scaled(p, values[p.name]) for p in self.parameters])
        result: np.ndarray = (scaled - self._low) / self._range
        return result

    def deviations(self, in_box: np.ndarray) -> np.ndarray:
        """Standard deviations, of the logarithm where a scale is logarithmic."""
        result: np.ndarray = in_box * self._range
        return result

    def prior(self, point: np.ndarray) -> np.ndarray:
        """Errors against what is known beforehand, one of each parameter that has a prior."""
        found = []
        for p, x in zip(self.parameters, self._low + self._range * point, strict=True):
            if p.prior is not None:
                mean, sd = p.prior
                found.append((x - math.log(mean)) / sd if p.log else (x - mean) / sd)
        return np.array(found)

    def prior_slope(self) -> np.ndarray:
        """Derivatives of `prior` by the point, shape (priors, n)."""
        rows = []
        for place, p in enumerate(self.parameters):
            if p.prior is not None:
                row = np.zeros(len(self.parameters))
                row[place] = self._range[place] / p.prior[1]
                rows.append(row)
        return np.array(rows).reshape(-1, len(self.parameters))


def _scaled(parameter: Parameter, value: float) -> float:
    return math.log(value) if parameter.log else value
