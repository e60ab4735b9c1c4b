# SPDX-License-Identifier: Apache-2.0
"""Runs the scene as it was measured: from values of the parameters to errors at every sample."""

from __future__ import annotations

import math
from typing import Any

import mujoco
import numpy as np

from volcontact import scene as volumetric_scene
from volcontact.given_keys import GivenKeys
from volcontact.identify import rotations
from volcontact.identify.measurements import Trial
from volcontact.identify.readers import level_of, make_reader
from volcontact.identify.settings import Nuisance, Settings, StudyError
from volcontact.identify.starts import disturbed, moved_joints, start_state
from volcontact.running.simulation import native_model
from volcontact.running.watched import Watch
from volcontact.study.mjcf import Document
from volcontact.study.targets import LiveNumbers, changed_text, targets_of

Values = dict[str, float]
_ON_STEP = 1e-6  # part of a step within which a sample is at the step
LOST = 1e3  # error of a sample that the motion did not reach [sigma]


def written(settings: Settings, values: Values) -> Values:
    """What is written to the scene: multiples of other parameters multiplied out."""
    return {
        each.name: values[each.name] * (values[each.times] if each.times else 1.0)
        for each in settings.parameters
    }


class Bench:
    """The scene of a study, and its trials.

    Args:
        settings: of the study.
        trials: to run, cut to their windows.

    Attributes:
        deviations: standard deviations of the numbers of each trial, shape (q,).

    Raises:
        StudyError: scene, study and measurements do not fit.
    """

    def __init__(self, settings: Settings, trials: list[Trial]) -> None:
        self.settings = settings
        self.trials = trials
        self._document = Document(settings.scene)
        self._targets = [
            target
            for each in settings.parameters
            for target in targets_of(each.as_input(), self._document)
        ]
        for target in self._targets:
            if target.where == "control":
                raise StudyError(f"target {target.text!r}: there is no controller here")
        self._compiled = [target for target in self._targets if not target.live]
        self._key: tuple[float, ...] | None = None
        self._contact: volumetric_scene.Contact | None = None
        self._open(self._nominal())
        self._joints = moved_joints(self._model, settings)
        state = self._data.qpos.copy(), self._data.qvel.copy()
        self._starts = [start_state(settings, self._joints, trial, *state) for trial in trials]
        self.deviations = self._deviations()

    def close(self) -> None:
        """Detaches the model."""
        if self._contact is not None:
            self._contact.close()
        self._contact, self._key = None, None

    def start_values(self) -> Values:
        """The first guess: of the file, else of the scene, else the middle of the bounds."""
        return self._nominal()

    def _nominal(self) -> Values:
        found = {}
        for each in self.settings.parameters:
            value = each.start
            if value is None and each.mode == "set" and not each.times:
                value = self._said(each.name)
            elif value is None and each.mode == "add":
                value = 0.0
            elif value is None and each.mode == "scale":
                value = 1.0
            if value is None or not each.low <= value <= each.high:
                middle = 0.5 * (each.low + each.high)
                value = math.sqrt(each.low * each.high) if each.log else middle
            found[each.name] = value
        return found

    def _said(self, name: str) -> float | None:
        """What the scene says of a parameter."""
        target = next(t for t in self._targets if t.column == name)
        element = None
        if target.where in ("numeric", "attribute"):
            element = self._document.find(target.tag, target.name)
        elif target.where == "option":
            element = self._document.root.find("option")
        if element is None:
            return None
        text = self._document.attribute(element, target.key)
        numbers = [float(word) for word in text.split()] if text else []
        index = target.index or 0
        return numbers[index] if index < len(numbers) else None

    def _open(self, values: Values) -> None:
        """Compiles the scene for values, where they ask for another one."""
        key = tuple(values[target.column] for target in self._compiled)
        if key == self._key:
            return
        self.close()
        settings = self.settings
        text = changed_text(self._document, self._compiled, dict(values))
        if settings.contact == "native":
            self._model = native_model(text)
        else:
            keys = GivenKeys(settings.material or None, settings.options or None)
            self._model = volumetric_scene.load(text, material=keys.material, options=keys.options)
        if settings.timestep is not None:
            self._model.opt.timestep = settings.timestep
        self._live = LiveNumbers(self._model, self._targets)
        if settings.contact != "native":
            self._live.write(dict(values))
            self._contact = volumetric_scene.Contact(self._model, keys)
        self._data = mujoco.MjData(self._model)
        self._watch = Watch()
        self._readers = [
            make_reader(self._model, self._data, each) for each in settings.measures if each.weight
        ]
        self._level = level_of(self._readers)
        self._key = key

    def _deviations(self) -> np.ndarray:
        nuisance = self.settings.nuisance
        found = []
        if nuisance != Nuisance(clock=nuisance.clock):
            found = [sd for joint in self._joints for sd in joint.deviations(nuisance)]
            if not found:
                raise StudyError("[nuisance]: no joint is measured whose start could be found")
        self._state_count = len(found)
        found.append(nuisance.clock)
        for each in self.settings.measures:
            if each.weight:
                found += [each.bias] * each.width
        return np.array(found)

    def errors(self, values: Values, trial: int, moved: np.ndarray | None = None) -> np.ndarray:
        """Errors of all samples of a trial that count, one measure after the other.

        Args:
            values: of the parameters.
            trial: its place among the trials.
            moved: numbers of the trial, as of `deviations`; None: zeros.

        Returns:
            Shape (n,), in standard deviations, times the root of their weights.
        """
        parts = []
        sigmas = {each.name: each for each in self.settings.measures}
        for name, error in self.raw_errors(values, trial, moved).items():
            measure = sigmas[name]
            scaled = math.sqrt(measure.weight) / measure.sigma * error
            parts.append(np.nan_to_num(scaled, nan=LOST, posinf=LOST, neginf=-LOST).ravel())
        return np.concatenate(parts) if parts else np.empty(0)

    def raw_errors(
        self, values: Values, trial: int, moved: np.ndarray | None = None
    ) -> dict[str, np.ndarray]:
        """Simulated less measured, of each measure that counts, shape (samples, width) [SI]."""
        found = {}
        predicted = self.predicted(values, trial, moved)
        place = self._state_count + 1
        for each in self.settings.measures:
            if not each.weight:
                continue
            samples = self.trials[trial].samples[each.name]
            simulated = predicted[each.name][samples.index]
            if each.kind == "orientation":
                back = rotations.inverse(samples.values)
                error = rotations.vector(rotations.product(back, simulated))
            else:
                error = simulated - samples.values
            if moved is not None:
                error = error + moved[place : place + each.width]
            place += each.width
            found[each.name] = error
        return found

    def predicted(
        self, values: Values, trial: int, moved: np.ndarray | None = None
    ) -> dict[str, np.ndarray]:
        """What each measure would read at all times of the trial; NaN once the motion is lost."""
        given = written(self.settings, values)
        self._open(given)
        times = self.trials[trial].times
        if moved is not None:
            times = times + moved[self._state_count]
        place = times / self._model.opt.timestep
        low = np.maximum(np.floor(place + _ON_STEP), 0.0)
        part = place - low
        part[np.abs(part) < _ON_STEP] = 0.0
        low = low.astype(int)
        steps, where = np.unique(np.concatenate([low, low + (part != 0.0)]), return_inverse=True)
        where = where.reshape(2, -1)
        rows = self._run(given, trial, moved, steps)
        found = {}
        for reader in self._readers:
            block = rows[:, reader.place : reader.place + reader.count]
            before, after = block[where[0]], block[where[1]]
            if reader.kind == "orientation":
                found[reader.name] = rotations.between(before, after, part)
            else:
                found[reader.name] = before + part[:, None] * (after - before)
        return found

    def _run(
        self, values: Values, trial: int, moved: np.ndarray | None, steps: np.ndarray
    ) -> np.ndarray:
        model, data, watch = self._model, self._data, self._watch
        self._live.write(dict(values))
        mujoco.mj_resetData(model, data)
        qpos, qvel = self._starts[trial]
        if moved is not None and self._state_count:
            qpos, qvel = disturbed(self._joints, qpos, qvel, moved[: self._state_count])
        data.qpos[:], data.qvel[:] = qpos, qvel
        self._live.start(data, dict(values))
        self._check_live()
        rows = np.full((len(steps), sum(reader.count for reader in self._readers)), math.nan)
        watch.restart()
        done = 0
        for row, step in zip(rows, steps.tolist(), strict=True):
            if step > done and watch.step(model, data, step - done) != step - done:
                break
            if watch.outcome:
                break
            done = step
            if self._level == 1:
                mujoco.mj_kinematics(model, data)
            elif self._level == 2:
                mujoco.mj_forward(model, data)
            for reader in self._readers:
                reader.read(row[reader.place : reader.place + reader.count])
        return rows

    def _check_live(self) -> None:
        if self._contact is None:
            return
        wrong = self._contact.live_error()
        if wrong:
            raise StudyError(wrong)

    def describe(self) -> dict[str, Any]:
        """Facts of the scene for reports."""
        return {"timestep": float(self._model.opt.timestep), "bodies": int(self._model.nbody)}
