# SPDX-License-Identifier: Apache-2.0
"""Contact forces of many sites as one wrench on a body."""

from __future__ import annotations

import numpy as np


def wrench_on(sites: np.ndarray, members: np.ndarray, point: np.ndarray) -> np.ndarray:
    """The sum of the contact forces on some geoms, and their torque about a point.

    Args:
        sites: structured array with `geom_a`, `geom_b`, `force` and `torque` on a, and the
            place `position` of the torque [m], world.
        members: which geoms these are, shape (ngeom,).
        point: in the world frame [m], shape (3,).

    Returns:
        Force [N] and torque [N m] in the world frame, shape (6,). Forces between two of the geoms
        cancel each other.
    """
    # A flex has no geom: -1 is none of the members.
    inside = np.append(members, False).astype(float)
    sign = inside[sites["geom_a"]] - inside[sites["geom_b"]]
    force, arm = sign[:, None] * sites["force"], sites["position"] - point
    torque = sign[:, None] * sites["torque"] + _cross(arm, force)
    return np.concatenate([force.sum(axis=0), torque.sum(axis=0)])


def wrenches_on_frames(
    sites: np.ndarray, frames_a: np.ndarray, frames_b: np.ndarray, origins: np.ndarray
) -> np.ndarray:
    """The sums of the contact forces on what moves with some frames, about their origins.

    Args:
        sites: as of `wrench_on`, of one instant or of many, each with frames of its own.
        frames_a: of the first geom of each site, shape (n,); -1 is none of the frames.
        frames_b: of the second one, likewise.
        origins: in the world frame [m], shape (frames, 3).

    Returns:
        Force [N] and torque [N m] in the world frame, shape (frames, 6).
    """
    wrenches = np.zeros((len(origins), 6))
    for frames, sign in ((frames_a, 1.0), (frames_b, -1.0)):
        rows = np.flatnonzero(frames >= 0)
        frames, force = frames[rows], sign * sites["force"][rows]
        arm = sites["position"][rows] - origins[frames]
        torque = sign * sites["torque"][rows] + _cross(arm, force)
        np.add.at(wrenches, frames, np.concatenate([force, torque], axis=1))
    return wrenches


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross products row by row; `np.cross` takes three times as long for a few rows."""
    left, right = a.T, b.T
    product = np.empty(a.shape)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        product[:, i] = left[j] * right[k] - left[k] * right[j]
    return product
