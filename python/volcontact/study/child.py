# SPDX-License-Identifier: Apache-2.0
"""Trials in a process of their own, so that one that crashes or hangs takes nothing with it.

Every worker of every engine owns such a child and watches it. What the child has to say comes
trial by trial; when nothing comes for the time limit, it is killed, and another one goes on.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle
import select
import signal
import struct
import subprocess
import sys
import threading
import time
from typing import IO, Any, NamedTuple

from volcontact.study.file.settings import Settings

_HEAD = struct.Struct("<Q")
_START_LIMIT = 300.0  # for Python, MuJoCo and the first model [s]
_ATTEMPTS = 2  # a child may have been killed by somebody else


class Batch(NamedTuple):
    """Some trials: their numbers, and the values of the inputs of each."""

    trials: list[int]
    values: list[dict[str, Any]]


class BatchResult(NamedTuple):
    """Rows of a batch, and how long it took [s]."""

    rows: list[dict[str, Any]]
    seconds: float


class ChildGone(RuntimeError):
    """The process ended, or said nothing for too long; the text says which."""


def run_batch(settings: Settings, batch: Batch) -> BatchResult:
    """Runs a batch in a child of this process; what any engine calls on its workers."""
    begin = time.monotonic()
    key = hashlib.sha256(pickle.dumps(settings)).hexdigest()
    rows: list[dict[str, Any]] = []
    deaths = 0
    child = _take(key, settings)
    try:
        place = 0
        while place < len(batch.trials):
            try:
                child.send((batch.trials[place:], batch.values[place:]))
                while place < len(batch.trials):
                    rows.append(child.receive(settings.time_limit))
                    place, deaths = place + 1, 0
            except ChildGone as gone:
                hung = child.hung
                child.kill()
                deaths += 1
                if hung or deaths == _ATTEMPTS:
                    outcome = "hung" if hung else "crashed"
                    failed = (batch.trials[place], batch.values[place], outcome, str(gone))
                    child = Child(settings)
                    rows.append(child.ask(("failed", failed)))
                    place, deaths = place + 1, 0
                else:
                    child = Child(settings)
    except BaseException:
        child.kill()
        raise
    _give_back(key, child)
    return BatchResult(rows, time.monotonic() - begin)


_idle: dict[str, list[Child]] = {}
_lock = threading.Lock()


def _take(key: str, settings: Settings) -> Child:
    with _lock:
        for other in [other for other in _idle if other != key]:
            for child in _idle.pop(other):  # of a study before this one
                child.kill()
        waiting = _idle.get(key)
        if waiting:
            return waiting.pop()
    return Child(settings)


def _give_back(key: str, child: Child) -> None:
    with _lock:
        _idle.setdefault(key, []).append(child)


def end_children() -> None:
    """Ends the idle children of this process."""
    with _lock:
        for children in _idle.values():
            for child in children:
                child.kill()
        _idle.clear()


class Child:
    """A process that runs trials of one study."""

    def __init__(self, settings: Settings) -> None:
        self.hung = False
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        environment.pop("COVERAGE_PROCESS_START", None)
        self._process = subprocess.Popen(
            [sys.executable, "-m", "volcontact.study.child"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=environment,
            start_new_session=True,  # Ctrl-C is for the driver
        )
        assert self._process.stdin is not None and self._process.stdout is not None
        self._input = self._process.stdin
        self._output = self._process.stdout.fileno()
        self._buffer = b""
        try:
            answer = self.ask(settings, _START_LIMIT)
        except BaseException:
            self.kill()
            raise
        if answer != "ready":
            self.kill()
            raise RuntimeError(str(answer))

    @property
    def pid(self) -> int:
        """Of the process."""
        return self._process.pid

    def send(self, message: object) -> None:
        """Sends an object."""
        try:
            _write(self._input, message)
        except OSError as error:
            raise ChildGone(self._end()) from error

    def receive(self, limit: float) -> Any:
        """The next answer within a time [s].

        Raises:
            ChildGone: there is none.
        """
        deadline = time.monotonic() + limit
        while True:
            size = len(self._buffer)
            if size >= _HEAD.size:
                length = _HEAD.unpack_from(self._buffer)[0] + _HEAD.size
                if size >= length:
                    body, self._buffer = self._buffer[_HEAD.size : length], self._buffer[length:]
                    return pickle.loads(body)
            left = deadline - time.monotonic()
            if left <= 0.0 or not select.select([self._output], [], [], left)[0]:
                self.hung = True
                raise ChildGone(f"no result after the time limit of {limit:g} s")
            more = os.read(self._output, 1 << 16)
            if not more:
                raise ChildGone(self._end())
            self._buffer += more

    def ask(self, message: object, limit: float = 60.0) -> Any:
        """Sends an object and waits for the answer."""
        self.send(message)
        return self.receive(limit)

    def kill(self) -> None:
        """Ends the process."""
        self._process.kill()
        self._process.wait()
        with contextlib.suppress(OSError):
            self._input.close()
        if self._process.stdout is not None:
            self._process.stdout.close()

    def _end(self) -> str:
        code = self._process.wait()
        if code < 0:
            with contextlib.suppress(ValueError):
                return f"its process was ended by {signal.Signals(-code).name}, twice"
        return f"its process ended with status {code}, twice"


def _write(stream: IO[bytes], message: object) -> None:
    body = pickle.dumps(message, protocol=pickle.HIGHEST_PROTOCOL)
    stream.write(_HEAD.pack(len(body)) + body)
    stream.flush()


def _read(stream: IO[bytes]) -> Any:
    head = stream.read(_HEAD.size)
    if len(head) < _HEAD.size:
        raise EOFError
    return pickle.loads(stream.read(_HEAD.unpack(head)[0]))


def _end_with_parent(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(1)


def main() -> None:
    """The program of the child."""
    requests, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what the user's functions print
    threading.Thread(target=_end_with_parent, args=(os.getppid(),), daemon=True).start()
    settings = _read(requests)
    try:
        from volcontact.study.trial import Runner

        runner = Runner(settings)
    except Exception as error:
        _write(answers, f"{type(error).__name__}: {error}")
        return
    _write(answers, "ready")
    while True:
        try:
            request = _read(requests)
        except EOFError:
            return
        if request[0] == "failed":
            _write(answers, runner.failed(*request[1]))
            continue
        for trial, values in zip(*request, strict=True):
            # The parent kills what hangs; should it be gone itself, this does.
            signal.setitimer(signal.ITIMER_REAL, 2.0 * settings.time_limit + 10.0)
            _write(answers, runner.run(trial, values))
        signal.setitimer(signal.ITIMER_REAL, 0.0)


if __name__ == "__main__":
    main()
