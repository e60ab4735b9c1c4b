# SPDX-License-Identifier: Apache-2.0
"""Rotations of many samples at a time, as unit quaternions w x y z."""

from __future__ import annotations

import numpy as np


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The rotation b and then a, shape (..., 4)."""
    aw, ax, ay, az = np.moveaxis(a, -1, 0)
    bw, bx, by, bz = np.moveaxis(b, -1, 0)
    return np.stack(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ],
        axis=-1,
    )


def inverse(q: np.ndarray) -> np.ndarray:
    """The rotation back."""
    result: np.ndarray = q * np.array([1.0, -1.0, -1.0, -1.0])
    return result


def rotate(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Vectors turned by rotations, shape (..., 3)."""
    axis = q[..., 1:]
    turned = 2.0 * np.cross(axis, v)
    found: np.ndarray = v + q[..., :1] * turned + np.cross(axis, turned)
    return found


def vector(q: np.ndarray) -> np.ndarray:
    """Axis times angle, the angle at most pi, shape (..., 3)."""
    q = np.where(q[..., :1] < 0.0, -q, q)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, q[..., :1])
    small = sine < 1e-12
    found: np.ndarray = np.where(small, 2.0, angle / np.where(small, 1.0, sine)) * q[..., 1:]
    return found


def quaternion(v: np.ndarray) -> np.ndarray:
    """The rotation of axis times angle, shape (..., 4)."""
    angle = np.linalg.norm(v, axis=-1, keepdims=True)
    half = 0.5 * angle
    small = angle < 1e-12
    factor = np.where(small, 0.5, np.sin(half) / np.where(small, 1.0, angle))
    return np.concatenate([np.cos(half), factor * v], axis=-1)


def between(a: np.ndarray, b: np.ndarray, part: np.ndarray) -> np.ndarray:
    """From a to b, a part of the way on the shorter side, shape (..., 4)."""
    b = np.where(np.sum(a * b, axis=-1, keepdims=True) < 0.0, -b, b)
    mixed = a + part[..., None] * (b - a)
    length = np.linalg.norm(mixed, axis=-1, keepdims=True)
    found: np.ndarray = mixed / np.where(length == 0.0, 1.0, length)
    return found
