# SPDX-License-Identifier: Apache-2.0
"""The report of a comparison: one HTML file, numbers, curves and pictures."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from volcontact._files import appearing_in
from volcontact.render import Renderer
from volcontact.report import files
from volcontact.report.comparison import Comparison, Limits

__all__ = ["Comparison", "Limits", "fill_report", "write_report"]


def write_report(
    comparison: Comparison,
    out: Path,
    *,
    renderer: Renderer | None,
    camera: str | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Writes the report, all its numbers and all its pictures.

    These are `report.html`, `summary.json`, `trajectory.parquet` and `.csv` (every instant),
    `sites.parquet` and `.csv` (every contact site of every instant), `figures/*.svg` and `*.png`,
    `frames/*.png` and `run.mp4`. The report appears whole or not at all.

    Args:
        comparison: what to report.
        out: folder; made when missing. An earlier report in it goes, all other files stay.
        renderer: of the scene's model; None leaves the pictures out.
        camera: of the scene that sees the pictures; None takes the first.
        progress: called with (frames drawn, frames in all).

    Returns:
        Path of the report.
    """
    with appearing_in(out, files.ALL) as folder:
        fill_report(comparison, folder, renderer=renderer, camera=camera, progress=progress)
    return out / files.REPORT


def fill_report(
    comparison: Comparison,
    folder: Path,
    *,
    renderer: Renderer | None,
    camera: str | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> None:
    """Writes a report, as `write_report`, file by file into a folder that is there and empty."""
    # Of the extra `report`: numbers and findings are had without it.
    from volcontact.report.figures import curves, write_figures
    from volcontact.report.page import write_page
    from volcontact.report.pictures import draw_frames, write_frames, write_movie
    from volcontact.report.table import write_table

    made = curves(comparison)  # first: an unknown column is an error before the pictures
    summary = json.dumps(comparison.summary(), indent=2, allow_nan=False) + "\n"
    (folder / files.SUMMARY).write_text(summary, encoding="utf-8")
    write_table(comparison.runs, folder / files.TRAJECTORY)
    pairs = [] if renderer is None else draw_frames(comparison, renderer, camera, progress)
    write_frames(pairs, folder / files.FRAMES)
    write_movie(pairs, folder / files.FILM)
    write_figures(made, folder / files.FIGURES)
    write_page(comparison, pairs, made, folder / files.REPORT)
