# SPDX-License-Identifier: Apache-2.0
"""The plots of the performance page."""

from __future__ import annotations

from collections.abc import Callable

from matplotlib.figure import Figure
from parts.performance_results import ASKED, by_scene, in_cpp, is_ours, read, span, times_of

from volcontact.report.palette import NATIVE, UNEXPLAINED, VOLUMETRIC

STYLE = {
    "svg.fonttype": "none",
    "svg.hashsalt": "volcontact",  # the same file from the same numbers
    "font.family": "sans-serif",
    "font.size": 10.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": "#e4e7eb",
    "legend.frameon": False,
}


def _plot_pairs() -> Figure:
    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    axes = figure.subplots()
    for y, asked in enumerate(ASKED):
        times = times_of(asked)
        color = VOLUMETRIC if max(times) < asked.time else NATIVE
        axes.plot([min(*times, asked.time), max(*times, asked.time)], [y, y], color="#dfe3e8")
        axes.plot(times, [y] * len(times), "o", ms=4, color=color, alpha=0.45)
        axes.plot(max(times), y, "o", ms=7, color=color)
        axes.plot(asked.time, y, "|", ms=14, mew=2, color="#30363d")
    for label, style in (
        ("measured, the slowest benchmark of the row", dict(marker="o", color=VOLUMETRIC)),
        ("the same, slower than asked", dict(marker="o", color=NATIVE)),
        ("asked", dict(marker="|", color="#30363d", ms=12, mew=2)),
    ):
        axes.plot([], [], ls="", label=label, **style)
    axes.set_yticks(range(len(ASKED)), [asked.title for asked in ASKED])
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.minorticks_off()
    axes.set_xticks([0.01, 0.1, 1, 10, 100, 1e3, 1e4], _names([0.01, 0.1, 1, 10, 100, 1e3, 1e4]))
    axes.grid(axis="x")
    axes.set_xlabel("time of one query, one thread")
    figure.legend(loc="outside upper right", ncols=3, fontsize=9)
    return figure


# Colour says who, shape says what the answer is.
_LOOKS = {
    "volcontact, from Python": ("volcontact from Python (volume)", VOLUMETRIC, "o"),
    "manifold3d, boolean": (None, "#1aa179", "o"),
    "manifold3d, boolean, 64 segments": ("manifold3d, flat or 64 chords (volume)", "#1aa179", "o"),
    "manifold3d, boolean, 256 segments": ("manifold3d, 256 chords (volume)", "#0b5e46", "o"),
    "Drake, hydroelastic": ("Drake hydroelastic (surface)", "#8a4fff", "D"),
    "Drake, point": ("Drake point (points)", "#8a4fff", "x"),
    "MuJoCo, native": ("MuJoCo native (points)", NATIVE, "x"),
    "MuJoCo, SDF": ("MuJoCo SDF (points)", "#f2b134", "x"),
}


def _plot_peers() -> Figure:
    rows = read("peers")
    ours = {row["case"]: float(in_cpp(row["case"])["time_us"]) for row in rows}
    return _ratios(rows, ours, _LOOKS)


_MESH_LOOKS = {
    "manifold3d, boolean": ("manifold3d (overlap, volume)", "#1aa179", "o"),
    "CGAL, corefinement": ("CGAL (overlap, all moments)", "#c0392b", "o"),
    "manifold3d, boolean, 64 segments": (None, "#1aa179", "o"),
    "Drake, hydroelastic": ("Drake hydroelastic (surface)", "#8a4fff", "D"),
    "MuJoCo, native": ("MuJoCo native (points of hulls)", NATIVE, "x"),
    "MuJoCo, SDF": ("MuJoCo SDF (points)", "#f2b134", "x"),
}


def _plot_meshes() -> Figure:
    rows = read("mesh_pairs")
    ours = {row["case"]: float(row["time_us"]) for row in rows if is_ours(row)}
    return _ratios(rows, ours, _MESH_LOOKS)


def _ratios(
    rows: list[dict[str, str]],
    ours: dict[str, float],
    looks: dict[str, tuple[str | None, str, str]],
) -> Figure:
    """Times by ours, a line for each pair."""
    cases = list(ours)
    figure = Figure(figsize=(8.0, 1.2 + 0.26 * len(cases)), layout="constrained")
    axes = figure.subplots()
    for name, (label, color, marker) in looks.items():
        mine = [row for row in rows if f"{row['library']}, {row['variant']}" == name]
        ratios = [float(row["time_us"]) / ours[row["case"]] for row in mine]
        places = [cases.index(row["case"]) for row in mine]
        if mine:
            axes.plot(ratios, places, marker, ms=6, color=color, label=label, alpha=0.85)
    axes.axvline(1.0, color="#30363d", lw=1.2)
    axes.set_yticks(range(len(cases)), cases)
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.minorticks_off()
    ticks = [1e-4, 0.01, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e6]
    low, high = axes.get_xlim()
    ticks = [tick for tick in ticks if low <= tick <= high]
    axes.set_xticks(ticks, [f"{tick:,.0f}" if tick >= 1 else f"{tick:g}" for tick in ticks])
    axes.grid()
    axes.set_xlabel("time by that of volcontact in C++ (left of 1: faster than ours)")
    figure.legend(loc="outside upper right", ncols=3, fontsize=8.5)
    return figure


def _plot_steps() -> Figure:
    scenes = by_scene()
    figure = Figure(figsize=(8.0, 4.4), layout="constrained")
    axes = figure.subplots()
    for k, (kind, label, color) in enumerate(
        (
            ("none", "no contact", UNEXPLAINED),
            ("native", "native contact", NATIVE),
            ("volumetric", "volumetric contact", VOLUMETRIC),
        )
    ):
        times = [float(kinds[kind]["time_us"]) for kinds in scenes.values()]
        places = [y + 0.27 * (k - 1) for y in range(len(scenes))]
        axes.barh(places, times, 0.25, color=color, label=label)
        for x, y in zip(times, places, strict=True):
            axes.text(x, y, f" {x:.3g}", va="center", fontsize=8)
    axes.set_yticks(range(len(scenes)), list(scenes))
    axes.invert_yaxis()
    axes.grid(axis="x")
    axes.set_xlabel("processor time of one step [us]")
    figure.legend(loc="outside upper right", ncols=3, fontsize=9)
    return figure


def _names(ticks: list[float]) -> list[str]:
    return [span(tick) for tick in ticks]


PLOT: dict[str, Callable[[], Figure]] = {
    "pairs": _plot_pairs,
    "peers": _plot_peers,
    "meshes": _plot_meshes,
    "steps": _plot_steps,
}
