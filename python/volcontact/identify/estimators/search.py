# SPDX-License-Identifier: Apache-2.0
"""Estimators that see one number a trial: CMA-ES and optuna, for impacts and chaos."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from volcontact.identify.estimators.scales import Box
from volcontact.identify.pool import Pool
from volcontact.identify.settings import Settings, StudyError

Progress = Callable[[int, int, str], None]
_STOPS = {
    "tolx": "parameters no longer change",
    "tolfun": "the cost no longer changes",
    "tolfunhist": "the cost no longer changes",
    "tolfunrel": "the cost no longer changes",
    "tolstagnation": "the cost no longer falls",
    "tolflatfitness": "the cost is flat",
    "tolfacupx": "the search ran away",
    "maxfevals": "the evaluations ran out",
    "maxiter": "the iterations ran out",
}
_GOOD = ("tolx", "tolfun", "tolfunhist", "tolfunrel", "tolstagnation", "tolflatfitness")


@dataclass
class Evaluations:
    """Costs of all trials at all points so far; a file keeps them, so that a search goes on.

    Args:
        settings: of the study.
        file: to keep them in; None keeps none.

    Raises:
        StudyError: the file is of another study.
    """

    settings: Settings
    file: Path | None = None
    points: list[np.ndarray] = field(default_factory=list)
    costs: list[np.ndarray] = field(default_factory=list)
    _known: dict[bytes, np.ndarray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.file is None:
            return
        self._sign = signature(self.settings)
        if self.file.exists():
            self._read(self.file)
        else:
            self.file.write_text(json.dumps({"study": self._sign}) + "\n", encoding="utf-8")

    def _read(self, file: Path) -> None:
        lines = file.read_text(encoding="utf-8").splitlines()
        if not lines or json.loads(lines[0]).get("study") != self._sign:
            raise StudyError(
                f"{file}: is of another study, or of this one before it changed; give another "
                "folder, or remove it"
            )
        for line in lines[1:]:
            try:
                entry = json.loads(line)
            except json.JSONDecodeError:  # cut off in the middle of a line
                continue
            point = np.array(entry["point"])
            self._known[point.tobytes()] = np.array(entry["costs"], float)

    def of(self, pool: Pool, box: Box, points: list[np.ndarray]) -> list[np.ndarray]:
        """Costs of all trials at each point, shape (trials,) each."""
        asked = [p for p in points if p.tobytes() not in self._known]
        if asked:
            results = pool.run("costs", [(box.values(p), None) for p in asked])
            for point, result in zip(asked, results, strict=True):
                costs = np.array(result)
                self._known[point.tobytes()] = costs
                self._keep(point, costs)
        found = [self._known[p.tobytes()] for p in points]
        self.points += points
        self.costs += found
        return found

    def _keep(self, point: np.ndarray, costs: np.ndarray) -> None:
        if self.file is None:
            return
        with self.file.open("a", encoding="utf-8") as out:
            out.write(json.dumps({"point": point.tolist(), "costs": costs.tolist()}) + "\n")


def signature(settings: Settings) -> str:
    """Tells studies apart: their text, their scene and their measurements."""
    digest = hashlib.sha256(settings.text.encode())
    for path in (settings.scene, *settings.files):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def total(settings: Settings, box: Box, point: np.ndarray, costs: np.ndarray) -> float:
    """The cost of a point: mean over trials for `absolute`, else their sum; and of the priors."""
    prior = 0.5 * float(np.sum(box.prior(point) ** 2))
    if settings.estimator.loss == "absolute":
        return float(np.mean(costs)) + prior / len(costs)
    return float(np.sum(costs)) + prior


@dataclass(frozen=True)
class Found:
    """The best point of an estimator.

    Attributes:
        point: in the box.
        cost: there.
        converged: whether the estimator ended by itself.
        reason: why it ended.
        evaluations: of all trials.
    """

    point: np.ndarray
    cost: float
    converged: bool
    reason: str
    evaluations: int


def search(
    settings: Settings, pool: Pool, box: Box, log: Evaluations, progress: Progress | None = None
) -> Found:
    """Looks for the best point.

    Raises:
        ModuleNotFoundError: the estimator is not installed.
    """
    estimator = settings.estimator
    run = _cma if estimator.method == "cma" else _optuna
    generator = np.random.default_rng(estimator.seed)
    first = np.clip(box.point(pool.start), 0.0, 1.0)
    best: Found | None = None
    for number in range(estimator.starts):
        begin = first if number == 0 else generator.uniform(0.0, 1.0, len(first))

        def cost(points: list[np.ndarray], done: int, shift: int = number) -> list[float]:
            found = [
                total(settings, box, p, c)
                for p, c in zip(points, log.of(pool, box, points), strict=True)
            ]
            if progress is not None:
                every = estimator.starts * estimator.evaluations
                progress(shift * estimator.evaluations + done, every, f"cost {min(found):.6g}")
            return found

        found = run(settings, begin, estimator.seed + number, cost)
        if best is None or found.cost < best.cost:
            best = found
    assert best is not None
    return best


def _cma(settings: Settings, begin: np.ndarray, seed: int, cost: Any) -> Found:
    import cma

    estimator = settings.estimator
    options: dict[str, Any] = {
        "bounds": [0.0, 1.0],
        "seed": seed + 1,
        "maxfevals": estimator.evaluations,
        "tolx": estimator.tolerance,
        "tolfun": 1e-9,
        "verbose": -9,
        "verb_log": 0,
        "verb_disp": 0,
    }
    if estimator.population:
        options["popsize"] = estimator.population
    # One parameter is too few for it: a second one that does nothing helps.
    padded = begin if len(begin) > 1 else np.append(begin, 0.5)
    state = cma.CMAEvolutionStrategy(np.clip(padded, 1e-3, 1 - 1e-3), estimator.spread, options)
    best, best_cost, done = begin, math.inf, 0
    while not state.stop():
        asked = [np.asarray(each, float) for each in state.ask()]
        points = [each[: len(begin)].copy() for each in asked]
        done += len(points)
        costs = cost(points, done)
        state.tell(asked, costs)
        least = int(np.argmin(costs))
        if costs[least] < best_cost:
            best, best_cost = points[least], costs[least]
    middle = np.clip(np.asarray(state.result.xfavorite)[: len(begin)], 0.0, 1.0)
    middle_cost = cost([middle], done)[0]
    if middle_cost < best_cost:
        best, best_cost = middle, middle_cost
    stops = list(state.stop())
    converged = any(word in _GOOD for word in stops)
    reason = ", ".join(dict.fromkeys(_STOPS.get(word, word) for word in stops))
    return Found(best, best_cost, converged, reason, done + 1)


def _optuna(settings: Settings, begin: np.ndarray, seed: int, cost: Any) -> Found:
    import optuna

    optuna.logging.set_verbosity(optuna.logging.ERROR)
    estimator = settings.estimator
    study = optuna.create_study(sampler=optuna.samplers.TPESampler(seed=seed))
    names = [each.name for each in settings.parameters]
    study.enqueue_trial(dict(zip(names, begin.tolist(), strict=True)))
    best, best_cost, last_better = begin, math.inf, 0
    for done in range(1, estimator.evaluations + 1):
        trial = study.ask()
        point = np.array([trial.suggest_float(name, 0.0, 1.0) for name in names])
        value = cost([point], done)[0]
        study.tell(trial, value)
        if value < best_cost:
            is_better = done == 1 or best_cost - value > estimator.tolerance * abs(best_cost)
            best, best_cost = point, value
            last_better = done if is_better else last_better
    settled = estimator.evaluations - last_better >= estimator.evaluations // 4
    reason = f"the last better point was evaluation {last_better} of {estimator.evaluations}"
    return Found(best, best_cost, settled, reason, estimator.evaluations)
