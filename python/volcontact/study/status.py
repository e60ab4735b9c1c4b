# SPDX-License-Identifier: Apache-2.0
"""How far a study is, from its folder alone: also from another terminal, while it runs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from volcontact.study.estimates import wilson
from volcontact.study.results import Folder

_RECENT = 5  # parts that the rate is of


def status_of(out: Path) -> dict[str, Any]:
    """Trials done, outcomes, rate and time left.

    Raises:
        StudyError: this is no folder of a study.
    """
    folder = Folder(out)
    said = folder.provenance()
    parts = folder.parts()
    outcomes = folder.counts()
    done = sum(outcomes.values())
    total = int(said["trials"])
    running = folder.is_running()
    rate = _rate(parts, said)
    left = (total - done) / rate if rate and running else None
    good = outcomes.get("success", 0)
    state = "running" if running else "finished" if done == total else "stopped"
    if state == "stopped":
        state = f"stopped; go on with: volcontact study resume {out}"
    weighted = said["method"] in ("importance", "optimise", "morris", "saltelli")
    return {
        "name": said["name"],
        "trials": total,
        "done": done,
        "outcomes": dict(sorted(outcomes.items(), key=lambda entry: -entry[1])),
        "success": good / done if done and not weighted else None,
        "interval": list(wilson(good, done)) if done and not weighted else None,
        "rate": rate,
        "running": running,
        "seconds_left": left,
        "state": state,
    }


def _rate(parts: list[Path], said: dict[str, Any]) -> float | None:
    """Trials a second of the last parts [1/s]."""
    if not parts or not said["sessions"]:
        return None
    recent = parts[-_RECENT - 1 :]
    times = [part.stat().st_mtime for part in recent]
    counts = [int(pq.read_metadata(part).num_rows) for part in recent]
    begin = float(said["sessions"][-1]["begin"])
    if len(parts) <= _RECENT or begin > times[0]:
        inside = [i for i, moment in enumerate(times) if moment >= begin]
        spent = times[-1] - begin
        number = sum(counts[i] for i in inside)
    else:
        spent, number = times[-1] - times[0], sum(counts[1:])
    return number / spent if spent > 0.0 and number else None
