# SPDX-License-Identifier: Apache-2.0
"""Array views of MuJoCo's small fixed-size fields, right under every NumPy."""

from __future__ import annotations

import numpy as np


def dense(view: np.ndarray) -> np.ndarray:
    """Returns a writable view of a contiguous MuJoCo field with its true strides.

    The bindings of MuJoCo 2.2 were compiled against NumPy 1. Under NumPy 2 they report a stride of
    0 for one-dimensional fields of fixed size (`data.energy`, `camera.lookat`, `geom.rgba`), so
    that every entry reads as the first one. The memory itself is sound and contiguous.
    """
    if 0 not in view.strides:
        return view
    strides = np.cumprod((view.itemsize, *view.shape[:0:-1]))[::-1]
    return np.lib.stride_tricks.as_strided(view, view.shape, strides.tolist())
