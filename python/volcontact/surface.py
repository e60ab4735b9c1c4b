# SPDX-License-Identifier: Apache-2.0
"""The shape of a contact site, for pictures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_THINNEST, _THICKEST = 0.08, 0.4  # what a body is stretched to, of the size of its patch


def stretch_to_see(area: float, depth: float, wanted: float = 0.0) -> float:
    """How many times thicker a body is drawn so that it is seen beside its patch; at least 1.

    Args:
        area: of the patch [m^2].
        depth: of the overlap [m].
        wanted: thickness that a picture shows well [m]; had where the patch is not too small.
    """
    size = float(np.sqrt(area))
    thickness = max(_THINNEST * size, min(wanted, _THICKEST * size))
    return max(1.0, thickness / depth) if depth > 0.0 else 1.0


@dataclass(frozen=True)
class SiteSurface:
    """The overlap at one contact site: columns along the normal, joined into triangles.

    Made by `Contact.surface`. Nothing in it enters a force.

    Attributes:
        low: ends of the columns against the normal [m], world, shape (n, 3).
        high: ends of the columns along the normal [m], world, shape (n, 3).
        triangles: indices of columns, counterclockwise seen against the normal, shape (m, 3).
        rim: lines of two columns around them, the overlap to the left, shape (k, 2).
    """

    low: np.ndarray
    high: np.ndarray
    triangles: np.ndarray
    rim: np.ndarray

    @property
    def is_empty(self) -> bool:
        """Whether the site is thinner than the columns are apart, and has no shape here."""
        return len(self.triangles) == 0

    @property
    def patch(self) -> tuple[np.ndarray, np.ndarray]:
        """The middle of the overlap, where the contact pressure acts.

        Returns:
            Points [m], shape (n, 3), and triangles, shape (m, 3).
        """
        return 0.5 * (self.low + self.high), self.triangles

    def body(self, stretch: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
        """The closed surface of the overlap.

        Args:
            stretch: how many times thicker than it is, along the normal: overlaps are often too
                thin to be seen.

        Returns:
            Points [m], shape (2 n, 3), and triangles, counterclockwise seen from outside,
            shape (2 m + 2 k, 3).

        Raises:
            ValueError: the stretch is no number above 0.
        """
        if not (np.isfinite(stretch) and stretch > 0.0):
            raise ValueError(f"stretch = {stretch:g} must be a number above 0")
        middle, half = 0.5 * (self.low + self.high), 0.5 * stretch * (self.high - self.low)
        n = len(self.low)
        begin, end = self.rim.T
        faces = [
            self.triangles[:, ::-1],
            self.triangles + n,
            np.column_stack([begin, end, end + n]),
            np.column_stack([begin, end + n, begin + n]),
        ]
        return np.concatenate([middle - half, middle + half]), np.concatenate(faces)
