# SPDX-License-Identifier: Apache-2.0
"""A scripted policy for `volcontact/ORUInsertion-v0`: it goes in and gives way to what it feels."""

from __future__ import annotations

import numpy as np

from volcontact.gym.oru_insertion import FORCE_LIMIT, Observation

STIFFNESS = np.array([2500.0, 2500.0, 5000.0, 1000.0, 1000.0, 1000.0])  # [N/m, N m/rad]
SPEED_LIMIT = 0.02  # of an action of 1 [m/s, rad/s]


class ForceGuided:
    """Moves the set point along the way in, more slowly the harder it pushes.

    Across it, and in angles, the set points follow the box until nothing pushes it aside:
    admittance control without a model of the worksite.

    Args:
        speed: along the way in while nothing is felt [m/s].
        settling: time in which forces across and torques fall to 1/e [s].
        push: force along the way in at which the set point stops [N].
    """

    def __init__(self, *, speed: float = 0.02, settling: float = 0.5, push: float = 60.0) -> None:
        if not 0.0 < speed <= SPEED_LIMIT:
            raise ValueError(f"speed = {speed} [m/s]: must be above 0 and at most {SPEED_LIMIT}")
        if not settling > 0.0:
            raise ValueError(f"settling = {settling} [s]: must be above 0")
        if not 0.0 < push < FORCE_LIMIT:
            raise ValueError(f"push = {push} [N]: must be above 0 and below {FORCE_LIMIT}")
        self._speed = speed
        self._settling = settling
        self._push = push

    def __call__(self, observation: Observation) -> np.ndarray:
        """The action for an observation, or for a batch of them; shape (..., 6)."""
        wrench = observation["wrench"]
        velocity = -wrench / (STIFFNESS * self._settling)
        velocity[..., 2] = -self._speed * np.clip(1.0 + wrench[..., 2] / self._push, -1.0, 1.0)
        return np.clip(velocity / SPEED_LIMIT, -1.0, 1.0).astype(np.float32)
