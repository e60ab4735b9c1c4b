# SPDX-License-Identifier: Apache-2.0
"""Numbers of a running scene by name: what conditions, limits and columns of a study speak of."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from volcontact.study.settings import Condition, StudyError
from volcontact.study.table import nearest
from volcontact.study.targets import joint_place

Reading = Callable[[], float]
KINDS = (
    "time",
    "distance",
    "angle",
    "site_force",
    "sites",
    "qpos/JOINT",
    "qvel/JOINT",
    "act/ACTUATOR",
    "ctrl/ACTUATOR",
    "position/BODY/x",
    "speed/BODY",
    "spin/BODY",
    "sensor/NAME",
)


class Quantities:
    """Readers of the quantities of one model and its data.

    Args:
        model: compiled.
        data: that is stepped; the readers look into it.
        pose: body, and keyframe or pos and quat, that `distance` and `angle` are measured from.
        felt: the last look at the contact sites, `sites` and `site_force`.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        pose: dict[str, Any],
        felt: dict[str, float],
    ) -> None:
        self._model = model
        self._data = data
        self._felt = felt
        self._pose = _seat(model, pose) if pose else None

    def reader(self, name: str) -> Reading:
        """The reader of a quantity.

        Raises:
            StudyError: there is no such quantity.
        """
        kind, _, rest = name.partition("/")
        data = self._data
        if kind == "time" and not rest:
            return lambda: float(data.time)
        if kind in ("sites", "site_force") and not rest:
            return lambda: self._felt[kind]
        if kind in ("distance", "angle") and not rest:
            if self._pose is None:
                raise StudyError(f"quantity {name!r}: needs the table [pose] with the body")
            return lambda: self.offset()[kind == "angle"]
        if kind in ("qpos", "qvel"):
            word, index = _indexed(rest)
            first, size = joint_place(self._model, word, kind)
            return _element(getattr(data, kind), first, size, index, name)
        if kind in ("act", "ctrl"):
            return self._actuator(kind, rest, name)
        if kind == "sensor":
            word, index = _indexed(rest)
            number = self._id("SENSOR", word, name)
            first = int(self._model.sensor_adr[number])
            size = int(self._model.sensor_dim[number])
            return _element(data.sensordata, first, size, index, name)
        if kind == "position":
            word, _, axis = rest.rpartition("/")
            if axis not in ("x", "y", "z"):
                raise StudyError(f"quantity {name!r}: must be position/BODY/x, y or z")
            row = data.xpos[self._id("BODY", word, name)]
            return _element(row, "xyz".index(axis), 1, 0, name)
        if kind in ("speed", "spin"):
            return self._speed(kind, self._id("BODY", rest, name))
        hint = nearest(name, KINDS)
        raise StudyError(f"quantity {name!r}: is unknown{hint}")

    def offset(self) -> tuple[float, float]:
        """Distance [m] and angle [degree] of the body of `pose` from its place."""
        assert self._pose is not None
        body, place, turn = self._pose
        distance = float(np.linalg.norm(self._data.xpos[body] - place))
        rest = np.zeros(4)
        back = np.zeros(4)
        mujoco.mju_negQuat(back, turn)
        mujoco.mju_mulQuat(rest, back, self._data.xquat[body])
        angle = 2.0 * math.atan2(float(np.linalg.norm(rest[1:])), abs(float(rest[0])))
        return distance, math.degrees(angle)

    def holds(self, conditions: tuple[Condition, ...]) -> Callable[[], bool]:
        """A function that says whether all conditions hold."""
        parts = [(self.reader(c.quantity), c.low, c.high) for c in conditions]

        def hold() -> bool:
            return all(low <= read() <= high for read, low, high in parts)

        return hold

    def norm(self, names: tuple[str, ...]) -> Reading:
        """The length of a vector of three quantities."""
        x, y, z = (self.reader(name) for name in names)
        return lambda: math.sqrt(x() ** 2 + y() ** 2 + z() ** 2)

    def _actuator(self, kind: str, word: str, name: str) -> Reading:
        number = self._id("ACTUATOR", word, name)
        if kind == "ctrl":
            return _element(self._data.ctrl, number, 1, 0, name)
        first = number - (self._model.nu - self._model.na)
        if hasattr(self._model, "actuator_actadr"):
            first = int(self._model.actuator_actadr[number])
        if first < 0:
            raise StudyError(f"quantity {name!r}: this actuator has no activation")
        return _element(self._data.act, first, 1, 0, name)

    def _speed(self, kind: str, body: int) -> Reading:
        velocity = np.zeros(6)
        half = velocity[3:] if kind == "speed" else velocity[:3]
        xbody = int(mujoco.mjtObj.mjOBJ_XBODY)

        def read() -> float:
            mujoco.mj_objectVelocity(self._model, self._data, xbody, body, velocity, 0)
            return math.sqrt(float(half @ half))

        return read

    def _id(self, kind: str, word: str, name: str) -> int:
        what = getattr(mujoco.mjtObj, f"mjOBJ_{kind}")
        number = mujoco.mj_name2id(self._model, int(what), word)
        if number < 0:
            count = {"BODY": "nbody", "SENSOR": "nsensor", "ACTUATOR": "nu"}[kind]
            known = [
                mujoco.mj_id2name(self._model, int(what), i) or ""
                for i in range(getattr(self._model, count))
            ]
            thing = kind.lower()
            raise StudyError(
                f"quantity {name!r}: the scene has no {thing} {word!r}"
                f"{nearest(word, [k for k in known if k])}"
            )
        return int(number)


def _indexed(text: str) -> tuple[str, int | None]:
    word, _, last = text.rpartition("/")
    return (word, int(last)) if word and last.isdecimal() else (text, None)


def _element(array: np.ndarray, first: int, size: int, index: int | None, name: str) -> Reading:
    if (index is None and size > 1) or (index is not None and index >= size):
        raise StudyError(f"quantity {name!r}: has {size} numbers; write {name}/0 for the first")
    place = first + (index or 0)
    return lambda: float(array[place])


def _seat(model: mujoco.MjModel, pose: dict[str, Any]) -> tuple[int, np.ndarray, np.ndarray]:
    body = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_BODY), pose["body"])
    if body < 0:
        raise StudyError(f"[pose] body = {pose['body']!r}: the scene has no such body")
    if "keyframe" not in pose:
        turn = np.array(pose["quat"])
        length = float(np.linalg.norm(turn))
        if not length > 0.0:
            raise StudyError("[pose] quat: must not be zero")
        return body, np.array(pose["pos"]), turn / length
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, keyframe_id(model, pose["keyframe"], "[pose]"))
    mujoco.mj_kinematics(model, data)
    return body, data.xpos[body].copy(), data.xquat[body].copy()


def keyframe_id(model: mujoco.MjModel, name: str, where: str) -> int:
    """The number of a keyframe."""
    number = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_KEY), name)
    if number < 0:
        known = [
            mujoco.mj_id2name(model, int(mujoco.mjtObj.mjOBJ_KEY), i) or ""
            for i in range(model.nkey)
        ]
        hint = nearest(name, [k for k in known if k])
        raise StudyError(f"{where} keyframe = {name!r}: the scene has no such keyframe{hint}")
    return int(number)
