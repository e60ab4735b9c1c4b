# SPDX-License-Identifier: Apache-2.0
"""Runs trials of a study, one after the other, in one process: from values to a row."""

from __future__ import annotations

import fnmatch
import math
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from volcontact import scene as volumetric_scene
from volcontact.given_keys import GivenKeys
from volcontact.probes import native_sites
from volcontact.simulation import native_model, warnings_of
from volcontact.study.control import check_control, make_controller
from volcontact.study.designs import trial_generator
from volcontact.study.functions import Functions
from volcontact.study.mjcf import Document
from volcontact.study.quantities import Quantities, keyframe_id
from volcontact.study.settings import ADAPTIVE, Settings, StudyError
from volcontact.study.table import nearest
from volcontact.study.targets import LiveNumbers, Target, changed_text, targets_of

Row = dict[str, Any]
_FATAL = ("BADQPOS", "BADQVEL", "BADQACC")
_FATAL_PLACES = tuple(int(getattr(mujoco.mjtWarning, f"mjWARN_{name}")) for name in _FATAL)
CHANNELS = ("normal", "roll", "slide", "spin")
Watcher = Callable[[mujoco.MjModel, mujoco.MjData, Any], None]


class Scene:
    """A compiled model, attached, with what a trial needs of it."""

    def __init__(self, settings: Settings, text: str, targets: list[Target]) -> None:
        keys = GivenKeys(settings.material or None, settings.options or None)
        self.contact: volumetric_scene.Contact | None = None
        if settings.contact == "native":
            self.model = native_model(text)
        else:
            self.model = volumetric_scene.load(text, material=keys.material, options=keys.options)
        if settings.timestep is not None:
            self.model.opt.timestep = settings.timestep
        self.live = LiveNumbers(self.model, targets)
        if settings.contact != "native":
            self.contact = volumetric_scene.Contact(self.model, keys)
        self.data = mujoco.MjData(self.model)
        self.felt = {"sites": 0.0, "site_force": 0.0}
        self.quantities = Quantities(self.model, self.data, settings.pose, self.felt)
        self.places = _places(self.model, settings.record.places)
        start = "start" if settings.keyframe is None else settings.keyframe
        key = mujoco.mj_name2id(self.model, int(mujoco.mjtObj.mjOBJ_KEY), start)
        if settings.keyframe is not None:
            key = keyframe_id(self.model, start, "[study]")
        self.key = key

    def close(self) -> None:
        """Detaches the model."""
        if self.contact is not None:
            self.contact.close()


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
        empty = {"float": math.nan, "text": "", "bool": False, "int": 0}
        row = {name: empty[kind] for name, kind in self.columns.items()}
        row |= {"trial": trial, **values}
        return row

    def failed(self, trial: int, values: Row, outcome: str, reason: str) -> Row:
        """The row of a trial that did not end by itself."""
        line = " ".join(reason.split())[:300]
        return {**self.empty_row(trial, values), "outcome": outcome, "reason": line}

    def run(self, trial: int, values: Row, watcher: Watcher | None = None) -> Row:
        """Runs one trial.

        Args:
            trial: its number.
            values: of the inputs, by column.
            watcher: called with model, data and contact after every look at the scene.
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
        if scene.contact is not None:
            wrong = scene.contact.live_error()
            if wrong:
                raise StudyError(wrong)
        control = None
        if self.settings.control:
            gains = {gain: float(values[column]) for gain, column in self._gains.items()}
            control = make_controller(self.settings.control, gains, model, self._functions)
        row = self.empty_row(trial, values)
        _Watch(self.settings, scene, row, control, self._success, watcher).run()
        for name, function in zip(self.settings.record.functions, self._record, strict=True):
            row[name] = float(function(model, data))
        if self._prepare is not None:
            self.forget()  # nobody knows what it changed
        return row


class _Watch:
    """Steps one trial to its end and fills in its row."""

    def __init__(
        self,
        settings: Settings,
        scene: Scene,
        row: Row,
        control: Callable[[mujoco.MjData], None] | None,
        success: Callable[..., Any] | None,
        watcher: Watcher | None,
    ) -> None:
        self._end = settings.end
        self._settings = settings
        self._scene = scene
        self._row = row
        self._control = control
        self._success_function = success
        self._watcher = watcher
        quantities = scene.quantities
        scene.felt.update(sites=0.0, site_force=0.0)
        self._good = quantities.holds(settings.success) if settings.success else None
        self._jammed = quantities.holds(self._end.jammed) if self._end.jammed else None
        self._force = quantities.norm(self._end.force) if self._end.force else None
        self._torque = quantities.norm(self._end.torque) if self._end.torque else None
        self._peaks = [(name, quantities.reader(what)) for name, what in settings.record.peak]
        self._place_peaks = np.zeros(max(len(scene.places.names), 1))
        self._good_since = self._jammed_since = math.inf
        self._sites: Any = np.zeros(0)
        for name in ("peak_force", "peak_torque", "peak_site_force", "most_sites"):
            row[name] = 0.0
        for name, _ in settings.record.peak:
            row[name] = -math.inf

    def run(self) -> None:
        """Steps until the trial ends."""
        model, data = self._scene.model, self._scene.data
        step = float(model.opt.timestep)
        watch = max(1, round(self._end.watch / step))
        every = max(1, round(self._settings.control.get("period", 0.1) / step / watch))
        total = max(1, math.ceil(self._end.duration / step - 1e-9))
        done = looks = 0
        outcome = "timed_out"
        while done < total:
            if self._control is not None and looks % every == 0:
                self._control(data)
            count = min(watch, total - done)
            mujoco.mj_step(model, data, count)
            done, looks = done + count, looks + 1
            if any(data.warning[place].number for place in _FATAL_PLACES):
                outcome = "diverged"
                names = ", ".join(warnings_of(data))
                self._row["reason"] = f"MuJoCo reset the state after {done * step:.6g} s: {names}"
                break
            ended = self._look()
            if self._watcher is not None:
                self._watcher(model, data, self._scene.contact)
            if ended:
                outcome = ended
                break
        self._finish(outcome, done * step)

    def _look(self) -> str:
        data, row, end = self._scene.data, self._row, self._end
        force, torque = self._feel()
        if self._force is not None:
            force = self._force()
        if self._torque is not None:
            torque = self._torque()
        row["peak_force"] = max(row["peak_force"], force)
        row["peak_torque"] = max(row["peak_torque"], torque)
        for name, read in self._peaks:
            row[name] = max(row[name], read())
        if force > end.force_limit:
            row["reason"] = f"force {force:.4g} N is above its limit {end.force_limit:g} N"
            return "force_limit"
        if torque > end.torque_limit:
            row["reason"] = f"torque {torque:.4g} N m is above its limit {end.torque_limit:g} N m"
            return "torque_limit"
        now = float(data.time)
        if self._is_good():
            self._good_since = min(self._good_since, now)
            if now - self._good_since >= self._settings.hold - 1e-12:
                return "success"
        else:
            self._good_since = math.inf
        if self._jammed is not None:
            self._jammed_since = min(self._jammed_since, now) if self._jammed() else math.inf
            if now - self._jammed_since >= end.jam_time - 1e-12:
                return "jammed"
        return ""

    def _is_good(self) -> bool:
        good = self._good is None or self._good()
        if good and self._success_function is not None:
            good = bool(self._success_function(self._scene.model, self._scene.data))
        return good

    def _feel(self) -> tuple[float, float]:
        """Looks at the contact sites; the sums of their forces [N] and torques [N m]."""
        scene, row = self._scene, self._row
        if scene.contact is not None:
            sites = scene.contact.sites(scene.data)
        else:
            sites = native_sites(scene.model, scene.data)
        self._sites = sites
        scene.felt["sites"] = float(len(sites))
        scene.felt["site_force"] = 0.0
        if not len(sites):
            return 0.0, 0.0
        force, torque = sites["force"], sites["torque"]
        forces = np.sqrt(np.einsum("ij,ij->i", force, force))
        torques = np.sqrt(np.einsum("ij,ij->i", torque, torque))
        largest = float(forces.max())
        scene.felt["site_force"] = largest
        if math.isnan(row["first_touch"]):
            row["first_touch"] = float(scene.data.time)
        row["most_sites"] = max(row["most_sites"], float(len(sites)))
        row["peak_site_force"] = max(row["peak_site_force"], largest)
        if scene.places.names:
            inside = scene.places.members[:, sites["geom_a"]]
            inside = inside | scene.places.members[:, sites["geom_b"]]
            np.maximum(self._place_peaks, inside @ forces, out=self._place_peaks)
        return float(forces.sum()), float(torques.sum())

    def _finish(self, outcome: str, time: float) -> None:
        scene, row = self._scene, self._row
        row |= {"outcome": outcome, "success": outcome == "success", "time": time}
        row["warnings"] = float(sum(warnings_of(scene.data).values()))
        row["place"] = self._place()
        for name, peak in zip(scene.places.names, self._place_peaks, strict=False):
            row[f"peak_force_{name}"] = float(peak)
        if outcome == "diverged":
            return  # MuJoCo has gone back to the start
        mujoco.mj_forward(scene.model, scene.data)
        if scene.contact is not None:
            energy = scene.contact.energy(scene.data)
            for channel, joules in zip(CHANNELS, energy.by_channel, strict=True):
                row[f"dissipated_{channel}"] = float(joules)
            row |= {"elastic": float(energy.elastic), "numerical": float(energy.numerical)}
        if self._settings.pose:
            row["distance"], row["angle"] = scene.quantities.offset()
        for name, what in self._settings.record.final:
            row[name] = scene.quantities.reader(what)()

    def _place(self) -> str:
        """Where the largest force is at the end: a place of the study, else two geoms."""
        if not len(self._sites):
            return ""
        forces = np.sqrt((self._sites["force"] ** 2).sum(axis=1))
        site = self._sites[int(np.argmax(forces))]
        pair = int(site["geom_a"]), int(site["geom_b"])
        for name, members in zip(
            self._scene.places.names, self._scene.places.members, strict=False
        ):
            if members[pair[0]] or members[pair[1]]:
                return name
        geom = int(mujoco.mjtObj.mjOBJ_GEOM)
        names = [mujoco.mj_id2name(self._scene.model, geom, i) or f"geom {i}" for i in pair]
        return " on ".join(names)


class _Places:
    def __init__(self, names: tuple[str, ...], members: np.ndarray) -> None:
        self.names = names
        self.members = members


def _places(model: mujoco.MjModel, places: tuple[tuple[str, tuple[str, ...]], ...]) -> _Places:
    geom = int(mujoco.mjtObj.mjOBJ_GEOM)
    geoms = [mujoco.mj_id2name(model, geom, i) or "" for i in range(model.ngeom)]
    members = np.zeros((len(places), model.ngeom), bool)
    for row, (name, patterns) in enumerate(places):
        for pattern in patterns:
            found = [i for i, each in enumerate(geoms) if each and fnmatch.fnmatch(each, pattern)]
            if not found:
                hint = nearest(pattern, [each for each in geoms if each])
                raise StudyError(
                    f"[record] places {name} = {pattern!r}: the scene has no such geom{hint}"
                )
            members[row, found] = True
    return _Places(tuple(name for name, _ in places), members)


def _told(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"
