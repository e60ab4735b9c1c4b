# SPDX-License-Identifier: Apache-2.0
"""The HTML page of a comparison: one file that needs nothing else and no network."""

from __future__ import annotations

import base64
import json
from dataclasses import dataclass
from pathlib import Path

import jinja2
import numpy as np
from markupsafe import Markup

from volcontact.messages.printable import printable
from volcontact.report import palette, step_error
from volcontact.report.comparison import Comparison
from volcontact.report.description import tables
from volcontact.report.figures import Curve
from volcontact.report.findings import findings
from volcontact.report.key_figures import key_figures_side_by_side
from volcontact.report.pictures import FramePair, png, reference_force
from volcontact.report.units import area, nominal, quantity
from volcontact.running.recording import Frame, Recording

_PALETTE_COLORS = 200  # of the embedded pictures; the files in frames/ keep all


def write_page(
    comparison: Comparison, pairs: list[FramePair], made: list[Curve], path: Path
) -> Path:
    """Writes the report and returns its path."""
    path.write_text(page(comparison, pairs, made), encoding="utf-8")
    return path


def page(comparison: Comparison, pairs: list[FramePair], made: list[Curve]) -> str:
    """The report as HTML text, of its pictures and its curves."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent / "templates"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
        finalize=_seen,
    )
    run = comparison.volumetric
    parts = tables(run.description)
    return environment.get_template("report.html.j2").render(
        title=title_of(comparison.scene),
        scene=label_of(comparison.scene),
        comparison=comparison,
        settings=_settings(comparison),
        findings=findings(comparison),
        rows=key_figures_side_by_side(comparison),
        frames=[_embedded(pair) for pair in pairs],
        curves=made,
        data=_script_data(comparison, made),
        tables=[table for table in parts if len(table.rows) <= 12],
        long_tables=[table for table in parts if len(table.rows) > 12],
        scene_warnings=run.description.get("warnings", ()),
        notes=tuple(dict.fromkeys(note for each in comparison.runs for note in each.notes)),
        step_error=comparison.error_of_step,
        step_words=step_error,
        reference=quantity(reference_force(comparison), "N"),
        by_weight=run.weight > 0.0,
        colors=palette,
    )


def _seen(value: object) -> object:
    """What a template is given: names may have control characters; figures are made without."""
    return printable(value) if type(value) is str else value


def title_of(scene: str) -> str:
    """A heading for a scene: the folder of a `scene.xml`, else the name of the file."""
    if scene.lstrip().startswith("<"):
        return "Scene"
    path = Path(scene)
    name = path.resolve().parent.name if path.stem == "scene" else path.stem
    return name.replace("_", " ").replace("-", " ").capitalize() or "Scene"


def label_of(scene: str) -> str:
    """Where a scene is, without the part of an absolute path that only its machine knows."""
    if scene.lstrip().startswith("<"):
        return "MJCF text"
    path = Path(scene)
    return "/".join(path.parts[-3:]) if path.is_absolute() else scene


_MOST_ROWS = 40  # of the sites of a frame; more are counted, not listed


def _script_data(comparison: Comparison, made: list[Curve]) -> Markup:
    """What the page's script reads: the numbers of the curves, and the sites of every frame."""
    data = {
        "curves": {curve.name: curve.data for curve in made if curve.data},
        "sites": {
            run.contact: [_site_rows(run, frame) for frame in run.frames] for run in comparison.runs
        },
        "times": [round(frame.time, 6) for frame in comparison.volumetric.frames],
    }
    # Nothing in it may end the script element.
    return Markup(json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"))


def _site_rows(run: Recording, frame: Frame) -> list[list[str]]:
    forces = np.linalg.norm(frame.sites["force"], axis=1)
    rows = []
    for i in np.argsort(-forces)[:_MOST_ROWS]:
        site = frame.sites[i]
        along = abs(float(site["force"] @ site["normal"]))
        rows.append(
            [
                printable(f"{run.geoms[site['geom_a']]} with {run.geoms[site['geom_b']]}"),
                quantity(along, "N"),
                quantity(float(np.sqrt(max(forces[i] ** 2 - along**2, 0.0))), "N"),
                quantity(float(np.linalg.norm(site["torque"])), "N m"),
                quantity(float(site["depth"]), "m"),
                area(float(site["area"])) if site["area"] > 0.0 else "a point",
            ]
        )
    if len(frame.sites) > _MOST_ROWS:
        rows.append([f"and {len(frame.sites) - _MOST_ROWS} more", "", "", "", "", ""])
    return rows


def _settings(comparison: Comparison) -> list[tuple[str, str]]:
    run = comparison.volumetric
    return [
        ("Simulated time", nominal(float(run.time[-1]), "s")),
        ("Timestep", nominal(run.timestep, "s")),
        ("Steps", f"{run.steps}"),
        ("MuJoCo", comparison.mujoco_version),
        ("volcontact", comparison.volcontact_version),
    ]


@dataclass(frozen=True)
class _Embedded:
    time: str
    volumetric: str
    native: str
    notes: tuple[str, str]


def _embedded(pair: FramePair) -> _Embedded:
    return _Embedded(
        time=f"{pair.time:.2f}",
        volumetric=_data_uri(pair.volumetric),
        native=_data_uri(pair.native) if pair.native is not None else "",
        notes=pair.notes,
    )


def _data_uri(picture: np.ndarray) -> str:
    code = base64.b64encode(png(picture, _PALETTE_COLORS)).decode("ascii")
    return f"data:image/png;base64,{code}"
