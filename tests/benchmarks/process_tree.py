# SPDX-License-Identifier: Apache-2.0
"""What the processes below this one take: processor time and memory, by what they are."""

from __future__ import annotations

import collections
import os
from dataclasses import dataclass
from pathlib import Path

_TICKS = os.sysconf("SC_CLK_TCK")
_PAGE = os.sysconf("SC_PAGE_SIZE")
_CHILD = "volcontact.study.child"
# In the command line of a process -> what it is; the first that fits.
_KINDS = {
    _CHILD: "trials",
    "ray::": "workers",
    "multiprocessing-fork": "workers",
    "multiprocessing.spawn": "workers",
}


@dataclass(frozen=True)
class Process:
    """A process.

    Attributes:
        kind: `driver`, `trials` (a child that runs them), `workers` or `services`, of a cluster.
        seconds: of a processor that it took so far.
        megabytes: of memory that are its own or shared, now.
    """

    kind: str
    seconds: float
    megabytes: float


def processes() -> dict[int, Process]:
    """This process and all below it, by their numbers."""
    parents: dict[int, int] = {}
    found: dict[int, Process] = {}
    for folder in Path("/proc").iterdir():
        if not folder.name.isdecimal():
            continue
        try:
            stat = (folder / "stat").read_text().rpartition(")")[2].split()
            command = (folder / "cmdline").read_bytes().decode("utf-8", "replace")
        except OSError:
            continue
        number = int(folder.name)
        parents[number] = int(stat[1])
        kind = next((word for part, word in _KINDS.items() if part in command), "services")
        kind = "driver" if number == os.getpid() else kind
        seconds = (int(stat[11]) + int(stat[12])) / _TICKS
        found[number] = Process(kind, seconds, int(stat[21]) * _PAGE / 1e6)
    ours = {os.getpid()}
    while True:
        more = {number for number, parent in parents.items() if parent in ours} - ours
        if not more:
            return {number: found[number] for number in ours}
        ours |= more


def seconds_between(
    before: dict[int, Process], after: dict[int, Process]
) -> collections.Counter[str]:
    """Processor time by kind [s]."""
    taken: collections.Counter[str] = collections.Counter()
    for number, process in after.items():
        begin = before[number].seconds if number in before else 0.0
        taken[process.kind] += process.seconds - begin
    return taken


def growth(before: dict[int, Process], after: dict[int, Process]) -> dict[str, float]:
    """How much the memory of each kind grew, of the one that grew most [MB]."""
    grown: dict[str, float] = {}
    for number, process in after.items():
        if number in before:
            more = process.megabytes - before[number].megabytes
            grown[process.kind] = max(grown.get(process.kind, -1e9), more)
    return grown
