# SPDX-License-Identifier: Apache-2.0
"""The state that each trial starts from, by its measurements."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from volcontact.identify import rotations
from volcontact.identify.measurements import Trial
from volcontact.identify.settings import Measure, Nuisance, Settings, StudyError
from volcontact.messages.spelling import nearest
from volcontact.study.targets import joint_place


@dataclass(frozen=True)
class MovedJoint:
    """A joint whose state is measured.

    Attributes:
        name: of the joint or its body.
        qpos, qvel: its first places there.
        is_free: six degrees of freedom; else one.
    """

    name: str
    qpos: int
    qvel: int
    is_free: bool

    def deviations(self, nuisance: Nuisance) -> list[float]:
        """Standard deviations of its state, in the order of `disturbed`."""
        if self.is_free:
            groups = (nuisance.position, nuisance.angle, nuisance.velocity, nuisance.spin)
            return [sd for sd in groups for _ in range(3)]
        # Whether it slides or turns, the user gives the numbers that fit.
        return [nuisance.position or nuisance.angle, nuisance.velocity or nuisance.spin]


def free_joint(model: mujoco.MjModel, body: str) -> int:
    """The free joint of a body, or -1.

    Raises:
        StudyError: there is no such body.
    """
    number = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_BODY), body)
    if number < 0:
        known = [
            mujoco.mj_id2name(model, int(mujoco.mjtObj.mjOBJ_BODY), i) or ""
            for i in range(model.nbody)
        ]
        raise StudyError(f"the scene has no body {body!r}{nearest(body, filter(None, known))}")
    joint = int(model.body_jntadr[number])
    return joint if joint >= 0 and int(model.jnt_type[joint]) == 0 else -1


def moved_joints(model: mujoco.MjModel, settings: Settings) -> list[MovedJoint]:
    """Joints that positions of free bodies, and angles, were measured of."""
    found: dict[tuple[int, int], MovedJoint] = {}
    for each in settings.measures:
        if each.kind in ("position", "orientation"):
            joint = free_joint(model, each.of)
            if joint >= 0:
                place = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
                found.setdefault(place, MovedJoint(each.of, *place, True))
        elif each.kind == "joint":
            q, count = joint_place(model, each.of, "qpos")
            if count != 1:
                raise StudyError(
                    f"[measure.{each.name}] of = {each.of!r}: has {count} numbers; a measured "
                    "joint is a hinge or a slide"
                )
            place = q, joint_place(model, each.of, "qvel")[0]
            found.setdefault(place, MovedJoint(each.of, *place, False))
    return list(found.values())


def start_state(
    settings: Settings, joints: list[MovedJoint], trial: Trial, qpos: np.ndarray, qvel: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """State of a trial at its first sample: that of the scene where nothing was measured."""
    qpos, qvel = qpos.copy(), qvel.copy()
    if not settings.start.measured:
        return qpos, qvel
    for joint in joints:
        of = {each.kind: each for each in settings.measures if each.of == joint.name}
        q, v = joint.qpos, joint.qvel
        if not joint.is_free:
            qpos[q] = trial.samples[of["joint"].name].values[0, 0]
            qvel[v] = _speed(settings, trial, of.get("joint_velocity"), of["joint"])[0]
            continue
        if "position" in of:
            qpos[q : q + 3] = trial.samples[of["position"].name].values[0]
            qvel[v : v + 3] = _speed(settings, trial, of.get("velocity"), of["position"])
        if "orientation" in of:
            turned = trial.samples[of["orientation"].name].values
            qpos[q + 3 : q + 7] = turned[0]
            qvel[v + 3 : v + 6] = _spin(
                settings, trial, of.get("angular_velocity"), of["orientation"]
            )
        measured = of.get("velocity")
        if measured is not None and measured.frame == "body":
            qvel[v : v + 3] = rotations.rotate(qpos[q + 3 : q + 7], qvel[v : v + 3])
    return qpos, qvel


def _speed(
    settings: Settings, trial: Trial, measured: Measure | None, place: Measure
) -> np.ndarray:
    if measured is not None and len(trial.samples[measured.name].values):
        result: np.ndarray = trial.samples[measured.name].values[0]
        return result
    samples = trial.samples[place.name]
    return _slope(trial.times[samples.index], samples.values, settings.start.samples)


def _spin(settings: Settings, trial: Trial, measured: Measure | None, turn: Measure) -> np.ndarray:
    """In the body's frame."""
    samples = trial.samples[turn.name]
    first = samples.values[0]
    if measured is not None and len(trial.samples[measured.name].values):
        spin: np.ndarray = trial.samples[measured.name].values[0]
        if measured.frame == "body":
            return spin
        return rotations.rotate(rotations.inverse(first), spin)
    count = settings.start.samples
    turned = rotations.product(rotations.inverse(first), samples.values[:count])
    return _slope(trial.times[samples.index], rotations.vector(turned), count)


def _slope(times: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Rate of change at the first sample, by a parabola through the first ones."""
    t, x = times[:count] - times[0], values[:count]
    if len(t) < 2:
        return np.zeros(values.shape[1])
    powers = np.vander(t, min(3, len(t)), increasing=True)
    fitted, *_ = np.linalg.lstsq(powers, x, rcond=None)
    result: np.ndarray = fitted[1]
    return result


def disturbed(
    joints: list[MovedJoint], qpos: np.ndarray, qvel: np.ndarray, by: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """A state moved by numbers: 12 of a free joint, 2 of another one."""
    qpos, qvel = qpos.copy(), qvel.copy()
    place = 0
    for joint in joints:
        q, v = joint.qpos, joint.qvel
        if joint.is_free:
            move = by[place : place + 12]
            place += 12
            qpos[q : q + 3] += move[:3]
            turn = rotations.quaternion(move[3:6])
            qpos[q + 3 : q + 7] = rotations.product(qpos[q + 3 : q + 7], turn)
            qvel[v : v + 6] += move[6:]
        else:
            qpos[q] += by[place]
            qvel[v] += by[place + 1]
            place += 2
    return qpos, qvel
