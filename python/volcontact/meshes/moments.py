# SPDX-License-Identifier: Apache-2.0
"""Volume, centroid and inertia of what closed triangles enclose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Moments", "moments_of"]


@dataclass(frozen=True)
class Moments:
    """Moments for unit density.

    Attributes:
        volume: [m^3], negative where the faces show inwards.
        centroid: [m], shape (3,).
        inertia: about the centroid [m^5], shape (3, 3).
    """

    volume: float
    centroid: NDArray[np.float64]
    inertia: NDArray[np.float64]


def moments_of(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Moments:
    """Sums signed tetrahedra from the middle of the vertices.

    Args:
        vertices: [m], shape (n, 3).
        faces: of a closed surface, shape (m, 3).

    Returns:
        The moments. The centroid of a volume of zero is the middle.
    """
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    corners = (vertices - middle)[faces]
    # Six times the volumes of the tetrahedra, and the sums of their corners but the origin.
    determinants = np.einsum("ni,ni->n", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    sums = corners.sum(axis=1)
    volume = float(determinants.sum() / 6.0)
    if volume == 0.0:
        return Moments(0.0, middle, np.zeros((3, 3)))
    first = determinants @ sums / 24.0
    products = np.einsum("ni,nj->nij", sums, sums) + np.einsum("nki,nkj->nij", corners, corners)
    second = np.einsum("n,nij->ij", determinants, products) / 120.0
    offset = first / volume
    second -= volume * np.outer(offset, offset)
    return Moments(volume, middle + offset, np.trace(second) * np.eye(3) - second)
