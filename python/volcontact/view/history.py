# SPDX-License-Identifier: Apache-2.0
"""What a scene went through while it was looked at, to go back to."""

from __future__ import annotations

import bisect

import mujoco
import numpy as np

_FIELDS = (
    "qpos",
    "qvel",
    "act",
    "ctrl",
    "qacc_warmstart",
    "qfrc_applied",
    "xfrc_applied",
    "userdata",
    "mocap_pos",
    "mocap_quat",
)
_MOST_BYTES = 256e6  # of all states that are kept


class Snapshot:
    """What a state of a scene is set again by: what MuJoCo integrates, and what contact keeps."""

    def __init__(self, data: mujoco.MjData) -> None:
        self.time = float(data.time)
        self._values = [np.array(getattr(data, name)) for name in _FIELDS]

    @property
    def size(self) -> int:
        """In bytes."""
        return sum(value.nbytes for value in self._values)

    def put_into(self, data: mujoco.MjData) -> None:
        """Sets the state; nothing is evaluated."""
        data.time = self.time
        for name, value in zip(_FIELDS, self._values, strict=True):
            getattr(data, name)[...] = value


class History:
    """Snapshots in the order of their times. The oldest go where they take too much memory.

    Args:
        most_bytes: of all of them.
    """

    def __init__(self, most_bytes: float = _MOST_BYTES) -> None:
        self._most_bytes = most_bytes
        self._snapshots: list[Snapshot] = []
        self._times: list[float] = []
        self._bytes = 0

    def __len__(self) -> int:
        return len(self._snapshots)

    def __getitem__(self, place: int) -> Snapshot:
        return self._snapshots[place]

    @property
    def begin(self) -> float:
        """Time of the first [s]; 0 where there is none."""
        return self._times[0] if self._times else 0.0

    @property
    def end(self) -> float:
        """Time of the last [s]; 0 where there is none."""
        return self._times[-1] if self._times else 0.0

    def add(self, snapshot: Snapshot) -> None:
        """Adds one; what was at its time or later is forgotten: the scene went another way."""
        self.forget_from(snapshot.time)
        self._snapshots.append(snapshot)
        self._times.append(snapshot.time)
        self._bytes += snapshot.size
        while self._bytes > self._most_bytes and len(self._snapshots) > 1:
            self._bytes -= self._snapshots.pop(0).size
            del self._times[0]

    def forget_from(self, time: float) -> None:
        """Forgets what was at a time or later."""
        place = bisect.bisect_left(self._times, time)
        self._bytes -= sum(snapshot.size for snapshot in self._snapshots[place:])
        del self._snapshots[place:], self._times[place:]

    def at(self, time: float) -> int:
        """The place of the snapshot nearest to a time.

        Raises:
            ValueError: there is none.
        """
        if not self._times:
            raise ValueError("nothing is recorded yet")
        place = bisect.bisect_left(self._times, time)
        if place == len(self._times):
            return place - 1
        if place > 0 and time - self._times[place - 1] < self._times[place] - time:
            return place - 1
        return place
