# SPDX-License-Identifier: Apache-2.0
"""The report of a comparison: one HTML file, numbers, curves and pictures."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from volcontact.render import Renderer
from volcontact.report.comparison import Comparison, Limits

__all__ = ["Comparison", "Limits", "write_report"]


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
    `frames/*.png` and `run.mp4`.

    Args:
        comparison: what to report.
        out: folder; made when missing, files of an earlier report are replaced.
        renderer: of the scene's model; None leaves the pictures out.
        camera: of the scene that sees the pictures; None takes the first.
        progress: called with (frames drawn, frames in all).

    Returns:
        Path of the report.
    """
    # Of the extra `report`: numbers and findings are had without it.
    from volcontact.report.figures import curves, write_figures
    from volcontact.report.page import write_page
    from volcontact.report.pictures import draw_frames, write_frames, write_movie
    from volcontact.report.table import write_table

    out.mkdir(parents=True, exist_ok=True)
    summary = json.dumps(comparison.summary(), indent=2, allow_nan=False) + "\n"
    (out / "summary.json").write_text(summary, encoding="utf-8")
    write_table(comparison.runs, out / "trajectory.parquet")
    pairs = [] if renderer is None else draw_frames(comparison, renderer, camera, progress)
    write_frames(pairs, out / "frames")
    write_movie(pairs, out / "run.mp4")
    made = curves(comparison)
    write_figures(made, out / "figures")
    return write_page(comparison, pairs, made, out / "report.html")
