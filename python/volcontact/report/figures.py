# SPDX-License-Identifier: Apache-2.0
"""The curves of a comparison, as SVG that takes its ink from the page around it."""

from __future__ import annotations

import io
import itertools
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from volcontact.recording import CHANNELS, Recording
from volcontact.report import palette
from volcontact.report.comparison import Comparison, offset_from

_SIZE = (4.2, 2.8)  # inches: readable when shrunk to a phone
_POINTS = 900  # per curve; more cannot be seen at this size
_FORCE_FLOOR = 1.0  # [N], lowest value of the logarithmic axis
_DEPTH_FLOOR = 1e-6  # [m]

# Placeholders of the SVG and the CSS variables of the page that replace them.
_INK, _MUTED, _LINE = "#010101", "#020202", "#030303"
_VARIABLES = {
    _INK: "var(--ink)",
    _MUTED: "var(--muted)",
    _LINE: "var(--line)",
    palette.VOLUMETRIC: "var(--volumetric)",
    palette.NATIVE: "var(--native)",
}

_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.size": 10.0,
    "text.color": _INK,
    "axes.labelcolor": _MUTED,
    "axes.edgecolor": _LINE,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": _LINE,
    "grid.linewidth": 0.6,
    "xtick.color": _LINE,
    "ytick.color": _LINE,
    "xtick.labelcolor": _MUTED,
    "ytick.labelcolor": _MUTED,
    "legend.frameon": False,
    "legend.fontsize": 9.0,
    "lines.linewidth": 1.4,
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "savefig.transparent": True,
}


@dataclass(frozen=True)
class Curve:
    """One figure of the report.

    Attributes:
        name: short, fit for a file name.
        title: above the figure.
        caption: one sentence on how to read it.
        svg: inline SVG.
    """

    name: str
    title: str
    caption: str
    svg: str


def curves(comparison: Comparison) -> list[Curve]:
    """All figures of the report, in reading order."""
    made = [
        _curve("height", "Height", _height_caption(comparison), _draw_height, comparison),
        _curve(
            "force",
            "Contact force",
            "Magnitudes of all site forces added up; logarithmic.",
            _draw_force,
            comparison,
        ),
        _curve(
            "penetration",
            "Penetration",
            "Depth of the deepest site; logarithmic.",
            _draw_penetration,
            comparison,
        ),
        _curve(
            "energy_volumetric",
            "Energy, volumetric",
            "Stacked; the dashed line is the energy at the start. Where the stack meets it, every "
            "joule is accounted for.",
            _draw_volumetric_energy,
            comparison,
        ),
        _curve(
            "energy_native",
            "Energy, native",
            "Stacked; native contact stores and dissipates without an account, which leaves the "
            "grey part.",
            _draw_native_energy,
            comparison,
        ),
        _curve(
            "sites",
            "Contact places",
            "Volumetric: connected overlap regions. Native: contact points that push or overlap.",
            _draw_sites,
            comparison,
        ),
        _curve(
            "timing",
            "Time of one step",
            "Wall time of mj_step alone; running median over a hundredth of the run.",
            _draw_timing,
            comparison,
        ),
    ]
    if comparison.design is not None:
        offset = _curve(
            "offset",
            "Distance from the design pose",
            "Of the body frame; logarithmic. The dashed line is the tolerance.",
            _draw_offset,
            comparison,
        )
        made.insert(1, offset)
    return made


def thin(x: np.ndarray, y: np.ndarray, points: int = _POINTS) -> tuple[np.ndarray, np.ndarray]:
    """Fewer points of a curve that keep its lowest and highest value in every interval.

    Args:
        x: shape (n,).
        y: shape (n,).
        points: at most about this many are returned.
    """
    intervals = points // 2
    if len(x) <= 2 * intervals:
        return x, y
    edges = np.linspace(0, len(x), intervals + 1).astype(int)
    keep = {0, len(x) - 1}
    for begin, end in itertools.pairwise(edges):
        keep.add(begin + int(np.argmin(y[begin:end])))
        keep.add(begin + int(np.argmax(y[begin:end])))
    rows = np.array(sorted(keep))
    return x[rows], y[rows]


def _curve(
    name: str,
    title: str,
    caption: str,
    draw: Callable[[Axes, Comparison], None],
    comparison: Comparison,
) -> Curve:
    with matplotlib.rc_context({**_STYLE, "svg.hashsalt": name}):
        figure = Figure(figsize=_SIZE, layout="constrained")
        axes = figure.add_subplot()
        axes.tick_params(length=0)
        draw(axes, comparison)
        axes.set_xlabel("time [s]")
        axes.xaxis.set_major_locator(MaxNLocator(6))
        axes.set_xlim(0.0, max(run.time[-1] for run in comparison.runs) or 1.0)
        return Curve(name, title, caption, _svg(figure, name))


def _svg(figure: Figure, name: str) -> str:
    """Inline SVG: page colours for ink, and ids that no other figure of the page has."""
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None})
    text = buffer.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.DOTALL)
    for placeholder, variable in _VARIABLES.items():
        text = text.replace(placeholder, variable)
    opening, rest = text.split(">", 1)
    opening = re.sub(r' (width|height)="[^"]*"', "", opening)  # the page decides; viewBox stays
    text = f"{opening}>{rest}"
    text = re.sub(r'\bid="', f'id="{name}-', text)
    text = re.sub(r"url\(#", f"url(#{name}-", text)
    return re.sub(r'href="#', f'href="#{name}-', text)


def _both(axes: Axes, comparison: Comparison, values: Callable[[Recording], np.ndarray]) -> None:
    # The native run first: where both coincide the volumetric one stays visible.
    for run in reversed(comparison.runs):
        x, y = thin(run.time, values(run))
        axes.plot(x, y, color=palette.RUN_COLORS[run.contact], label=run.contact)


def _legend(axes: Axes, columns: int = 2) -> None:
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(
        handles[::-1],
        labels[::-1],
        loc="lower left",
        bbox_to_anchor=(-0.02, 1.0),
        ncols=columns,
        borderaxespad=0.1,
        handlelength=1.2,
        columnspacing=1.2,
    )


def _height_caption(comparison: Comparison) -> str:
    body = comparison.volumetric.bodies[0] if comparison.volumetric.bodies else "body"
    return f"World height of the frame of {body.replace('_', ' ')}."


def _draw_height(axes: Axes, comparison: Comparison) -> None:
    if comparison.volumetric.bodies:
        _both(axes, comparison, lambda run: run.height[:, 0])
    axes.set_ylabel("height [m]")
    _legend(axes)


def _draw_offset(axes: Axes, comparison: Comparison) -> None:
    design = comparison.design
    assert design is not None
    _both(axes, comparison, lambda run: 1e3 * np.maximum(offset_from(run, design).distance, 1e-7))
    axes.axhline(1e3 * design.position_tolerance, color=_MUTED, linewidth=0.9, linestyle="--")
    axes.set_yscale("log")
    axes.set_ylabel("distance [mm]")
    _legend(axes)


def _draw_force(axes: Axes, comparison: Comparison) -> None:
    _both(axes, comparison, lambda run: np.maximum(run.contact_force, _FORCE_FLOOR))
    weight = comparison.volumetric.weight
    if weight > 0.0:
        axes.axhline(weight, color=_MUTED, linewidth=0.9, linestyle="--", label="weight")
    axes.set_yscale("log")
    axes.set_ylim(bottom=1.25 * _FORCE_FLOOR)  # hides the line along the floor
    axes.set_ylabel("force [N]")
    _legend(axes, columns=3)


def _draw_penetration(axes: Axes, comparison: Comparison) -> None:
    _both(axes, comparison, lambda run: 1e3 * np.maximum(run.penetration, _DEPTH_FLOOR))
    axes.set_yscale("log")
    axes.set_ylim(bottom=1.25e3 * _DEPTH_FLOOR)
    axes.set_ylabel("depth [mm]")
    _legend(axes)


def _draw_sites(axes: Axes, comparison: Comparison) -> None:
    _both(axes, comparison, lambda run: run.site_count)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel("number at once")
    _legend(axes)


def _draw_timing(axes: Axes, comparison: Comparison) -> None:
    top = 0.0
    for run in reversed(comparison.runs):
        if run.steps == 0:
            continue
        x, y = _running_median(run.time[:-1], run.step_microseconds)
        top = max(top, 1.25 * float(np.quantile(y, 0.99)))
        axes.plot(x, y, color=palette.RUN_COLORS[run.contact], label=run.contact)
    axes.set_ylim(0.0, top or 1.0)
    axes.set_ylabel("time [µs]")
    _legend(axes)


def _running_median(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    width = max(1, len(y) // 100)
    count = len(y) // width
    return (
        x[: count * width].reshape(count, width).mean(axis=1),
        np.median(y[: count * width].reshape(count, width), axis=1),
    )


def _draw_volumetric_energy(axes: Axes, comparison: Comparison) -> None:
    run = comparison.volumetric
    layers = _mechanical_layers(comparison, run)
    layers.append(("elastic", palette.ELASTIC, run.elastic))
    for i, channel in enumerate(CHANNELS):
        if run.dissipated[:, i].max() > 1e-6 * max(run.energy[0], 1e-12):
            layers.append((channel, palette.DISSIPATED[channel], run.dissipated[:, i]))
    _stack(axes, run, layers)


def _draw_native_energy(axes: Axes, comparison: Comparison) -> None:
    run = comparison.native
    layers = _mechanical_layers(comparison, run)
    missing = np.maximum(run.energy[0] - run.energy, 0.0)
    layers.append(("not accounted for", palette.UNEXPLAINED, missing))
    _stack(axes, run, layers)


def _mechanical_layers(comparison: Comparison, run: Recording) -> list[tuple[str, str, np.ndarray]]:
    lowest = min(float(other.potential.min()) for other in comparison.runs)
    return [
        ("potential", palette.POTENTIAL, run.potential - lowest),
        ("kinetic", palette.KINETIC, run.kinetic),
    ]


def _stack(axes: Axes, run: Recording, layers: list[tuple[str, str, np.ndarray]]) -> None:
    rows = np.unique(np.linspace(0, len(run.time) - 1, _POINTS // 2).astype(int))
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
    axes.axhline(start, color=_INK, linewidth=0.9, linestyle="--")
    axes.set_ylim(0.0, 1.1 * max(start, float(np.sum(values, axis=0).max()), 1e-12))
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
