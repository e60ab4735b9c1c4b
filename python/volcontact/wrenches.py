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
    torque = sign[:, None] * sites["torque"] + np.cross(arm, force)
    return np.concatenate([force.sum(axis=0), torque.sum(axis=0)])


def wrenches_on_bodies(
    sites: np.ndarray, geom_bodies: np.ndarray, origins: np.ndarray
) -> np.ndarray:
    """The sum of the contact forces on the geoms of each body, about the origin of its frame.

    Args:
        sites: as of `wrench_on`.
        geom_bodies: body of each geom, shape (ngeom,).
        origins: of the body frames in the world frame [m], shape (nbody, 3).

    Returns:
        Force [N] and torque [N m] in the world frame, shape (nbody, 6).
    """
    wrenches = np.zeros((len(origins), 6))
    for sign, side in ((1.0, "geom_a"), (-1.0, "geom_b")):
        rows = sites[sites[side] >= 0]  # a flex has no geom
        bodies = geom_bodies[rows[side]]
        arm = rows["position"] - origins[bodies]
        np.add.at(wrenches[:, :3], bodies, sign * rows["force"])
        np.add.at(wrenches[:, 3:], bodies, sign * (rows["torque"] + np.cross(arm, rows["force"])))
    return wrenches
