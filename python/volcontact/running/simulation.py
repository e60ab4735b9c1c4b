# SPDX-License-Identifier: Apache-2.0
"""Runs a scene under volumetric or native contact and records what happened."""

from __future__ import annotations

import copy
import dataclasses
import os
import re
import time as clock
from collections.abc import Callable, Sequence
from typing import Any

import mujoco
import numpy as np

from volcontact import scene as volumetric_scene
from volcontact._mujoco_views import dense
from volcontact.compiling import require_scene
from volcontact.given_keys import GivenKeys, Values
from volcontact.hints import sunk
from volcontact.messages.names import name_of
from volcontact.running.driving import Drive, Driver, to_keyframe
from volcontact.running.outside_work import OutsideWork
from volcontact.running.probes import Probe, probe
from volcontact.running.recording import (
    CHANNELS,
    SITE,
    SITE_IN_RUN,
    ContactKind,
    Frame,
    Origin,
    Recording,
)
from volcontact.running.signals import SignalReader
from volcontact.wrenches import wrenches_on_frames

Progress = Callable[[int, int], None]

# A state with one of these is worthless: MuJoCo resets the data and starts again at time 0.
_WARNING_NAMES = {
    int(getattr(mujoco.mjtWarning, name)): name[len("mjWARN_") :]
    for name in dir(mujoco.mjtWarning)
    if name.startswith("mjWARN_")
}
_FATAL_WARNINGS = [
    int(getattr(mujoco.mjtWarning, f"mjWARN_{name}")) for name in ("BADQPOS", "BADQVEL", "BADQACC")
]
_FRAME_OF_BODY = int(mujoco.mjtObj.mjOBJ_XBODY)
_PROGRESS_CALLS = 200


class SimulationError(ValueError):
    """A request that makes no sense: the message is one line and says what to change."""


def simulate(
    scene: str | os.PathLike[str] | mujoco.MjModel,
    *,
    contact: ContactKind = "volumetric",
    duration: float,
    timestep: float | None = None,
    frame_interval: float | None = 0.2,
    material: Values | None = None,
    options: Values | None = None,
    drive: Drive | None = None,
    follow: Sequence[str] = (),
    progress: Progress | None = None,
) -> Recording:
    """Steps a scene for a while, from a keyframe if it has one, and records it.

    Args:
        scene: path of an MJCF file, MJCF text, or a model (which is not changed).
        contact: "volumetric" (volcontact) or "native" (MuJoCo's own).
        duration: [s].
        timestep: [s]; None takes the scene's.
        frame_interval: time between two frames to draw [s]; None records no frames.
        material: of volumetric contact, as `volcontact.attach` takes it.
        options: likewise.
        drive: where it starts, and its controls over time; None starts it at the keyframe called
            `start`, where there is one, and leaves all controls as they are there.
        follow: names of bodies to follow besides, as one that another carries.
        progress: called now and then with (steps done, steps in all).

    Returns:
        The recording; check `warnings`, `stopped` and `notes`.

    Raises:
        SimulationError: duration, timestep, interval or kind of contact out of range.
        FileNotFoundError: there is no such file.
        ValueError: the scene cannot be read or understood, or it has no such keyframe or actuator.
    """
    keys = GivenKeys(material, options)
    model = _model_to_run(scene, contact, timestep, keys)
    step = float(model.opt.timestep)
    if not (np.isfinite(duration) and duration >= step):
        raise SimulationError(f"duration {duration:g} s must be at least one timestep ({step:g} s)")
    if frame_interval is not None and not frame_interval > 0.0:
        raise SimulationError(f"frame interval {frame_interval:g} s must be positive")
    steps = round(duration / step)
    data = mujoco.MjData(model)
    driver = Driver(model, drive or Drive())
    driver.start(data)
    with probe(contact, model, keys) as reader:
        recorder = RunRecorder(model, reader, steps, frame_interval, follow)
        recorder.notes = driver.notes()
        every = max(1, steps // _PROGRESS_CALLS)
        for i in range(steps):
            driver.write(data)
            recorder.step(data)
            if progress is not None and (i + 1) % every == 0:
                progress(i + 1, steps)
            if recorder.stopped is not None:
                break
        driver.write(data)
        recorder.finish(data)
        if progress is not None:
            progress(steps, steps)
        made = recorder.recording(contact, reader.description)
        return dataclasses.replace(made, origin=_origin(scene, keys, drive))


def to_start(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Puts data of a model at its keyframe `start`; without one they stay as they are."""
    to_keyframe(model, data, None)


def native_model(scene: str | os.PathLike[str]) -> mujoco.MjModel:
    """Loads a scene as plain MuJoCo does, from a path or MJCF text.

    Raises:
        FileNotFoundError: there is no such file.
        ValueError: MuJoCo cannot compile it.
    """
    text = os.fspath(scene)
    if text.lstrip().startswith("<"):
        return mujoco.MjModel.from_xml_string(text)
    require_scene(text)
    if text.endswith(".mjb"):
        return mujoco.MjModel.from_binary_path(text)
    return mujoco.MjModel.from_xml_path(text)


def warnings_of(data: mujoco.MjData) -> dict[str, int]:
    """MuJoCo's warning counters that are not 0, by name (without the mjWARN_ prefix)."""
    counts = data.warning.number.tolist()
    return {_WARNING_NAMES.get(i, f"warning {i}"): n for i, n in enumerate(counts) if n}


def _origin(
    scene: str | os.PathLike[str] | mujoco.MjModel, keys: GivenKeys, drive: Drive | None
) -> Origin:
    path = None
    if not isinstance(scene, mujoco.MjModel) and not os.fspath(scene).lstrip().startswith("<"):
        path = os.path.abspath(scene)
    keyframe = None if drive is None else drive.keyframe
    return Origin(path, dict(keys.material or {}), dict(keys.options or {}), keyframe)


def _model_to_run(
    scene: str | os.PathLike[str] | mujoco.MjModel,
    contact: ContactKind,
    timestep: float | None,
    keys: GivenKeys,
) -> mujoco.MjModel:
    if contact not in ("volumetric", "native"):
        raise SimulationError(f"contact {contact!r} must be 'volumetric' or 'native'")
    if isinstance(scene, mujoco.MjModel):
        model = copy.copy(scene)
        if contact == "volumetric":  # nobody has data of the copy yet
            keys.make_room(model)
    elif contact == "volumetric":
        model = volumetric_scene.load(scene, material=keys.material, options=keys.options)
    else:
        model = native_model(scene)
    if timestep is not None:
        if not (np.isfinite(timestep) and timestep > 0.0):
            raise SimulationError(f"timestep {timestep:g} s must be positive")
        model.opt.timestep = timestep
    # MuJoCo then evaluates both energies inside the step, at the state the step began with.
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    return model


class RunRecorder:
    """Arrays of one run, filled row by row.

    Args:
        model: that is stepped.
        probe: of its contact.
        steps: there will be at most.
        frame_interval: time between two frames to draw [s]; None records no frames.
        follow: names of bodies to follow besides.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        probe: Probe,
        steps: int,
        frame_interval: float | None,
        follow: Sequence[str] = (),
    ) -> None:
        self._model = model
        self._probe = probe
        self._ids = _bodies_followed(model, follow)
        rows, bodies = steps + 1, len(self._ids)
        self._rows = 0
        self._time = np.zeros(rows)
        self._qpos = np.zeros((rows, model.nq))
        self._qvel = np.zeros((rows, model.nv))
        self._position = np.zeros((rows, bodies, 3))
        self._quaternion = np.zeros((rows, bodies, 4))
        self._twist = np.zeros((rows, bodies, 6))  # angular, linear
        self._energies = np.zeros((rows, 7))  # kinetic, potential, then of contact
        self._dissipated = np.zeros((rows, len(CHANNELS)))
        self._sensors = np.zeros((rows, model.nsensordata))
        self._solid = _bodies_with_geoms(model)
        self._origins = np.zeros((rows, len(self._solid), 3))
        self._signals = SignalReader(model, rows)
        self._outside = OutsideWork(model, rows)
        self._microseconds = np.zeros(steps)
        self._frames: list[Frame] = []
        # By row: one may be evaluated again, or be the one at which the run stops.
        self._sites: dict[int, np.ndarray] = {}
        self._contacts: dict[int, np.ndarray] = {}
        self._frame_rows = _frame_rows(steps, float(model.opt.timestep), frame_interval)
        self._warnings: dict[str, int] = {}
        self._dropped = 0
        # The last stage of Runge-Kutta is not the state the step began with, so ask for that one.
        self._evaluate_first = model.opt.integrator == int(mujoco.mjtIntegrator.mjINT_RK4)
        self.stopped: str | None = None
        self.notes: tuple[str, ...] = ()

    def step(self, data: mujoco.MjData) -> None:
        """Takes one step, times it, and records the state it began with."""
        row = self._rows
        self._keep_state(row, data)
        if self._evaluate_first:
            mujoco.mj_forward(self._model, data)
            self._keep_evaluation(row, data)
        begin = clock.perf_counter_ns()
        mujoco.mj_step(self._model, data)
        self._microseconds[row] = 1e-3 * (clock.perf_counter_ns() - begin)
        self._outside.keep_step(row, data, self._qvel[row])
        if data.warning.number[_FATAL_WARNINGS].any():
            self._stop(data, row)
            return
        if not self._evaluate_first:
            self._keep_evaluation(row, data)
        self._rows += 1

    def look(self, data: mujoco.MjData, microseconds: float) -> None:
        """Records a state that somebody else stepped to.

        Args:
            data: evaluated here; a copy of what is stepped, which then goes on as if nobody looked.
            microseconds: that the step to it took.
        """
        row = self._rows
        if row > 0:
            self._microseconds[row - 1] = microseconds
        self._keep_state(row, data)
        mujoco.mj_forward(self._model, data)
        self._outside.keep_power(row, data, always=not self._evaluate_first)
        self._keep_evaluation(row, data)
        self._rows += 1
        self._warnings = warnings_of(data)
        self._dropped = self._probe.dropped(data)

    def finish(self, data: mujoco.MjData) -> None:
        """Records the state after the last step."""
        self._warnings = warnings_of(data)
        self._dropped = self._probe.dropped(data)
        if self.stopped is None:
            self._keep_state(self._rows, data)
            mujoco.mj_forward(self._model, data)
            self._keep_evaluation(self._rows, data)
            self._rows += 1
            self.notes += tuple(sunk(self._model, data, self._probe.sites(data)))

    def recording(self, contact: ContactKind, description: dict[str, Any]) -> Recording:
        """Packs what was recorded."""
        n = self._rows
        kinetic, potential, elastic, work, numerical, driven, made = self._energies[:n].T
        sites = _joined(self._sites, n)
        forces = np.linalg.norm(sites["force"], axis=1)
        wrenches = self._wrenches(n)
        gravity = np.linalg.norm(self._model.opt.gravity)
        return Recording(
            contact=contact,
            timestep=float(self._model.opt.timestep),
            bodies=tuple(name_of(self._model, "body", i) for i in self._ids),
            time=self._time[:n],
            qpos=self._qpos[:n],
            qvel=self._qvel[:n],
            position=self._position[:n],
            quaternion=self._quaternion[:n],
            speed=np.linalg.norm(self._twist[:n, :, 3:], axis=2),
            spin=np.linalg.norm(self._twist[:n, :, :3], axis=2),
            kinetic=kinetic,
            potential=potential,
            elastic=elastic,
            dissipated=self._dissipated[:n],
            work=work,
            numerical=numerical,
            driven=driven,
            made=made,
            outside_work=self._outside.work(n),
            contact_force=np.bincount(sites["row"], forces, minlength=n),
            largest_site_force=_largest(sites["row"], forces, n),
            site_count=np.bincount(sites["row"], minlength=n),
            penetration=_largest(sites["row"], sites["depth"], n),
            step_microseconds=self._microseconds[: max(n - 1, 0)],
            warnings=self._warnings,
            stopped=self.stopped,
            dropped=self._dropped,
            frames=tuple(self._frames),
            sites=sites,
            sensors={
                name: np.linalg.norm(self._sensors[:n, places], axis=1)
                for name, places in _sensor_places(self._model).items()
            },
            signals=self._signals.signals(self._qpos[:n], self._qvel[:n]),
            wrench_on={
                name_of(self._model, "body", body): wrenches[:, i]
                for i, body in enumerate(self._solid)
            },
            notes=self.notes,
            geoms=tuple(name_of(self._model, "geom", i) for i in range(self._model.ngeom)),
            description=description,
            weight=float(gravity * self._model.body_mass[self._model.body_weldid != 0].sum()),
        )

    def _wrenches(self, rows: int) -> np.ndarray:
        """On each of the solid bodies, about the origin of its frame, shape (rows, bodies, 6)."""
        bodies = len(self._solid)
        of_bodies = np.full(self._model.nbody, -1)
        of_bodies[self._solid] = np.arange(bodies)
        of_geoms = np.append(of_bodies[self._model.geom_bodyid], -1)  # a flex is geom -1
        contacts = _joined(self._contacts, rows)

        def frames(side: str) -> np.ndarray:
            body = of_geoms[contacts[side]]
            return np.where(body >= 0, contacts["row"] * bodies + body, -1)

        origins = self._origins[:rows].reshape(rows * bodies, 3)
        found = wrenches_on_frames(contacts, frames("geom_a"), frames("geom_b"), origins)
        return found.reshape(rows, bodies, 6)

    def _stop(self, data: mujoco.MjData, row: int) -> None:
        if row == 0:  # MuJoCo has gone back to the start, which is the state of this row
            self._keep_evaluation(row, data)
            self._rows = 1
        names = ", ".join(warnings_of(data))
        self.stopped = f"the state became unusable at t = {self._time[row]:.4g} s ({names})"

    def _keep_state(self, row: int, data: mujoco.MjData) -> None:
        self._time[row] = data.time
        self._qpos[row] = data.qpos
        self._qvel[row] = data.qvel

    def _keep_evaluation(self, row: int, data: mujoco.MjData) -> None:
        self._position[row] = data.xpos[self._ids]
        self._quaternion[row] = data.xquat[self._ids]
        for body, twist in zip(self._ids, self._twist[row], strict=True):
            mujoco.mj_objectVelocity(self._model, data, _FRAME_OF_BODY, body, twist, 0)
        self._outside.keep_power(row, data)
        self._probe.update_touch(data)
        self._sensors[row] = data.sensordata
        self._signals.keep(row, data)
        energy = self._probe.energy(data)
        potential, kinetic = dense(data.energy)
        of_contact = energy.elastic, energy.work, energy.numerical, energy.driven, energy.made
        self._energies[row] = kinetic, potential, *of_contact
        self._dissipated[row] = energy.by_channel
        sites = self._probe.sites(data)
        self._sites[row] = _in_run(sites, row)
        contacts = self._probe.contacts(data, sites)
        is_known = contacts is sites
        self._contacts[row] = self._sites[row] if is_known else _in_run(contacts, row)
        self._origins[row] = data.xpos[self._solid]
        if row in self._frame_rows:
            shapes = self._probe.surfaces(data)
            self._frames.append(Frame(row, float(self._time[row]), sites, shapes))


def _bodies_followed(model: mujoco.MjModel, names: Sequence[str]) -> list[int]:
    free = [
        int(model.jnt_bodyid[j])
        for j in range(model.njnt)
        if model.jnt_type[j] == int(mujoco.mjtJoint.mjJNT_FREE)
    ]
    found = free or [b for b in range(1, model.nbody) if model.body_dofnum[b] > 0]
    asked = [mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_BODY), name) for name in names]
    return [*(body for body in asked if body > 0 and body not in found), *found]


def _bodies_with_geoms(model: mujoco.MjModel) -> list[int]:
    """Those that can move and have geoms of their own."""
    return [b for b in range(1, model.nbody) if model.body_weldid[b] and model.body_geomnum[b]]


def _sensor_places(model: mujoco.MjModel) -> dict[str, list[int]]:
    """Places in sensordata by name; NAME_x, NAME_y and NAME_z are the parts of NAME."""
    places: dict[str, list[int]] = {}
    for sensor in range(model.nsensor):
        name = mujoco.mj_id2name(model, int(mujoco.mjtObj.mjOBJ_SENSOR), sensor)
        name = re.sub("_[xyz]$", "", name or f"sensor {sensor}")
        start = int(model.sensor_adr[sensor])
        places.setdefault(name, []).extend(range(start, start + int(model.sensor_dim[sensor])))
    return places


def _in_run(sites: np.ndarray, row: int) -> np.ndarray:
    rows = np.zeros(len(sites), SITE_IN_RUN)
    rows["row"] = row
    for name in SITE.names or ():
        if name in (sites.dtype.names or ()):
            rows[name] = sites[name]
    return rows


def _joined(parts: dict[int, np.ndarray], rows: int) -> np.ndarray:
    """Arrays of `SITE_IN_RUN` in one; as records, NumPy would match their names part by part."""
    plain = f"V{SITE_IN_RUN.itemsize}"
    kept = (part.view(plain) for row, part in parts.items() if row < rows)
    return np.concatenate([np.zeros(0, plain), *kept]).view(SITE_IN_RUN)


def _largest(rows: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """The largest of the values of each row; 0 where there is none."""
    largest = np.zeros(count)
    np.maximum.at(largest, rows, values)
    return largest


def _frame_rows(steps: int, timestep: float, interval: float | None) -> frozenset[int]:
    if interval is None:
        return frozenset()
    count = int(np.floor(steps * timestep / interval + 1e-9)) + 1
    return frozenset(min(steps, round(k * interval / timestep)) for k in range(count))
