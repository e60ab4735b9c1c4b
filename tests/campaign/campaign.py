# SPDX-License-Identifier: Apache-2.0
"""Looks for energy that contact makes: thousands of scenes, one row a case.

    ./run campaign                          all parts, and docs/campaign.md
    ./run campaign --part grazing --sample 10

Rows are kept in build/campaign, so that a run that was stopped goes on where it was; they end in
tests/benchmarks/results/campaign_*.csv. `--sample n` takes one case in n, and keeps no table
without `--keep`.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import csv
import importlib
import json
import os
import random
import subprocess
import sys
import time
from pathlib import Path
from types import ModuleType
from typing import Any

import mujoco

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RESULTS = ROOT / "tests" / "benchmarks" / "results"
PARTS = ("box_on_plane", "grazing", "generated_scenes", "models_of_others")


def main() -> None:
    """Runs what is missing of the parts asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--part", action="append", choices=PARTS)
    parser.add_argument("--sample", type=int, default=1, help="one case in n [%(default)s]")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="at once [%(default)s]")
    parser.add_argument("--minutes", type=float, default=1e9, help="that a part may take")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "campaign")
    parser.add_argument("--packages", type=Path, default=ROOT / "build" / "third_party")
    parser.add_argument("--keep", action="store_true", help="write the results of a sample, too")
    arguments = parser.parse_args()
    os.environ.setdefault("VOLCONTACT_THIRD_PARTY", str(arguments.packages))
    folder = arguments.folder / version()
    folder.mkdir(parents=True, exist_ok=True)
    for name in arguments.part or PARTS:
        part = module(name)
        rows = run(part, folder, arguments.sample, arguments.jobs, 60.0 * arguments.minutes)
        report(part, rows)
        if arguments.sample == 1 or arguments.keep:
            write(part, rows)


def module(name: str) -> ModuleType:
    """A part of the campaign."""
    if str(HERE) not in sys.path:
        sys.path.insert(0, str(HERE))
    return importlib.import_module(name)


def version() -> str:
    """The last commit that changed what is under test, with a mark if it was changed since."""
    git = ["git", "-C", str(ROOT)]
    log = [*git, "log", "-1", "--format=%h", "--", "plugin", "python"]
    commit = subprocess.run(log, check=True, capture_output=True, text=True).stdout.strip()
    changed = subprocess.run([*git, "diff", "--quiet", "HEAD", "--", "plugin", "python"])
    return commit + ("-changed" if changed.returncode else "")


def key_of(part: ModuleType, case: dict[str, Any]) -> str:
    """What tells a case from all others of its part."""
    return json.dumps([case[name] for name in part.KEYS])


def together(part: ModuleType, cases: list[dict[str, Any]]) -> list[list[dict[str, Any]]]:
    """The cases by what they have in common, for one process each."""
    groups: dict[str, list[dict[str, Any]]] = {}
    for case in cases:
        shared = [case[name] for name in getattr(part, "SHARED", part.KEYS)]
        groups.setdefault(json.dumps(shared), []).append(case)
    return list(groups.values())


def all_examined(name: str, cases: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The rows of some cases."""
    return [examined(name, case) for case in cases]


def examined(name: str, case: dict[str, Any]) -> dict[str, Any]:
    """The row of a case; what was thrown is in it."""
    # They are counted; told, they fill the terminal and a log file.
    mujoco.set_mju_user_warning(_ignore)
    try:
        return module(name).examine(case)
    except Exception as error:
        return case | {"refused": "", "error": f"{type(error).__name__}: {error}"}


def _ignore(_message: str) -> None: ...


def run(
    part: ModuleType, folder: Path, sample: int, jobs: int, seconds: float = 1e9
) -> list[dict[str, Any]]:
    """The rows of all cases, or of those that the time allows; those there are not run again."""
    path = folder / f"{part.NAME}.jsonl"
    done = {}
    if path.exists():
        for line in path.read_text(encoding="utf-8").splitlines():
            row = json.loads(line)
            done[key_of(part, row)] = row
    cases = list(part.cases(sample))
    missing = [case for case in cases if key_of(part, case) not in done]
    groups = together(part, missing)
    random.Random(1).shuffle(groups)  # a part of them is of all kinds
    begin = time.monotonic()
    with (
        path.open("a", encoding="utf-8") as file,
        concurrent.futures.ProcessPoolExecutor(jobs) as pool,
    ):
        runs = [pool.submit(all_examined, part.NAME, group) for group in groups]
        number = 0
        for ended in concurrent.futures.as_completed(runs):
            for found in ended.result():
                row = found | {"state": path.parent.name}
                file.write(json.dumps(row) + "\n")
                done[key_of(part, row)] = row
                number += 1
            file.flush()
            left = (time.monotonic() - begin) / number * (len(missing) - number)
            print(f"\r{part.NAME}: {number} of {len(missing)}, {left:.0f} s left ", end="")
            if time.monotonic() - begin > seconds:
                pool.shutdown(cancel_futures=True)
                break
    return [done[key] for case in cases if (key := key_of(part, case)) in done]


def is_sound(part: ModuleType, row: dict[str, Any]) -> bool:
    """Nothing was thrown, and the row is as the part wants it."""
    return not row.get("error") and part.is_sound(row)


def report(part: ModuleType, rows: list[dict[str, Any]]) -> None:
    """How many cases fail, and the worst of them."""
    failed = [row for row in rows if not is_sound(part, row)]
    print(f"\r{part.NAME}: {len(failed)} of {len(rows)} cases fail" + 40 * " ")
    failed.sort(key=lambda row: -float(row.get(part.WORST) or 0.0))
    for row in failed[:5]:
        print("   ", {name: row[name] for name in row if row[name] not in ("", None)})


def write(part: ModuleType, rows: list[dict[str, Any]]) -> None:
    """The recorded table."""
    path = RESULTS / f"campaign_{part.NAME}.csv"
    with path.open("w", encoding="utf-8", newline="") as table:
        writer = csv.DictWriter(
            table, (*part.COLUMNS, "error", "state"), lineterminator="\n", extrasaction="ignore"
        )
        writer.writeheader()
        for row in rows:
            writer.writerow({name: short(value) for name, value in row.items()})


def short(value: Any) -> Any:
    """Six digits of a measured number."""
    return f"{value:.6g}" if isinstance(value, float) else value


if __name__ == "__main__":
    main()
