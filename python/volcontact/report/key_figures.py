# SPDX-License-Identifier: Apache-2.0
"""The most asked-for figures of a run, as names and texts for a table."""

from __future__ import annotations

from dataclasses import dataclass

from volcontact.recording import Recording
from volcontact.report.comparison import Comparison, first_touch, is_seated, offset_from, peak
from volcontact.report.design_pose import DesignPose
from volcontact.report.units import angle, digits, quantity


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


def key_figures(run: Recording, design: DesignPose | None) -> list[tuple[str, str]]:
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
        ("Largest force of one place", quantity(peak(run, "force").value, "N")),
        ("Largest torque of one place", quantity(peak(run, "torque").value, "N m")),
        ("Contact force at the end", quantity(run.contact_force[-1], "N")),
        ("Largest penetration", quantity(run.penetration.max(), "m")),
        ("Penetration at the end", quantity(run.penetration[-1], "m")),
        ("Speed at the end", quantity(float(run.speed[-1].max(initial=0.0)), "m/s")),
        ("Mechanical energy at the start", quantity(run.energy[0], "J")),
        ("Mechanical energy at the end", quantity(run.energy[-1], "J")),
        ("Time of one step (median)", quantity(1e-6 * run.microseconds_per_step, "s")),
        ("MuJoCo warnings", f"{sum(run.warnings.values())}"),
    ]
