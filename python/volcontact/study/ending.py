# SPDX-License-Identifier: Apache-2.0
"""What a row says of a trial that has ended."""

from __future__ import annotations

import ctypes
from typing import Any

import mujoco
import numpy as np

from volcontact._adaptor import RawEnergy, RawWatch, adaptor
from volcontact.running.recording import CHANNELS
from volcontact.running.simulation import warnings_of
from volcontact.running.watched import Reading, Watch
from volcontact.study.file.settings import Settings
from volcontact.study.quantities import Quantities

_FELT = ("peak_force", "peak_torque", "peak_site_force", "most_sites", "first_touch")  # neighbours
_PLACE = RawWatch.peak_force.offset // 8


class Ending:
    """Reads the columns of a row from a scene, one trial after the other.

    Args:
        settings: of the study.
        model, data: of all trials.
        attached: whether the model is.
        quantities: the numbers by name.
        places: geoms of each place of the study, shape (m, ngeom).
        watch: of all trials.
    """

    def __init__(
        self,
        settings: Settings,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        *,
        attached: bool,
        quantities: Quantities,
        places: np.ndarray,
        watch: Watch,
    ) -> None:
        self._settings = settings
        self._model, self._data, self._watch = model, data, watch
        self._warnings = data.warning.number
        felt = np.frombuffer(watch.felt, np.float64)
        self._felt = felt[_PLACE : _PLACE + len(_FELT)]
        record = settings.record
        self._peaks = [name for name, _ in record.peak]
        self._place_columns = [f"peak_force_{name}" for name, _ in record.places]
        final = list(record.final)
        if settings.pose:
            final += [(name, name) for name in ("distance", "angle")]
        self._final = [name for name, _ in final]
        self._read = Reading([quantities.number(what) for _, what in final], watch)
        self._energy = RawEnergy() if attached else None
        self._get_energy = adaptor().function("get_energy")
        self._places = places
        self._place_of: dict[tuple[int, int], str] = {}

    def write(self, row: dict[str, Any], outcome: str, time: float) -> None:
        """Fills in a row.

        Args:
            row: of the trial.
            outcome: how it ended.
            time: when, from its start [s].
        """
        row |= {"outcome": outcome, "success": outcome == "success", "time": time}
        row["reason"] = self._reason(outcome, time)
        row.update(zip(_FELT, self._felt.tolist(), strict=True))
        row["warnings"] = float(self._warnings.sum())
        row["place"] = self._place()
        row.update(zip(self._peaks, self._watch.peaks.tolist(), strict=True))
        row.update(zip(self._place_columns, self._watch.place_peaks.tolist(), strict=True))
        if outcome == "diverged":
            return  # MuJoCo has gone back to the start
        mujoco.mj_forward(self._model, self._data)
        if self._energy is not None:
            raw = self._energy
            self._get_energy(self._model._address, self._data._address, ctypes.byref(raw))
            for channel, joules in zip(CHANNELS, raw.dissipated, strict=True):
                row[f"dissipated_{channel}"] = joules
            row["elastic"], row["numerical"] = raw.elastic, raw.numerical
        if self._final:
            row.update(zip(self._final, self._read(self._model, self._data), strict=True))

    def _reason(self, outcome: str, time: float) -> str:
        felt, end = self._watch.felt, self._settings.end
        if outcome == "force_limit":
            return f"force {felt.force:.4g} N is above its limit {end.force_limit:g} N"
        if outcome == "torque_limit":
            return f"torque {felt.torque:.4g} N m is above its limit {end.torque_limit:g} N m"
        if outcome == "diverged":
            names = ", ".join(warnings_of(self._data))
            return f"MuJoCo reset the state after {time:.6g} s: {names}"
        return ""

    def _place(self) -> str:
        """Where the largest force is at the end: a place of the study, else two geoms."""
        pair = self._watch.felt.geom_a, self._watch.felt.geom_b
        if max(pair) < 0:
            return ""
        if pair not in self._place_of:
            self._place_of[pair] = self._named(pair)
        return self._place_of[pair]

    def _named(self, pair: tuple[int, int]) -> str:
        for (name, _), members in zip(self._settings.record.places, self._places, strict=True):
            if np.any(members[[i for i in pair if i >= 0]]):
                return name
        model, geom = self._model, int(mujoco.mjtObj.mjOBJ_GEOM)
        names = [
            "a flex" if i < 0 else mujoco.mj_id2name(model, geom, i) or f"geom {i}" for i in pair
        ]
        return " on ".join(names)
