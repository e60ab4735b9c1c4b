# SPDX-License-Identifier: Apache-2.0
"""A scene under somebody's hands: steps, pauses, starts again, changes its contact."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Sequence

import mujoco
import numpy as np

from volcontact._closing import Closing
from volcontact.running.driving import Drive, Driver
from volcontact.running.probes import native_sites, recorded_sites
from volcontact.running.recording import ContactKind
from volcontact.scene import Contact, attach, load
from volcontact.surface import SiteSurface
from volcontact.view.drawing import SiteDrawing, draw_sites
from volcontact.view.hand import Hand
from volcontact.view.history import History, Snapshot

_SHARE = 0.7  # of real time that may go into stepping


class Stage(Closing):
    """A scene that steps in real time. Use as a context manager, or call `close`.

    A reader on another thread holds `lock` while it looks at the data.

    Args:
        scene: path of an MJCF file, or MJCF text.
        contact: "volumetric" or "native", to begin with.
        drive: where it starts, and its controls over time: a `volcontact.running.driving.Drive`.

    Attributes:
        model: of the scene.
        data: its state.
        lock: held while the state changes.
        paused: whether `advance` does nothing.
        speed: simulated seconds a second; less where the machine does not keep up.
        hand: pulls at bodies; it lets go when the scene is reset or shown at another time.
        history: what was seen, to go back to with `show`.
        can_pull: whether the hand acts.

    Raises:
        ValueError: the scene cannot be read or understood, or it has no such keyframe or actuator.
    """

    can_pull = True

    def __init__(
        self,
        scene: str | os.PathLike[str],
        *,
        contact: ContactKind = "volumetric",
        drive: Drive | None = None,
    ) -> None:
        self.model = load(scene)
        self.data = mujoco.MjData(self.model)
        self.lock = threading.RLock()
        self.paused = False
        self.speed = 1.0
        self.hand = Hand()
        self.history = History()
        self._driver = Driver(self.model, drive or Drive())
        self._contact: Contact | None = None
        self._behind = 0.0
        self.set_contact(contact)
        self.reset()

    @property
    def contact(self) -> ContactKind:
        """Which contact acts now."""
        return "native" if self._contact is None else "volumetric"

    def set_contact(self, kind: ContactKind) -> None:
        """Changes the contact; the motion goes on from the present state."""
        with self.lock:
            if kind == self.contact:
                return
            if self._contact is None:
                self._contact = attach(self.model)
            else:
                self._contact.release(self.data)
                self._contact.close()
                self._contact = None
            mujoco.mj_forward(self.model, self.data)

    def reset(self) -> None:
        """Goes back to the start: the keyframe that was asked for, or that called `start`."""
        with self.lock:
            mujoco.mj_resetData(self.model, self.data)
            self._driver.start(self.data)
            self._settle()

    def show(self, time: float) -> None:
        """Pauses at what was seen next to a time [s]; from there the scene goes on anew.

        Raises:
            ValueError: nothing was seen yet.
        """
        with self.lock:
            self.paused = True
            self.history[self.history.at(time)].put_into(self.data)
            self._settle(keep=True)

    def _settle(self, *, keep: bool = False) -> None:
        """After a jump: nothing is held, nothing is behind, the state is evaluated."""
        self.hand.forget()
        self._behind = 0.0
        mujoco.mj_forward(self.model, self.data)
        if not keep:
            self.history.add(Snapshot(self.data))

    def step(self, count: int = 1) -> None:
        """Takes so many steps, also while paused."""
        with self.lock:
            for _ in range(count):
                self._take_step()
            self._show_state()

    def _take_step(self) -> None:
        self._driver.write(self.data)
        self.hand.apply(self.model, self.data)
        mujoco.mj_step(self.model, self.data)

    def _show_state(self) -> None:
        self.hand.take_out(self.data)  # what is kept of a state is the scene's own
        mujoco.mj_forward(self.model, self.data)
        self.history.add(Snapshot(self.data))

    def advance(self, seconds: float) -> None:
        """Steps for so much real time; what there is no time for is left out, not made up for."""
        with self.lock:
            if self.paused:
                return
            self._behind += self.speed * seconds
            end = time.monotonic() + _SHARE * seconds
            step = float(self.model.opt.timestep)
            begin = self.data.time
            while self._behind >= step and time.monotonic() < end:
                self._take_step()
                self._behind -= step
            self._behind = min(self._behind, step)
            if self.data.time != begin:
                self._show_state()

    def contacts_of(
        self, data: mujoco.MjData, *, resolution: int = 16
    ) -> tuple[np.ndarray, Sequence[SiteSurface | None]]:
        """The contacts of evaluated data of the model.

        Args:
            data: to read.
            resolution: of the shapes: columns across a site.

        Returns:
            An array of `volcontact.running.recording.SITE`, and the shape of each of them; under
            native contact there are no shapes.
        """
        if self._contact is None:
            return native_sites(self.model, data), ()
        found = self._contact.sites(data)
        return recorded_sites(found), [
            self._contact.surface(data, i, resolution=resolution) for i in range(len(found))
        ]

    def drawings(self, *, stretch: float | None = None, resolution: int = 16) -> list[SiteDrawing]:
        """What to draw of the present contacts: see `draw_sites`."""
        with self.lock:
            sites, surfaces = self.contacts_of(self.data, resolution=resolution)
            return draw_sites(self.model, sites, surfaces, stretch=stretch)

    def close(self) -> None:
        """Detaches the scene. May be called twice."""
        with self.lock:
            if self._contact is not None:
                self._contact.close()
                self._contact = None
