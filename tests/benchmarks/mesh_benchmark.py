# SPDX-License-Identifier: Apache-2.0
"""Time and value of one query of a pair with triangle meshes: volcontact and other libraries.

    ./run benchmark

runs it and all other benchmarks. All libraries see the same triangles at the same poses, in turns.
Ours is timed in a loop in C++, the others from Python, CGAL in its own program; times are processor
times, the median of each pose over the turns and then over the poses. Ours is timed twice: drifting
slowly from each pose, as from step to step of a simulation, and from pose to pose, where nothing
that the memory caches hold is of use. The slower ones see fewer poses. What a library takes to
build its solids does not count.
"""

from __future__ import annotations

import argparse
import csv
import importlib
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from peers.cases import Case, pose_of, turn
from peers.library import Unsupported
from peers.mesh_cases import all_cases
from peers.ours import FromPython, microseconds_in_cpp
from peers_benchmark import text

import volcontact as vc

TURNS = 15
LEAST = 2  # turns, and poses of those a case has
SECONDS = 0.3  # of one library on one pair: slower ones take fewer turns and poses
LOOP = 1e3  # our own loop in one turn [us]
DRIFT, DRIFTS = 1e-6, 32  # of the size of B, and poses of one course
WAYS = {  # what to import, and its ways to ask
    "peers.exact_meshes": ("MeshBoolean", "Corefinement"),
    "peers.mesh_surfaces": ("MeshHydroelastic",),
    "peers.mujoco_geoms": ("Hull", "MeshSdf"),
}


@dataclass
class Row:
    """One library on one pair: a line of the results.

    The errors are the worst over the poses, beside ours, or beside a formula where there is one: of
    the volume and the inertia relative, of the centroid by the cube root of the volume. The bound
    is what our answer itself says, relative.
    """

    case: str
    library: str
    variant: str
    gives: str
    time_us: float
    q1_us: float
    q3_us: float
    poses: int
    found: int
    volume_error: float
    centroid_error: float
    inertia_error: float
    volume_bound: float
    status: str
    note: str


@dataclass
class Answer:
    """What one way says at one pose; None for what it does not say."""

    found: bool
    volume: float | None
    moments: Any
    bound: float
    status: str


class Course:
    """The times of one way on one pair, turn by turn, and its answers."""

    def __init__(self, query: Any, poses: np.ndarray) -> None:
        self.query = query
        self.times: list[np.ndarray] = []  # of each turn, of each pose [us]
        self.answers: list[Answer] = []
        self._ask(poses[0])
        once = max(1e-3, self._ask(poses[0]))
        afforded = 1e6 * SECONDS / once
        self.poses = poses[: max(LEAST, min(len(poses), int(afforded / LEAST)))]
        self.turns = max(LEAST, min(TURNS, int(afforded / len(self.poses))))

    def _ask(self, pose: np.ndarray) -> float:
        """Time of one query [us]."""
        self.query.place(pose)
        begin = time.process_time_ns()
        self.answer = self.query.ask()
        here = 1e-3 * (time.process_time_ns() - begin)
        return getattr(self.query, "spent_us", here)  # a program of its own says what it took

    def _judge(self) -> Answer:
        """Of the last query, while its pose still stands."""
        query, answer = self.query, self.answer
        moments = query.moments(answer) if getattr(query, "is_exact", False) else None
        found, volume = bool(query.finds(answer)), query.volume(answer)
        return Answer(found, volume, moments, *says_of_itself(answer))

    def run_turn(self) -> None:
        """Every pose once."""
        spent = []
        for pose in self.poses:
            spent.append(self._ask(pose))
            if not self.times:
                self.answers.append(self._judge())
        self.times.append(np.array(spent))


def says_of_itself(answer: Any) -> tuple[float, str]:
    """Bound of the error of the volume, relative, and status: of our answers only."""
    if not isinstance(answer, vc.Interference):
        return math.nan, ""
    return (answer.volume_error / answer.volume if answer.volume else 0.0), answer.status


class InCpp(FromPython):
    """Ours, asked from Python and timed in C++."""

    variant, is_exact = "in C++", True

    def moments(self, answer: Any) -> Any:
        """Of the overlap, in A."""
        return answer


class OurCourse(Course):
    """In C++, drifting from each pose."""

    def run_turn(self) -> None:
        """Every pose, at least once."""
        if not self.times:
            super().run_turn()
            self.queries = np.maximum(1, LOOP / self.times[0]).astype(int)
            self.courses = [drift(pose, self.query.case.b.size) for pose in self.poses]
        self.times.append(self._measure())

    def _measure(self) -> np.ndarray:
        ask = zip(self.courses, self.queries, strict=True)
        return np.array([microseconds_in_cpp(self.query.case, c, int(n)) for c, n in ask])


class FromPoseToPose(OurCourse):
    """In C++, all poses over and over."""

    def _measure(self) -> np.ndarray:
        mean = microseconds_in_cpp(self.query.case, self.poses, int(self.queries.mean()))
        return np.full(len(self.poses), mean)


class Jumping(InCpp):
    """Ours, never twice at the same pose."""

    variant = "from pose to pose in C++"


def drift(pose: np.ndarray, size: float) -> np.ndarray:
    """Poses along a slow motion that begins at one."""
    steps = np.arange(DRIFTS) if np.isfinite(size) else np.zeros(1)
    way = DRIFT * size * np.array([1.0, -2.0, 1.5])
    return np.array([pose @ pose_of(turn((1, 2, 3), DRIFT * k), k * way) for k in steps])


def ways_to_ask() -> list[type]:
    """Those of all libraries that are installed."""
    found: list[type] = []
    for module, names in WAYS.items():
        try:
            loaded = importlib.import_module(module)
        except ImportError as missing:
            print(f"{module} is left out: {missing}", flush=True)
            continue
        found += [getattr(loaded, name) for name in names]
    return found


def measure(case: Case, ways: Sequence[type]) -> list[Row]:
    """All rows of one pair, ours first."""
    ours = OurCourse(InCpp(case), case.poses)
    courses: list[Course] = [ours, FromPoseToPose(Jumping(case), case.poses)]
    for way in ways:
        try:
            courses.append(Course(way(case.a, case.b), case.poses))
        except Unsupported:
            continue
    for number in range(TURNS):
        for course in courses:
            if number < course.turns:
                course.run_turn()
    for course in courses[:2]:
        course.times = course.times[1:]  # the first was asked from Python
    truths = [case.exact(case.a, case.b, pose) if case.exact else None for pose in ours.poses]
    return [row_of(case, course, ours.answers, truths) for course in courses]


def errors_of(
    answer: Answer, ours: Answer, truth: float | None, *, is_ours: bool
) -> tuple[float, float, float]:
    """Of volume, centroid and inertia; NaN for what is not compared."""
    if truth is not None or answer.moments is None:
        volume = ours.volume if truth is None else truth
        found = math.nan if answer.volume is None else _relative(answer.volume, volume)
        return found, math.nan, math.nan
    if is_ours:
        return math.nan, math.nan, math.nan
    mine, other = ours.moments, answer.moments
    if other.volume == 0.0 or mine.volume == 0.0:
        worst = 0.0 if other.volume == mine.volume else math.inf
        return worst, worst, worst
    centroid = np.abs(mine.centroid - other.centroid).max() / np.cbrt(other.volume)
    inertia = np.abs(mine.inertia - other.inertia).max() / np.abs(other.inertia).max()
    return _relative(mine.volume, other.volume), float(centroid), float(inertia)


def _relative(value: float, reference: float) -> float:
    return abs(value / reference - 1.0) if reference else (0.0 if value == 0.0 else math.inf)


def row_of(
    case: Case, course: Course, ours: Sequence[Answer], truths: Sequence[float | None]
) -> Row:
    """The result of one way."""
    query, answers = course.query, course.answers
    is_ours = query.library == "volcontact"
    # Of two ways that see different numbers of poses, one sees the first ones of the other's.
    errors = [
        errors_of(answer, mine, truth, is_ours=is_ours)
        for answer, mine, truth in zip(answers, ours, truths, strict=False)
    ]
    worst = np.max(errors, axis=0)
    q1, median, q3 = np.percentile(np.median(course.times, axis=0), [25, 50, 75])
    return Row(
        case=case.name,
        library=query.library,
        variant=query.variant,
        gives=query.gives,
        time_us=median,
        q1_us=q1,
        q3_us=q3,
        poses=len(answers),
        found=sum(answer.found for answer in answers),
        volume_error=float(worst[0]),
        centroid_error=float(worst[1]),
        inertia_error=float(worst[2]),
        volume_bound=max(answer.bound for answer in answers),
        status=" ".join(sorted({answer.status for answer in answers})),
        note=query.note,
    )


def main() -> None:
    """Measures all pairs and writes them as CSV."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, help="CSV file to write")
    parser.add_argument("--only", default="", help="pairs whose name contains this")
    arguments = parser.parse_args()
    ways = ways_to_ask()
    rows: list[Row] = []
    for case in all_cases():
        if arguments.only not in case.name:
            continue
        for row in measure(case, ways):
            rows.append(row)
            print(
                f"{row.case:34} {row.library:11} {row.variant:21} {row.time_us:12.3f} us, "
                f"errors {row.volume_error:.1e} {row.centroid_error:.1e} {row.inertia_error:.1e}, "
                f"{row.found} of {row.poses} {row.status}",
                flush=True,
            )
    if arguments.out:
        with arguments.out.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(field.name for field in fields(Row))
            writer.writerows([text(getattr(row, f.name)) for f in fields(Row)] for row in rows)


if __name__ == "__main__":
    main()
