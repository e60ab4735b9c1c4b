# SPDX-License-Identifier: Apache-2.0
"""A run that was recorded, shown again as a scene that steps."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Sequence

import mujoco

from volcontact.running.driving import Drive, Driver
from volcontact.running.recording import ContactKind
from volcontact.scene import Contact, attach, load
from volcontact.view.hand import Hand
from volcontact.view.history import History, Snapshot
from volcontact.view.stage import Stage

_PICTURE = 1.0 / 120.0  # between two states that are kept [s]
_FEWEST = 600  # states that are kept of a short run, where it has so many


def record(
    scene: str | os.PathLike[str],
    seconds: float,
    *,
    contact: ContactKind = "volumetric",
    drive: Drive | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Playback:
    """Steps a scene for a while and returns what it went through, to be looked at.

    Args:
        scene: path of an MJCF file, or MJCF text.
        seconds: of simulated time.
        contact: "volumetric" or "native".
        drive: where it starts, and its controls over time.
        progress: called now and then with (steps done, steps in all).

    Raises:
        ValueError: the scene cannot be read or understood, or it has no such keyframe or actuator.
    """
    model = load(scene)
    data = mujoco.MjData(model)
    driver = Driver(model, drive or Drive())
    driver.start(data)
    attached = attach(model) if contact == "volumetric" else None
    try:
        mujoco.mj_forward(model, data)
        snapshots = [Snapshot(data)]
        steps = max(1, round(seconds / float(model.opt.timestep)))
        every = stride(steps, float(model.opt.timestep))
        for i in range(1, steps + 1):
            driver.write(data)
            mujoco.mj_step(model, data)
            if i % every == 0 or i == steps:
                snapshots.append(Snapshot(data))
                if progress is not None:
                    progress(i, steps)
        return Playback(model, attached, snapshots)
    except BaseException:
        if attached is not None:
            attached.close()
        raise


def stride(steps: int, timestep: float) -> int:
    """How many steps lie between two states to look at; a short run keeps all of them.

    Args:
        steps: of the run.
        timestep: [s].
    """
    return max(1, min(round(_PICTURE / timestep), steps // _FEWEST))


class Playback(Stage):
    """A recorded run: each step goes on to the next snapshot, and after the last begins anew.

    Args:
        model: of the run.
        contact: of the model, attached; None under native contact. `close` detaches it.
        snapshots: in the order of their times, at least one.
    """

    can_pull = False  # what was recorded stays

    def __init__(
        self, model: mujoco.MjModel, contact: Contact | None, snapshots: Sequence[Snapshot]
    ) -> None:
        self.model = model
        self.data = mujoco.MjData(model)
        self.lock = threading.RLock()
        self.paused = False
        self.speed = 1.0
        self.hand = Hand()
        self.history = History(most_bytes=float("inf"))
        for snapshot in snapshots:
            self.history.add(snapshot)
        self._contact = contact
        self._time = 0.0
        self.reset()

    def set_contact(self, kind: ContactKind) -> None:
        """Does nothing: what was recorded stays."""

    def reset(self) -> None:
        """Goes back to the first snapshot."""
        self._put(0)

    def show(self, time: float) -> None:
        """Pauses at the snapshot nearest to a time [s]."""
        self.paused = True
        self._put(self.history.at(time))

    def step(self, count: int = 1) -> None:
        """Goes on by so many snapshots."""
        with self.lock:
            self._put((self._place + count) % len(self.history))

    def advance(self, seconds: float) -> None:
        """Goes on by so much real time."""
        with self.lock:
            if self.paused:
                return
            time = self._time + self.speed * seconds
            if time > self.history.end:
                self._put(0)
                return
            place = self._place
            while self.history[place].time < time:
                place += 1
            if place != self._place:
                self._put(place)
            self._time = time

    def _put(self, place: int) -> None:
        with self.lock:
            self._place = place
            self._time = self.history[place].time
            self.history[place].put_into(self.data)
            mujoco.mj_forward(self.model, self.data)
