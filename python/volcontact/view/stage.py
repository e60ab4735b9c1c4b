# SPDX-License-Identifier: Apache-2.0
"""A scene under somebody's hands: steps, pauses, starts again, changes its contact."""

from __future__ import annotations

import os
import threading
import time

import mujoco
import numpy as np

from volcontact._closing import Closing
from volcontact.probes import native_sites, recorded_sites
from volcontact.recording import ContactKind
from volcontact.scene import Contact, attach, load
from volcontact.simulation import to_start
from volcontact.view.drawing import SiteDrawing, draw_sites

_SHARE = 0.7  # of real time that may go into stepping


class Stage(Closing):
    """A scene that steps in real time. Use as a context manager, or call `close`.

    A reader on another thread holds `lock` while it looks at the data.

    Args:
        scene: path of an MJCF file, or MJCF text.
        contact: "volumetric" or "native", to begin with.

    Attributes:
        model: of the scene.
        data: its state.
        lock: held while the state changes.
        paused: whether `advance` does nothing.
        speed: simulated seconds a second; less where the machine does not keep up.
    """

    def __init__(
        self, scene: str | os.PathLike[str], *, contact: ContactKind = "volumetric"
    ) -> None:
        self.model = load(scene)
        self.data = mujoco.MjData(self.model)
        self.lock = threading.RLock()
        self.paused = False
        self.speed = 1.0
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
        """Goes back to the start: the keyframe `start` where the scene has one."""
        with self.lock:
            mujoco.mj_resetData(self.model, self.data)
            to_start(self.model, self.data)
            self._behind = 0.0
            mujoco.mj_forward(self.model, self.data)

    def step(self, count: int = 1) -> None:
        """Takes so many steps, also while paused."""
        with self.lock:
            for _ in range(count):
                mujoco.mj_step(self.model, self.data)
            mujoco.mj_forward(self.model, self.data)

    def advance(self, seconds: float) -> None:
        """Steps for so much real time; what there is no time for is left out, not made up for."""
        with self.lock:
            if self.paused:
                return
            self._behind += self.speed * seconds
            end = time.monotonic() + _SHARE * seconds
            step = float(self.model.opt.timestep)
            while self._behind >= step and time.monotonic() < end:
                mujoco.mj_step(self.model, self.data)
                self._behind -= step
            self._behind = min(self._behind, step)
            mujoco.mj_forward(self.model, self.data)

    def sites(self) -> np.ndarray:
        """Contacts of the present state: structured array of `volcontact.recording.SITE`."""
        with self.lock:
            if self._contact is None:
                return native_sites(self.model, self.data)
            return recorded_sites(self._contact.sites(self.data))

    def drawings(self, *, stretch: float | None = None, resolution: int = 16) -> list[SiteDrawing]:
        """What to draw of the present contacts: see `draw_sites`."""
        with self.lock:
            if self._contact is None:
                return draw_sites(self.model, native_sites(self.model, self.data))
            found = self._contact.sites(self.data)
            surfaces = [
                self._contact.surface(self.data, i, resolution=resolution)
                for i in range(len(found))
            ]
            return draw_sites(self.model, recorded_sites(found), surfaces, stretch=stretch)

    def close(self) -> None:
        """Detaches the scene. May be called twice."""
        with self.lock:
            if self._contact is not None:
                self._contact.close()
                self._contact = None
