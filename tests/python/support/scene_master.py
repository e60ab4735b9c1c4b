# SPDX-License-Identifier: Apache-2.0
"""An instance of a unit of a whole scene, of FMI 2 or 3, driven call by call."""

import shutil

import fmpy
import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave

_STATUS = {1: "warning", 2: "discard", 3: "error", 4: "fatal"}


def copied(model, data):
    """A copy of data; releases before 2.3 have no function for it in Python."""
    import copy

    return copy.copy(data)


class SceneInstance:
    """Co-Simulation with names of arrays for both versions."""

    last_messages = ()

    def __init__(self, path, *, start=None, initialized=True, event_mode=False):
        self.folder = fmpy.extract(str(path))
        self.about = fmpy.read_model_description(self.folder)
        self.is_two = self.about.fmiVersion == "2.0"
        self.event_mode = event_mode
        self.variables = {v.name: v for v in self.about.modelVariables}
        self.timestep = float(self.about.defaultExperiment.stepSize)
        self.messages = SceneInstance.last_messages = []
        self.start_values = start or {}
        self.at = 0.0
        kind = FMU2Slave if self.is_two else FMU3Slave
        self.fmu = kind(
            guid=self.about.guid if self.is_two else self.about.instantiationToken,
            unzipDirectory=self.folder,
            modelIdentifier=self.about.coSimulation.modelIdentifier,
            instanceName="scene",
        )
        if self.is_two:
            self._logger = fmi2CallbackLoggerTYPE(
                lambda _e, _n, _s, _c, message: self.messages.append(message.decode())
            )
            callbacks = fmi2CallbackFunctions()
            callbacks.logger = self._logger
            self.fmu.instantiate(callbacks=callbacks)
        else:
            self.fmu.instantiate(
                logMessage=lambda _e, _s, _c, message: self.messages.append(message.decode()),
                eventModeUsed=event_mode,
                earlyReturnAllowed=event_mode,
            )
        if initialized:
            self.initialize()

    def initialize(self):
        """From Instantiated to Step Mode, with the values to start with."""
        self.at = 0.0
        for name, values in self.start_values.items():
            self.set(name, values)
        if self.is_two:
            self.fmu.setupExperiment(startTime=0.0)
            self.fmu.enterInitializationMode()
            self.fmu.exitInitializationMode()
        else:
            self.fmu.enterInitializationMode(startTime=0.0)
            self.fmu.exitInitializationMode()
            if self.event_mode:
                self.fmu.enterStepMode()

    def reset(self):
        """As new."""
        self.fmu.reset()
        self.initialize()

    def _first(self, name, count):
        scalar = self.is_two and f"{name}[1]" in self.variables
        return self.variables[f"{name}[1]" if scalar else name]

    def set(self, name, values):
        """Sets an array."""
        first = self._first(name, len(values)).valueReference
        if self.is_two:
            self.fmu.setReal(range(first, first + len(values)), [float(v) for v in values])
        else:
            self.fmu.setFloat64([first], [float(v) for v in values])

    def get(self, name, count=1):
        """An array."""
        first = self._first(name, count).valueReference
        if self.is_two:
            return np.array(self.fmu.getReal(range(first, first + count)))
        return np.array(self.fmu.getFloat64([first], nValues=count))

    def step(self, length):
        """One communication step."""
        self.fmu.doStep(currentCommunicationPoint=self.at, communicationStepSize=length)
        self.at += length

    def step_until_event(self, length):
        """FMI 3: a communication step as far as it goes; its end, and whether there is an event."""
        event, _, early, reached = self.fmu.doStep(
            currentCommunicationPoint=self.at, communicationStepSize=length
        )
        self.at = reached
        assert early == (reached < length)
        return reached, event

    def status(self, method, *arguments):
        """What a call returns that is not fine."""
        try:
            getattr(self, method)(*arguments)
        except FMICallException as error:
            return _STATUS[error.status]
        return "ok"

    def save(self):
        """A state."""
        return self.fmu.getFMUState()

    def restore(self, state):
        """Goes back to a state."""
        self.fmu.setFMUState(state)
        self.at = self.get("time")[0]

    def bytes_of(self, state):
        """A state as bytes."""
        return self.fmu.serializeFMUState(state)

    def restore_bytes(self, content):
        """Goes on from bytes."""
        state = self.fmu.deserializeFMUState(content)
        self.restore(state)
        self.free(state)

    def free(self, state):
        """Frees a state."""
        self.fmu.freeFMUState(state)

    def close(self):
        """Frees all."""
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)
