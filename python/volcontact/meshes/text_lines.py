# SPDX-License-Identifier: Apache-2.0
"""Lines of a text file as numbers, with the line named where one is none."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from volcontact.meshes.triangles import LONGEST, fail

__all__ = ["Polygons", "count_of", "points_of", "text_of"]


def text_of(path: str, content: bytes) -> list[str]:
    """The lines of a text file."""
    zero = content.find(b"\0")
    if zero >= 0:
        fail(path, f"byte {zero}", "a text file has no zero byte")
    # Names and comments may be in any encoding; numbers are in ASCII.
    return content.decode("latin-1").replace("\r\n", "\n").replace("\r", "\n").split("\n")


def points_of(
    path: str, rows: Sequence[Sequence[str]], lines: Sequence[int]
) -> NDArray[np.float64]:
    """Points, of the first three words of each row.

    Args:
        path: the file, for messages.
        rows: the words of each point.
        lines: the number of the line of each point.

    Returns:
        In the unit of the file, shape (n, 3).
    """
    for row, line in zip(rows, lines, strict=True):
        if len(row) < 3:
            fail(path, f"line {line}", f"a point needs three numbers, here are {len(row)}")
    words = [row[:3] for row in rows]
    try:
        points = np.array([[_float(word) for word in row] for row in words]).reshape(-1, 3)
    except ValueError:
        for row, line in zip(words, lines, strict=True):
            for word in row:
                _number(path, line, word)
        raise
    bad = np.flatnonzero(~(np.abs(points) <= LONGEST).all(axis=1))
    if bad.size:
        row, line = words[bad[0]], lines[bad[0]]
        fail(
            path,
            f"line {line}, vertex {bad[0]}",
            f"'{' '.join(row)}' is no point: coordinates are finite and at most {LONGEST:g}",
            "Correct the number or the unit where the mesh was made",
        )
    return points


def _float(word: str) -> float:
    if "_" in word:  # Python would read 1_000
        raise ValueError(word)
    return float(word)


def _number(path: str, line: int, word: str) -> None:
    try:
        _float(word)
    except ValueError:
        fail(path, f"line {line}", f"{_short(word)} is no number")


def count_of(path: str, line: int, word: str, what: str, most: int) -> int:
    """A number of things.

    Args:
        path: the file, for messages.
        line: the line.
        word: the text of the number.
        what: the things, for messages.
        most: more cannot be in the file.

    Returns:
        The number.
    """
    if not (word.isascii() and word.isdecimal()):
        fail(path, f"line {line}", f"the number of {what} is {_short(word)}")
    if len(word) > 18 or int(word) > most:
        fail(
            path,
            f"line {line}",
            f"{word[:20]} {what} are announced, the file is too short for them",
        )
    return int(word)


class Polygons:
    """Collects polygons of a text file as triangles.

    Args:
        path: the file, for messages.
        first: the index of the first vertex in the file, 0 or 1.
    """

    def __init__(self, path: str, *, first: int) -> None:
        self._path = path
        self._first = first
        self._faces: list[tuple[int, int, int]] = []
        self._lines: list[int] = []

    def add(
        self, words: Sequence[str], line: int, vertices: int, *, relative: bool = False
    ) -> None:
        """Adds a polygon as a fan of triangles.

        Args:
            words: the indices of its corners.
            line: where it stands.
            vertices: the number of vertices that exist.
            relative: a negative index counts backwards.
        """
        if len(words) < 3:
            fail(self._path, f"line {line}", f"a face needs three corners, here are {len(words)}")
        corners = []
        for word in words:
            try:
                index = int(word) if "_" not in word else int("")
            except ValueError:
                fail(self._path, f"line {line}", f"{_short(word)} is no index of a vertex")
            position = index - self._first
            if relative and index < 0:
                position = vertices + index
            if not 0 <= position < vertices:
                have = f"{self._first} to {vertices - 1 + self._first}" if vertices else "none"
                fail(
                    self._path,
                    f"line {line}, face {len(self._faces)}",
                    f"vertex {_short(word)} does not exist, the file has {have}",
                )
            corners.append(position)
        for second, third in pairwise(corners[1:]):
            self._faces.append((corners[0], second, third))
            self._lines.append(line)

    def faces(self) -> NDArray[np.int64]:
        """The triangles, shape (m, 3)."""
        return np.array(self._faces, dtype=np.int64).reshape(-1, 3)

    def lines(self) -> NDArray[np.int64]:
        """The line of each triangle, shape (m,)."""
        return np.array(self._lines, dtype=np.int64)


def _short(word: str) -> str:
    printable = "".join(letter if letter.isprintable() else "?" for letter in word)
    return f"'{printable[:20]}...'" if len(printable) > 23 else f"'{printable}'"
