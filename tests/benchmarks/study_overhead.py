# SPDX-License-Identifier: Apache-2.0
"""What a study costs beside its trials: rates of all engines beside a bare loop, memory, disk.

./run python tests/benchmarks/study_overhead.py

Trials of about 20 ms: the sliding box of the tests. Rates are of the time after each engine has
started, until its last batch. Then 100,000 trials of a function that does next to nothing.
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
import time
from pathlib import Path

import mujoco
import numpy as np

import volcontact as vc

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "python"))
DURATION = 2.0  # [s]; about 20 ms of work

INSTANT = "def trial(values, rng):\n    return {'sum': values['x'] + values['y']}\n"


def bare(path: Path, values: dict[str, np.ndarray], trials: int) -> float:
    """Trials a second of a loop that does nothing but step."""
    model = vc.load(path)
    data = mujoco.MjData(model)
    number = model.numeric("volcontact/material/all/friction").data
    with vc.attach(model):
        begin = time.perf_counter()
        for i in range(trials):
            number[0] = values["friction"][i]
            mujoco.mj_resetData(model, data)
            data.qvel[0] = values["speed"][i]
            mujoco.mj_step(model, data, round(DURATION / model.opt.timestep))
        return trials / (time.perf_counter() - begin)


def rate(study: vc.Study, out: Path, engine: str) -> float:
    """Trials a second of an engine with two workers (serial: one), once it has started."""
    seen: list[tuple[float, int]] = []
    study.run(
        out,
        engine=engine,
        workers=2,
        progress=lambda done, total, outcomes: seen.append((time.perf_counter(), done)),
    )
    warm = next(i for i, (_, done) in enumerate(seen) if done >= 0.1 * seen[-1][1])
    return (seen[-1][1] - seen[warm][1]) / (seen[-1][0] - seen[warm][0])


def resident() -> float:
    """Memory of this process and of its largest child so far [MB]."""
    own = int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize() / 1e6
    return own + resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e3


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--trials", type=int, default=1500)
    parser.add_argument("--short", type=int, default=100_000)
    trials, short = vars(parser.parse_args()).values()
    from study_files import SCENE, SCENE_STUDY, function_study, scene_study

    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        text = SCENE_STUDY.replace("duration = 0.4", f"duration = {DURATION}\nwatch = 0.01")
        text = text.replace('target = "geom/block/size/2"\n', "")
        text = text.replace('"position/block/x" = [0.08, 0.2]', '"position/block/x" = [9, 9]')
        study = vc.Study(scene_study(place, text, SCENE), trials=trials)
        values = {n: np.resize(v, trials) for n, v in study.check().items()}
        alone = bare(place / "scene.xml", values, trials // 4)
        serial = rate(study, place / "serial", "serial")
        again = bare(place / "scene.xml", values, trials // 4)
        alone = 0.5 * (alone + again)
        print(f"bare loop {1e3 / alone:.2f} ms a trial; serial {100 * (alone / serial - 1):+.1f} %")
        for engine in ("processes", "ray", "dask"):
            print(
                f"{engine}, 2 workers: {rate(study, place / engine, engine) / serial:.2f} x serial"
            )
        (place / "short").mkdir()
        path = function_study(place / "short")
        (place / "short" / "functions.py").write_text(INSTANT)
        path.write_text(path.read_text().replace('"sum", "noise"', '"sum"'))
        memory: dict[int, float] = {}

        def watch(done: int, total: int, outcomes: dict[str, int]) -> None:
            memory[done] = resident()

        many = vc.Study(path, trials=short)
        begin = time.perf_counter()
        many.run(place / "many", engine="processes", workers=2, progress=watch)
        took = time.perf_counter() - begin
        tenth = next(m for done, m in memory.items() if done >= short // 10)
        disk = sum(p.stat().st_size for p in (place / "many" / "trials").iterdir()) / short
        print(f"{short} short trials: {short / took:.0f} a second, {disk:.0f} bytes a row,")
        print(f"memory {list(memory.values())[-1] - tenth:+.1f} MB from the first tenth on")
        wide = sum(p.stat().st_size for p in (place / "serial" / "trials").iterdir()) / trials
        print(f"a row of the scene with all its columns: {wide:.0f} bytes")


if __name__ == "__main__":
    main()
