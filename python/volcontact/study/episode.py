# SPDX-License-Identifier: Apache-2.0
"""Steps one trial of a scene to its end and fills in its row."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from volcontact.recording import CHANNELS
from volcontact.simulation import warnings_of
from volcontact.study.scene import Scene
from volcontact.study.settings import Settings
from volcontact.watched import read

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
        self._finish(row, outcome or "timed_out", done * step)

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

    def _finish(self, row: dict[str, Any], outcome: str, time: float) -> None:
        scene, settings, felt = self._scene, self._settings, self._watch.felt
        row |= {"outcome": outcome, "success": outcome == "success", "time": time}
        row["reason"] = self._reason(outcome, time)
        for name in ("peak_force", "peak_torque", "peak_site_force", "most_sites", "first_touch"):
            row[name] = float(getattr(felt, name))
        row["warnings"] = float(sum(warnings_of(scene.data).values()))
        row["place"] = self._place()
        for (name, _), peak in zip(settings.record.peak, self._watch.peaks, strict=True):
            row[name] = float(peak)
        for (name, _), peak in zip(settings.record.places, self._watch.place_peaks, strict=True):
            row[f"peak_force_{name}"] = float(peak)
        if outcome == "diverged":
            return  # MuJoCo has gone back to the start
        mujoco.mj_forward(scene.model, scene.data)
        if scene.contact is not None:
            energy = scene.contact.energy(scene.data)
            for channel, joules in zip(CHANNELS, energy.by_channel, strict=True):
                row[f"dissipated_{channel}"] = float(joules)
            row |= {"elastic": float(energy.elastic), "numerical": float(energy.numerical)}
        names = [name for name, _ in settings.record.final]
        numbers = [scene.quantities.number(what) for _, what in settings.record.final]
        if settings.pose:
            names += ["distance", "angle"]
            numbers += [scene.quantities.number(name) for name in ("distance", "angle")]
        if numbers:
            values = read(scene.model, scene.data, numbers, self._watch)
            row |= {name: float(value) for name, value in zip(names, values, strict=True)}

    def _reason(self, outcome: str, time: float) -> str:
        felt, end = self._watch.felt, self._settings.end
        if outcome == "force_limit":
            return f"force {felt.force:.4g} N is above its limit {end.force_limit:g} N"
        if outcome == "torque_limit":
            return f"torque {felt.torque:.4g} N m is above its limit {end.torque_limit:g} N m"
        if outcome == "diverged":
            names = ", ".join(warnings_of(self._scene.data))
            return f"MuJoCo reset the state after {time:.6g} s: {names}"
        return ""

    def _place(self) -> str:
        """Where the largest force is at the end: a place of the study, else two geoms."""
        pair = [self._watch.felt.geom_a, self._watch.felt.geom_b]
        if max(pair) < 0:
            return ""
        for (name, _), members in zip(
            self._settings.record.places, self._scene.places, strict=True
        ):
            if np.any(members[[i for i in pair if i >= 0]]):
                return name
        model, geom = self._scene.model, int(mujoco.mjtObj.mjOBJ_GEOM)
        names = [
            "a flex" if i < 0 else mujoco.mj_id2name(model, geom, i) or f"geom {i}" for i in pair
        ]
        return " on ".join(names)
