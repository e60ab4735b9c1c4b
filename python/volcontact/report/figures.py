# SPDX-License-Identifier: Apache-2.0
"""The curves of a comparison, as SVG that takes its ink from the page around it."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from volcontact.report import palette
from volcontact.report.comparison import Comparison, offset_from
from volcontact.report.energy_figures import draw_native_energy, draw_volumetric_energy
from volcontact.report.series import POINTS, Series
from volcontact.report.svg import INK, LINE, MUTED, inline, standing_alone
from volcontact.running.recording import Recording

_SIZE = (4.2, 2.8)  # inches: readable when shrunk to a phone
_FORCE_FLOOR = 1.0  # [N], lowest value of the logarithmic axis
_DEPTH_FLOOR = 1e-6  # [m]
_TOWERS = 3.0  # times the 99 % quantile: beyond it a linear axis shows the peak alone


_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.size": 10.0,
    "text.color": INK,
    "axes.labelcolor": MUTED,
    "axes.edgecolor": LINE,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": LINE,
    "grid.linewidth": 0.6,
    "xtick.color": LINE,
    "ytick.color": LINE,
    "xtick.labelcolor": MUTED,
    "ytick.labelcolor": MUTED,
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
        svg: inline SVG, in the colours of the page.
        paper: SVG that stands alone, dark on white.
        data: what the page needs to tell the numbers under the pointer: `left` and `right` of the
            axes in shares of the width, the time `start` and `end` there [s], and the `series`
            with `label`, `color`, `x` and `y`; {} of one that is not over time.
        figure: matplotlib's.
    """

    name: str
    title: str
    caption: str
    svg: str
    paper: str
    data: dict[str, Any]
    figure: Figure


@dataclass(frozen=True)
class Plan:
    """How a figure is drawn.

    Attributes:
        name: short, fit for a file name.
        title: above the figure.
        caption: one sentence on how to read it.
        draw: draws runs into axes and returns its lines.
        across: label of the axis that goes across.
        is_over_time: whether that is the time.
    """

    name: str
    title: str
    caption: str
    draw: Callable[[Axes, tuple[Recording, ...]], list[Series]]
    across: str = "time [s]"
    is_over_time: bool = True


@dataclass(frozen=True)
class _Plan:
    name: str
    title: str
    caption: str
    draw: Callable[[Axes, Comparison], list[Series]]


def curves(comparison: Comparison) -> list[Curve]:
    """All figures of the report, in reading order."""
    from volcontact.report.plots import plans, plans_of_signals

    def bound(plan: _Plan) -> Plan:
        return Plan(
            plan.name, plan.title, plan.caption, lambda axes, _: plan.draw(axes, comparison)
        )

    runs = comparison.runs
    every = [
        *plans(runs, comparison.plots),
        *map(bound, _plans(comparison)),
        *plans_of_signals(runs),
    ]
    return [curve_of_plan(plan, runs) for plan in every]


def write_figures(made: list[Curve], folder: Path) -> list[Path]:
    """Writes every figure as `NAME.svg` and `NAME.png`, dark on white, and returns the files."""
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for curve in made:
        files += [folder / f"{curve.name}.svg", folder / f"{curve.name}.png"]
        files[-2].write_text(curve.paper, encoding="utf-8")
        curve.figure.savefig(files[-1], dpi=150, facecolor="white", transparent=False)
    return files


def _plans(comparison: Comparison) -> list[_Plan]:
    plans = [
        _Plan("height", "Height", _height_caption(comparison), _draw_height),
        _Plan(
            "force",
            "Contact force",
            "Magnitudes of all site forces added up; logarithmic.",
            _draw_force,
        ),
        _Plan(
            "force_linear",
            "Contact force, linear",
            "The same, linear; cut off above what one instant in a hundred exceeds, where peaks "
            "tower.",
            _draw_force_linear,
        ),
        _Plan(
            "penetration",
            "Penetration",
            "Depth of the deepest site; logarithmic.",
            _draw_penetration,
        ),
        _Plan(
            "energy_volumetric",
            "Energy, volumetric",
            "Stacked; the dashed line is the energy at the start, less what the finite step takes "
            "(more, where it gives). Where the stack meets it, every joule is accounted for.",
            draw_volumetric_energy,
        ),
        _Plan(
            "energy_native",
            "Energy, native",
            "Stacked; native contact stores and dissipates without an account, which leaves the "
            "grey part.",
            draw_native_energy,
        ),
        _Plan(
            "sites",
            "Contact places",
            "Volumetric: connected overlap regions. Native: contact points that push or overlap.",
            _draw_sites,
        ),
        _Plan(
            "timing",
            "Time of one step",
            "Wall time of mj_step alone; running median over a hundredth of the run.",
            _draw_timing,
        ),
    ]
    if comparison.design is not None:
        offset = _Plan(
            "offset",
            "Distance from the design pose",
            "Of the body frame; logarithmic. The dashed line is the tolerance.",
            _draw_offset,
        )
        plans.insert(1, offset)
    return plans


def thin(x: np.ndarray, y: np.ndarray, points: int = POINTS) -> tuple[np.ndarray, np.ndarray]:
    """Fewer points of a curve that keep its lowest and highest value in every interval.

    Args:
        x: shape (n,).
        y: shape (n,).
        points: at most about this many are returned.
    """
    rows = thin_rows(y, points)
    return x[rows], y[rows]


def thin_rows(y: np.ndarray, points: int = POINTS) -> np.ndarray:
    """The rows that `thin` keeps."""
    intervals = points // 2
    if len(y) <= 2 * intervals:
        return np.arange(len(y))
    edges = np.linspace(0, len(y), intervals + 1).astype(int)
    keep = {0, len(y) - 1}
    for begin, end in itertools.pairwise(edges):
        keep.add(begin + int(np.argmin(y[begin:end])))
        keep.add(begin + int(np.argmax(y[begin:end])))
    return np.array(sorted(keep))


def curve_of_plan(plan: Plan, runs: tuple[Recording, ...]) -> Curve:
    """Draws the figure of a plan."""
    with matplotlib.rc_context({**_STYLE, "svg.hashsalt": plan.name}):
        figure, axes, series = _drawn(plan, runs)
        paper = standing_alone(figure)
        figure.set_layout_engine("none")  # the places are found
        place = axes.get_position()  # after the layout, which drawing makes
        start, end = axes.get_xlim()
        data = {
            "left": round(float(place.x0), 5),
            "right": round(float(place.x1), 5),
            "start": start,
            "end": end,
            "series": [
                {"label": s.label, "color": s.color, "x": _short(s.x), "y": _short(s.y)}
                for s in series
            ],
        }
        if not plan.is_over_time:
            data = {}
        in_page = inline(paper, plan.name)
        return Curve(plan.name, plan.title, plan.caption, in_page, paper, data, figure)


def _drawn(plan: Plan, runs: tuple[Recording, ...]) -> tuple[Figure, Axes, list[Series]]:
    figure = Figure(figsize=_SIZE, layout="constrained")
    axes = figure.add_subplot()
    axes.tick_params(length=0)
    series = plan.draw(axes, runs)
    axes.set_xlabel(plan.across)
    axes.xaxis.set_major_locator(MaxNLocator(6))
    if plan.is_over_time:
        axes.set_xlim(0.0, max(run.time[-1] for run in runs) or 1.0)
    if len(runs) > 1 and not axes.get_legend():
        _legend(axes)
    return figure, axes, series


def _short(values: np.ndarray) -> list[float]:
    """Five digits, which is more than can be read off."""
    return [float(f"{value:.5g}") for value in values]


def _both(
    axes: Axes, comparison: Comparison, values: Callable[[Recording], np.ndarray]
) -> list[Series]:
    # The native run first: where both coincide the volumetric one stays visible.
    series = []
    for run in reversed(comparison.runs):
        x, y = thin(run.time, values(run))
        color = palette.RUN_COLORS[run.contact]
        axes.plot(x, y, color=color, label=run.contact)
        series.append(Series(run.contact, color, x, y))
    return series[::-1]


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


def _draw_height(axes: Axes, comparison: Comparison) -> list[Series]:
    series = []
    if comparison.volumetric.bodies:
        series = _both(axes, comparison, lambda run: run.height[:, 0])
    axes.set_ylabel("height [m]")
    _legend(axes)
    return series


def _draw_offset(axes: Axes, comparison: Comparison) -> list[Series]:
    design = comparison.design
    assert design is not None
    series = _both(
        axes, comparison, lambda run: 1e3 * np.maximum(offset_from(run, design).distance, 1e-7)
    )
    _dashed(axes, 1e3 * design.position_tolerance)
    axes.set_yscale("log")
    axes.set_ylabel("distance [mm]")
    _legend(axes)
    return series


def _dashed(axes: Axes, y: float, label: str | None = None) -> None:
    color = matplotlib.rcParams["axes.labelcolor"]
    axes.axhline(y, color=color, linewidth=0.9, linestyle="--", label=label)


def _draw_force(axes: Axes, comparison: Comparison) -> list[Series]:
    series = _both(axes, comparison, lambda run: np.maximum(run.contact_force, _FORCE_FLOOR))
    weight = comparison.volumetric.weight
    if weight > 0.0:
        _dashed(axes, weight, "weight")
    axes.set_yscale("log")
    axes.set_ylim(bottom=1.25 * _FORCE_FLOOR)  # hides the line along the floor
    axes.set_ylabel("force [N]")
    _legend(axes, columns=3)
    return series


def _draw_force_linear(axes: Axes, comparison: Comparison) -> list[Series]:
    series = _both(axes, comparison, lambda run: run.contact_force)
    if comparison.volumetric.weight > 0.0:
        _dashed(axes, comparison.volumetric.weight, "weight")
    usual = max(float(np.quantile(run.contact_force, 0.99)) for run in comparison.runs)
    most = max(float(run.contact_force.max()) for run in comparison.runs)
    axes.set_ylim(0.0, 1.1 * (usual if most > _TOWERS * usual > 0.0 else most) or 1.0)
    axes.set_ylabel("force [N]")
    _legend(axes, columns=3)
    return series


def _draw_penetration(axes: Axes, comparison: Comparison) -> list[Series]:
    series = _both(axes, comparison, lambda run: 1e3 * np.maximum(run.penetration, _DEPTH_FLOOR))
    axes.set_yscale("log")
    axes.set_ylim(bottom=1.25e3 * _DEPTH_FLOOR)
    axes.set_ylabel("depth [mm]")
    _legend(axes)
    return series


def _draw_sites(axes: Axes, comparison: Comparison) -> list[Series]:
    series = _both(axes, comparison, lambda run: run.site_count)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel("number at once")
    _legend(axes)
    return series


def _draw_timing(axes: Axes, comparison: Comparison) -> list[Series]:
    top, series = 0.0, []
    for run in reversed(comparison.runs):
        if run.steps == 0:
            continue
        x, y = _running_median(run.time[:-1], run.step_microseconds)
        top = max(top, 1.25 * float(np.quantile(y, 0.99)))
        color = palette.RUN_COLORS[run.contact]
        axes.plot(x, y, color=color, label=run.contact)
        series.append(Series(run.contact, color, x, y))
    axes.set_ylim(0.0, top or 1.0)
    axes.set_ylabel("time [µs]")
    _legend(axes)
    return series[::-1]


def _running_median(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    width = max(1, len(y) // 100)
    count = len(y) // width
    return (
        x[: count * width].reshape(count, width).mean(axis=1),
        np.median(y[: count * width].reshape(count, width), axis=1),
    )
