# SPDX-License-Identifier: Apache-2.0
"""Frames of two runs side by side, with their contact sites drawn."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from volcontact.render import Renderer, SiteStyle
from volcontact.report import palette
from volcontact.report.comparison import Comparison
from volcontact.report.film import write_film
from volcontact.running.recording import Frame, Recording

_BAR = 36  # height of the caption bar [pixel]
_GAP = 4  # between the two pictures [pixel]
_PAPER, _INK = (255, 255, 255), (29, 33, 41)


@dataclass(frozen=True)
class FramePair:
    """Both runs at one instant.

    Attributes:
        time: [s].
        volumetric: picture, shape (height, width, 3), uint8.
        native: likewise; None where that run has ended before.
        notes: what to say below each picture.
    """

    time: float
    volumetric: np.ndarray
    native: np.ndarray | None
    notes: tuple[str, str]


def draw_frames(
    comparison: Comparison,
    renderer: Renderer,
    camera: str | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> list[FramePair]:
    """Draws all recorded frames of both runs, seen by a camera of the scene, or its first."""

    def draw(run: Recording, frame: Frame) -> np.ndarray:
        style = SiteStyle(palette.rgb(palette.RUN_COLORS[run.contact]), reference)
        return renderer.draw(
            run.qpos[frame.row],
            sites=frame.sites,
            surfaces=frame.surfaces,
            style=style,
            view=camera,
        )

    first, second = (list(run.frames) for run in comparison.runs)
    reference = reference_force(comparison)
    pairs = []
    for i, frame in enumerate(first):
        other = second[i] if i < len(second) else None
        pairs.append(
            FramePair(
                time=frame.time,
                volumetric=draw(comparison.volumetric, frame),
                native=None if other is None else draw(comparison.native, other),
                notes=(_note(frame), _note(other) if other else "ended"),
            )
        )
        if progress is not None:
            progress(i + 1, len(first))
    return pairs


def reference_force(comparison: Comparison) -> float:
    """The force whose arrow has full length [N]: the weight, without gravity the largest force."""
    peak = max(float(run.largest_site_force.max()) for run in comparison.runs)
    return comparison.volumetric.weight or peak or 1.0


def side_by_side(pair: FramePair) -> Image.Image:
    """One picture with a caption bar: volumetric left, native right."""
    height, width, _ = pair.volumetric.shape
    sheet = Image.new("RGB", (2 * width + _GAP, height + _BAR), _PAPER)
    sheet.paste(Image.fromarray(pair.volumetric), (0, _BAR))
    if pair.native is not None:
        sheet.paste(Image.fromarray(pair.native), (width + _GAP, _BAR))
    pen = ImageDraw.Draw(sheet)
    font = _font(17)
    middle = _BAR // 2
    for left, color, name, note in (
        (0, palette.VOLUMETRIC, "volumetric", pair.notes[0]),
        (width + _GAP, palette.NATIVE, "native", pair.notes[1]),
    ):
        pen.rectangle((left + 10, middle - 6, left + 22, middle + 6), fill=color)
        pen.text((left + 32, middle), f"{name}, {note}", _INK, font, anchor="lm")
    pen.text((width - 10, middle), f"t = {pair.time:.2f} s", _INK, font, anchor="rm")
    return sheet


def write_frames(pairs: list[FramePair], folder: Path) -> list[Path]:
    """Writes `frame_0000.png`, ... and removes frames of an earlier, longer run."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("frame_[0-9][0-9][0-9][0-9].png"):
        old.unlink()
    paths = []
    for i, pair in enumerate(pairs):
        path = folder / f"frame_{i:04d}.png"
        side_by_side(pair).save(path)
        paths.append(path)
    return paths


def write_movie(pairs: list[FramePair], path: Path) -> bool:
    """Writes the frames as an MP4 film in real time; False where there are not two of them."""
    if len(pairs) < 2:
        path.unlink(missing_ok=True)
        return False
    rate = (len(pairs) - 1) / (pairs[-1].time - pairs[0].time)
    write_film((np.asarray(side_by_side(pair)) for pair in pairs), path, rate)
    return True


def png(picture: np.ndarray, colors: int | None = None) -> bytes:
    """A picture as PNG, with a palette of so many colours to make it small."""
    image = Image.fromarray(picture)
    if colors is not None:
        image = image.quantize(colors, dither=Image.Dither.FLOYDSTEINBERG)
    buffer = io.BytesIO()
    image.save(buffer, format="png", optimize=True)
    return buffer.getvalue()


def _note(frame: Frame) -> str:
    count = len(frame.sites)
    if count == 0:
        return "no contact"
    return f"{count} contact{'' if count == 1 else 's'}"


def _font(size: int) -> ImageFont.FreeTypeFont:
    # matplotlib brings a font file, so the caption looks the same on every machine.
    path = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
    return ImageFont.truetype(str(path), size)
