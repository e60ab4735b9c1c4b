# SPDX-License-Identifier: Apache-2.0
"""Runs a study: hands batches to an engine, and puts what comes back into the folder."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from volcontact.study.child import Batch
from volcontact.study.engines import Engine, make_engine
from volcontact.study.file.reading import parse_study
from volcontact.study.file.settings import Settings, StudyError
from volcontact.study.plans import Plan, Round, row_values
from volcontact.study.results import MARKER, STUDY, Folder, provenance_of, schema_of, session
from volcontact.study.trial import Runner

Progress = Callable[[int, int, dict[str, int]], None]
_BATCH_SECONDS = 1.0  # of work in a batch
_MOST_TRIALS = 2000  # in a batch
_AHEAD = 2  # batches under way for each worker
_FLUSH = 2.0  # rows reach the disk after so long at the latest, later on less often [s]
_SLOWEST_FLUSH = 30.0
_MOST_ROWS = 10_000  # that wait for the disk: a row is half a kilobyte until it is there


def run_study(
    settings: Settings,
    out: Path,
    *,
    engine: str = "processes",
    workers: int | None = None,
    address: str | None = None,
    progress: Progress | None = None,
) -> Folder:
    """Runs a study into a new folder.

    Raises:
        StudyError: the study cannot be run, or the folder cannot be written to.
    """
    columns = check_trials(settings)
    plan = Plan(settings)
    folder = Folder(out)
    folder.create(provenance_of(settings, plan.trials, out), settings.text)
    _go_on(settings, plan, folder, columns, engine, workers, address, progress)
    return folder


def resume_study(
    out: Path,
    *,
    engine: str = "processes",
    workers: int | None = None,
    address: str | None = None,
    progress: Progress | None = None,
) -> Folder:
    """Runs the trials of a folder that have no row yet.

    Raises:
        StudyError: no folder of a study, or the scene is another one by now.
    """
    folder = Folder(out)
    settings = settings_of(folder)
    columns = check_trials(settings)
    _go_on(settings, Plan(settings), folder, columns, engine, workers, address, progress)
    return folder


def settings_of(folder: Folder) -> Settings:
    """The settings that the trials of a folder ran with.

    Raises:
        StudyError: what they came from has changed.
    """
    said = folder.provenance()
    text = (folder.path / STUDY).read_text(encoding="utf-8")
    settings = _parse_where_it_lies(text, folder.path, said)
    sample = dataclasses.replace(
        settings.sample, trials=int(said["asked_trials"]), seed=int(said["seed"])
    )
    settings = dataclasses.replace(settings, sample=sample, name=str(said["name"]))
    now = provenance_of(settings, int(said["trials"]), folder.path)
    for key, what in (
        ("study_sha256", "the study file"),
        ("model_sha256", "the scene"),
        ("functions_sha256", "the file of functions"),
    ):
        if said[key] != now[key]:
            raise StudyError(
                f"{folder.path}: {what} has changed since the first trials; put it back, or run "
                "the study into another folder"
            )
    for library in ("volcontact", "mujoco"):
        then, here = said["versions"][library], now["versions"][library]
        if then != here:
            raise StudyError(
                f"{folder.path}: was run with {library} {then}, and this is {here}; take that "
                "version, or run the study into another folder"
            )
    return settings


def _parse_where_it_lies(text: str, results: Path, said: dict[str, Any]) -> Settings:
    """The study where it was, or, moved together with its results, where it is now."""
    moved = results.resolve() / said["folder_from_results"]
    try:
        return parse_study(text, Path(said["folder"]), STUDY)
    except StudyError as error:
        try:
            return parse_study(text, moved.resolve(), STUDY)
        except StudyError:
            raise error from None


def check_trials(settings: Settings, count: int = 64) -> dict[str, str]:
    """Checks all that can be checked without running a trial, and gives the columns of a row.

    The scene is compiled with the values of the first trials and with the extreme ones among them.

    Raises:
        StudyError: the study asks for what is not there, or draws what cannot be.
    """
    runner = Runner(settings)
    plan = Plan(settings)
    if settings.scene is None:
        return runner.columns
    first = next(iter(plan.rounds()))
    number = min(first.count, count)
    values = first.values(np.arange(number))
    picked = {0}
    compiled = {t.column for t in runner.targets if not t.live or t.where == "numeric"}
    for column in compiled:
        if values[column].dtype.kind == "f":
            picked |= {int(values[column].argmin()), int(values[column].argmax())}
    rows = row_values(values)
    try:
        for place in sorted(picked):
            check_values(settings, runner, place, rows[place])
    finally:
        runner.forget()
    return runner.columns


def check_values(settings: Settings, runner: Runner, trial: int, values: dict[str, Any]) -> None:
    """Compiles the scene of a trial, and reads every quantity of the study once.

    Raises:
        StudyError: it cannot be.
    """
    import mujoco

    shown = ", ".join(f"{name} = {value:.6g}" for name, value in values.items() if value != "")
    try:
        scene = runner.scene(values)
    except StudyError:
        raise
    except ValueError as error:
        message = " ".join(str(error).split())
        raise StudyError(f"trial {trial} ({shown}): {message}") from error
    scene.live.write(values)
    mujoco.mj_resetData(scene.model, scene.data)
    mujoco.mj_forward(scene.model, scene.data)
    wrong = scene.contact.live_error() if scene.contact is not None else ""
    if wrong:
        raise StudyError(f"trial {trial} ({shown}): {wrong}")
    for condition in (*settings.success, *settings.end.jammed):
        scene.quantities.number(condition.quantity)
    for _, name in (*settings.record.final, *settings.record.peak):
        scene.quantities.number(name)
    for names in (settings.end.force, settings.end.torque):
        for name in names:
            scene.quantities.number(name)


def _go_on(
    settings: Settings,
    plan: Plan,
    folder: Folder,
    columns: dict[str, str],
    engine: str,
    workers: int | None,
    address: str | None,
    progress: Progress | None,
) -> None:
    folder.lock()
    try:
        folder.tidy()
        done = folder.done(plan.trials)
        marker = folder.path / MARKER
        made = make_engine(engine, settings, workers=workers, address=address, marker=marker)
        try:
            said = folder.provenance()
            said["sessions"].append(session(engine, made.workers))
            folder.write_provenance(said)
            writer = _Writer(folder, schema_of(columns), done, plan.trials, progress)
            _run_rounds(plan, folder, made, writer, done)
            said["sessions"][-1]["end"] = time.time()
            folder.write_provenance(said)
        finally:
            made.close()
    finally:
        folder.unlock()


def _run_rounds(
    plan: Plan, folder: Folder, engine: Engine, writer: _Writer, done: np.ndarray
) -> None:
    rounds = plan.rounds()
    answer: np.ndarray | None = None
    while True:
        try:
            part = next(rounds) if answer is None else rounds.send(answer)  # type: ignore[attr-defined]
        except StopIteration:
            return
        try:
            _run_round(part, engine, writer, done)
        finally:
            writer.flush()
        if plan.response is not None:
            rows = folder.read(["trial", plan.response])
            rows = rows.slice(part.first, part.count)
            answer = rows[plan.response].cast(pa.float64()).to_numpy()


def _run_round(part: Round, engine: Engine, writer: _Writer, done: np.ndarray) -> None:
    batches = _batches(part, done, writer, engine.workers)
    tickets: list[Any] = []
    more = True
    while more or tickets:
        while more and len(tickets) < _AHEAD * engine.workers:
            batch = next(batches, None)
            if batch is None:
                more = False
            else:
                tickets.append(engine.submit(batch))
        if tickets:
            results, tickets = engine.wait(tickets, writer.until_flush())
            for result in results:
                writer.add(result.rows, result.seconds)
            writer.flush_in_time()


def _batches(part: Round, done: np.ndarray, writer: _Writer, workers: int) -> Iterator[Batch]:
    """Batches of about a second of work, of the trials that have no row.

    Towards the end they get smaller, so that no worker is left with a long one.
    """
    here = np.flatnonzero(~done[part.first : part.first + part.count]) + part.first
    place = 0
    while place < len(here):
        share = (len(here) - place) // (2 * workers)
        size = max(min(writer.batch_size, share), writer.batch_size // 20, 1)
        trials = here[place : place + size]
        place += size
        yield Batch(trials.tolist(), row_values(part.values(trials)))


class _Writer:
    """Gathers rows, writes them in parts, and says how far things are."""

    def __init__(
        self,
        folder: Folder,
        schema: pa.Schema,
        done: np.ndarray,
        total: int,
        progress: Progress | None,
    ) -> None:
        self._folder = folder
        self._schema = schema
        self._done = done
        self._total = total
        self._progress = progress
        self._rows: list[dict[str, Any]] = []
        self._outcomes = folder.counts()
        self._count = int(done.sum())
        self._begin = self._flushed = time.monotonic()
        self._seconds = self._trials = 0.0
        self.batch_size = 1

    def add(self, rows: list[dict[str, Any]], seconds: float) -> None:
        """Takes the rows of a batch."""
        self._rows += rows
        for row in rows:
            word = str(row["outcome"])
            self._outcomes[word] = self._outcomes.get(word, 0) + 1
        self._count += len(rows)
        # The first batch of a worker also starts Python; later ones count more.
        self._seconds = 0.5 * self._seconds + seconds
        self._trials = 0.5 * self._trials + len(rows)
        rate = self._trials / max(self._seconds, 1e-9)
        wanted = int(min(max(rate * _BATCH_SECONDS, 1.0), _MOST_TRIALS))
        self.batch_size = min(wanted, 4 * self.batch_size)
        if self._progress is not None:
            self._progress(self._count, self._total, self._outcomes)

    def until_flush(self) -> float:
        """Time until rows must reach the disk [s]; without any, for a good while."""
        now = time.monotonic()
        if not self._rows:
            return _SLOWEST_FLUSH
        if len(self._rows) >= _MOST_ROWS:
            return 0.0
        period = min(max(_FLUSH, 0.01 * (now - self._begin)), _SLOWEST_FLUSH)
        return max(self._flushed + period - now, 0.0)

    def flush_in_time(self) -> None:
        """Writes what was gathered when it is time to."""
        if self._rows and self.until_flush() == 0.0:
            self.flush()

    def flush(self) -> None:
        """Writes what was gathered.

        Raises:
            StudyError: the disk does not take it.
        """
        rows, self._rows = self._rows, []
        self._flushed = time.monotonic()
        try:
            self._folder.add(rows, self._schema)
        except OSError as error:
            raise StudyError(
                f"{self._folder.trials}: cannot be written to ({error.strerror or error}); "
                f"{self._count - len(rows)} trials are safe. Make room, then `volcontact study "
                f"resume {self._folder.path}`"
            ) from error
        self._done[[row["trial"] for row in rows]] = True
