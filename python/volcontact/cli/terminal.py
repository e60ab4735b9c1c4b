# SPDX-License-Identifier: Apache-2.0
"""What the program prints: results on standard output, all else on standard error."""

from __future__ import annotations

import contextlib
import json as json_format
import time
import warnings
from collections.abc import Iterator
from typing import Protocol

from rich.console import Console, ConsoleOptions, RenderableType
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn
from rich.segment import Segment

from volcontact.messages.printable import printable

_PATIENCE = 0.7  # a bar appears when the work has taken so long [s]


class SafeConsole(Console):
    """A console that spells out control characters of what it is given: names may have any."""

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterator[Segment]:
        """As of `Console`; its own colours and movements stay."""
        for segment in super().render(renderable, options):
            if segment.control:
                yield segment
            else:
                yield Segment(printable(segment.text), segment.style)


class Terminal:
    """Standard output and error of one run of the program.

    Args:
        json: print nothing but JSON on standard output, and no progress bars.
    """

    def __init__(self, *, json: bool = False) -> None:
        self.json = json
        self.out = SafeConsole(highlight=False, soft_wrap=json)
        self.log = SafeConsole(stderr=True, highlight=False)

    def result(self, content: object) -> None:
        """Prints a result for machines."""
        try:
            self.out.out(json_format.dumps(content, indent=2), highlight=False)
        except OSError as error:
            raise _named(error) from error
        self.flush()

    def flush(self) -> None:
        """Sees to it that all that was printed has arrived.

        Raises:
            OSError: it cannot; says that it is standard output.
        """
        try:
            self.out.file.flush()
        except OSError as error:
            raise _named(error) from error

    def error(self, message: str) -> None:
        """Prints one line that says what is wrong."""
        line = " ".join(message.split())
        if self.json:
            with contextlib.suppress(OSError):  # which may be what is wrong
                self.result({"error": line})
        self.log.print("error:", style="bold red", end=" ")
        self.log.print(line, markup=False, soft_wrap=True)

    def warning(self, message: str) -> None:
        """Prints one line that deserves attention."""
        self.log.print("warning:", style="bold yellow", end=" ")
        self.log.print(" ".join(message.split()), markup=False, soft_wrap=True)

    def note(self, message: str) -> None:
        """Prints one line that is good to know and no fault."""
        self.log.print("note:", style="bold", end=" ")
        self.log.print(" ".join(message.split()), markup=False, soft_wrap=True)

    @contextlib.contextmanager
    def python_warnings(self) -> Iterator[None]:
        """Prints what the package warns of as lines of the program, each text once."""
        shown: set[str] = set()

        def show(message: Warning | str, *_: object, **__: object) -> None:
            text = str(message)
            if text not in shown:
                shown.add(text)
                self.warning(text)

        with warnings.catch_warnings():
            warnings.simplefilter("always", RuntimeWarning)
            warnings.showwarning = show
            yield

    @contextlib.contextmanager
    def progress(self) -> Iterator[ProgressBars]:
        """Shows bars with the time left, once the work takes longer than a moment."""
        bars = ProgressBars(self.log, enabled=self.log.is_terminal and not self.json)
        try:
            yield bars
        finally:
            bars.close()


def _named(error: OSError) -> OSError:
    """The error of a stream, whose name Python leaves out."""
    return type(error)(error.errno, error.strerror, "standard output")


class Mover(Protocol):
    """Moves a bar."""

    def __call__(self, done: int, total: int, note: str = "") -> None:
        """So many are done, of so many."""


class ProgressBars:
    """One bar per task, each fed by calls of (done, total), and of a note that stands behind."""

    def __init__(self, console: Console, *, enabled: bool) -> None:
        self._progress = Progress(
            TextColumn("{task.description:<22}"),
            BarColumn(bar_width=32),
            TextColumn("{task.percentage:>3.0f} %"),
            TimeRemainingColumn(compact=True, elapsed_when_finished=True),
            TextColumn("{task.fields[note]}"),
            console=console,
            transient=True,
        )
        self._enabled = enabled
        self._begin = time.monotonic()
        self._started = False

    def task(self, name: str) -> Mover:
        """Adds a bar and returns the function that moves it."""
        task: TaskID = self._progress.add_task(name, start=False, total=None, note="")

        def move(done: int, total: int, note: str = "") -> None:
            self._progress.start_task(task)
            self._progress.update(task, completed=done, total=total, note=note)
            if self._enabled and not self._started and time.monotonic() - self._begin > _PATIENCE:
                self._started = True
                self._progress.start()

        return move

    def close(self) -> None:
        """Removes the bars."""
        if self._started:
            self._progress.stop()
