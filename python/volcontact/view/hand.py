# SPDX-License-Identifier: Apache-2.0
"""A hand that pulls at a point of a body, as the mouse does in MuJoCo's viewer."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np


@dataclass(frozen=True)
class Grip:
    """What a hand holds, and where it wants it.

    Attributes:
        geom: that it took hold of.
        point: where, in the frame of the geom [m], shape (3,).
        target: where to, in the world [m], shape (3,).
    """

    geom: int
    point: np.ndarray
    target: np.ndarray


class Hand:
    """Pulls by a spring and a damper, in `mjData.xfrc_applied`, beside what is there.

    The spring is that of MuJoCo's viewer: `<visual><map stiffness=.../>`, 100 by default, times the
    mass that is felt at the point; the damper is critical. The force goes with the hand.

    Any thread may move it; `apply` and `forget` are for the one that steps.
    """

    def __init__(self) -> None:
        self.grip: Grip | None = None
        self._taken: tuple[int, np.ndarray] = (0, np.zeros(3))
        self._mass: tuple[int, float] | None = None  # of the geom that is held [kg]
        self._applied: tuple[int, np.ndarray] | None = None

    def take(self, geom: int, point: np.ndarray) -> None:
        """Takes hold of a point of a geom, in its frame [m]; it pulls once it is moved."""
        self.grip = None
        self._mass = None
        self._taken = geom, np.array(point, float)

    def move(self, target: np.ndarray) -> None:
        """Wants the point at a place in the world [m]."""
        geom, point = self._taken
        self.grip = Grip(geom, point, np.array(target, float))

    def let_go(self) -> None:
        """Pulls no longer."""
        self.grip = None

    def forget(self) -> None:
        """The data were reset: nothing is applied, nothing is held."""
        self.grip = self._applied = self._mass = None

    def ends(self, data: mujoco.MjData) -> tuple[np.ndarray, np.ndarray] | None:
        """From where to where it pulls in the world [m]; None where it holds nothing."""
        grip = self.grip
        if grip is None:
            return None
        frame = data.geom_xmat[grip.geom].reshape(3, 3)
        return data.geom_xpos[grip.geom] + frame @ grip.point, grip.target

    def take_out(self, data: mujoco.MjData) -> None:
        """Takes out what was applied; the hand holds on."""
        if self._applied is not None:
            body, wrench = self._applied
            data.xfrc_applied[body] -= wrench
            self._applied = None

    def apply(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Writes the force of the present state, in place of that of the last step."""
        self.take_out(data)
        grip = self.grip
        if grip is None:
            return
        body = int(model.geom_bodyid[grip.geom])
        frame = data.geom_xmat[grip.geom].reshape(3, 3)
        point = data.geom_xpos[grip.geom] + frame @ grip.point
        if self._mass is None or self._mass[0] != grip.geom:
            self._mass = grip.geom, felt_mass(model, data, body, point)
        mass, stiffness = self._mass[1], float(model.vis.map.stiffness)
        arm = point - data.xipos[body]
        motion = np.zeros(6)
        mujoco.mj_objectVelocity(model, data, int(mujoco.mjtObj.mjOBJ_BODY), body, motion, 0)
        velocity = motion[3:] + np.cross(motion[:3], arm)
        force = mass * (stiffness * (grip.target - point) - 2.0 * np.sqrt(stiffness) * velocity)
        wrench = np.concatenate([force, np.cross(arm, force)])
        data.xfrc_applied[body] += wrench
        self._applied = body, wrench


def felt_mass(model: mujoco.MjModel, data: mujoco.MjData, body: int, point: np.ndarray) -> float:
    """The mass that a force at a point of a body feels, over all directions [kg].

    The inverse of the mean of the mobilities J M^-1 J^T; 0 where the body cannot move.
    """
    if model.nv == 0:
        return 0.0
    jacobian = np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, jacobian, None, point, body)
    solved = np.zeros_like(jacobian)
    mujoco.mj_solveM(model, data, solved, jacobian)
    mobility = float(np.einsum("ij,ij->", jacobian, solved)) / 3.0
    return 1.0 / mobility if mobility > 0.0 else 0.0
