# SPDX-License-Identifier: Apache-2.0
"""The most asked-for figures of a run, as names and texts for a table."""

from __future__ import annotations

from dataclasses import dataclass

from volcontact.report.comparison import Comparison, first_touch, is_seated, offset_from, peak
from volcontact.report.design_pose import DesignPose
from volcontact.report.units import angle, digits, quantity
from volcontact.running.recording import Recording


@dataclass(frozen=True)
class Row:
    """One line of the table of figures: a name and a text per run."""

    name: str
    volumetric: str
    native: str


def key_figures_side_by_side(comparison: Comparison) -> list[Row]:
    """The most asked-for figures of both runs."""
    volumetric, native = (key_figures(run, comparison.design) for run in comparison.runs)
    return [Row(a[0], a[1], b[1]) for a, b in zip(volumetric, native, strict=True)]


def measured(run: Recording, design: DesignPose | None) -> list[tuple[str, str, float | None]]:
    """The figures of one run that are measured, as (name, unit, value): SI, angles in degrees."""
    rows: list[tuple[str, str, float | None]] = []
    if design is not None:
        offset = offset_from(run, design)
        rows += [
            ("Distance from design pose", "m", float(offset.distance[-1])),
            ("Angle from design pose", "degree", float(offset.angle[-1])),
        ]
    return [
        *rows,
        ("First touch", "s", first_touch(run)),
        ("Largest contact force", "N", float(run.contact_force.max())),
        ("Largest force of one place", "N", peak(run, "force").value),
        ("Largest torque of one place", "N m", peak(run, "torque").value),
        ("Contact force at the end", "N", float(run.contact_force[-1])),
        ("Largest penetration", "m", float(run.penetration.max())),
        ("Penetration at the end", "m", float(run.penetration[-1])),
        ("Speed at the end", "m/s", float(run.speed[-1].max(initial=0.0))),
        ("Mechanical energy at the start", "J", float(run.energy[0])),
        ("Mechanical energy at the end", "J", float(run.energy[-1])),
    ]


def text_of(value: float | None, unit: str) -> str:
    """A measured figure as of a table."""
    if value is None:
        return "never"
    if unit == "degree":
        return angle(value)
    return f"{digits(value)} s" if unit == "s" else quantity(value, unit)


def key_figures(run: Recording, design: DesignPose | None) -> list[tuple[str, str]]:
    """The most asked-for figures of one run, as (name, text)."""
    rows = [(name, text_of(value, unit)) for name, unit, value in measured(run, design)]
    if design is not None:
        rows.insert(0, ("Seated", "yes" if is_seated(run, design) else "no"))
    touch = next(i for i, (name, _) in enumerate(rows) if name == "First touch")
    rows.insert(touch + 1, ("Most contact places at once", f"{run.site_count.max()}"))
    return [
        *rows,
        ("Time of one step (median)", quantity(1e-6 * run.microseconds_per_step, "s")),
        ("MuJoCo warnings", f"{sum(run.warnings.values())}"),
    ]
