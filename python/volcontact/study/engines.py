# SPDX-License-Identifier: Apache-2.0
"""Where batches run: in this process, in processes here, on a Ray or on a Dask cluster."""

from __future__ import annotations

import concurrent.futures
import contextlib
import functools
import importlib
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Protocol

from volcontact.study.child import Batch, BatchResult, end_children, run_batch
from volcontact.study.file.settings import Settings, StudyError

ENGINES = ("serial", "processes", "ray", "dask")
_LOST_WORKERS = 20  # of a Dask batch, until something must be wrong
# How often Dask looks at its own processes; by default that takes an eighth of a core.
_SELDOM = {
    "distributed.worker.profile.interval": "200ms",
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.system-monitor.interval": "5s",
}


class Engine(Protocol):
    """Takes batches, and gives their results in any order."""

    workers: int

    def submit(self, batch: Batch) -> object:
        """Begins a batch; the ticket is for `wait`."""
        ...

    def wait(self, tickets: list[Any], seconds: float) -> tuple[list[BatchResult], list[Any]]:
        """Results that are there and the tickets that are left; waits so long for the first."""
        ...

    def close(self) -> None:
        """Gives back what the engine took."""
        ...


def make_engine(
    name: str,
    settings: Settings,
    *,
    workers: int | None = None,
    address: str | None = None,
    marker: Path | None = None,
) -> Engine:
    """An engine by name.

    Args:
        name: one of `ENGINES`.
        settings: of the study.
        workers: how many trials run at once; None takes the cores, or the whole cluster.
        address: of a running cluster; None makes one here.
        marker: file in which the serial engine says which trial it runs: should that one end the
            interpreter, it gets a process of its own the next time.

    Raises:
        StudyError: unknown, or an address where none is taken.
    """
    if name not in ENGINES:
        raise StudyError(f"engine {name!r}: must be one of {', '.join(ENGINES)}")
    if address is not None and name not in ("ray", "dask"):
        raise StudyError(f"engine {name!r} takes no address: only ray and dask do")
    if workers is not None and workers < 1:
        raise StudyError(f"workers = {workers}: must be at least 1")
    if name == "serial":
        return _Serial(settings, marker)
    if name == "processes":
        return _Processes(settings, workers or len(os.sched_getaffinity(0)))
    if name == "ray":
        return _Ray(settings, workers, address)
    return _Dask(settings, workers, address)


class _Serial:
    """One trial after the other, in this process."""

    def __init__(self, settings: Settings, marker: Path | None) -> None:
        from volcontact.study.trial import Runner

        self.workers = 1
        self._settings = settings
        self._marker = marker
        self._suspect = -1
        self._mark = -1
        if marker is not None:
            if marker.exists() and marker.read_text().strip():
                self._suspect = int(marker.read_text())
            self._mark = os.open(marker, os.O_WRONLY | os.O_CREAT, 0o644)
        self._runner = Runner(settings)

    def submit(self, batch: Batch) -> Batch:
        return batch

    def wait(self, tickets: list[Batch], seconds: float) -> tuple[list[BatchResult], list[Batch]]:
        begin = time.monotonic()
        batch, rest = tickets[0], tickets[1:]
        with _alarm() as arm:
            rows = [self._run(t, v, arm) for t, v in zip(batch.trials, batch.values, strict=True)]
        return [BatchResult(rows, time.monotonic() - begin)], rest

    def close(self) -> None:
        self._runner.forget()
        if self._marker is not None:
            os.close(self._mark)
            self._marker.unlink(missing_ok=True)

    def _run(
        self, trial: int, values: dict[str, Any], arm: Callable[[float], object]
    ) -> dict[str, Any]:
        limit = self._settings.time_limit
        if trial == self._suspect:
            return run_batch(self._settings, Batch([trial], [values])).rows[0]
        if self._mark >= 0:
            os.pwrite(self._mark, f"{trial:<20}".encode(), 0)
        try:
            arm(limit)
            try:
                return self._runner.run(trial, values)
            finally:
                arm(0.0)
        except TimeoutError:
            self._runner.forget()
            reason = f"no result after the time limit of {limit:g} s"
            return self._runner.failed(trial, values, "hung", reason)


@contextlib.contextmanager
def _alarm() -> Iterator[Callable[[float], object]]:
    """Gives what interrupts a trial that takes longer than so many seconds, where Python can be.

    With 0 seconds nothing rings any more.
    """
    if threading.current_thread() is not threading.main_thread():
        yield lambda seconds: None
        return

    def ring(*_: object) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGALRM, ring)
    try:
        yield functools.partial(signal.setitimer, signal.ITIMER_REAL)
    finally:
        signal.signal(signal.SIGALRM, before)


class _Processes:
    """Processes of this machine, each watched by a thread."""

    def __init__(self, settings: Settings, workers: int) -> None:
        self.workers = workers
        self._settings = settings
        self._threads = concurrent.futures.ThreadPoolExecutor(workers)

    def submit(self, batch: Batch) -> concurrent.futures.Future[BatchResult]:
        return self._threads.submit(run_batch, self._settings, batch)

    def wait(self, tickets: list[Any], seconds: float) -> tuple[list[BatchResult], list[Any]]:
        first = concurrent.futures.FIRST_COMPLETED
        done, rest = concurrent.futures.wait(tickets, timeout=seconds, return_when=first)
        return [ticket.result() for ticket in done], list(rest)

    def close(self) -> None:
        self._threads.shutdown(wait=True, cancel_futures=True)
        end_children()


class _Ray:
    """Tasks of a Ray cluster. Ray runs those of lost nodes and workers again."""

    def __init__(self, settings: Settings, workers: int | None, address: str | None) -> None:
        ray: Any = importlib.import_module("ray")
        self._ray = ray
        self._own = not ray.is_initialized()
        if self._own:
            cores = {} if address is not None else {"num_cpus": workers or os.cpu_count()}
            ray.init(address=address, log_to_driver=False, logging_level="error", **cores)
        cores_there = max(int(ray.cluster_resources().get("CPU", 1)), 1)
        self.workers = min(workers or cores_there, cores_there)
        self._settings = ray.put(settings)
        self._run = ray.remote(num_cpus=1, max_retries=-1)(run_batch)

    def submit(self, batch: Batch) -> Any:
        return self._run.remote(self._settings, batch)

    def wait(self, tickets: list[Any], seconds: float) -> tuple[list[BatchResult], list[Any]]:
        done, rest = self._ray.wait(tickets, num_returns=1, timeout=seconds)
        return [self._ray.get(ticket) for ticket in done], list(rest)

    def close(self) -> None:
        if self._own:
            self._ray.shutdown()


class _Dask:
    """Tasks of a Dask cluster. Dask runs those of lost workers again."""

    def __init__(self, settings: Settings, workers: int | None, address: str | None) -> None:
        distributed: Any = importlib.import_module("distributed")
        self._distributed = distributed
        self._cluster: Any = None
        if address is None:
            with importlib.import_module("dask").config.set(_SELDOM):
                self._cluster = distributed.LocalCluster(
                    n_workers=workers or os.cpu_count(),
                    threads_per_worker=1,
                    processes=True,
                    dashboard_address=":0",
                )
        self._client = distributed.Client(self._cluster if address is None else address)
        threads = sum(self._client.nthreads().values())
        self.workers = max(min(workers or threads, threads), 1)
        self._settings = settings
        self._lost: dict[Any, tuple[Batch, int]] = {}

    def submit(self, batch: Batch) -> Any:
        return self._begin(batch, 0)

    def _begin(self, batch: Batch, lost: int) -> Any:
        ticket = self._client.submit(run_batch, self._settings, batch, pure=False)
        self._lost[ticket.key] = batch, lost
        return ticket

    def wait(self, tickets: list[Any], seconds: float) -> tuple[list[BatchResult], list[Any]]:
        try:
            # Else it waits by the client that the program may have made current, in its event loop.
            with self._client.as_current():
                state = self._distributed.wait(tickets, seconds, return_when="FIRST_COMPLETED")
        except self._distributed.TimeoutError:
            return [], tickets
        left, found = list(state.not_done), []
        for ticket in state.done:
            batch, lost = self._lost.pop(ticket.key)
            try:
                found.append(ticket.result())
            except self._distributed.KilledWorker:
                if lost == _LOST_WORKERS:
                    raise
                left.append(self._begin(batch, lost + 1))
        return found, left

    def close(self) -> None:
        self._client.close()
        if self._cluster is not None:
            self._cluster.close()
