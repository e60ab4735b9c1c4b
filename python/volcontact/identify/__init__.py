# SPDX-License-Identifier: Apache-2.0
"""Parameters from measurements. See docs/identification.md."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from volcontact.identify.estimators.search import Progress
    from volcontact.identify.run import Identified

__all__ = ["identify"]


def identify(
    path: str | os.PathLike[str],
    out: str | os.PathLike[str] | None = None,
    *,
    measurements: Sequence[str | os.PathLike[str]] | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Identified:
    """Finds parameters of a scene from measured motions.

        found = vc.identify("drop/study.toml", "results")
        found.values["stiffness"], found.findings

    Args:
        path: of the identification file.
        out: folder for `identified.json`, `identified.xml` and `report.html`; an interrupted run
            goes on in it. None writes nothing.
        measurements: files instead of those that the study names.
        workers: processes; None takes the cores, 1 runs everything in this one. The results are the
            same.
        progress: called with evaluations done, in all, and a note.

    Raises:
        FileNotFoundError: there is no such file.
        StudyError: a line of it is wrong, or scene and measurements do not fit it.
    """
    from volcontact.identify.reading import read_settings
    from volcontact.identify.run import run

    folder = None if out is None else Path(out)
    return run(
        read_settings(path, measurements=measurements), folder, workers=workers, progress=progress
    )
