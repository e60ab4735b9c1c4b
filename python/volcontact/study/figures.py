# SPDX-License-Identifier: Apache-2.0
"""Figures of a study."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from volcontact.report.palette import VOLUMETRIC

_ACROSS = 4


def draw_inputs(values: dict[str, np.ndarray], path: Path) -> None:
    """Draws a histogram of each input, as SVG or PNG by the name of the file."""
    rows = -(-len(values) // _ACROSS)
    figure = Figure(figsize=(2.6 * min(len(values), _ACROSS), 2.0 * rows), layout="constrained")
    for place, (name, column) in enumerate(values.items()):
        axes = figure.add_subplot(rows, min(len(values), _ACROSS), place + 1)
        _histogram(axes, column)
        axes.set_title(name, fontsize=9)
        axes.tick_params(labelsize=7)
    figure.savefig(path)


def _histogram(axes: object, column: np.ndarray) -> None:
    if column.dtype.kind in "US":
        words, counts = np.unique(column, return_counts=True)
        axes.bar(words, counts, color=VOLUMETRIC)  # type: ignore[attr-defined]
    else:
        axes.hist(column, bins=30, color=VOLUMETRIC)  # type: ignore[attr-defined]
