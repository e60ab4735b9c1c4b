# SPDX-License-Identifier: Apache-2.0
"""Pictures as a film: an MP4 file that is whole, or an error."""

from __future__ import annotations

import io
from collections.abc import Iterable
from pathlib import Path

import imageio_ffmpeg
import numpy as np


def write_film(pictures: Iterable[np.ndarray], path: Path, rate: float) -> None:
    """Writes an MP4 film.

    Args:
        pictures: at least one, each of shape (height, width, 3), uint8, all of one size. An odd row
            or column at the end is left out: the codec wants even sizes.
        path: of the file.
        rate: pictures a second.

    Raises:
        OSError: it cannot be written, or not to its end.
        ValueError: there are no pictures.
    """
    film = None
    for picture in pictures:
        height, width = (size - size % 2 for size in picture.shape[:2])
        try:
            if film is None:
                film = imageio_ffmpeg.write_frames(
                    str(path),
                    (width, height),
                    fps=rate,
                    quality=8,
                    macro_block_size=1,
                    ffmpeg_log_level="error",
                )
                film.send(None)
            film.send(np.ascontiguousarray(picture[:height, :width]))
        except OSError as error:
            reason = str(error).split("\n", 1)[0]
            raise OSError(f"{path.name}: the film cannot be written: {reason}") from error
    if film is None:
        raise ValueError(f"{path.name}: there is no picture to write")
    film.close()
    if not _is_whole(path):  # the encoder ends without a word
        raise OSError(f"{path.name}: the film was cut short: is the disk full?")


def _is_whole(path: Path) -> bool:
    """Whether an MP4 file has its index and all of its boxes."""
    place, size, kinds = 0, path.stat().st_size if path.exists() else 0, set()
    with path.open("rb") if size else io.BytesIO() as file:
        while place < size:
            file.seek(place)
            head = file.read(16)
            length = int.from_bytes(head[:4], "big")
            if length == 1:  # a long one, with its length behind
                length = int.from_bytes(head[8:16], "big")
            kinds.add(head[4:8])
            place += max(length, 8)
    return b"moov" in kinds and place == size
