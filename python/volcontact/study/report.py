# SPDX-License-Identifier: Apache-2.0
"""The report of a study: one HTML file with probabilities, maps, indices and the worst trials."""

from __future__ import annotations

import base64
import itertools
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
import pyarrow as pa
from markupsafe import Markup
from matplotlib.figure import Figure

from volcontact._files import appearing
from volcontact.messages.printable import printable
from volcontact.messages.spelling import nearest
from volcontact.report.svg import standing_alone
from volcontact.study import figures
from volcontact.study.driver import settings_of
from volcontact.study.estimates import rare_event, sensitivity, wilson
from volcontact.study.file.settings import Settings, StudyError
from volcontact.study.results import Folder

_PAGE = """\
<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>{{ title }}</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
body { font: 16px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem;
  color: #1b1f27; background: #fff; }
h1 { margin-bottom: 0; } .finding { font-size: 1.15rem; }
table { border-collapse: collapse; } td, th { padding: .15rem .8rem .15rem 0; text-align: left; }
figure { margin: 1rem 0; } svg, img { max-width: 100%; height: auto; }
.worst { display: grid; grid-template-columns: repeat(auto-fill, minmax(15rem, 1fr)); gap: 1rem; }
.muted { color: #5b6472; font-size: .9rem; }
</style></head><body>
<h1>{{ title }}</h1>
<p class="muted">{{ subtitle }}</p>
{% for line in findings %}<p class="finding">{{ line }}</p>
{% endfor %}
<h2>Outcomes</h2>
<table><tr><th>outcome</th><th>trials</th><th>share</th></tr>
{% for row in outcomes %}<tr>{% for cell in row %}<td>{{ cell }}</td>{% endfor %}</tr>
{% endfor %}</table>
{% for heading, parts in sections %}<h2>{{ heading }}</h2>
{% for part in parts %}<figure>{{ part }}</figure>
{% endfor %}{% endfor %}
{% if worst %}<h2>The worst trials</h2>
<p>By {{ worst_by }}; each again with <code>volcontact study replay {{ folder }} TRIAL</code>.</p>
<div class="worst">{% for trial in worst %}<figure>{{ trial.picture }}
<figcaption>trial {{ trial.number }}: {{ trial.text }}</figcaption></figure>{% endfor %}</div>
{% endif %}
<h2>Where this comes from</h2>
<table>{% for name, value in provenance %}<tr><td>{{ name }}</td><td>{{ value }}</td></tr>
{% endfor %}</table>
<pre>{{ study }}</pre>
</body></html>
"""


def write_study_report(
    out: Path, file: Path, *, inputs: tuple[str, ...] = (), pictures: bool = True
) -> Path:
    """Writes the report of a folder.

    Args:
        out: folder of the study; it may still be running.
        file: HTML file to write.
        inputs: that success and peak force are mapped over, in pairs; none takes the four that
            decide most, a single one goes with each of them.
        pictures: whether the worst trials are drawn.

    Raises:
        StudyError: no folder of a study, or without trials; or it has no such input.
    """
    folder = Folder(out)
    settings = settings_of(folder)
    said = folder.provenance()
    rows = folder.read()
    counts = dict(sorted(folder.counts().items(), key=lambda entry: -entry[1]))
    by_success = sensitivity(settings, rows, "success")
    sections = _sections(settings, rows, by_success, inputs)
    worst_by, worst = _worst(settings, folder, rows) if pictures else ("", [])
    page = jinja2.Environment(autoescape=True, finalize=_seen).from_string(_PAGE)
    versions = ", ".join(f"{name} {number}" for name, number in said["versions"].items())
    text = page.render(
        title=said["name"],
        subtitle=f"{len(rows)} of {said['trials']} trials, method {said['method']}, seed "
        f"{said['seed']}",
        findings=findings(settings, rows, by_success),
        outcomes=[(name, n, f"{100 * n / len(rows):.2f} %") for name, n in counts.items()],
        sections=sections,
        worst=worst,
        worst_by=worst_by,
        folder=out.name,
        provenance=[
            ("study", said["study_sha256"]),
            ("model", said["model_sha256"] or "none: a function"),
            ("versions", versions),
            ("machine", f"{said['machine']['processor']}, {said['machine']['system']}"),
        ],
        study=settings.text,
    )
    with appearing(file) as made:
        made.write_text(text, encoding="utf-8")
    return file


def findings(settings: Settings, rows: pa.Table, indices: Any) -> list[str]:
    """What a reviewer can quote."""
    n = len(rows)
    options = settings.sample.options
    lines = []
    if settings.sample.method == "importance":
        found = rare_event(rows, options["response"], options["threshold"])
        lines.append(
            f"{options['response']} exceeds {options['threshold']:g} with probability "
            f"{found.probability:.3g} (95 % interval {found.low:.3g} to {found.high:.3g}, "
            f"importance sampling, {found.events} events in {found.trials} trials)."
        )
    elif settings.sample.method in ("monte_carlo", "latin_hypercube", "sobol"):
        good = int(np.count_nonzero(rows["success"].to_numpy(zero_copy_only=False)))
        low, high = wilson(good, n)
        lines.append(
            f"{good} of {n} trials succeeded: a probability of {good / n:.4g} (95 % interval "
            f"{low:.4g} to {high:.4g}, Wilson)."
        )
    else:
        lines.append(
            f"The {n} trials are placed by {settings.sample.method}: their share of successes is "
            "no probability."
        )
    if indices is not None and indices.values[0] > indices.errors[0]:
        lines.append(
            f"Success depends most on {indices.names[0]} (index {indices.values[0]:.2g} +- "
            f"{indices.errors[0]:.2g}, {indices.method})."
        )
    return lines


def _seen(value: object) -> object:
    return printable(value) if type(value) is str else value


def _svg(figure: Figure) -> Markup:
    text = standing_alone(figure)
    return Markup(text[text.index("<svg") :])


def _sections(
    settings: Settings, rows: pa.Table, by_success: Any, inputs: tuple[str, ...]
) -> list[tuple[str, list[Markup]]]:
    success = rows["success"].to_numpy(zero_copy_only=False)
    response = settings.sample.options.get("response")
    names = set(rows.column_names)
    found: list[tuple[str, list[Markup]]] = []
    shown = [by_success]
    for column in (response, "peak_force"):
        if column is not None and column in names:
            shown.append(sensitivity(settings, rows, column))
    bars = [_svg(figures.bars(each)) for each in shown if each is not None]
    if bars:
        found.append(("Which input decides", bars))
    force = rows["peak_force"].to_numpy() if "peak_force" in names else None
    maps = [
        _svg(figures.maps(rows[a].to_numpy(), rows[b].to_numpy(), success, force, [a, b]))
        for a, b in _pairs(settings, rows, by_success, inputs)
    ]
    if maps:
        found.append(("Maps over two inputs", maps))
    shown_columns = [n for n in ("time", "peak_force", "peak_torque", "first_touch") if n in names]
    shown_columns += [*settings.record.columns, *(n for n, _ in settings.record.final)]
    columns = {n: rows[n].to_numpy() for n in shown_columns}
    if columns:
        found.append(("Distributions", [_svg(figures.histograms(columns))]))
    if "place" in names and not success.all():
        ended = [p for p, s in zip(rows["place"].to_pylist(), success, strict=True) if not s]
        counts = {p or "no contact": ended.count(p) for p in sorted(set(ended))}
        title = "largest force at the end of trials without success"
        found.append(("Where it ends", [_svg(figures.tallies(counts, title))]))
    return found


def _pairs(
    settings: Settings, rows: pa.Table, by_success: Any, inputs: tuple[str, ...]
) -> list[tuple[str, str]]:
    """Which inputs are mapped."""
    for name in inputs:
        if name not in settings.columns:
            raise StudyError(
                f"--map {name!r}: the study has no such input{nearest(name, settings.columns)}"
            )
    varied = [n for n in settings.columns if len(set(rows[n].to_pylist())) > 1]
    varied = [n for n in varied if not isinstance(rows[n][0].as_py(), str)]
    first = list(by_success.names) if by_success is not None else varied
    decide = [n for n in first if n in varied][:4]
    if len(inputs) == 1:
        return [(inputs[0], other) for other in decide if other != inputs[0]]
    return list(itertools.combinations(inputs or decide, 2))


def _worst(settings: Settings, folder: Folder, rows: pa.Table) -> tuple[str, list[dict[str, Any]]]:
    """The ten worst trials, drawn at their end."""
    if settings.scene is None:
        return "", []
    from volcontact.render import Renderer, RenderError
    from volcontact.report.pictures import png
    from volcontact.study.replay import replay_trial

    by = settings.sample.options.get("response", "peak_force")
    numbers = np.nan_to_num(rows[by].to_numpy(), nan=-np.inf)
    success = rows["success"].to_numpy(zero_copy_only=False)
    order = np.lexsort((-numbers, success))[:10]
    made = []
    for place in order:
        trial = int(rows["trial"][int(place)].as_py())
        row = rows.slice(int(place), 1).to_pylist()[0]
        text = f"{row['outcome']}, {by} {row[by]:.4g}, {row['place']}"
        picture = Markup("")
        again = replay_trial(folder.path, trial) if row["outcome"] != "crashed" else None
        if again is not None and again.model is not None and len(again.states):
            try:
                renderer = Renderer(again.model, width=480, height=360)
            except RenderError:
                renderer = None
            if renderer is not None:
                code = base64.b64encode(png(renderer.draw(again.states[-1]), 128)).decode("ascii")
                renderer.close()
                picture = Markup(f'<img alt="trial {trial}" src="data:image/png;base64,{code}">')
        made.append({"number": trial, "text": text, "picture": picture})
    return f"success, then {by}", made
