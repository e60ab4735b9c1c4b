# SPDX-License-Identifier: Apache-2.0
"""How triangles hang together: open, crowded and flipped edges, parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Edges", "edges_of", "loops_of", "parts_of", "pinched_vertices", "weld"]

Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Edges:
    """The edges of faces, sorted by kind. Each is a pair of vertices, lower index first.

    Attributes:
        open: with one face, shape (k, 2).
        open_faces: that face of each, shape (k,).
        crowded: with more than two faces, shape (k, 2).
        crowded_faces: one face of each, shape (k,).
        flipped: with two faces that run along it the same way, shape (k, 2).
        flipped_faces: one face of each, shape (k,).
        neighbours: pairs of faces across an edge, shape (k, 2).
        across: the edge of each of these pairs, shape (k, 2).
    """

    open: Indices
    open_faces: Indices
    crowded: Indices
    crowded_faces: Indices
    flipped: Indices
    flipped_faces: Indices
    neighbours: Indices
    across: Indices


def weld(vertices: NDArray[np.float64], faces: Indices) -> tuple[NDArray[np.float64], Indices]:
    """Makes equal points one.

    Args:
        vertices: shape (n, 3).
        faces: shape (m, 3).

    Returns:
        The different points that faces use, and the faces with their new indices.
    """
    used, compact = np.unique(faces, return_inverse=True)
    points = vertices[used] + 0.0  # -0 becomes 0
    order = np.lexsort(points.T)
    ordered = points[order]
    new = np.ones(len(points), dtype=bool)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    index = np.empty(len(points), dtype=np.int64)
    index[order] = np.cumsum(new) - 1
    return ordered[new], index[compact.reshape(faces.shape)]


def edges_of(faces: Indices) -> Edges:
    """Sorts the edges of faces by how many faces they have."""
    start = faces.reshape(-1)
    end = np.roll(faces, -1, axis=1).reshape(-1)
    face = np.repeat(np.arange(len(faces), dtype=np.int64), 3)
    low, high = np.minimum(start, end), np.maximum(start, end)
    order = np.lexsort((high, low))
    low, high, face = low[order], high[order], face[order]
    along = (start < end)[order]
    new = np.ones(len(low), dtype=bool)
    new[1:] = (low[1:] != low[:-1]) | (high[1:] != high[:-1])
    first = np.flatnonzero(new)
    count = np.diff(np.append(first, len(low)))
    ends = np.stack([low, high], axis=1)
    alone, two, many = first[count == 1], first[count == 2], first[count > 2]
    same = two[along[two] == along[two + 1]]
    inner = np.flatnonzero(~new)
    return Edges(
        open=ends[alone],
        open_faces=face[alone],
        crowded=ends[many],
        crowded_faces=face[many],
        flipped=ends[same],
        flipped_faces=face[same],
        neighbours=np.stack([face[inner - 1], face[inner]], axis=1),
        across=ends[inner],
    )


def pinched_vertices(faces: Indices, edges: Edges) -> Indices:
    """Vertices at which parts of a surface meet in a point: their faces make several fans."""
    corner_of = {}  # the corners of both faces at each end of an edge hang together
    for side in (0, 1):
        at = edges.across[:, side]
        corner_of[side] = np.stack(
            [3 * pair + (faces[pair] == at[:, None]).argmax(axis=1) for pair in edges.neighbours.T],
            axis=1,
        )
    fan = parts_of(faces.size, np.concatenate([corner_of[0], corner_of[1]]))
    fans = np.unique(np.stack([faces.reshape(-1), fan], axis=1), axis=0)
    vertex, count = np.unique(fans[:, 0], return_counts=True)
    return vertex[count > 1]


def parts_of(count: int, pairs: Indices) -> Indices:
    """Connected components.

    Args:
        count: of things.
        pairs: things that hang together, shape (k, 2).

    Returns:
        For each thing the number of its part, from 0 on, shape (count,).
    """
    label = np.arange(count, dtype=np.int64)
    while len(pairs):
        a, b = label[pairs[:, 0]], label[pairs[:, 1]]
        apart = a != b
        if not apart.any():
            break
        pairs, a, b = pairs[apart], a[apart], b[apart]
        np.minimum.at(label, np.maximum(a, b), np.minimum(a, b))
        while (label[label] != label).any():
            label = label[label]
    return np.unique(label, return_inverse=True)[1].reshape(-1).astype(np.int64)


def loops_of(edges: Indices) -> list[Indices]:
    """Groups open edges that hang together; returns for each group its edges, longest first."""
    if not len(edges):
        return []
    ends, compact = np.unique(edges, return_inverse=True)
    pairs = compact.reshape(edges.shape)
    part = parts_of(len(ends), pairs)[pairs[:, 0]]
    groups = [edges[part == one] for one in np.unique(part)]
    return sorted(groups, key=len, reverse=True)
