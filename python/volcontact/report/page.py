# SPDX-License-Identifier: Apache-2.0
"""The HTML page of a comparison: one file that needs nothing else and no network."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from pathlib import Path

import jinja2
import numpy as np

from volcontact.recording import Recording
from volcontact.report import palette
from volcontact.report.comparison import Comparison, first_touch, is_seated, offset_from
from volcontact.report.description import tables
from volcontact.report.design_pose import DesignPose
from volcontact.report.figures import curves
from volcontact.report.findings import findings
from volcontact.report.pictures import FramePair, png, reference_force
from volcontact.report.units import angle, digits, nominal, quantity

_PALETTE_COLORS = 200  # of the embedded pictures; the files in frames/ keep all


@dataclass(frozen=True)
class Row:
    """One line of the table of figures: a name and a text per run."""

    name: str
    volumetric: str
    native: str


def write_page(comparison: Comparison, pairs: list[FramePair], path: Path) -> Path:
    """Writes the report and returns its path."""
    path.write_text(page(comparison, pairs), encoding="utf-8")
    return path


def page(comparison: Comparison, pairs: list[FramePair]) -> str:
    """The report as HTML text."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent / "templates"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    run = comparison.volumetric
    parts = tables(run.description)
    return environment.get_template("report.html.j2").render(
        title=title_of(comparison.scene),
        scene=label_of(comparison.scene),
        comparison=comparison,
        settings=_settings(comparison),
        findings=findings(comparison),
        rows=figures_side_by_side(comparison),
        frames=[_embedded(pair) for pair in pairs],
        curves=curves(comparison),
        tables=[table for table in parts if len(table.rows) <= 12],
        long_tables=[table for table in parts if len(table.rows) > 12],
        scene_warnings=run.description.get("warnings", ()),
        reference=quantity(reference_force(comparison), "N"),
        by_weight=run.weight > 0.0,
        colors=palette,
    )


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


def figures_side_by_side(comparison: Comparison) -> list[Row]:
    """The most asked-for figures of both runs."""
    volumetric, native = (figures(run, comparison.design) for run in comparison.runs)
    return [Row(a[0], a[1], b[1]) for a, b in zip(volumetric, native, strict=True)]


def figures(run: Recording, design: DesignPose | None) -> list[tuple[str, str]]:
    """The most asked-for figures of one run, as (name, text)."""
    rows = []
    if design is not None:
        offset = offset_from(run, design)
        rows += [
            ("Seated", "yes" if is_seated(run, design) else "no"),
            ("Distance from design pose", quantity(float(offset.distance[-1]), "m")),
            ("Angle from design pose", angle(float(offset.angle[-1]))),
        ]
    touch = first_touch(run)
    return [
        *rows,
        ("First touch", "never" if touch is None else f"{digits(touch)} s"),
        ("Most contact places at once", f"{run.site_count.max()}"),
        ("Largest contact force", quantity(run.contact_force.max(), "N")),
        ("Contact force at the end", quantity(run.contact_force[-1], "N")),
        ("Largest penetration", quantity(run.penetration.max(), "m")),
        ("Penetration at the end", quantity(run.penetration[-1], "m")),
        ("Speed at the end", quantity(float(run.speed[-1].max(initial=0.0)), "m/s")),
        ("Mechanical energy at the start", quantity(run.energy[0], "J")),
        ("Mechanical energy at the end", quantity(run.energy[-1], "J")),
        ("Time of one step (median)", quantity(1e-6 * run.microseconds_per_step, "s")),
        ("MuJoCo warnings", f"{sum(run.warnings.values())}"),
    ]


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
