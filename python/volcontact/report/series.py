# SPDX-License-Identifier: Apache-2.0
"""One line of a figure of the report."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

POINTS = 900  # per curve; more cannot be seen at the size of a figure


@dataclass(frozen=True)
class Series:
    """One line, or one layer of a stack, for reading off its numbers.

    Attributes:
        label: what it is.
        color: "#rrggbb".
        x: time [s], shape (n,).
        y: in the unit of the axis, shape (n,).
    """

    label: str
    color: str
    x: np.ndarray
    y: np.ndarray
