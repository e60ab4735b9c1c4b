# SPDX-License-Identifier: Apache-2.0
"""What a measure reads of a running scene."""

from __future__ import annotations

from abc import ABC, abstractmethod

import mujoco
import numpy as np

from volcontact.identify import rotations
from volcontact.identify.settings import WIDTHS, Measure, StudyError
from volcontact.identify.starts import free_joint
from volcontact.messages.spelling import nearest
from volcontact.study.targets import joint_place


class Reader(ABC):
    """Reads one measure.

    Attributes:
        name, kind: of the measure.
        count: numbers of a sample.
        place: of the first in a row; set by `level_of`.
        level: what must be up to date: 0 the state, 1 places of bodies, 2 all.
    """

    def __init__(self, measure: Measure) -> None:
        self.name, self.kind = measure.name, measure.kind
        self.count = WIDTHS[measure.kind][0] if measure.kind in WIDTHS else len(measure.columns)
        self.place = 0
        self.level = 0

    @abstractmethod
    def read(self, out: np.ndarray) -> None:
        """Writes the numbers."""


class _View(Reader):
    """A part of an array."""

    def __init__(self, measure: Measure, array: np.ndarray, level: int) -> None:
        super().__init__(measure)
        self._array, self.level = array, level

    def read(self, out: np.ndarray) -> None:
        out[:] = self._array


class _Turned(Reader):
    """A vector of the state of a free body, in the other frame."""

    def __init__(self, measure: Measure, vector: np.ndarray, quat: np.ndarray) -> None:
        super().__init__(measure)
        self._vector, self._quat = vector, quat
        self._to_body = measure.frame == "body"

    def read(self, out: np.ndarray) -> None:
        quat = rotations.inverse(self._quat) if self._to_body else self._quat
        out[:] = rotations.rotate(quat, self._vector)


class _Moving(Reader):
    """A velocity of a body that hangs on others."""

    def __init__(
        self, measure: Measure, model: mujoco.MjModel, data: mujoco.MjData, body: int
    ) -> None:
        super().__init__(measure)
        self._model, self._data, self._body = model, data, body
        self._local = int(measure.frame == "body")
        self._first = 0 if measure.kind == "angular_velocity" else 3
        self._both = np.zeros(6)
        self.level = 2

    def read(self, out: np.ndarray) -> None:
        kind = int(mujoco.mjtObj.mjOBJ_XBODY)
        mujoco.mj_objectVelocity(self._model, self._data, kind, self._body, self._both, self._local)
        out[:] = self._both[self._first : self._first + 3]


def make_reader(model: mujoco.MjModel, data: mujoco.MjData, measure: Measure) -> Reader:
    """The reader of a measure.

    Raises:
        StudyError: the scene has no such thing.
    """
    try:
        if measure.kind == "sensor":
            return _View(measure, _sensor(model, data, measure), 2)
        if measure.kind == "joint":
            place, _ = joint_place(model, measure.of, "qpos")
            return _View(measure, data.qpos[place : place + 1], 0)
        if measure.kind == "joint_velocity":
            place, _ = joint_place(model, measure.of, "qvel")
            return _View(measure, data.qvel[place : place + 1], 0)
        return _of_body(model, data, measure)
    except StudyError as error:
        raise StudyError(f"[measure.{measure.name}] of = {measure.of!r}: {error}") from error


def _sensor(model: mujoco.MjModel, data: mujoco.MjData, measure: Measure) -> np.ndarray:
    kind = int(mujoco.mjtObj.mjOBJ_SENSOR)
    number = mujoco.mj_name2id(model, kind, measure.of)
    if number < 0:
        known = [mujoco.mj_id2name(model, kind, i) or "" for i in range(model.nsensor)]
        raise StudyError(f"the scene has no sensor of this name{nearest(measure.of, known)}")
    size = int(model.sensor_dim[number])
    if size != len(measure.columns):
        raise StudyError(f"the sensor has {size} numbers, and columns are {len(measure.columns)}")
    first = int(model.sensor_adr[number])
    result: np.ndarray = data.sensordata[first : first + size]
    return result


def _of_body(model: mujoco.MjModel, data: mujoco.MjData, measure: Measure) -> Reader:
    joint = free_joint(model, measure.of)
    if joint >= 0:
        q, v = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
        quat = data.qpos[q + 3 : q + 7]
        if measure.kind == "position":
            return _View(measure, data.qpos[q : q + 3], 0)
        if measure.kind == "orientation":
            return _View(measure, quat, 0)
        turning = measure.kind == "angular_velocity"
        vector = data.qvel[v + 3 : v + 6] if turning else data.qvel[v : v + 3]
        if (measure.frame == "body") == turning:  # as MuJoCo has them
            return _View(measure, vector, 0)
        return _Turned(measure, vector, quat)
    body = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_BODY), measure.of)
    if measure.kind in ("position", "orientation"):
        array = data.xpos if measure.kind == "position" else data.xquat
        return _View(measure, array[body], 1)
    return _Moving(measure, model, data, body)


def level_of(readers: list[Reader]) -> int:
    """Puts readers one after the other in a row; what they all need up to date."""
    place = 0
    for reader in readers:
        reader.place = place
        place += reader.count
    return max((reader.level for reader in readers), default=0)
