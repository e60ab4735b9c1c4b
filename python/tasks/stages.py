# SPDX-License-Identifier: Apache-2.0
"""The parts of `./run test`: one that fails stops no other; times and counts at the end."""

from __future__ import annotations

import os
import sys
import tempfile
import threading
import time
import traceback
import xml.etree.ElementTree as xml
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from tasks.shell import Stopped, aside


@dataclass
class Stages:
    """What has been run: a word, a title and seconds each."""

    results: Path  # folder of the JUnit files
    rows: list[tuple[str, str, float]] = field(default_factory=list)

    def run(self, title: str, work: Callable[[], None]) -> bool:
        """Runs one part; whether it ended well."""
        print(f"\n==== {title}", flush=True)
        start = time.monotonic()
        word = _outcome(work)
        self.rows.append((word, title, time.monotonic() - start))
        return word == "ok"

    def beside(
        self, title: str, work: Callable[[], None], *, idle: bool = False
    ) -> Callable[[], bool]:
        """The same while other parts run. Call what is returned to wait for its end.

        Args:
            title: of the part.
            work: tells what it does when it is waited for.
            idle: takes only what time the others leave.
        """
        outcome: list[tuple[str, float]] = []
        told = tempfile.TemporaryFile("a+", encoding="utf-8")  # noqa: SIM115 (`wait` closes it)

        def body() -> None:
            if idle and sys.platform == "linux":  # where a priority is that of a thread
                os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), 19)
            start = time.monotonic()
            with aside(told):
                word = _outcome(work)
            outcome.append((word, time.monotonic() - start))

        thread = threading.Thread(target=body)
        thread.start()

        def wait() -> bool:
            thread.join()
            ((word, seconds),) = outcome
            self.rows.append((word, f"{title} (beside others)", seconds))
            told.seek(0)
            if text := told.read():
                print(f"\n==== {title} (beside others)\n{text}", end="", flush=True)
            told.close()
            return word == "ok"

        return wait

    def note(self, word: str, title: str) -> None:
        """A line of the summary for what was not run."""
        self.rows.append((word, title, 0.0))

    def summary(self) -> int:
        """Prints all; the number of failures. The last line counts the tests."""
        cases = _cases(self.results)
        counts = {kind: sum(case.kind == kind for case in cases) for kind in _KINDS}
        print("\n==== Slowest tests")
        for case in sorted(cases, key=lambda case: -case.seconds)[:10]:
            print(f"{case.seconds:7.1f} s  {case.suite}: {case.name}")
        print("\n==== Summary")
        for word, title, seconds in self.rows:
            print(f"{word:8s}{seconds:6.0f} s  {title}")
        broken = sum(word == "FAILED" for word, _, _ in self.rows)
        failed = max(counts["failed"], broken)  # a build that fails leaves no report
        print(f"{counts['passed']} passed, {failed} failed, {counts['skipped']} skipped")
        return failed


_KINDS = ("passed", "failed", "skipped")


@dataclass(frozen=True)
class _Case:
    suite: str
    name: str
    seconds: float
    kind: str


def _outcome(work: Callable[[], None]) -> str:
    try:
        work()
    except Stopped as error:
        print(f"run: {error}", flush=True)
        return "FAILED"
    except Exception:
        traceback.print_exc()
        return "FAILED"
    return "ok"


def _cases(folder: Path) -> list[_Case]:
    found = []
    for report in sorted(folder.glob("*.xml")):
        for case in xml.parse(report).iter("testcase"):
            children = {child.tag for child in case}
            failed = bool(children & {"failure", "error"})
            kind = "failed" if failed else "skipped" if "skipped" in children else "passed"
            name = case.get("name", "")
            found.append(_Case(report.stem, name, float(case.get("time", 0)), kind))
    return found
