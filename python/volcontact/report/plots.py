# SPDX-License-Identifier: Apache-2.0
"""Curves that the user asks for, and those of what a scene measures: linear, over any column."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np
from matplotlib.axes import Axes

from volcontact.messages.printable import drawn
from volcontact.messages.spelling import nearest
from volcontact.report import palette
from volcontact.report.figures import Curve, Plan, curve_of_plan, thin_rows
from volcontact.report.series import Series
from volcontact.report.table import columns_of
from volcontact.running.recording import Recording

_MOST = 6  # curves of what a scene measures that are drawn unasked


def plots_of_run(run: Recording, wanted: Iterable[str]) -> list[Curve]:
    """A curve of one run for each `Y` or `Y:X`, names of columns of the trajectory.

    Raises:
        ValueError: there is no such column.
    """
    return [curve_of_plan(plan, (run,)) for plan in plans((run,), wanted)]


def plans(runs: tuple[Recording, ...], wanted: Iterable[str]) -> Iterator[Plan]:
    """How each curve is drawn; see `plots_of_run`."""
    known = columns_of(runs[0])
    for i, text in enumerate(wanted):
        y, x = _names(text, known)
        yield _plan(f"plot_{i + 1}", y, x, known)


def plans_of_signals(runs: tuple[Recording, ...]) -> Iterator[Plan]:
    """Forces of actuators and sensors over time, and over the way of the one joint that is driven.

    Those that stay 0 are left out, and all beyond a handful.
    """
    run, known = runs[0], columns_of(runs[0])
    forces = [
        name
        for name in run.signals
        if (name.startswith("sensor.") or name.endswith(".force"))
        and any(other.signals[name].values.any() for other in runs if name in other.signals)
    ]
    for i, name in enumerate(forces[:_MOST]):
        yield _plan(f"signal_{i + 1}", name, "time", known)


def _names(text: str, known: Mapping[str, tuple[np.ndarray, str]]) -> tuple[str, str]:
    """The columns of `Y` or `Y:X`; names may have colons of their own."""
    if text in known:
        return text, "time"
    splits = [(text[:i], text[i + 1 :]) for i, letter in enumerate(text) if letter == ":"]
    for y, x in splits:
        if y in known and x in known:
            return y, x
    wrong = [name for name in (splits[0] if splits else (text,)) if name not in known]
    raise ValueError(f"the trajectory has no column {wrong[0]!r}{nearest(wrong[0], known)}")


def _plan(name: str, y: str, x: str, known: Mapping[str, tuple[np.ndarray, str]]) -> Plan:
    def draw(axes: Axes, runs: tuple[Recording, ...]) -> list[Series]:
        series = []
        for run in reversed(runs):
            columns = columns_of(run)
            rows = thin_rows(columns[y][0])
            across, up = columns[x][0][rows], columns[y][0][rows]
            color = palette.RUN_COLORS[run.contact]
            axes.plot(across, up, color=color, label=run.contact)
            series.append(Series(run.contact, color, across, up))
        axes.set_ylabel(drawn(f"{y} {_bracketed(known[y][1])}"))
        return series[::-1]

    over = "time" if x == "time" else x
    return Plan(
        name,
        y if x == "time" else f"{y} over {x}",
        f"{y} {_bracketed(known[y][1])} over {over}; linear.",
        draw,
        drawn(f"{x} {_bracketed(known[x][1])}"),
        is_over_time=x == "time",
    )


def _bracketed(unit: str) -> str:
    return "[-]" if unit == "1" else f"[{unit}]"
