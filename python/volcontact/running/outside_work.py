# SPDX-License-Identifier: Apache-2.0
"""Work that a scene gets besides that of volumetric contact and of its potentials, over a run."""

from __future__ import annotations

import mujoco
import numpy as np

CHANNELS = ("actuators", "dampers", "limits", "native")

_CONTACT_ROWS = tuple(  # one after another
    int(getattr(mujoco.mjtConstraint, f"mjCNSTR_CONTACT_{kind}"))
    for kind in ("FRICTIONLESS", "PYRAMIDAL", "ELLIPTIC")
)
_IMPLICIT = frozenset(
    int(getattr(mujoco.mjtIntegrator, f"mjINT_{name}"))
    for name in ("IMPLICIT", "IMPLICITFAST")
    if hasattr(mujoco.mjtIntegrator, f"mjINT_{name}")
)
_RK4 = int(mujoco.mjtIntegrator.mjINT_RK4)
_NO_EULER_DAMPING = int(getattr(mujoco.mjtDisableBit, "mjDSBL_EULERDAMP", 0))
_NO_DAMPERS = int(
    mujoco.mjtDisableBit.mjDSBL_DAMPER
    if hasattr(mujoco.mjtDisableBit, "mjDSBL_DAMPER")
    else mujoco.mjtDisableBit.mjDSBL_PASSIVE
)
_AFFINE = int(mujoco.mjtBias.mjBIAS_AFFINE)


class OutsideWork:
    """Adds up the work of `CHANNELS`, step by step.

    A step of h changes the kinetic energy by h F (v_0 + v_1) / 2, the force F being that which the
    integrator took: dampers, and servos of `implicit` and `implicitfast`, are taken at v_1 where it
    is implicit in them. Under Runge-Kutta the powers are integrated by the trapezoidal rule. Where
    the inertia changes with the pose, and under Runge-Kutta, an error of the step remains.

    Channels: the actuators, the dampers of joints and tendons with drag and gravity compensation
    (these two from MuJoCo 3 on), joint limits with friction of joints and equalities, and contacts
    of MuJoCo's own.

    Args:
        model: that is stepped; its options stay as they are.
        rows: there will be at most.
    """

    def __init__(self, model: mujoco.MjModel, rows: int) -> None:
        self._model = model
        self._work = np.zeros((rows, len(CHANNELS)))
        self._step = float(model.opt.timestep)
        integrator = int(model.opt.integrator)
        self._by_power = integrator == _RK4
        is_implicit = integrator in _IMPLICIT
        flags = int(model.opt.disableflags)
        self._servos = _velocity_gains(model) if is_implicit else np.zeros(model.nu)
        self._damps_late = is_implicit or not (self._by_power or flags & _NO_EULER_DAMPING)
        is_damped = not flags & _NO_DAMPERS
        self._dampers = is_damped * model.dof_damping, is_damped * model.tendon_damping
        # Time, power and controls of the last row.
        self._last: tuple[float, np.ndarray, np.ndarray] | None = None

    def keep_power(self, row: int, data: mujoco.MjData, *, always: bool = False) -> None:
        """Adds the work up to the state of a row, by the trapezoidal rule.

        Args:
            row: of the state.
            data: evaluated there.
            always: also where `keep_step` has added it.
        """
        if not (self._by_power or always):
            return
        if self._last is not None:
            time, before, control = self._last
            after = self._power_under(control, data)
            self._work[row] = self._work[row - 1] + 0.5 * (data.time - time) * (before + after)
        power = self._power(data, data.qvel, data.qvel)
        self._last = float(data.time), power, data.ctrl.copy()

    def _power_under(self, control: np.ndarray, data: mujoco.MjData) -> np.ndarray:
        """The power at the end of a step, over which controls are held."""
        present = data.ctrl.copy()
        if np.array_equal(control, present):
            return self._power(data, data.qvel, data.qvel)
        data.ctrl[:] = control
        mujoco.mj_fwdActuation(self._model, data)
        power = self._power(data, data.qvel, data.qvel)
        data.ctrl[:] = present
        mujoco.mj_fwdActuation(self._model, data)
        return power

    def keep_step(self, row: int, data: mujoco.MjData, velocity: np.ndarray) -> None:
        """Adds the work of the step from a row to the next one; not under Runge-Kutta.

        Args:
            row: where the step began.
            data: after the step, its forces those that the step took.
            velocity: at the beginning of the step, shape (nv,).
        """
        if self._by_power:
            return
        middle = 0.5 * (velocity + data.qvel)
        power = self._power(data, middle, data.qvel if self._damps_late else velocity)
        if self._servos.any():
            power[0] += self._of_servos(data, velocity, middle)
        self._work[row + 1] = self._work[row] + self._step * power

    def work(self, rows: int) -> np.ndarray:
        """Since the start [J], shape (rows, 4), columns `CHANNELS`."""
        return self._work[:rows].copy()

    def _power(self, data: mujoco.MjData, middle: np.ndarray, late: np.ndarray) -> np.ndarray:
        power = np.zeros(len(CHANNELS))
        power[0] = data.qfrc_actuator @ middle
        of_joints, of_tendons = self._dampers
        power[1] = -(of_joints * late) @ middle - of_tendons @ data.ten_velocity**2
        for name in ("qfrc_fluid", "qfrc_gravcomp"):
            force = getattr(data, name, None)
            if force is not None and len(force):
                power[1] += force @ middle
        if data.nefc:
            speed = np.zeros(data.nefc)
            mujoco.mj_mulJacVec(self._model, data, speed, np.ascontiguousarray(middle))
            each = data.efc_force[: data.nefc] * speed
            kinds = data.efc_type[: data.nefc]
            is_contact = (kinds >= min(_CONTACT_ROWS)) & (kinds <= max(_CONTACT_ROWS))
            power[2], power[3] = each[~is_contact].sum(), each[is_contact].sum()
        return power

    def _of_servos(self, data: mujoco.MjData, velocity: np.ndarray, middle: np.ndarray) -> float:
        """Power of the change of velocity servos within a step, which implicit ones take."""
        change = data.qvel - velocity
        total = 0.0
        for i in np.flatnonzero(self._servos):
            arm = _moment(self._model, data, int(i))
            total += float(self._servos[i] * (arm @ change) * (arm @ middle))
        return total


def _velocity_gains(model: mujoco.MjModel) -> np.ndarray:
    """Derivative of the force of each actuator by its velocity [N s/m, N m s], shape (nu,).

    That of servos whose force has no limit; a limited one may be at its limit.
    """
    is_affine = model.actuator_biastype == _AFFINE
    is_free = model.actuator_forcelimited == 0
    gains: np.ndarray = np.where(is_affine & is_free, model.actuator_biasprm[:, 2], 0.0)
    return gains


def _moment(model: mujoco.MjModel, data: mujoco.MjData, actuator: int) -> np.ndarray:
    """Row of the moment matrix of an actuator, shape (nv,); it is sparse from MuJoCo 3.2 on."""
    if not hasattr(data, "moment_rownnz"):
        row: np.ndarray = data.actuator_moment.reshape(model.nu, model.nv)[actuator]
        return row
    arm = np.zeros(model.nv)
    start, count = int(data.moment_rowadr[actuator]), int(data.moment_rownnz[actuator])
    arm[data.moment_colind[start : start + count]] = data.actuator_moment.ravel()[
        start : start + count
    ]
    return arm
