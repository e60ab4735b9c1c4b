# SPDX-License-Identifier: Apache-2.0
"""Runs the program search_pairs over many cases and writes their sum, results/random_search.json.

Every chunk of cases has a file of its own, so that a run that was stopped goes on where it was.
Chunks that were judged on other engines hold where the answers are the same to the last bit: that
is asked of the program, without the judge, who takes most of the time. Those with failures are
judged again. The command `./run search`
builds the program and calls this script.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import datetime
import json
import os
import platform
import re
import subprocess
import time
from collections import defaultdict
from pathlib import Path
from typing import Any

RESULT = Path(__file__).parent / "results" / "random_search.json"
ROOT = Path(__file__).resolve().parents[2]
# Of a million cases. Composed solids take a thousand times as long as simple ones.
SHARES = {
    "random": 0.23,
    "special": 0.30,
    "cones": 0.17,
    "thin": 0.12,
    "bored": 0.11,
    "meshes": 0.04,
    "slender": 0.02,
    "composed": 0.01,
}
CHUNK = {"composed": 40, "meshes": 500, "slender": 500}
EXAMPLES = 3  # of a kind of failure that are kept in full


def main() -> None:
    """Runs what is missing, then adds up."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path, help="the built program search_pairs")
    parser.add_argument("--cases", type=int, default=1_000_000, help="in all [%(default)s]")
    parser.add_argument("--family", action="append", help="only this one; may be repeated")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="at once [%(default)s]")
    parser.add_argument("--minutes", type=float, help="begin no chunk after that; record the rest")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "random-search")
    parser.add_argument("--out", type=Path, default=RESULT)
    arguments = parser.parse_args()
    version = engines_version()
    folder = arguments.folder / version
    folder.mkdir(parents=True, exist_ok=True)
    chunks = chunks_of(arguments.cases, arguments.family or list(SHARES))
    missing = [chunk for chunk in chunks if not (folder / file_of(*chunk)).exists()]
    judged = {path.name for path in arguments.folder.glob("*/*.jsonl")}
    missing.sort(key=lambda chunk: file_of(*chunk) not in judged)  # these cost little
    begin = time.monotonic()
    end = begin + 60 * arguments.minutes if arguments.minutes else float("inf")

    def run_in_time(chunk: tuple[str, int, int]) -> None:
        if time.monotonic() < end and not carry(arguments.program, folder, *chunk):
            run(arguments.program, folder, *chunk)

    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        runs = [pool.submit(run_in_time, chunk) for chunk in missing]
        for done, finished in enumerate(concurrent.futures.as_completed(runs), 1):
            finished.result()
            left = (time.monotonic() - begin) / done * (len(missing) - done)
            print(f"\r{done} of {len(missing)} chunks, {left:.0f} s left ", end="", flush=True)
    paths = [folder / file_of(*chunk) for chunk in chunks]
    texts = [path.read_text(encoding="utf-8") for path in paths if path.exists()]
    result = {"version": version, "date": f"{datetime.date.today()}", **summary(texts)}
    result["machine"] = platform.machine()
    arguments.out.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    failures = sum(kind["number"] for kind in result["failures"])
    print(f"\n{failures} failures, {result['seconds']:.0f} s of one processor")


def engines_version() -> str:
    """The last commit that changed the engines, with a mark if they were changed since."""
    git = ["git", "-C", str(ROOT)]
    log = [*git, "log", "-1", "--format=%h", "--", "plugin/volcontact"]
    commit = subprocess.run(log, check=True, capture_output=True, text=True).stdout.strip()
    changed = subprocess.run([*git, "diff", "--quiet", "HEAD", "--", "plugin/volcontact"])
    return commit + ("-changed" if changed.returncode else "")


def chunks_of(cases: int, families: list[str]) -> list[tuple[str, int, int]]:
    """Family, seed and number of cases of every chunk, all families evenly from the start."""
    chunks = []
    for family in families:
        size = CHUNK.get(family, 2000)
        count = max(1, round(cases * SHARES[family] / size))
        chunks += [((seed - 0.5) / count, family, seed, size) for seed in range(1, count + 1)]
    return [(family, seed, size) for _, family, seed, size in sorted(chunks)]


def file_of(family: str, seed: int, size: int) -> str:
    """Where the output of a chunk is kept."""
    return f"{family}-{seed:04d}-{size}.jsonl"


def carry(program: Path, folder: Path, family: str, seed: int, size: int) -> bool:
    """Takes over what was found on other engines that give the same answers."""
    name, answers = file_of(family, seed, size), None
    for path in sorted(folder.parent.glob(f"*/{name}")):
        text = path.read_text(encoding="utf-8")
        lines = [json.loads(line) for line in text.splitlines()]
        known = next((line["answers"] for line in lines if "answers" in line), None)
        if known is None or any("crash" in line or "what" in line for line in lines):
            continue  # failures are looked at again
        if answers is None:
            command = [program, family, str(seed), "0", str(size), "answers"]
            ran = subprocess.run(command, capture_output=True, text=True)
            if ran.returncode != 0:
                return False
            answers = json.loads(ran.stdout)["answers"]
        if known == answers:
            if not any("judged_on" in line for line in lines):
                text += json.dumps({"judged_on": path.parent.name}) + "\n"
            write(folder / name, text)
            return True
    return False


def write(path: Path, text: str) -> None:
    """All of it or nothing."""
    partial = path.with_suffix(".partial")
    partial.write_text(text, encoding="utf-8")
    partial.rename(path)


def run(program: Path, folder: Path, family: str, seed: int, size: int) -> None:
    """Runs one chunk; goes on behind a case that ends the program."""
    text, first = "", 0
    while first < size:
        command = [program, family, str(seed), str(first), str(size - first)]
        ran = subprocess.run(command, capture_output=True, text=True)
        text += ran.stdout
        if ran.returncode == 0:
            break
        crash = re.search(r'"crash": \d+, "index": (\d+)', ran.stdout)
        if crash is None:
            raise RuntimeError(f"{command} ended with {ran.returncode}: {ran.stderr[-500:]}")
        first = int(crash.group(1)) + 1
    text += json.dumps({"chunk": [family, seed, size]}) + "\n"
    write(folder / file_of(family, seed, size), text)


# ---- Adding up -----------------------------------------------------------------------------------


def summary(texts: list[str]) -> dict[str, Any]:
    """The sum over the outputs of search_pairs."""
    rows: dict[tuple[str, str], dict[str, Any]] = {}
    kinds: dict[tuple[str, str, str], dict[str, Any]] = {}
    crashes: list[dict[str, Any]] = []
    refused, seconds, elsewhere = 0, 0.0, 0
    for text in texts:
        lines = [json.loads(line) for line in text.splitlines()]
        family, seed, _ = next(line["chunk"] for line in lines if "chunk" in line)
        carried = any("judged_on" in line for line in lines)
        for line in lines:
            if "count" in line:
                _add_count(rows, line)
                elsewhere += line["cases"] if carried else 0
            elif "what" in line:
                _add_failure(kinds, line, seed)
            elif "crash" in line:
                crashes.append({"family": family, "seed": seed} | line)
            elif "seconds" in line:
                refused += line["refused"]
                seconds += line["seconds"]
    return {
        "cases": sum(row["cases"] for row in rows.values()),
        "judged_elsewhere": elsewhere,
        "refused": refused,
        "seconds": round(seconds),
        "crashes": crashes,
        "rows": [rows[key] for key in sorted(rows)],
        "failures": [kinds[key] for key in sorted(kinds)],
    }


def _add_count(rows: dict[tuple[str, str], dict[str, Any]], line: dict[str, Any]) -> None:
    key = (line["family"], line["count"])
    empty = {"family": key[0], "engine": key[1], "cases": 0, "overlapping": 0, "undecided": 0}
    row = rows.setdefault(key, empty | {"known": [0, 0, 0, 0], "slowest": 0.0})
    for name in ("cases", "overlapping", "undecided"):
        row[name] += line[name]
    row["known"] = [a + b for a, b in zip(row["known"], line["known"], strict=True)]
    row["slowest"] = max(row["slowest"], line["slowest"])


def excess(failure: dict[str, Any]) -> float:
    """By how much V is beyond what it claims, relative to the true one."""
    beyond = abs(failure["volume"] - failure["expected"]) - failure["volume_error"]
    return max(0.0, beyond) / max(abs(failure["expected"]), 1e-300)


def _add_failure(
    kinds: dict[tuple[str, str, str], dict[str, Any]], line: dict[str, Any], seed: int
) -> None:
    key = (line["what"], line["engine"], line["family"])
    empty = {"what": key[0], "engine": key[1], "family": key[2], "number": 0, "worst": 0.0}
    kind = kinds.setdefault(key, empty | {"pairs": defaultdict(int), "examples": []})
    kind["number"] += 1
    kind["pairs"][" - ".join(sorted(_name(line[side]) for side in "ab"))] += 1
    if line["what"] in ("wrong volume", "beyond the bound"):
        kind["worst"] = max(kind["worst"], excess(line))
    # The shortest are the easiest to look into.
    kind["examples"].append({"seed": seed} | line)
    kind["examples"].sort(key=lambda e: len(e["a"]) + len(e["b"]) + len(e["X_AB"]))
    del kind["examples"][EXAMPLES:]


def _name(expression: str) -> str:
    return "composed" if expression.startswith("(") else expression.split("(")[0]


if __name__ == "__main__":
    main()
