# SPDX-License-Identifier: Apache-2.0
"""Triangles as a file has them, and what is said of a file that has none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

__all__ = ["LONGEST", "MeshFileError", "Triangles", "counted", "fail"]

# Above this a coordinate is a broken number or a wrong unit, and products of four overflow late.
LONGEST = 1e12  # [length]

AGAIN = "Export or download the file again"


class MeshFileError(ValueError):
    """A file is no mesh: what is wrong where, and what to do."""


def fail(path: str, place: str, problem: str, fix: str = AGAIN) -> NoReturn:
    """Raises MeshFileError.

    Args:
        path: the file.
        place: line, byte, face or vertex; "" for the file as a whole.
        problem: what is wrong, without a full stop.
        fix: what to do, without a full stop.
    """
    where = f"{path}: {place}: " if place else f"{path}: "
    raise MeshFileError(f"{where}{problem}. {fix}.")


def counted(count: int, one: str, many: str = "") -> str:
    """A number of things, such as "1 face" and "2 faces"."""
    return f"{count} {one if count == 1 else many or one + 's'}"


@dataclass(frozen=True)
class Triangles:
    """Triangles of a file. Nothing is known of how they hang together.

    Attributes:
        vertices: in the unit of the file, shape (n, 3).
        faces: indices of vertices, counter-clockwise seen from outside, shape (m, 3).
        path: the file.
        format: such as "STL, binary".
        places: line or byte at which each face stands, shape (m,).
        unit_of_places: "line" or "byte".
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    path: str
    format: str
    places: NDArray[np.int64]
    unit_of_places: str

    def face_name(self, face: int) -> str:
        """The face for a reader of the file, such as "face 7 (line 31)"."""
        return f"face {face} ({self.unit_of_places} {self.places[face]})"
