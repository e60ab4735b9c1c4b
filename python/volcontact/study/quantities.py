# SPDX-License-Identifier: Apache-2.0
"""Numbers of a running scene by name: what conditions, limits and columns of a study speak of."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from volcontact.messages.spelling import nearest
from volcontact.running.watched import Kind, Number, Range, number
from volcontact.study.file.settings import Condition, StudyError
from volcontact.study.targets import joint_place

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
_WITHOUT_NAME = {"time": Kind.TIME, "sites": Kind.SITES, "site_force": Kind.SITE_FORCE}
_OF_JOINTS = {"qpos": Kind.QPOS, "qvel": Kind.QVEL}


class Quantities:
    """The numbers of one model by their names in a study.

    Args:
        model: compiled.
        pose: body, and keyframe or pos and quat, that `distance` and `angle` are measured from.
    """

    def __init__(self, model: mujoco.MjModel, pose: dict[str, Any]) -> None:
        self._model = model
        self._offset = _seat(model, pose) if pose else None

    def number(self, name: str) -> Number:
        """A quantity.

        Raises:
            StudyError: there is no such quantity.
        """
        kind, _, rest = name.partition("/")
        if kind in _WITHOUT_NAME and not rest:
            return number(_WITHOUT_NAME[kind])
        if kind in ("distance", "angle") and not rest:
            if self._offset is None:
                raise StudyError(f"quantity {name!r}: needs the table [pose] with the body")
            return self._offset[kind == "angle"]
        if kind in _OF_JOINTS:
            word, index = _indexed(rest)
            first, size = joint_place(self._model, word, kind)
            return number(_OF_JOINTS[kind], _element(first, size, index, name))
        if kind in ("act", "ctrl"):
            return self._actuator(kind, rest, name)
        if kind == "sensor":
            word, index = _indexed(rest)
            sensor = self._id("SENSOR", word, name)
            first = int(self._model.sensor_adr[sensor])
            size = int(self._model.sensor_dim[sensor])
            return number(Kind.SENSOR, _element(first, size, index, name))
        if kind == "position":
            word, _, axis = rest.rpartition("/")
            if axis not in ("x", "y", "z"):
                raise StudyError(f"quantity {name!r}: must be position/BODY/x, y or z")
            return number(Kind.POSITION, 3 * self._id("BODY", word, name) + "xyz".index(axis))
        if kind in ("speed", "spin"):
            which = Kind.SPEED if kind == "speed" else Kind.SPIN
            return number(which, self._id("BODY", rest, name))
        hint = nearest(name, KINDS)
        raise StudyError(f"quantity {name!r}: is unknown{hint}")

    def range(self, condition: Condition) -> Range:
        """A condition."""
        return Range(self.number(condition.quantity), condition.low, condition.high)

    def _actuator(self, kind: str, word: str, name: str) -> Number:
        actuator = self._id("ACTUATOR", word, name)
        if kind == "ctrl":
            return number(Kind.CTRL, actuator)
        first = actuator - (self._model.nu - self._model.na)
        if hasattr(self._model, "actuator_actadr"):
            first = int(self._model.actuator_actadr[actuator])
        if first < 0:
            raise StudyError(f"quantity {name!r}: this actuator has no activation")
        return number(Kind.ACT, first)

    def _id(self, kind: str, word: str, name: str) -> int:
        what = getattr(mujoco.mjtObj, f"mjOBJ_{kind}")
        found = mujoco.mj_name2id(self._model, int(what), word)
        if found < 0:
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
        return int(found)


def _indexed(text: str) -> tuple[str, int | None]:
    word, _, last = text.rpartition("/")
    return (word, int(last)) if word and last.isdecimal() else (text, None)


def _element(first: int, size: int, index: int | None, name: str) -> int:
    if (index is None and size > 1) or (index is not None and index >= size):
        raise StudyError(f"quantity {name!r}: has {size} numbers; write {name}/0 for the first")
    return first + (index or 0)


def _seat(model: mujoco.MjModel, pose: dict[str, Any]) -> tuple[Number, Number]:
    """Distance and angle of the body of `pose` from its place."""
    body = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_BODY), pose["body"])
    if body < 0:
        raise StudyError(f"[pose] body = {pose['body']!r}: the scene has no such body")
    if "keyframe" not in pose:
        place, turn = np.array(pose["pos"]), np.array(pose["quat"])
        length = float(np.linalg.norm(turn))
        if not length > 0.0:
            raise StudyError("[pose] quat: must not be zero")
        turn = turn / length
    else:
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, keyframe_id(model, pose["keyframe"], "[pose]"))
        mujoco.mj_kinematics(model, data)
        place, turn = data.xpos[body], data.xquat[body]
    return number(Kind.DISTANCE, body, place), number(Kind.ANGLE, body, turn)


def keyframe_id(model: mujoco.MjModel, name: str, where: str) -> int:
    """The number of a keyframe."""
    key = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_KEY), name)
    if key < 0:
        known = [
            mujoco.mj_id2name(model, int(mujoco.mjtObj.mjOBJ_KEY), i) or ""
            for i in range(model.nkey)
        ]
        hint = nearest(name, [k for k in known if k])
        raise StudyError(f"{where} keyframe = {name!r}: the scene has no such keyframe{hint}")
    return int(key)
