# SPDX-License-Identifier: Apache-2.0
"""What drives a run from outside: the keyframe it starts at, and its controls over time."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field

import mujoco
import numpy as np

from volcontact.messages.names import name_of
from volcontact.messages.spelling import nearest
from volcontact.running.control_table import ControlTable, read_controls

__all__ = ["ControlTable", "Drive", "Driver", "to_keyframe"]

_START = "start"  # the keyframe that is taken where none is named
_NAMED = 6  # so many names of a list are told


@dataclass(frozen=True)
class Drive:
    """What a run is given besides its scene.

    Attributes:
        keyframe: name of the keyframe to start from (`keyframe 0`, `keyframe 1` where it has none).
            None takes that called `start`, and without one the pose of the file.
        controls: by name of the actuator, held over the whole run, in the unit of the control.
        table: controls over time: a `ControlTable`, or the path of a CSV or Parquet file with
            the column `time` [s] and one for each actuator. In between they are linear; before
            the first row and after the last one they stay.
    """

    keyframe: str | None = None
    controls: Mapping[str, float] = field(default_factory=dict)
    table: ControlTable | str | os.PathLike[str] | None = None


class Driver:
    """Starts and drives data of one model.

    Args:
        model: that is stepped.
        drive: what drives it.

    Raises:
        ValueError: an unknown keyframe or actuator, one that is driven twice, a control that is no
            number, or a table that cannot be read; the message says which.
    """

    def __init__(self, model: mujoco.MjModel, drive: Drive) -> None:
        self._model = model
        self._key = _keyframe(model, drive.keyframe)
        self._asked = drive.keyframe is not None
        table = drive.table
        if table is not None and not isinstance(table, ControlTable):
            table = read_controls(table)
        self._held = {_actuator(model, n, ""): _number(n, v) for n, v in drive.controls.items()}
        self._times = np.zeros(1) if table is None else table.time
        self._columns: dict[int, np.ndarray] = {}
        if table is not None:
            for name, values in table.columns.items():
                index = _actuator(model, name, f"{table.source}: ")
                if index in self._held:
                    raise ValueError(
                        f"{table.source}: {name!r} is driven twice, by a column and by a control "
                        "that is held: leave one of them out"
                    )
                self._columns[index] = values

    def start(self, data: mujoco.MjData) -> None:
        """Puts data at the keyframe."""
        if self._key is not None:
            mujoco.mj_resetDataKeyframe(self._model, data, self._key)
        self.write(data)

    def write(self, data: mujoco.MjData) -> None:
        """Writes the controls of the present time into `data.ctrl`."""
        for index, value in self._held.items():
            data.ctrl[index] = value
        for index, values in self._columns.items():
            data.ctrl[index] = np.interp(data.time, self._times, values)

    def notes(self) -> tuple[str, ...]:
        """What was left as it is, and hardly meant: lines for people."""
        model = self._model
        notes = []
        keys = [name_of(model, "key", k) for k in range(model.nkey)]
        if self._key is None and keys:
            notes.append(
                f"starts at the pose of the file; {_list('keyframe', keys)} not used: "
                "--keyframe NAME starts at one"
            )
        elif self._key is not None and not self._asked:
            notes.append(f"starts at the keyframe {keys[self._key]!r}, which is taken unasked")
        notes += self._limited()
        at_rest = [name_of(model, "actuator", i) for i in range(model.nu) if not self._is_driven(i)]
        if at_rest:
            notes.append(
                f"{_list('actuator', at_rest, len(at_rest) == model.nu)} at control 0: "
                "--ctrl NAME=VALUE or --controls FILE drives them"
            )
        return tuple(notes)

    def _is_driven(self, index: int) -> bool:
        if index in self._held or index in self._columns:
            return True
        return self._key is not None and bool(self._model.key_ctrl[self._key][index] != 0.0)

    def _limited(self) -> list[str]:
        """Controls beyond what the scene allows, which MuJoCo cuts."""
        model, notes = self._model, []
        held = {index: np.array([value]) for index, value in self._held.items()}
        for index, values in (held | self._columns).items():
            low, high = (float(x) for x in model.actuator_ctrlrange[index])
            least, most = float(values.min()), float(values.max())
            if model.actuator_ctrllimited[index] and (least < low or most > high):
                worst = least if least < low else most
                notes.append(
                    f"control {worst:g} of {name_of(model, 'actuator', index)!r} is outside of its "
                    f"ctrlrange from {low:g} to {high:g}: MuJoCo cuts it"
                )
        return notes


def to_keyframe(model: mujoco.MjModel, data: mujoco.MjData, keyframe: str | None) -> None:
    """Puts data at a keyframe; None takes that called `start`, and without one changes nothing.

    Raises:
        ValueError: the scene has no such keyframe.
    """
    key = _keyframe(model, keyframe)
    if key is not None:
        mujoco.mj_resetDataKeyframe(model, data, key)


def _keyframe(model: mujoco.MjModel, name: str | None) -> int | None:
    names = [name_of(model, "key", k) for k in range(model.nkey)]
    wanted = _START if name is None else name
    if wanted in names:
        return names.index(wanted)
    if name is None:
        return None
    raise ValueError(f"the scene has no keyframe {name!r}{nearest(name, names)}")


def _actuator(model: mujoco.MjModel, name: str, where: str) -> int:
    names = [name_of(model, "actuator", i) for i in range(model.nu)]
    if name not in names:
        raise ValueError(f"{where}the scene has no actuator {name!r}{nearest(name, names)}")
    return names.index(name)


def _number(name: str, value: float) -> float:
    good = isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
    if not good or not math.isfinite(value):
        raise ValueError(f"control {name!r} = {value!r} must be a finite number")
    return float(value)


def _list(noun: str, names: list[str], every: bool = False) -> str:
    """`keyframes a and b are`, `all 21 actuators stay`: the subject of a note."""
    verb = {"keyframe": ("is", "are"), "actuator": ("stays", "stay")}[noun][len(names) > 1]
    if len(names) > _NAMED:
        count = f"all {len(names)}" if every else f"{len(names)}"
        return f"{count} {noun}s {verb}"
    *most, last = (repr(name) for name in names)
    told = f"{', '.join(most)} and {last}" if most else last
    return f"{noun}{'s' if most else ''} {told} {verb}"
