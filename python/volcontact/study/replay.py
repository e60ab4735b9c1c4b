# SPDX-License-Identifier: Apache-2.0
"""One trial again, to the same bits, with everything recorded."""

from __future__ import annotations

import contextlib
import copy
import math
import re
import time as clock
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

import volcontact
from volcontact.running.probes import probe_of
from volcontact.running.recorder import Recorder
from volcontact.running.recording import ContactKind, Recording
from volcontact.running.simulation import RunRecorder
from volcontact.study.driver import settings_of
from volcontact.study.file.settings import Settings, StudyError
from volcontact.study.results import Folder
from volcontact.study.scene import Scene
from volcontact.study.trial import Runner
from volcontact.view.history import Snapshot
from volcontact.view.playback import Playback

if TYPE_CHECKING:
    from volcontact.report.comparison import Comparison

_PICTURE = 1.0 / 120.0  # between two states that are shown [s]


@dataclass(frozen=True)
class Replay:
    """A trial that ran again.

    Attributes:
        row: as it ran now.
        recorded: as it is in the folder.
        differing: columns whose bits differ; none.
        states: position coordinates at every look, shape (n, nq).
        times: of these [s], shape (n,).
        model: of the trial, not attached any more; None of a function.
    """

    row: dict[str, Any]
    recorded: dict[str, Any]
    differing: tuple[str, ...]
    states: np.ndarray
    times: np.ndarray
    model: mujoco.MjModel | None


def replay_trial(out: Path, trial: int, trajectory: Path | None = None) -> Replay:
    """Runs a trial of a folder again.

    Args:
        out: folder of the study.
        trial: its number.
        trajectory: folder for the states, energies and contact sites of every look, as
            `volcontact.Recorder` writes them.

    Raises:
        StudyError: there is no such trial, or the scene has changed since.
    """
    folder = Folder(out)
    settings = settings_of(folder)
    recorded = row_of(folder, trial)
    runner = Runner(settings)
    values = _values_of(settings, recorded)
    states: list[np.ndarray] = []
    times: list[float] = []
    recorder: list[Recorder] = []

    def watch(model: mujoco.MjModel, data: mujoco.MjData, contact: Any) -> None:
        del model
        states.append(data.qpos.copy())
        times.append(float(data.time))
        if trajectory is not None and contact is not None:
            if not recorder:
                recorder.append(Recorder(contact))
            # Recording evaluates: beside the trial, whose bits stay what they are.
            recorder[0].record(copy.copy(data))

    row = runner.run(trial, values, watch)
    if trajectory is not None and recorder:
        recorder[0].write(trajectory)
    model = None
    if settings.scene is not None:
        model = runner.scene(values).model
        runner.scene(values).live.write(values)
    runner.forget()
    differing = tuple(n for n, value in row.items() if not _same(value, recorded[n]))
    return Replay(row, recorded, differing, np.array(states), np.array(times), model)


def compare_trial(
    out: Path, trial: int, *, frame_interval: float = 0.2
) -> tuple[Comparison, mujoco.MjModel]:
    """Runs a trial of a folder again, under volumetric and under native contact, recording all.

    Args:
        out: folder of the study.
        trial: its number.
        frame_interval: time between two frames to draw [s].

    Returns:
        Both runs, and the model of the trial, to draw them.

    Raises:
        StudyError: there is no such trial, it has no scene, or the scene has changed since.
    """
    from volcontact.report.comparison import Comparison, Limits

    folder = Folder(out)
    settings = settings_of(folder)
    if settings.scene is None:
        raise StudyError(f"{out}: the study of a function has no scene to show")
    values = _values_of(settings, row_of(folder, trial))
    limits = {}
    for names, limit in (
        (settings.end.force, settings.end.force_limit),
        (settings.end.torque, settings.end.torque_limit),
    ):
        if names and math.isfinite(limit) and all(name.startswith("sensor/") for name in names):
            limits[re.sub("_[xyz]$", "", names[0].removeprefix("sensor/"))] = limit
    runs = {}
    for kind in ("volumetric", "native"):
        with _playing(replace(settings, contact=kind), values) as play:
            runs[kind] = play.recording(trial, frame_interval)
            model = play.scene.model
    comparison = Comparison(
        scene=f"{settings.name}, trial {trial}",
        volumetric=runs["volumetric"],
        native=runs["native"],
        design=None,
        mujoco_version=mujoco.mj_versionString(),
        volcontact_version=volcontact.__version__,
        limits=Limits(sensors=limits),
    )
    return comparison, model


@contextlib.contextmanager
def play_trial(out: Path, trial: int) -> Iterator[Playback]:
    """Runs a trial of a folder again, to be looked at within the `with` block.

    Raises:
        StudyError: there is no such trial, it has no scene, or the scene has changed since.
    """
    folder = Folder(out)
    settings = settings_of(folder)
    if settings.scene is None:
        raise StudyError(f"{out}: the study of a function has no scene to show")
    snapshots: list[Snapshot] = []

    def watch(model: mujoco.MjModel, data: mujoco.MjData, contact: Any) -> None:
        del model, contact
        if not snapshots or data.time >= snapshots[-1].time + _PICTURE:
            snapshots.append(Snapshot(data))

    with _playing(settings, _values_of(settings, row_of(folder, trial))) as play:
        play.runner.run(trial, play.values, watch)
        scene = play.scene
        with Playback(scene.model, scene.contact, snapshots) as stage:
            yield stage


@dataclass(frozen=True)
class _Play:
    runner: Runner
    values: dict[str, Any]

    @property
    def scene(self) -> Scene:
        return self.runner.scene(self.values)

    def recording(self, trial: int, frame_interval: float) -> Recording:
        settings, scene = self.runner.settings, self.scene
        looked_at = max(settings.end.watch, float(scene.model.opt.timestep))
        looks = math.ceil(settings.end.duration / looked_at) + 1
        probe = probe_of(scene.model, scene.contact)
        recorder = RunRecorder(scene.model, probe, looks, frame_interval)
        begin = clock.perf_counter()

        def watch(model: mujoco.MjModel, data: mujoco.MjData, contact: Any) -> None:
            nonlocal begin
            del model, contact
            took = 1e6 * (clock.perf_counter() - begin)
            recorder.look(copy.copy(data), took)
            begin = clock.perf_counter()

        row = self.runner.run(trial, self.values, watch)
        if row["outcome"] == "error":
            raise StudyError(f"trial {trial} ({settings.contact} contact): {row['reason']}")
        kind: ContactKind = "native" if settings.contact == "native" else "volumetric"
        return recorder.recording(kind, probe.description)


@contextlib.contextmanager
def _playing(settings: Settings, values: dict[str, Any]) -> Iterator[_Play]:
    """A runner that looks after every step, unless the user's word on success says how often."""
    if not settings.success_function:
        settings = replace(settings, end=replace(settings.end, watch=0.0))
    play = _Play(Runner(settings), values)
    try:
        yield play
    finally:
        play.runner.forget()


def _values_of(settings: Settings, row: dict[str, Any]) -> dict[str, Any]:
    return {name: row[name] for name in (*settings.columns, "level", "weight") if name in row}


def record_trajectories(out: Path) -> list[int]:
    """Records everything of the trials that the study asks for, by running these again.

    They go to `DIR/trajectories/trial-NUMBER`; those that are there already stay.

    Returns:
        The trials that were asked for.

    Raises:
        StudyError: the scene has changed since.
    """
    folder = Folder(out)
    settings = settings_of(folder)
    wanted = settings.record.trajectories
    if settings.scene is None or not (wanted["worst"] or wanted["every"] or wanted["outcomes"]):
        return []
    by = settings.sample.options.get("response", "peak_force")
    rows = folder.read(["trial", "outcome", "success", by])
    trials, outcomes = rows["trial"].to_numpy(), np.array(rows["outcome"].to_pylist())
    numbers = np.nan_to_num(rows[by].to_numpy(), nan=-np.inf)
    success = rows["success"].to_numpy(zero_copy_only=False)
    worst = np.lexsort((-numbers, success))[: wanted["worst"]]
    picked = [int(trials[place]) for place in worst]
    if wanted["every"]:
        picked += trials[trials % wanted["every"] == 0].tolist()
    picked += trials[np.isin(outcomes, list(wanted["outcomes"]))].tolist()
    bad = set(trials[np.isin(outcomes, ["crashed", "hung"])].tolist())  # and would be again
    chosen = [trial for trial in dict.fromkeys(picked) if trial not in bad][: wanted["most"]]
    for trial in chosen:
        place = out / "trajectories" / f"trial-{trial:08d}"
        if not place.exists():
            replay_trial(out, trial, place)
    return chosen


def row_of(folder: Folder, trial: int) -> dict[str, Any]:
    """The row of a trial.

    Raises:
        StudyError: there is none.
    """
    import pyarrow.compute as pc
    import pyarrow.parquet as pq

    for part in folder.parts():
        table = pq.read_table(part)
        found = table.filter(pc.equal(table["trial"], trial))
        if len(found):
            row: dict[str, Any] = found.to_pylist()[0]
            return row
    raise StudyError(f"{folder.path}: has no trial {trial}")


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, float) and isinstance(b, float):
        return np.float64(a).tobytes() == np.float64(b).tobytes()
    return bool(a == b)
