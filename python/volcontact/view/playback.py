# SPDX-License-Identifier: Apache-2.0
"""A run that was recorded, shown again as a scene that steps."""

from __future__ import annotations

import threading
from collections.abc import Sequence

import mujoco
import numpy as np

from volcontact.recording import ContactKind
from volcontact.scene import Contact
from volcontact.view.stage import Stage

_FIELDS = ("qpos", "qvel", "act", "ctrl", "userdata", "mocap_pos", "mocap_quat")


class Snapshot:
    """What a state of a scene is set again by."""

    def __init__(self, data: mujoco.MjData) -> None:
        self.time = float(data.time)
        self._values = [np.array(getattr(data, name)) for name in _FIELDS]

    def put_into(self, data: mujoco.MjData) -> None:
        """Sets the state; nothing is evaluated."""
        data.time = self.time
        for name, value in zip(_FIELDS, self._values, strict=True):
            getattr(data, name)[...] = value


class Playback(Stage):
    """A recorded run: each step goes on to the next snapshot, and after the last begins anew.

    Args:
        model: of the run.
        contact: of the model, attached; None under native contact. `close` detaches it.
        snapshots: in the order of their times, at least one.
    """

    def __init__(
        self, model: mujoco.MjModel, contact: Contact | None, snapshots: Sequence[Snapshot]
    ) -> None:
        self.model = model
        self.data = mujoco.MjData(model)
        self.lock = threading.RLock()
        self.paused = False
        self.speed = 1.0
        self._contact = contact
        self._snapshots = snapshots
        self._time = 0.0
        self.reset()

    def set_contact(self, kind: ContactKind) -> None:
        """Does nothing: what was recorded stays."""

    def reset(self) -> None:
        """Goes back to the first snapshot."""
        self._show(0)

    def step(self, count: int = 1) -> None:
        """Goes on by so many snapshots."""
        with self.lock:
            self._show((self._place + count) % len(self._snapshots))

    def advance(self, seconds: float) -> None:
        """Goes on by so much real time."""
        with self.lock:
            if self.paused:
                return
            time = self._time + self.speed * seconds
            if time > self._snapshots[-1].time:
                self._show(0)
                return
            place = self._place
            while self._snapshots[place].time < time:
                place += 1
            if place != self._place:
                self._show(place)
            self._time = time

    def _show(self, place: int) -> None:
        with self.lock:
            self._place = place
            self._time = self._snapshots[place].time
            self._snapshots[place].put_into(self.data)
            mujoco.mj_forward(self.model, self.data)
