# SPDX-License-Identifier: Apache-2.0
"""Names of the elements of a model, and what those without one are called."""

from __future__ import annotations

import mujoco


def name_of(model: mujoco.MjModel, kind: str, index: int) -> str:
    """The name of an element, or its kind and number where the scene gives it none.

    Args:
        model: that has it.
        kind: "geom", "body", "joint", "actuator", "sensor", "key", as in `mujoco.mjtObj`.
        index: from 0.
    """
    name = mujoco.mj_id2name(model, int(getattr(mujoco.mjtObj, f"mjOBJ_{kind.upper()}")), index)
    return name or f"{'keyframe' if kind == 'key' else kind} {index}"
