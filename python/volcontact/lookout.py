# SPDX-License-Identifier: Apache-2.0
"""What the first readings of a scene show that is hardly meant: sinking, and grasps that creep."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import mujoco
import numpy as np

from volcontact.hints import SINKS, creeping_grasps, has_size, size_of, sunk

_LOOKS = 1000  # readings, and
_BEGINS = 0.1  # simulated time from which it looks out: before, what was put there may yet part [s]
_LASTS = 10.0  # and until which [s]


class Lookout:
    """Looks at the contact sites of the first readings, until it has said something of each kind.

    Args:
        model: of the scene.
        pairs: gives `Contact.description["pairs"]`; asked once, where a grasp is seen.
    """

    def __init__(
        self, model: mujoco.MjModel, pairs: Callable[[], Sequence[Mapping[str, Any]]]
    ) -> None:
        self._model = model
        self._pairs = pairs
        self._left = _LOOKS
        self._kinds = {"sinks", "creeps"} if model.nu else {"sinks"}
        self._smallest = min(
            (size_of(model, geom) for geom in range(model.ngeom) if has_size(model, geom)),
            default=np.inf,
        )

    @property
    def is_over(self) -> bool:
        """Whether there is nothing left to say."""
        return not self._kinds or self._left <= 0

    def end(self) -> None:
        """Says no more."""
        self._left = 0

    def is_time(self, data: mujoco.MjData) -> bool:
        """Whether the state is worth a look."""
        return bool(data.time >= _BEGINS)

    def look(self, data: mujoco.MjData, sites: np.ndarray) -> list[str]:
        """What is worth a word.

        Args:
            data: at the state of the last evaluation.
            sites: of `Contact.sites`.
        """
        self._left = self._left - 1 if data.time < _LASTS else 0
        if len(sites) == 0:
            return []
        lines: list[str] = []
        if "sinks" in self._kinds and float(sites["depth"].max()) > SINKS * self._smallest:
            lines += sunk(self._model, data, sites)
            if lines:
                self._kinds.discard("sinks")
        if "creeps" in self._kinds:
            self._kinds.discard("creeps")
            lines += creeping_grasps(self._model, self._pairs())
        return lines
