# SPDX-License-Identifier: Apache-2.0
"""Runs the program fuzz_pairs with many seeds and writes their sum, results/search.json.

Every seed has a file of its own, so that a run that was stopped goes on where it was. The command
`./run search` builds the program and calls this script.
"""

from __future__ import annotations

import argparse
import datetime
import json
import platform
import subprocess
import time
from collections import defaultdict
from pathlib import Path
from typing import Any

RESULT = Path(__file__).parent / "results" / "search.json"
ROOT = Path(__file__).resolve().parents[2]
RANDOM_POSES, DEGENERATE_POSES = 10_000, 1_000  # a seed
PARTS = {"median": 0.5, "p99": 0.99, "p999": 0.999, "worst": 1.0}


def main() -> None:
    """Runs what is missing, then adds up."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path, help="the built program fuzz_pairs")
    parser.add_argument("--seeds", type=int, default=100, help="of 11,000 poses each [%(default)s]")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "search")
    parser.add_argument("--out", type=Path, default=RESULT)
    arguments = parser.parse_args()
    version = _version()
    folder = arguments.folder / version
    folder.mkdir(parents=True, exist_ok=True)
    chunks = [folder / f"{seed:04d}.csv" for seed in range(1, arguments.seeds + 1)]
    missing = [chunk for chunk in chunks if not chunk.exists()]
    begin = time.monotonic()
    for done, chunk in enumerate(missing):
        left = (time.monotonic() - begin) / max(done, 1) * (len(missing) - done)
        print(f"\r{done} of {len(missing)} seeds, about {left:.0f} s left ", end="", flush=True)
        _run(arguments.program, chunk)
    result = summary([chunk.read_text(encoding="utf-8") for chunk in chunks])
    result = {"version": version, "date": f"{datetime.date.today()}", **result}
    result["machine"] = platform.machine()
    arguments.out.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    print(f"\n{len(result['failures'])} failures, {result['seconds']:.0f} s of one processor")


def _version() -> str:
    """The last commit that changed the engines, with a mark if they were changed since."""
    git = ["git", "-C", str(ROOT)]
    log = [*git, "log", "-1", "--format=%h", "--", "plugin/volcontact"]
    commit = subprocess.run(log, check=True, capture_output=True, text=True).stdout.strip()
    changed = subprocess.run([*git, "diff", "--quiet", "HEAD", "--", "plugin/volcontact"])
    return commit + ("-changed" if changed.returncode else "")


def _run(program: Path, chunk: Path) -> None:
    command = [program, str(RANDOM_POSES), str(DEGENERATE_POSES), str(int(chunk.stem))]
    ran = subprocess.run(command, capture_output=True, text=True)
    text = ran.stdout
    if ran.returncode != 0:
        text += f"crash,{chunk.stem},{ran.returncode}\n"
    partial = chunk.with_suffix(".partial")
    partial.write_text(text, encoding="utf-8")
    partial.rename(chunk)


def summary(texts: list[str]) -> dict[str, Any]:
    """The sum over the outputs of fuzz_pairs."""
    poses: dict[tuple[str, str], list[int]] = defaultdict(lambda: [0, 0])
    errors: dict[tuple[str, str], list[float]] = defaultdict(list)
    failures: list[dict[str, Any]] = []
    undecided, crashes, seconds = 0, 0, 0.0
    plan: list[float] = []
    for text in texts:
        for line in text.splitlines():
            word, *rest = line.split(",")
            if word == "count":
                tally = poses[rest[0], rest[1]]
                tally[0] += int(rest[2])
                tally[1] += int(rest[3])
            elif word == "error":
                errors[rest[0], rest[1]].append(float(rest[2]))
            elif word == "undecided":
                undecided += int(rest[0])
            elif word == "plan":
                plan = [float(number) for number in rest]
            elif word == "crash":
                crashes += 1
            elif word == "seconds":
                seconds += float(rest[0])
            elif word == "failure":
                failures.append(_failure(line))
    rows = [
        {"engine": engine, "kind": kind, "poses": tally[0], "overlapping": tally[1]}
        | _spread(sorted(errors[engine, kind]))
        for (engine, kind), tally in poses.items()
        if tally[0]
    ]
    return {
        "seeds": len(texts),
        "weights": plan[:3],
        "reference_shares": plan[3:],
        "seconds": round(seconds),
        "crashes": crashes,
        "undecided": undecided,
        "rows": rows,
        "failures": failures,
    }


def _spread(errors: list[float]) -> dict[str, float]:
    if not errors:
        return {"compared": 0}
    parts = {name: errors[int(part * (len(errors) - 1))] for name, part in PARTS.items()}
    return {"compared": len(errors)} | parts


def _failure(line: str) -> dict[str, Any]:
    # The words of a failure may hold a comma; its pose does.
    _, engine, a, b, rest = line.split(",", 4)
    what, pose = rest.split(",Pose", 1)
    what, volume, expected = what.rsplit(",", 2)
    return {
        "engine": engine,
        "a": a,
        "b": b,
        "what": what,
        "volume": float(volume),
        "expected": float(expected),
        "X_AB": "Pose" + pose,
    }


if __name__ == "__main__":
    main()
