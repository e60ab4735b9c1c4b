# SPDX-License-Identifier: Apache-2.0
"""Runs trials of a study, one after the other, in one process: from values to a row."""

from __future__ import annotations

import math
from typing import Any

import mujoco

from volcontact.messages.spelling import nearest
from volcontact.running.recording import CHANNELS
from volcontact.study.control import POLICIES, check_control, make_controller
from volcontact.study.designs import trial_generator
from volcontact.study.episode import Episode, Watcher
from volcontact.study.file.settings import ADAPTIVE, Settings, StudyError
from volcontact.study.functions import Functions
from volcontact.study.mjcf import Document
from volcontact.study.scene import Scene
from volcontact.study.targets import changed_text, targets_of

Row = dict[str, Any]


class Runner:
    """Runs trials of a study.

    Args:
        settings: of the study.

    Raises:
        StudyError: the study asks for what the scene or the functions do not have.
    """

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self._functions = Functions(settings.python)
        get = self._functions.get
        self._prepare = get(settings.prepare, "[study] prepare") if settings.prepare else None
        self._function = get(settings.function, "[study] function") if settings.function else None
        self._success = (
            get(settings.success_function, "[success] function")
            if settings.success_function
            else None
        )
        self._record = [get(name, "[record] functions") for name in settings.record.functions]
        policy = settings.control.get("policy", POLICIES[0])
        self._has_own_code = any((self._prepare, self._success, policy not in POLICIES))
        self._document: Document | None = None
        if settings.scene is not None:
            self._document = Document(settings.scene)
        self.targets = [t for each in settings.inputs for t in targets_of(each, self._document)]
        self._compiled = [t for t in self.targets if not t.live]
        gains = [t for t in self.targets if t.where == "control"]
        self._gains = {t.name: t.column for t in gains}
        check_control(settings.control, set(self._gains), self._functions)
        self._scene: Scene | None = None
        self._scene_values: tuple[Any, ...] = ()
        self.columns = self._columns()
        empty = {"float": math.nan, "text": "", "bool": False, "int": 0}
        self._empty = {name: empty[kind] for name, kind in self.columns.items()}

    def _columns(self) -> dict[str, str]:
        """Names and kinds of all columns of a row, in their order."""
        settings = self.settings
        found = {"trial": "int"}
        if settings.sample.method in ADAPTIVE:
            found |= {"level": "int", "weight": "float"}
        for each in settings.inputs:
            found |= dict.fromkeys(each.columns, "text" if each.is_text else "float")
        found |= {"outcome": "text", "success": "bool", "reason": "text"}
        names: list[str] = []
        if settings.scene is not None:
            names = ["time", "peak_force", "peak_torque", "peak_site_force", "first_touch"]
            names += ["most_sites", *(f"dissipated_{channel}" for channel in CHANNELS)]
            names += ["elastic", "numerical", "warnings"]
            names += ["distance", "angle"] if settings.pose else []
            names += [f"peak_force_{name}" for name, _ in settings.record.places]
            names += [name for name, _ in settings.record.final]
            names += [name for name, _ in settings.record.peak]
        names += [*settings.record.columns, *settings.record.functions]
        for name in names:
            if name in found:
                raise StudyError(f"[record] {name}: there are two columns of this name")
            found[name] = "float"
        if settings.scene is not None:
            found["place"] = "text"
        response = settings.sample.options.get("response")
        numbers = [name for name, kind in found.items() if kind in ("float", "bool")]
        if response is not None and response not in numbers:
            raise StudyError(
                f"[sample] response = {response!r}: is no column{nearest(response, numbers)}"
            )
        for condition in settings.success if settings.function else ():
            if condition.quantity not in settings.record.columns:
                raise StudyError(
                    f'[success] "{condition.quantity}": is none of [record] columns'
                    + nearest(condition.quantity, settings.record.columns)
                )
        return found

    def empty_row(self, trial: int, values: Row) -> Row:
        """A row with nothing but the inputs."""
        return {**self._empty, "trial": trial, **values}

    def failed(self, trial: int, values: Row, outcome: str, reason: str) -> Row:
        """The row of a trial that did not end by itself."""
        line = " ".join(reason.split())[:300]
        return {**self.empty_row(trial, values), "outcome": outcome, "reason": line}

    def run(self, trial: int, values: Row, watcher: Watcher | None = None) -> Row:
        """Runs one trial.

        Args:
            trial: its number.
            values: of the inputs, by column.
            watcher: called with model, data and contact at the start and at every look.
        """
        try:
            if self._function is not None:
                return self._run_function(trial, values)
            return self._run_scene(trial, values, watcher)
        except TimeoutError:
            raise
        except Exception as error:
            self.forget()
            message = str(error) if isinstance(error, StudyError) else _told(error)
            return self.failed(trial, values, "error", message)

    def forget(self) -> None:
        """Drops the compiled model, which a trial may have left half changed."""
        if self._scene is not None:
            self._scene.close()
        self._scene, self._scene_values = None, ()

    def scene(self, values: Row) -> Scene:
        """The model for these values, compiled anew only where they ask for another one."""
        key = tuple(values[t.column] for t in self._compiled)
        if self._scene is None or key != self._scene_values:
            self.forget()
            assert self._document is not None
            text = changed_text(self._document, self._compiled, values)
            self._scene = Scene(self.settings, text, self.targets)
            self._scene_values = key
        return self._scene

    def _run_function(self, trial: int, values: Row) -> Row:
        assert self._function is not None
        settings = self.settings
        result = self._function(values, trial_generator(settings.sample.seed, trial))
        row = self.empty_row(trial, values)
        for name in settings.record.columns:
            row[name] = float(result[name])
        good = all(c.low <= row[c.quantity] <= c.high for c in settings.success)
        if self._success is not None:
            good = good and bool(self._success(result))
        row["success"] = good
        row["outcome"] = "success" if good else "failure"
        return row

    def _run_scene(self, trial: int, values: Row, watcher: Watcher | None) -> Row:
        scene = self.scene(values)
        model, data = scene.model, scene.data
        scene.restore()
        scene.live.write(values)
        if scene.key >= 0:
            mujoco.mj_resetDataKeyframe(model, data, scene.key)
        else:
            mujoco.mj_resetData(model, data)
        scene.live.start(data, values)
        if self._prepare is not None:
            generator = trial_generator(self.settings.sample.seed, trial)
            self._prepare(model, data, values, generator)
        mujoco.mj_forward(model, data)
        _check_contact(scene)
        control = None
        if self.settings.control:
            gains = {gain: float(values[column]) for gain, column in self._gains.items()}
            control = make_controller(self.settings.control, gains, model, self._functions)
        row = self.empty_row(trial, values)
        Episode(self.settings, scene, control, self._success, watcher).run(row)
        if self._has_own_code:
            _check_contact(scene)
        for name, function in zip(self.settings.record.functions, self._record, strict=True):
            row[name] = float(function(model, data))
        return row


def _check_contact(scene: Scene) -> None:
    """The numbers that the model has now are in force."""
    if scene.contact is None:
        return
    wrong = scene.contact.live_error()
    if wrong:
        raise StudyError(wrong)
    if not scene.contact.is_installed():
        raise StudyError("MuJoCo's passive callback was replaced: volumetric contact does not act")


def _told(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"
