# SPDX-License-Identifier: Apache-2.0
"""Steps one trial of a scene to its end and fills in its row."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mujoco

from volcontact.study.file.settings import Settings
from volcontact.study.scene import Scene

Watcher = Callable[[mujoco.MjModel, mujoco.MjData, Any], None]
_LONGEST = 1000  # steps in one call, so that a signal is heard


class Episode:
    """One trial of a scene.

    Args:
        settings: of the study.
        scene: whose data are at the start of the trial.
        control: called once every control period.
        success: the user's own word on success, `success(model, data)`.
        watcher: called with model, data and contact at the start and at every look.
    """

    def __init__(
        self,
        settings: Settings,
        scene: Scene,
        control: Callable[[mujoco.MjData], None] | None,
        success: Callable[..., Any] | None,
        watcher: Watcher | None,
    ) -> None:
        self._settings = settings
        self._scene = scene
        self._control = control
        self._success = success
        self._watcher = watcher
        self._good_since = math.inf
        self._watch = scene.watch
        self._watch.restart()

    def run(self, row: dict[str, Any]) -> None:
        """Steps until the trial ends, and writes what happened into its row."""
        model, data, watch = self._scene.model, self._scene.data, self._watch
        step = float(model.opt.timestep)
        look = max(1, round(self._settings.end.watch / step))
        period = max(1, round(self._settings.control.get("period", 0.1) / step))
        looks = self._success is not None or self._watcher is not None
        total = max(1, math.ceil(self._settings.end.duration / step - 1e-9))
        done = 0
        outcome = ""
        if self._watcher is not None:
            self._watcher(model, data, self._scene.contact)
        while done < total and not outcome:
            if self._control is not None and done % period == 0:
                self._control(data)
            most = min(total - done, _LONGEST)
            if self._control is not None:
                most = min(most, period - done % period)
            if looks:
                most = min(most, look - done % look)
            done += watch.step(model, data, most)
            outcome = watch.outcome or self._judged()
            if self._watcher is not None and outcome != "diverged":
                self._watcher(model, data, self._scene.contact)
        self._scene.ending.write(row, outcome or "timed_out", done * step)

    def _judged(self) -> str:
        if self._success is None:
            return ""
        data = self._scene.data
        if not (self._watch.felt.is_good and self._success(self._scene.model, data)):
            self._good_since = math.inf
            return ""
        self._good_since = min(self._good_since, float(data.time))
        held = float(data.time) - self._good_since >= self._settings.hold - 1e-12
        return "success" if held else ""
