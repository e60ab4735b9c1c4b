# SPDX-License-Identifier: Apache-2.0
"""What a scene measures of itself: its sensors, its actuators and its named joints, over a run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np

from volcontact.messages.names import name_of

_LINEAR, _ANGULAR = int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE)
_SENSOR_UNITS = {
    "TOUCH": "N",
    "ACCELEROMETER": "m/s^2",
    "VELOCIMETER": "m/s",
    "GYRO": "rad/s",
    "FORCE": "N",
    "TORQUE": "N m",
    "MAGNETOMETER": "T",
    "RANGEFINDER": "m",
    "TENDONPOS": "m",
    "TENDONVEL": "m/s",
    "BALLANGVEL": "rad/s",
    "FRAMEPOS": "m",
    "FRAMELINVEL": "m/s",
    "FRAMEANGVEL": "rad/s",
    "FRAMELINACC": "m/s^2",
    "FRAMEANGACC": "rad/s^2",
    "SUBTREECOM": "m",
    "SUBTREELINVEL": "m/s",
    "SUBTREEANGMOM": "kg m^2/s",
    "CLOCK": "s",
    "E_POTENTIAL": "J",
    "E_KINETIC": "J",
}
# Of a joint, by what is asked of it: that of a sliding one, that of a turning one.
_JOINT_UNITS = {
    "JOINTPOS": ("m", "rad"),
    "JOINTVEL": ("m/s", "rad/s"),
    "JOINTACTFRC": ("N", "N m"),
    "JOINTLIMITPOS": ("m", "rad"),
    "JOINTLIMITVEL": ("m/s", "rad/s"),
    "JOINTLIMITFRC": ("N", "N m"),
    "ACTUATORPOS": ("m", "rad"),
    "ACTUATORVEL": ("m/s", "rad/s"),
    "ACTUATORFRC": ("N", "N m"),
}
_SENSOR_KINDS = {
    int(getattr(mujoco.mjtSensor, name)): name[len("mjSENS_") :]
    for name in dir(mujoco.mjtSensor)
    if name.startswith("mjSENS_")
}
_AXES = {3: "xyz", 4: "wxyz"}


@dataclass(frozen=True)
class Signal:
    """One number of a scene over a run.

    Attributes:
        values: shape (n,).
        unit: "1" where it has none, or none that is known.
    """

    values: np.ndarray
    unit: str


@dataclass(frozen=True)
class _Column:
    name: str
    unit: str
    read: Callable[[mujoco.MjData], float]


class SignalReader:
    """Reads all signals of a scene, row by row.

    Names are `sensor.NAME` (with `.x`, `.y`, `.z`, `.w`, or a number where it has several),
    `actuator.NAME.control` and `.force`, and of sliding and turning joints that have a name
    `joint.NAME.position` and `.velocity`.

    Args:
        model: that is stepped.
        rows: there will be at most.
    """

    def __init__(self, model: mujoco.MjModel, rows: int) -> None:
        self._columns = [*_sensors(model), *_actuators(model)]
        self._joints = _joints(model)
        self._values = np.zeros((rows, len(self._columns)))

    def keep(self, row: int, data: mujoco.MjData) -> None:
        """Reads the numbers of an evaluation into a row."""
        self._values[row] = [column.read(data) for column in self._columns]

    def signals(self, qpos: np.ndarray, qvel: np.ndarray) -> dict[str, Signal]:
        """The first rows, by name.

        Args:
            qpos: of these rows, shape (n, nq); `mj_step` moves that of the data on.
            qvel: likewise, shape (n, nv).
        """
        signals = {
            column.name: Signal(self._values[: len(qpos), i].copy(), column.unit)
            for i, column in enumerate(self._columns)
        }
        for name, place, dof, turns in self._joints:
            units = _JOINT_UNITS["JOINTPOS"][turns], _JOINT_UNITS["JOINTVEL"][turns]
            signals[f"joint.{name}.position"] = Signal(qpos[:, place].copy(), units[0])
            signals[f"joint.{name}.velocity"] = Signal(qvel[:, dof].copy(), units[1])
        return signals


def _sensors(model: mujoco.MjModel) -> list[_Column]:
    columns = []
    for sensor in range(model.nsensor):
        start, count = int(model.sensor_adr[sensor]), int(model.sensor_dim[sensor])
        name, unit = f"sensor.{name_of(model, 'sensor', sensor)}", _sensor_unit(model, sensor)
        parts = _AXES.get(count, [str(i) for i in range(count)])
        for i in range(count):
            columns.append(
                _Column(
                    name if count == 1 else f"{name}.{parts[i]}",
                    unit,
                    lambda data, place=start + i: float(data.sensordata[place]),  # type: ignore[misc]
                )
            )
    return columns


def _sensor_unit(model: mujoco.MjModel, sensor: int) -> str:
    kind = _SENSOR_KINDS.get(int(model.sensor_type[sensor]), "")
    if kind not in _JOINT_UNITS:
        return _SENSOR_UNITS.get(kind, "1")
    index = int(model.sensor_objid[sensor])
    joint = _joint_of(model, index) if kind.startswith("ACTUATOR") else index
    return "1" if joint is None else _JOINT_UNITS[kind][_turns(model, joint)]


def _actuators(model: mujoco.MjModel) -> list[_Column]:
    columns = []
    for i in range(model.nu):
        name, joint = f"actuator.{name_of(model, 'actuator', i)}", _joint_of(model, i)
        unit = "1" if joint is None else _JOINT_UNITS["ACTUATORFRC"][_turns(model, joint)]
        columns += [
            _Column(f"{name}.control", "1", lambda data, i=i: float(data.ctrl[i])),  # type: ignore[misc]
            _Column(f"{name}.force", unit, lambda data, i=i: float(data.actuator_force[i])),  # type: ignore[misc]
        ]
    return columns


def _joints(model: mujoco.MjModel) -> list[tuple[str, int, int, bool]]:
    """Name, places in qpos and qvel, and whether it turns, of the joints that are told."""
    joints = []
    for joint in range(model.njnt):
        name = mujoco.mj_id2name(model, int(mujoco.mjtObj.mjOBJ_JOINT), joint)
        if name and int(model.jnt_type[joint]) in (_LINEAR, _ANGULAR):
            place, dof = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
            joints.append((name, place, dof, _turns(model, joint)))
    return joints


def _turns(model: mujoco.MjModel, joint: int) -> bool:
    return int(model.jnt_type[joint]) != _LINEAR


def _joint_of(model: mujoco.MjModel, actuator: int) -> int | None:
    """The sliding or turning joint that an actuator drives, if it drives one."""
    kinds = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
    joint = int(model.actuator_trnid[actuator][0])
    is_joint = int(model.actuator_trntype[actuator]) in kinds
    if not is_joint or int(model.jnt_type[joint]) not in (_LINEAR, _ANGULAR):
        return None
    return joint
