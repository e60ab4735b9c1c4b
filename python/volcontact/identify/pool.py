# SPDX-License-Identifier: Apache-2.0
"""Runs trials in several processes; results depend on the tasks alone, never on who runs them."""

from __future__ import annotations

import concurrent.futures
import contextlib
import os
import queue
import subprocess
import sys
from types import TracebackType
from typing import Any

import numpy as np

from volcontact.identify.bench import Bench, Values
from volcontact.identify.measurements import Trial
from volcontact.identify.settings import Settings, StudyError
from volcontact.identify.tasks import Task, run_task
from volcontact.study.child import _read, _write


class Pool:
    """Processes that hold the scene and the trials.

    Args:
        settings: of the study.
        trials: cut to their windows.
        workers: processes; 1 runs everything in this one, None takes the cores.

    Attributes:
        deviations: of the numbers of a trial, as of `Bench`.
        start: the first guess.

    Raises:
        StudyError: scene, study and measurements do not fit.
    """

    def __init__(self, settings: Settings, trials: list[Trial], workers: int | None = None) -> None:
        count = len(os.sched_getaffinity(0)) if workers is None else workers
        if count < 1:
            raise StudyError(f"workers = {count}: must be at least 1")
        self.trials = trials
        self.bench = Bench(settings, trials)
        self.deviations = self.bench.deviations
        self.start: Values = self.bench.start_values()
        self._threads: concurrent.futures.ThreadPoolExecutor | None = None
        self._idle: queue.Queue[_Process] = queue.Queue()
        self._all: list[_Process] = []
        self._count = count
        if count > 1:
            self._threads = concurrent.futures.ThreadPoolExecutor(count)
            self._all = [_Process() for _ in range(count)]
            for process in self._all:
                process.send((settings, trials))
            for process in self._all:
                process.receive()
                self._idle.put(process)

    def __enter__(self) -> Pool:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Ends the processes."""
        for process in self._all:
            process.kill()
        if self._threads is not None:
            self._threads.shutdown(wait=True, cancel_futures=True)
        self.bench.close()

    def run(self, kind: str, points: list[tuple[Values, np.ndarray | None]]) -> list[list[Any]]:
        """Runs all trials at every point.

        Args:
            kind: of `tasks.KINDS`.
            points: values of the parameters, and numbers of each trial.

        Returns:
            For each point the results of the trials.
        """
        pieces = max(1, -(-self._count // max(len(points), 1)))
        every = np.array_split(np.arange(len(self.trials)), min(pieces, len(self.trials)))
        tasks = [
            Task(kind, values, part.tolist(), moved) for values, moved in points for part in every
        ]
        if self._threads is None:
            results = [run_task(self.bench, task) for task in tasks]
        else:
            results = list(self._threads.map(self._serve, tasks))
        found = []
        for place in range(len(points)):
            parts = results[place * len(every) : (place + 1) * len(every)]
            found.append([each for part in parts for each in part])
        return found

    def _serve(self, task: Task) -> list[Any]:
        process = self._idle.get()
        try:
            process.send(task)
            result: list[Any] = process.receive()
            return result
        finally:
            self._idle.put(process)


class _Process:
    """One worker, and the pipes to it."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "volcontact.identify.worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
            start_new_session=True,  # Ctrl-C is for the driver
        )

    def send(self, message: object) -> None:
        assert self._process.stdin is not None
        try:
            _write(self._process.stdin, message)
        except OSError as error:
            raise RuntimeError(self._end()) from error

    def receive(self) -> Any:
        assert self._process.stdout is not None
        try:
            word, content = _read(self._process.stdout)
        except EOFError as error:
            raise RuntimeError(self._end()) from error
        if word == "wrong":
            raise StudyError(content)
        if word == "broken":
            raise RuntimeError(f"a worker failed: {content}")
        return content

    def _end(self) -> str:
        return f"a worker ended with status {self._process.wait()}"

    def kill(self) -> None:
        self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                with contextlib.suppress(OSError):
                    stream.close()
