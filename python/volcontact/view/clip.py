# SPDX-License-Identifier: Apache-2.0
"""A film of what was seen in the viewer, with contact sites, at the speed it was seen at."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import mujoco
import numpy as np

from volcontact.render import Renderer, SiteStyle, View
from volcontact.report.palette import RUN_COLORS, rgb
from volcontact.running.recording import ContactKind
from volcontact.view.drawing import reference_force
from volcontact.view.stage import Stage

RATE = 30.0  # pictures a second
_SIZE = (960, 640)  # [pixel]
_COLUMNS = 12  # across a site


def write_clip(
    stage: Stage,
    path: Path,
    *,
    begin: float | None = None,
    end: float | None = None,
    view: View | None = None,
    size: tuple[int, int] = _SIZE,
    progress: Callable[[int, int], None] | None = None,
) -> int:
    """Writes an MP4 film of the history of a stage, which stays as it is.

    Args:
        stage: what was seen.
        path: of the file, which ends in .mp4.
        begin: time of the first picture [s]; None takes the first that is kept.
        end: of the last one [s]; None takes the last that is kept.
        view: camera; None takes the scene's first, or one that sees the whole scene.
        size: width and height [pixel].
        progress: called with (pictures done, pictures in all).

    Returns:
        How many pictures it has.

    Raises:
        OSError: it cannot be written.
        ValueError: the name does not end in .mp4, or nothing was seen.
    """
    from volcontact.report.film import write_film

    if path.suffix.lower() != ".mp4":
        raise ValueError(f"{path}: the name of a clip must end in .mp4")
    with stage.lock:
        times = _times(stage, begin, end)
        write_film(_pictures(stage, times, view, size, progress), path, RATE)
    return len(times)


def _times(stage: Stage, begin: float | None, end: float | None) -> np.ndarray:
    history = stage.history
    if len(history) == 0:
        raise ValueError("nothing was seen yet: step the scene first")
    first = history.begin if begin is None else begin
    last = history.end if end is None else end
    count = int((last - first) * RATE / stage.speed) + 1
    return first + np.arange(max(count, 1)) * (stage.speed / RATE)


def _pictures(
    stage: Stage,
    times: np.ndarray,
    view: View | None,
    size: tuple[int, int],
    progress: Callable[[int, int], None] | None,
) -> Iterator[np.ndarray]:
    model, data = stage.model, mujoco.MjData(stage.model)
    width, height = size
    kind: ContactKind = stage.contact
    with Renderer(model, width=width, height=height) as renderer:
        for i, time in enumerate(times):
            stage.history[stage.history.at(float(time))].put_into(data)
            mujoco.mj_forward(model, data)
            sites, surfaces = stage.contacts_of(data, resolution=_COLUMNS)
            yield renderer.draw(
                data.qpos,
                sites=sites,
                surfaces=surfaces,
                style=SiteStyle(rgb(RUN_COLORS[kind]), reference_force(model, sites)),
                view=view,
                mocap=(data.mocap_pos, data.mocap_quat),
            )
            if progress is not None:
                progress(i + 1, len(times))
