# SPDX-License-Identifier: Apache-2.0
"""The report of an identification: one HTML file, with its figures and a motion to watch."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from volcontact._files import appearing
from volcontact.identify import pictures, scores
from volcontact.identify.bench import Bench, Values
from volcontact.identify.estimators.scales import Box
from volcontact.identify.estimators.uncertainty import Known
from volcontact.identify.measurements import Trial
from volcontact.identify.settings import Settings
from volcontact.messages.printable import printable
from volcontact.report.svg import standing_alone

_PAGE = Path(__file__).with_name("report.html.jinja")


def write_report(
    settings: Settings,
    summary: dict[str, Any],
    known: Known,
    box: Box,
    trials: list[Trial],
    raw: list[dict[str, np.ndarray]],
    file: Path,
) -> None:
    """Writes the report.

    Args:
        settings: of the study.
        summary: of `run`.
        known: of the parameters.
        box: of the parameters.
        trials: that are shown: those to judge on, else those of the fit.
        raw: their errors.
        file: to write.
    """
    values = {name: each["value"] for name, each in summary["parameters"].items()}
    order = np.argsort(scores.ranking(settings, raw), kind="stable")
    chosen = {
        "best": int(order[0]),
        "median": int(order[len(order) // 2]),
        "worst": int(order[-1]),
    }
    bench = Bench(settings, trials)
    try:
        shown = [_trial(settings, bench, values, word, place) for word, place in chosen.items()]
    finally:
        bench.close()
    names = [each.name for each in settings.parameters]
    correlations = pictures.correlations(names, known.correlation) if len(names) > 1 else None
    profiles = [
        pictures.profile(name, each["values"], each["rises"], settings)
        for name, each in summary["profiles"].items()
    ]
    page = jinja2.Environment(autoescape=True, finalize=_seen).from_string(
        _PAGE.read_text(encoding="utf-8")
    )
    text = page.render(
        title=summary["name"],
        summary=summary,
        rows=[_row(name, each) for name, each in summary["parameters"].items()],
        level=f"{100 * summary['level']:g} %",
        errors=[(word, _errors(summary[word])) for word in ("fit", "judge") if word in summary],
        histograms=_svg(pictures.histograms(settings, raw)),
        correlations=_svg(correlations) if correlations is not None else None,
        profiles=[_svg(each) for each in profiles],
        chain=_svg(pictures.chain(settings, box, known.chain)) if known.chain else None,
        trials=shown,
        study=settings.text,
    )
    with appearing(file) as made:
        made.write_text(text, encoding="utf-8")


def _row(name: str, each: dict[str, Any]) -> list[str]:
    low = "" if each["low"] is None else f"{each['low']:.4g}"
    high = "" if each["high"] is None else f"{each['high']:.4g}"
    said = "" if each["told"] else "not told by the data"
    return [name, f"{each['value']:.5g}", f"{low} to {high}", said, ", ".join(each["targets"])]


def _errors(table: dict[str, Any]) -> list[list[str]]:
    found = []
    for name, each in table.items():
        after = ["" if part is None else f"{part:.3g}" for part in each["after_impacts"]]
        found.append([name, each["unit"], f"{each['mean']:.4g}", f"{each['median']:.4g}", *after])
    return found


def _trial(
    settings: Settings, bench: Bench, values: Values, word: str, place: int
) -> dict[str, Any]:
    trial = bench.trials[place]
    predicted = bench.predicted(values, place)
    motion = pictures.motion(settings, trial, predicted)
    return {
        "word": word,
        "label": trial.label,
        "figure": _svg(pictures.beside(settings, trial, predicted)),
        "motion": Markup(json.dumps(motion)) if motion else None,
    }


def _svg(figure: Figure) -> Markup:
    text = standing_alone(figure)
    return Markup(text[text.index("<svg") :])


def _seen(value: object) -> object:
    return printable(value) if type(value) is str else value
