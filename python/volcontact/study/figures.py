# SPDX-License-Identifier: Apache-2.0
"""Figures of a study."""

from __future__ import annotations

from dataclasses import dataclass
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
    """Share of successes, and median peak force [N], over two inputs, numbers or words."""
    panels: list[tuple[str, np.ndarray, Any]] = [("success", success.astype(float), np.mean)]
    if force is not None:
        panels.append(("peak force [N], median", force, np.median))
    figure = Figure(figsize=(3.6 * len(panels), 3.0), layout="constrained")
    bins = int(np.clip(np.sqrt(len(x) / 12.0), 3, _BINS))
    across, up = _Cells.of(x, bins), _Cells.of(y, bins)
    for place, (title, values, summary) in enumerate(panels):
        grid = np.full((len(up.edges) - 1, len(across.edges) - 1), np.nan)
        for j, i in np.ndindex(*grid.shape):
            inside = values[(across.cell == i) & (up.cell == j)]
            inside = inside[np.isfinite(inside)]
            if len(inside):
                grid[j, i] = summary(inside)
        axes = figure.add_subplot(1, len(panels), place + 1)
        low, high = (0.0, 1.0) if place == 0 else (None, None)
        mesh = axes.pcolormesh(across.edges, up.edges, grid, cmap="viridis", vmin=low, vmax=high)
        figure.colorbar(mesh, ax=axes)
        axes.set_title(title, fontsize=9)
        axes.set_xlabel(names[0], fontsize=8)
        axes.set_ylabel(names[1], fontsize=8)
        axes.locator_params(nbins=4)
        if across.words:
            axes.set_xticks(range(len(across.words)), across.words)
        if up.words:
            axes.set_yticks(range(len(up.words)), up.words)
        axes.tick_params(labelsize=7)
    return figure


@dataclass(frozen=True)
class _Cells:
    """The cells of a map along one axis: of which cell each trial is, and where they end."""

    cell: np.ndarray
    edges: np.ndarray
    words: tuple[str, ...] = ()

    @staticmethod
    def of(values: np.ndarray, bins: int) -> _Cells:
        """Of numbers so many cells, of words one each."""
        if values.dtype.kind in "USO":
            words, cell = np.unique(values.astype(str), return_inverse=True)
            return _Cells(cell, np.arange(len(words) + 1) - 0.5, tuple(words.tolist()))
        low, high = float(values.min()), float(values.max())
        edges = np.linspace(low, high + 1e-12 * (1.0 + abs(high)), bins + 1)
        inside = np.searchsorted(edges, values, side="right") - 1
        return _Cells(np.clip(inside, 0, bins - 1), edges)
