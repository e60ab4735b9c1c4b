# SPDX-License-Identifier: Apache-2.0
"""Figures of a study."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from volcontact.report.palette import NATIVE, VOLUMETRIC
from volcontact.study.estimates import Indices

_ACROSS = 4
_BINS = 12  # of a map, along each axis


def draw_inputs(values: dict[str, np.ndarray], path: Path) -> None:
    """Draws a histogram of each input, as SVG or PNG by the name of the file."""
    histograms(values).savefig(path)


def histograms(values: dict[str, np.ndarray]) -> Figure:
    """A histogram of each column."""
    across = min(len(values), _ACROSS)
    rows = -(-len(values) // across)
    figure = Figure(figsize=(2.6 * across, 2.0 * rows), layout="constrained")
    for place, (name, column) in enumerate(values.items()):
        axes = figure.add_subplot(rows, across, place + 1)
        if column.dtype.kind in "USO":
            words, counts = np.unique(column.astype(str), return_counts=True)
            axes.bar(words, counts, color=VOLUMETRIC)
        else:
            axes.hist(column[np.isfinite(column)], bins=30, color=VOLUMETRIC)
        axes.set_title(name, fontsize=9)
        axes.tick_params(labelsize=7)
    return figure


def bars(indices: Indices) -> Figure:
    """The inputs by their importance, with intervals."""
    count = len(indices.names)
    figure = Figure(figsize=(5.6, 0.6 + 0.28 * count), layout="constrained")
    axes = figure.add_subplot()
    places = np.arange(count)[::-1]
    axes.barh(places, indices.values, xerr=indices.errors, color=VOLUMETRIC, ecolor=NATIVE)
    axes.set_yticks(places, indices.names, fontsize=8)
    axes.tick_params(labelsize=8)
    axes.axvline(0.0, color="#5b6472", linewidth=0.8)
    axes.set_title(f"{indices.response}, {indices.method}", fontsize=9)
    return figure


def tallies(counts: dict[str, int], title: str) -> Figure:
    """Counts by word."""
    figure = Figure(figsize=(5.6, 0.6 + 0.28 * max(len(counts), 1)), layout="constrained")
    axes = figure.add_subplot()
    places = np.arange(len(counts))[::-1]
    axes.barh(places, list(counts.values()), color=VOLUMETRIC)
    axes.set_yticks(places, list(counts), fontsize=8)
    axes.tick_params(labelsize=8)
    axes.set_title(title, fontsize=9)
    return figure


def maps(
    x: np.ndarray, y: np.ndarray, success: np.ndarray, force: np.ndarray | None, names: list[str]
) -> Figure:
    """Share of successes, and median peak force [N], over two inputs."""
    panels: list[tuple[str, np.ndarray, Any]] = [("success", success.astype(float), np.mean)]
    if force is not None:
        panels.append(("peak force [N], median", force, np.median))
    figure = Figure(figsize=(3.6 * len(panels), 3.0), layout="constrained")
    bins = int(np.clip(np.sqrt(len(x) / 12.0), 3, _BINS))
    edges = [np.linspace(v.min(), v.max() + 1e-12 * (1 + abs(v.max())), bins + 1) for v in (x, y)]
    cells = [
        np.clip(np.searchsorted(edge, v, side="right") - 1, 0, bins - 1)
        for edge, v in zip(edges, (x, y), strict=True)
    ]
    for place, (title, values, summary) in enumerate(panels):
        grid = np.full((bins, bins), np.nan)
        for i in range(bins):
            for j in range(bins):
                inside = values[(cells[0] == i) & (cells[1] == j)]
                inside = inside[np.isfinite(inside)]
                if len(inside):
                    grid[j, i] = summary(inside)
        axes = figure.add_subplot(1, len(panels), place + 1)
        low, high = (0.0, 1.0) if place == 0 else (None, None)
        mesh = axes.pcolormesh(edges[0], edges[1], grid, cmap="viridis", vmin=low, vmax=high)
        figure.colorbar(mesh, ax=axes)
        axes.set_title(title, fontsize=9)
        axes.set_xlabel(names[0], fontsize=8)
        axes.set_ylabel(names[1], fontsize=8)
        axes.tick_params(labelsize=7)
    return figure
