# SPDX-License-Identifier: Apache-2.0
"""What a study costs beside its trials: rates of all engines beside a bare loop, memory, disk.

./run python tests/benchmarks/study_overhead.py [--engines serial processes ...]

Trials of about 20 ms: the sliding box of the tests. Rates are of the time after each engine has
started, until its last batch; beside them the processor time of all processes, which a busy
machine changes less. Then 100,000 trials of a function that does next to nothing.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from process_tree import Process, growth, processes, seconds_between

import volcontact as vc

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "python" / "support"))
ENGINES = ("serial", "processes", "ray", "dask")
DURATION = 3.4  # [s]; about 20 ms of work
INSTANT = "def trial(values, rng):\n    return {'sum': values['x'] + values['y']}\n"
Tree = dict[int, Process]


@dataclass(frozen=True)
class Cost:
    """Of a trial: time of the clock, and of processors by kind of process [s]."""

    wall: float
    processor: dict[str, float]

    @property
    def total(self) -> float:
        """Of all processes."""
        return sum(self.processor.values())


class Bare:
    """A loop that does nothing but step."""

    def __init__(self, path: Path, values: dict[str, np.ndarray]) -> None:
        self._model = vc.load(path)
        self._data = mujoco.MjData(self._model)
        self._number = self._model.numeric("volcontact/material/all/friction").data
        self._values = values

    def cost(self, trials: int) -> Cost:
        """Of a trial."""
        steps = round(DURATION / self._model.opt.timestep)
        with vc.attach(self._model):
            begin, processor = time.perf_counter(), time.process_time()
            for i in range(trials):
                self._number[0] = self._values["friction"][i]
                mujoco.mj_resetData(self._model, self._data)
                self._data.qvel[0] = self._values["speed"][i]
                mujoco.mj_step(self._model, self._data, steps)
            processor = time.process_time() - processor
            return Cost((time.perf_counter() - begin) / trials, {"driver": processor / trials})


class Moments:
    """The processes of a run once some of its trials are done, and at its end."""

    def __init__(self, first: float) -> None:
        self._first = first
        self.seen: list[tuple[int, float, Tree]] = []

    def progress(self, done: int, total: int, outcomes: dict[str, int]) -> None:
        """Called by the study."""
        del outcomes
        if done == total or (not self.seen and done >= self._first * total):
            self.seen.append((done, time.perf_counter(), processes()))

    def cost(self) -> Cost:
        """Of a trial between the two."""
        (n, begin, before), (m, end, after) = self.seen[0], self.seen[-1]
        taken = seconds_between(before, after)
        return Cost((end - begin) / (m - n), {kind: s / (m - n) for kind, s in taken.items()})

    def growth(self) -> dict[str, float]:
        """Of memory between the two, by kind [MB]."""
        return growth(self.seen[0][2], self.seen[-1][2])


def rates(place: Path, trials: int, engines: list[str]) -> None:
    """Costs of a trial of 20 ms, with two workers (serial: one), once the engine has started."""
    from study_files import SCENE, SCENE_STUDY, scene_study

    text = SCENE_STUDY.replace("duration = 0.4", f"duration = {DURATION}\nwatch = 0.01")
    text = text.replace('target = "geom/block/size/2"\n', "")
    text = text.replace('"position/block/x" = [0.08, 0.2]', '"position/block/x" = [9, 9]')
    study = vc.Study(scene_study(place, text, SCENE), trials=trials)
    values = {n: np.resize(v, trials) for n, v in study.check().items()}
    bare = Bare(place / "scene.xml", values)
    alone = [bare.cost(trials // 4)]
    found = {}
    for engine in engines:
        moments = Moments(0.15)
        study.run(place / engine, engine=engine, workers=2, progress=moments.progress)
        found[engine] = moments.cost()
        if engine == "serial":
            alone.append(bare.cost(trials // 4))
    wall = 0.5 * (alone[0].wall + alone[-1].wall)
    total = 0.5 * (alone[0].total + alone[-1].total)
    print(f"bare loop: {1e3 * wall:.2f} ms a trial, {1e3 * total:.2f} ms of a processor")
    serial = found.get("serial", Cost(wall, {"driver": total}))
    for engine, cost in found.items():
        shares = ", ".join(f"{kind} {1e3 * s:.2f}" for kind, s in sorted(cost.processor.items()))
        print(f"{engine}: {1e3 * cost.wall:.2f} ms a trial, {1e3 * cost.total:.2f} of processors")
        print(f"  ({shares});", end=" ")
        if engine == "serial":
            more = 100 * (cost.wall / wall - 1), 100 * (cost.total / total - 1)
            print(f"beside the bare loop {more[0]:+.1f} %, of the processor {more[1]:+.1f} %")
        else:
            possible = 2.0 * serial.total / cost.total
            print(f"{serial.wall / cost.wall:.2f} x serial, by the processors {possible:.2f} x")
    disk = sum(p.stat().st_size for p in (place / engines[0] / "trials").iterdir()) / trials
    print(f"a row of the scene with all its columns: {disk:.0f} bytes")


def short_trials(place: Path, trials: int, engines: list[str]) -> None:
    """Rate, memory and disk of trials that do next to nothing."""
    from study_files import function_study

    path = function_study(place)
    (place / "functions.py").write_text(INSTANT)
    path.write_text(path.read_text().replace('"sum", "noise"', '"sum"'))
    study = vc.Study(path, trials=trials)
    for engine in engines:
        moments = Moments(0.1)
        study.run(place / engine, engine=engine, workers=2, progress=moments.progress)
        disk = sum(p.stat().st_size for p in (place / engine / "trials").iterdir()) / trials
        rate, grown = 1.0 / moments.cost().wall, moments.growth()
        told = ", ".join(f"{kind} {more:+.1f}" for kind, more in sorted(grown.items()))
        print(f"{engine}, {trials} short trials: {rate:.0f} a second, {disk:.0f} bytes a row;")
        print(f"  memory from the first tenth on [MB]: {told}")


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--trials", type=int, default=1500)
    parser.add_argument("--short", type=int, default=100_000)
    parser.add_argument("--engines", nargs="+", choices=ENGINES, default=list(ENGINES))
    given = parser.parse_args()
    parts: list[tuple[int, Callable[[Path, int, list[str]], None]]] = [
        (given.trials, rates),
        (given.short, short_trials),
    ]
    for trials, measure in parts:
        if trials:
            with tempfile.TemporaryDirectory() as folder:
                measure(Path(folder), trials, given.engines)


if __name__ == "__main__":
    main()
