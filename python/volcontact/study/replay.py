# SPDX-License-Identifier: Apache-2.0
"""One trial again, to the same bits, with everything recorded."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from volcontact.recorder import Recorder
from volcontact.study.driver import settings_of
from volcontact.study.results import Folder
from volcontact.study.settings import StudyError
from volcontact.study.trial import Runner


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
    values = {
        name: recorded[name] for name in (*settings.columns, "level", "weight") if name in recorded
    }
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
