# SPDX-License-Identifier: Apache-2.0
"""The energy of a run over time, stacked: one layer a kind of energy."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.axes import Axes

from volcontact.report import palette
from volcontact.report.comparison import Comparison
from volcontact.report.series import POINTS, Series
from volcontact.running.outside_work import CHANNELS as OUTSIDE
from volcontact.running.recording import CHANNELS, Recording


def draw_volumetric_energy(axes: Axes, comparison: Comparison) -> list[Series]:
    """What is mechanical, stored in the contacts and dissipated, by channel, stacked."""
    run = comparison.volumetric
    layers = _mechanical_layers(comparison, run)
    layers.append(("elastic", palette.ELASTIC, run.elastic))
    for i, channel in enumerate(CHANNELS):
        if run.dissipated[:, i].max() > 1e-6 * max(run.energy[0], 1e-12):
            layers.append((channel, palette.DISSIPATED[channel], run.dissipated[:, i]))
    return _stack(axes, run, layers)


def draw_native_energy(axes: Axes, comparison: Comparison) -> list[Series]:
    """What is mechanical, and what contact has taken from it, stacked."""
    run = comparison.native
    layers = _mechanical_layers(comparison, run)
    taken = np.maximum(-run.outside_work[:, OUTSIDE.index("native")], 0.0)
    layers.append(("taken by contact", palette.UNEXPLAINED, taken))
    return _stack(axes, run, layers)


def _mechanical_layers(comparison: Comparison, run: Recording) -> list[tuple[str, str, np.ndarray]]:
    lowest = min(float(other.potential.min()) for other in comparison.runs)
    return [
        ("potential", palette.POTENTIAL, run.potential - lowest),
        ("kinetic", palette.KINETIC, run.kinetic),
    ]


def _stack(axes: Axes, run: Recording, layers: list[tuple[str, str, np.ndarray]]) -> list[Series]:
    rows = np.unique(np.linspace(0, len(run.time) - 1, POINTS // 2).astype(int))
    values = [layer[2][rows] for layer in layers]
    axes.stackplot(
        run.time[rows],
        values,
        labels=[layer[0] for layer in layers],
        colors=[layer[1] for layer in layers],
        alpha=0.85,
        linewidth=0.0,
    )
    start = sum(float(layer[2][0]) for layer in layers)
    # What is there, and what came in besides: a stack that meets it accounts for all.
    outside = run.outside_work[rows].sum(axis=1) + run.driven[rows]
    if run.contact == "native":
        outside -= run.outside_work[rows, OUTSIDE.index("native")]
    line = start + outside - (run.numerical[rows] - run.numerical[0])
    ink = matplotlib.rcParams["text.color"]
    axes.plot(run.time[rows], line, color=ink, linewidth=0.9, linestyle="--")
    axes.set_ylim(0.0, 1.1 * max(float(line.max()), float(np.sum(values, axis=0).max()), 1e-12))
    axes.set_ylabel("energy [J]")
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(
        handles,
        labels,
        loc="lower left",
        bbox_to_anchor=(-0.02, 1.0),
        ncols=4,
        borderaxespad=0.1,
        handlelength=0.9,
        handletextpad=0.4,
        columnspacing=0.9,
    )
    return [
        Series(label, color, run.time[rows], y)
        for (label, color, _), y in zip(layers, values, strict=True)
    ]
