# SPDX-License-Identifier: Apache-2.0
"""Time and error of one query of a pair: volcontact and other libraries on the same poses.

    ./run benchmark

runs it and all other benchmarks, and writes docs/performance.md. All libraries are called from
Python, in turns; volcontact is timed in a loop in C++ as well. Setting a pose is not timed where
the library can do it ahead. Times are processor time, so that neither threads nor neighbours on
the machine count; below LONG, where the clock of the processor is too coarse, they are wall time.
"""

from __future__ import annotations

import argparse
import csv
import importlib
import math
import time
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np
from peers.cases import Case, all_cases
from peers.library import Query, Unsupported
from peers.ours import FromPython, microseconds_in_cpp, true_volume

ROUNDS = 15
SECONDS = 0.05  # of one library in one round: slower ones see fewer poses, but four at least
LONG = 100.0  # [us]
PEERS = {  # what to import, and its ways to ask
    "peers.manifold_meshes": ("CoarseBoolean", "FineBoolean"),
    "peers.mujoco_geoms": ("Native", "Sdf"),
    "peers.drake_geometry": ("Hydroelastic", "PointContact"),
}


@dataclass
class Row:
    """One way of one library on one pair: a line of the results."""

    case: str
    library: str
    variant: str
    gives: str
    time_us: float
    q1_us: float
    q3_us: float
    apart_us: float  # the same call when the two are far apart: no query is cheaper
    poses: int
    found: int
    volume_error_median: float
    volume_error_worst: float
    reference_error: float
    note: str


class Clock:
    """Times of one query at all poses, round by round [us]."""

    def __init__(self, query: Query, poses: np.ndarray) -> None:
        self.query = query
        self.now = time.perf_counter_ns
        query.place(poses[0])
        query.ask()
        once = min(self._time(poses[0]) for _ in range(3))
        if once > LONG:
            self.now = time.process_time_ns
        self.poses = poses[: max(4, min(len(poses), int(1e6 * SECONDS / once)))]
        self.rounds: list[list[float]] = []

    def _time(self, pose: np.ndarray) -> float:
        self.query.place(pose)
        begin = self.now()
        self.query.ask()
        return 1e-3 * (self.now() - begin)

    def run_round(self) -> None:
        """Every pose once."""
        self.rounds.append([self._time(pose) for pose in self.poses])

    def quartiles(self) -> np.ndarray:
        """Over the rounds, then the mean over the poses, shape (3,)."""
        return np.percentile(self.rounds, [25, 50, 75], axis=0).mean(axis=1)

    def apart(self) -> float:
        """The call when nothing is near."""
        far = np.eye(4)
        far[:3, 3] = 0.0, 0.0, 100.0
        return float(np.median([self._time(far) for _ in range(25)]))


def peers() -> list[type[Query]]:
    """The ways of all libraries that are installed."""
    found: list[type[Query]] = []
    for module, names in PEERS.items():
        try:
            loaded = importlib.import_module(module)
        except ImportError as missing:
            print(f"{module} is left out: {missing}", flush=True)
            continue
        found += [getattr(loaded, name) for name in names]
    return found


def queries_of(case: Case, ways: list[type[Query]]) -> list[Query]:
    """The queries that can be asked of a pair, ours first; one of those that are called alike."""
    queries: list[Query] = [FromPython(case)]
    for way in ways:
        try:
            query = way(case.a, case.b)
        except Unsupported:
            continue
        if (query.library, query.variant) not in [(q.library, q.variant) for q in queries]:
            queries.append(query)
    return queries


def measure(case: Case, ways: list[type[Query]]) -> list[Row]:
    """All rows of one pair."""
    clocks = [Clock(query, case.poses) for query in queries_of(case, ways)]
    loops = []
    enough = max(len(case.poses), int(1e4 / microseconds_in_cpp(case, case.poses, 1)))
    for _ in range(ROUNDS):
        loops.append(microseconds_in_cpp(case, case.poses, enough))
        for clock in clocks:
            clock.run_round()
    truth = [true_volume(case, pose) for pose in case.poses]
    rows = [row_of(case, clock, truth) for clock in clocks]
    first = asdict(rows[0])
    q1, median, q3 = np.percentile(loops, [25, 50, 75])
    far = np.eye(4)[None].copy()
    far[0, 2, 3] = 100.0
    first |= dict(variant="in C++", time_us=median, q1_us=q1, q3_us=q3)
    return [Row(**first | dict(apart_us=microseconds_in_cpp(case, far, 10000))), *rows]


def row_of(case: Case, clock: Clock, truth: list[tuple[float, float]]) -> Row:
    """The result of one query."""
    errors, found = [], 0
    for pose, (volume, _) in zip(case.poses, truth, strict=True):
        clock.query.place(pose)
        answer = clock.query.ask()
        found += clock.query.finds(answer)
        measured = clock.query.volume(answer)
        errors.append(math.nan if measured is None else abs(measured / volume - 1.0))
    q1, median, q3 = clock.quartiles()
    return Row(
        case=case.name,
        library=clock.query.library,
        variant=clock.query.variant,
        gives=clock.query.gives,
        time_us=median,
        q1_us=q1,
        q3_us=q3,
        apart_us=clock.apart(),
        poses=len(case.poses),
        found=found,
        volume_error_median=float(np.median(errors)),
        volume_error_worst=float(np.max(errors)),
        reference_error=max(error / volume for volume, error in truth),
        note=clock.query.note,
    )


def text(value: object) -> object:
    """Numbers as short as they are true; nothing for a number that is not there."""
    if not isinstance(value, float):
        return value
    return "" if math.isnan(value) else f"{value:.3g}"


def main() -> None:
    """Measures all pairs and writes them as CSV."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, help="CSV file to write")
    parser.add_argument("--only", default="", help="pairs whose name contains this")
    arguments = parser.parse_args()
    ways = peers()
    rows: list[Row] = []
    for case in all_cases():
        if arguments.only not in case.name:
            continue
        rows += measure(case, ways)
        for row in rows:
            if row.case == case.name:
                print(
                    f"{row.case:26} {row.library:11} {row.variant:22} {row.time_us:10.3f} us, "
                    f"error {row.volume_error_median:.1e}, {row.found} of {row.poses}",
                    flush=True,
                )
    if arguments.out:
        with arguments.out.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(field.name for field in fields(Row))
            writer.writerows([text(value) for value in asdict(row).values()] for row in rows)


if __name__ == "__main__":
    main()
