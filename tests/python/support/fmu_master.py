# SPDX-License-Identifier: Apache-2.0
"""A rigid body as equations of a master, with its contact from an FMU of Model Exchange."""

import ctypes
import shutil
from dataclasses import dataclass

import fmpy
import mujoco
import numpy as np
from fmpy.fmi2 import FMU2Model, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Model


class Exchange:
    """One instance of Model Exchange of FMI 2 or 3, with the names of FMI 2 for its numbers."""

    def __init__(self, path):
        self.folder = fmpy.extract(str(path))
        self.about = fmpy.read_model_description(self.folder)
        self.is_two = self.about.fmiVersion == "2.0"
        self.references = {}
        for variable in self.about.modelVariables:
            self.references[variable.name] = variable.valueReference
        self.messages = []
        kind = FMU2Model if self.is_two else FMU3Model
        self.fmu = kind(
            guid=self.about.guid if self.is_two else self.about.instantiationToken,
            unzipDirectory=self.folder,
            modelIdentifier=self.about.modelExchange.modelIdentifier,
            instanceName="master",
        )
        if self.is_two:
            self._logger = fmi2CallbackLoggerTYPE(
                lambda _e, _n, _s, _c, message: self.messages.append(message.decode())
            )
            callbacks = fmi2CallbackFunctions()
            callbacks.logger = self._logger
            self.fmu.instantiate(callbacks=callbacks)
            self.fmu.setupExperiment(startTime=0.0)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.instantiate(
                logMessage=lambda _e, _s, _c, message: self.messages.append(message.decode())
            )
            self.fmu.enterInitializationMode(startTime=0.0)
        self.states = self._count(self.about.numberOfContinuousStates, "States")
        self.indicators = self._count(self.about.numberOfEventIndicators, "EventIndicators")

    def _count(self, two, what):
        if self.is_two:
            return two
        return getattr(self.fmu, f"getNumberOf{'Continuous' if what == 'States' else ''}{what}")()

    def start(self):
        """Ends the initialization and handles the first event."""
        self.fmu.exitInitializationMode()
        self.event(entering=False)

    def event(self, *, entering=True):
        """One event."""
        if entering:
            self.fmu.enterEventMode()
        if self.is_two:
            self.fmu.newDiscreteStates()
        else:
            self.fmu.updateDiscreteStates()
        self.fmu.enterContinuousTimeMode()

    def set(self, name, values):
        """Sets an array."""
        reference = self.references[name if not self.is_two or len(values) == 1 else f"{name}[1]"]
        if self.is_two:
            self.fmu.setReal(range(reference, reference + len(values)), values)
        else:
            self.fmu.setFloat64([reference], list(values))

    def get(self, name, count=1):
        """An array."""
        reference = self.references[name if not self.is_two or count == 1 else f"{name}[1]"]
        if self.is_two:
            return np.array(self.fmu.getReal(range(reference, reference + count)))
        return np.array(self.fmu.getFloat64([reference], nValues=count))

    def rates(self, out):
        """Derivatives of the continuous states, to a pointer."""
        if self.is_two:
            self.fmu.getDerivatives(out, self.states)
        else:
            self.fmu.getContinuousStateDerivatives(out, self.states)

    def set_states(self, x):
        """From a pointer."""
        self.fmu.setContinuousStates(x, self.states)

    def close(self):
        """Frees all."""
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


@dataclass
class RigidBody:
    """Mass and inertia, and how it starts: numbers of one free body of an MjModel."""

    mass: float
    inertia: np.ndarray
    to_mass: np.ndarray  # centre of mass in the frame of the body
    turned: np.ndarray  # axes of inertia there
    gravity: np.ndarray

    @classmethod
    def of(cls, model, name):
        """Of a body of a model."""
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
        turned = np.zeros(9)
        mujoco.mju_quat2Mat(turned, model.body_iquat[body])
        return cls(
            float(model.body_mass[body]),
            model.body_inertia[body].copy(),
            model.body_ipos[body].copy(),
            turned.reshape(3, 3),
            model.opt.gravity.copy(),
        )


def rotation(q):
    out = np.zeros(9)
    mujoco.mju_quat2Mat(out, q / np.linalg.norm(q))
    return out.reshape(3, 3)


class Master:
    """The body's equations and the FMU, as one system for a solver.

    Its states: place of the centre of mass, quaternion, angular velocity and velocity of that
    centre, in the world; then those of the FMU.
    """

    def __init__(self, unit, body, name, qpos, qvel):
        self.unit, self.body, self.name = unit, body, name
        R = rotation(qpos[3:7])
        w = R @ qvel[3:6]  # of MuJoCo's free joints: in the body
        arm = R @ body.to_mass
        self.y = np.r_[qpos[:3] + arm, qpos[3:7], w, qvel[:3] + np.cross(w, arm)]
        self.x = np.zeros(unit.states)
        self.apply(0.0, self.y)
        unit.start()
        self._get_x()
        self.evaluations = 0

    def _get_x(self):
        pointer = self.x.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        self.unit.fmu.getContinuousStates(pointer, len(self.x))

    def apply(self, time, y):
        """Hands the motion to the FMU."""
        self.R = rotation(y[3:7])
        self.arm = self.R @ self.body.to_mass
        if self.unit.is_two:  # all four in a row
            first = self.unit.references[f"{self.name}.position[1]"]
            values = [
                *(y[:3] - self.arm),
                *y[3:7],
                *y[7:10],
                *(y[10:13] - np.cross(y[7:10], self.arm)),
            ]
            self.unit.fmu.setReal(range(first, first + 13), values)
            return
        self.unit.set(f"{self.name}.position", y[:3] - self.arm)
        self.unit.set(f"{self.name}.quaternion", y[3:7])
        self.unit.set(f"{self.name}.angular_velocity", y[7:10])
        self.unit.set(f"{self.name}.velocity", y[10:13] - np.cross(y[7:10], self.arm))

    def slopes(self):
        """Of the body's states, under the FMU's wrench."""
        y, body = self.y, self.body
        force = self.unit.get(f"{self.name}.force", 3)
        torque = self.unit.get(f"{self.name}.torque", 3) - np.cross(self.arm, force)
        w = y[7:10]
        axes = self.R @ body.turned
        local = axes.T @ w
        spin_up = axes @ ((axes.T @ torque - np.cross(local, body.inertia * local)) / body.inertia)
        q = y[3:7]
        dq = 0.5 * np.r_[-w @ q[1:], q[0] * w + np.cross(w, q[1:])]
        return np.r_[y[10:13], dq, spin_up, body.gravity + force / body.mass]

    def energy(self):
        """Of the body, of the contact, and what friction and damping have taken [J]."""
        self.apply(0.0, self.y)
        w = (self.R @ self.body.turned).T @ self.y[7:10]
        moves = (
            0.5 * self.body.mass * self.y[10:13] @ self.y[10:13] + 0.5 * self.body.inertia @ w**2
        )
        falls = -self.body.mass * self.body.gravity @ self.y[:3]
        return moves + falls + self.unit.get("elastic_energy")[0] + self.x[:4].sum()

    # What CVODE asks for.
    def size(self):
        return 13 + len(self.x)

    def get_x(self, pointer, count):
        np.ctypeslib.as_array(pointer, (count,))[:] = np.r_[self.y, self.x]

    def set_x(self, pointer, count):
        values = np.ctypeslib.as_array(pointer, (count,))
        self.y[:], self.x[:] = values[:13], values[13:]
        self.apply(0.0, self.y)
        self.unit.set_states(self.x.ctypes.data_as(ctypes.POINTER(ctypes.c_double)))

    def get_dx(self, pointer, count):
        self.evaluations += 1
        out = np.ctypeslib.as_array(pointer, (count,))
        rates = np.zeros(len(self.x))
        self.unit.rates(rates.ctypes.data_as(ctypes.POINTER(ctypes.c_double)))
        out[:13], out[13:] = self.slopes(), rates

    def get_z(self, pointer, count):
        self.unit.fmu.getEventIndicators(pointer, count)

    def get_nominals(self, pointer, count):
        out = np.ctypeslib.as_array(pointer, (count,))
        out[:13] = 1.0
        own = np.zeros(len(self.x))
        self.unit.fmu.getNominalsOfContinuousStates(
            own.ctypes.data_as(ctypes.POINTER(ctypes.c_double)), len(own)
        )
        out[13:] = own

    def set_time(self, time):
        self.unit.fmu.setTime(time)

    def run(self, duration, *, tolerance=1e-8, output=1e-3, longest=1e-3, until=None):
        """Solves; returns times and body states at each output, and the events (time, roots)."""
        from fmpy.sundials import CVodeSolver

        nothing = type("NoInput", (), {"apply": lambda self, _time: None})()
        solver = CVodeSolver(
            nx=self.size(), nz=self.unit.indicators, get_x=self.get_x, set_x=self.set_x,
            get_dx=self.get_dx, get_z=self.get_z, get_nominals=self.get_nominals,
            set_time=self.set_time, input=nothing, startTime=0.0, maxStep=longest,
            relativeTolerance=tolerance, maxNumSteps=100000,
        )  # fmt: skip
        time, rows, events = 0.0, [], []
        while time < duration - 1e-12:
            found, roots, time = solver.step(time, min(time + output, duration))
            enter, _ = self.unit.fmu.completedIntegratorStep()
            if found or enter:
                if found:
                    events.append((time, *map(int, roots)))
                self.unit.event()
                self._get_x()
                solver.reset(time)
            rows.append(np.r_[time, self.y])
            if until is not None and until(time, self.y):
                break
        return np.array(rows), events
