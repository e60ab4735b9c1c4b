# SPDX-License-Identifier: Apache-2.0
"""Least squares over parameters and the numbers of each trial, from several first guesses."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from volcontact.identify.estimators.costs import rho
from volcontact.identify.estimators.own_numbers import settled
from volcontact.identify.estimators.scales import Box
from volcontact.identify.estimators.search import Found, Progress, signature
from volcontact.identify.pool import Pool
from volcontact.identify.settings import Settings, StudyError

_DENSE = 4e6  # numbers of a Jacobian that is kept whole
_MOVED_STEP = 1e-3  # of differences by the numbers of a trial [sd]
_MOVED_MOST = 8.0  # how far these may go [sd]
_ROUNDS, _GAIN = 3, 0.01  # in which starts are looked for anew, and what it must gain


class Residuals:
    """Errors of all samples, of priors and of the numbers of trials, and their derivatives.

    The unknowns are the parameters in the box, and for every trial the numbers that have a
    deviation, in such deviations.

    Attributes:
        count: parameters.
        active: which numbers of a trial are looked for, shape (q,).
    """

    def __init__(
        self, settings: Settings, pool: Pool, box: Box, progress: Progress | None = None
    ) -> None:
        self._settings, self._pool, self._box = settings, pool, box
        self.count = len(settings.parameters)
        self.active = np.flatnonzero(pool.deviations > 0.0)
        self.trials = len(pool.trials)
        self.evaluations = 0
        self._progress = progress
        self.sizes: list[int] = []

    @property
    def unknowns(self) -> int:
        """How many there are."""
        return self.count + self.trials * len(self.active)

    def first(self, point: np.ndarray) -> np.ndarray:
        """Unknowns that begin at a point of the box."""
        return np.concatenate([point, np.zeros(self.unknowns - self.count)])

    def moved(self, unknowns: np.ndarray) -> np.ndarray | None:
        """Numbers of all trials at the unknowns, as of `Bench.deviations`; None: there are none."""
        if not len(self.active):
            return None
        moved = np.zeros((self.trials, len(self._pool.deviations)))
        own = unknowns[self.count :].reshape(self.trials, -1)
        moved[:, self.active] = own * self._pool.deviations[self.active]
        return moved

    def __call__(self, unknowns: np.ndarray) -> np.ndarray:
        """Of shape (rows,): samples of all trials, priors, numbers of trials."""
        point = unknowns[: self.count]
        parts = self._pool.run("errors", [(self._box.values(point), self.moved(unknowns))])[0]
        self.sizes = [len(part) for part in parts]
        self.evaluations += 1
        found = np.concatenate([*parts, self._box.prior(point), unknowns[self.count :]])
        if self._progress is not None:
            most = self._settings.estimator.evaluations
            cost = 0.5 * float(found @ found)
            self._progress(min(self.evaluations, most), most, f"cost {cost:.6g}")
        return found

    def shares(self) -> list[np.ndarray]:
        """When each row of `by_trial` was measured, from 0 at the start of its trial to 1."""
        found = []
        for trial in self._pool.trials:
            end = max(float(trial.times[-1]), 1e-300)
            parts = [
                np.repeat(trial.times[trial.samples[each.name].index] / end, each.width)
                for each in self._settings.measures
                if each.weight
            ]
            found.append(np.concatenate(parts))
        return found

    def by_trial(self, unknowns: np.ndarray) -> list[np.ndarray]:
        """Errors of the samples of each trial."""
        asked = [(self._box.values(unknowns[: self.count]), self.moved(unknowns))]
        parts: list[np.ndarray] = self._pool.run("errors", asked)[0]
        self.evaluations += 1
        return parts

    def own_slopes(self, unknowns: np.ndarray) -> list[np.ndarray]:
        """Derivatives of `by_trial` by the numbers of the trial, shape (samples, q) each."""
        values = self._box.values(unknowns[: self.count])
        points = self._own_points(unknowns)
        results = self._pool.run("errors", [(values, self.moved(point)) for point in points])
        columns = [
            [(up - down) / (2.0 * _MOVED_STEP) for up, down in zip(one, two, strict=True)]
            for one, two in zip(results[::2], results[1::2], strict=True)
        ]
        return [np.stack(each, axis=1) for each in zip(*columns, strict=True)]

    def bounded(self, own: np.ndarray) -> np.ndarray:
        """Numbers of trials within what is looked for."""
        inside: np.ndarray = np.clip(own, -_MOVED_MOST, _MOVED_MOST)
        return inside

    def _own_points(self, unknowns: np.ndarray) -> list[np.ndarray]:
        points = []
        for number in range(len(self.active)):
            for sign in (1.0, -1.0):
                there = unknowns.copy()
                there[self.count + number :: len(self.active)] += sign * _MOVED_STEP
                points.append(there)
        return points

    def jacobian(self, unknowns: np.ndarray) -> Any:
        """By central differences, of shape (rows, unknowns); sparse where it is large."""
        points, steps = [], []
        for place in range(self.count):
            ends = []
            for sign in (1.0, -1.0):
                there = unknowns.copy()
                step = self._settings.estimator.step
                there[place] = min(max(there[place] + sign * step, 0.0), 1.0)
                ends.append(there)
            steps.append(ends[0][place] - ends[1][place])
            points += ends
        points += self._own_points(unknowns)
        asked = [(self._box.values(p[: self.count]), self.moved(p)) for p in points]
        results = [np.concatenate(parts) for parts in self._pool.run("errors", asked)]
        columns = [
            (up - down) / step
            for up, down, step in zip(
                results[0 : 2 * self.count : 2], results[1 : 2 * self.count : 2], steps, strict=True
            )
        ]
        own = results[2 * self.count :]
        moved = [
            (up - down) / (2.0 * _MOVED_STEP) for up, down in zip(own[::2], own[1::2], strict=True)
        ]
        return self._assembled(np.array(columns).T, moved)

    def _assembled(self, columns: np.ndarray, moved: list[np.ndarray]) -> Any:
        from scipy import sparse

        slope = self._box.prior_slope()
        left = np.concatenate([columns, slope])
        if not moved:
            return left
        blocks, begin = [], 0
        for size in self.sizes:
            block = np.stack([each[begin : begin + size] for each in moved], axis=1)
            blocks.append(sparse.csr_matrix(block))
            begin += size
        right = sparse.vstack(
            [
                sparse.block_diag(blocks),
                sparse.csr_matrix((len(slope), self.unknowns - self.count)),
            ]
        )
        own = self.unknowns - self.count
        bottom = sparse.hstack([sparse.csr_matrix((own, self.count)), sparse.identity(own)])
        whole = sparse.vstack([sparse.hstack([sparse.csr_matrix(left), right]), bottom]).tocsr()
        return whole.toarray() if whole.shape[0] * whole.shape[1] <= _DENSE else whole


@dataclass(frozen=True)
class Fit:
    """A solution of least squares.

    Attributes:
        found: the parameters.
        unknowns: with the numbers of the trials.
        residuals: of all rows.
        jacobian: there, weighted by the loss.
        sizes: rows of each trial.
        starts: cost and values of every first guess that was tried.
    """

    found: Found
    unknowns: np.ndarray
    residuals: np.ndarray
    jacobian: Any
    sizes: list[int]
    starts: list[dict[str, Any]]


def solve(
    settings: Settings,
    residuals: Residuals,
    begin: np.ndarray,
    *,
    fixed: int | None = None,
) -> Any:
    """Least squares from one first guess; one parameter may be held."""
    from scipy.optimize import least_squares

    estimator = settings.estimator
    low = np.concatenate(
        [np.zeros(residuals.count), np.full(len(begin) - residuals.count, -_MOVED_MOST)]
    )
    high = np.concatenate(
        [np.ones(residuals.count), np.full(len(begin) - residuals.count, _MOVED_MOST)]
    )
    free = np.ones(len(begin), bool)
    if fixed is not None:
        free[fixed] = False

    def whole(part: np.ndarray) -> np.ndarray:
        found = begin.copy()
        found[free] = part
        return found

    margin = 1e-9
    start = np.clip(begin, low + margin, high - margin)
    loss: Any = "linear" if estimator.loss == "linear" else _Loss(settings, residuals)
    return least_squares(
        lambda part: residuals(whole(part)),
        start[free],
        jac=lambda part: residuals.jacobian(whole(part))[:, free],
        bounds=(low[free], high[free]),
        loss=loss,
        f_scale=estimator.loss_scale,
        x_scale="jac",
        xtol=estimator.tolerance,
        ftol=1e-14,
        gtol=1e-14,
        max_nfev=estimator.evaluations,
    )


class _Loss:
    """The loss of the study for samples; what is known beforehand counts in full."""

    def __init__(self, settings: Settings, residuals: Residuals) -> None:
        self._word, self._residuals = settings.estimator.loss, residuals

    def __call__(self, squares: np.ndarray) -> np.ndarray:
        found = np.array([squares, np.ones_like(squares), np.zeros_like(squares)])
        count = sum(self._residuals.sizes)
        z = squares[:count]
        found[0, :count] = rho(self._word, z)
        if self._word == "soft_l1":
            found[1, :count] = (1.0 + z) ** -0.5
            found[2, :count] = -0.5 * (1.0 + z) ** -1.5
        elif self._word == "huber":
            far = z > 1.0
            root = np.sqrt(np.where(far, z, 1.0))
            found[1, :count] = 1.0 / root
            found[2, :count] = np.where(far, -0.5 / root**3, 0.0)
        else:
            found[1, :count] = 1.0 / (1.0 + z)
            found[2, :count] = -1.0 / (1.0 + z) ** 2
        return found


def fit(
    settings: Settings,
    pool: Pool,
    box: Box,
    file: Path | None = None,
    progress: Progress | None = None,
) -> Fit:
    """The best of several first guesses.

    Args:
        settings: of the study.
        pool: that runs the trials.
        box: of the parameters.
        file: keeps what each first guess led to, so that an interrupted study goes on.
        progress: called with evaluations done, in all, and a note.

    Raises:
        StudyError: the file is of another study.
    """
    estimator = settings.estimator
    generator = np.random.default_rng(estimator.seed)
    first = np.clip(box.point(pool.start), 0.0, 1.0)
    begins = [first] + [
        generator.uniform(0.05, 0.95, len(first)) for _ in range(estimator.starts - 1)
    ]
    kept = _kept(settings, file)
    done: list[dict[str, Any]] = []
    for number, begin in enumerate(begins):
        if number < len(kept):
            done.append(kept[number])
            continue
        residuals = Residuals(settings, pool, box, progress)
        result = _solved(settings, residuals, begin)
        done.append(
            {
                "cost": float(result.cost),
                "unknowns": result.x.tolist(),
                "converged": bool(result.status > 0),
                "reason": _REASONS.get(int(result.status), str(result.message)),
                "evaluations": residuals.evaluations,
            }
        )
        if file is not None:
            text = json.dumps({"study": signature(settings), "starts": done})
            file.write_text(text, encoding="utf-8")
    best = min(done, key=lambda each: each["cost"])
    return _looked_at(settings, pool, box, best, done)


def _solved(settings: Settings, residuals: Residuals, begin: np.ndarray) -> Any:
    """From one first guess; with numbers of trials again from these, while that gains.

    Starts that were found with parameters far off may sit in a valley of their own.
    """
    result = solve(settings, residuals, settled(residuals, residuals.first(begin)))
    for _ in range(_ROUNDS if len(residuals.active) else 0):
        fresh = settled(residuals, residuals.first(result.x[: residuals.count]))
        if _cost(settings, residuals, fresh) > (1.0 - _GAIN) * result.cost:
            break
        again = solve(settings, residuals, fresh)
        if again.cost >= result.cost:
            break
        result = again
    return result


def _cost(settings: Settings, residuals: Residuals, unknowns: np.ndarray) -> float:
    """As `solve` has it."""
    squares = residuals(unknowns) ** 2
    if settings.estimator.loss == "linear":
        return 0.5 * float(squares.sum())
    scale = settings.estimator.loss_scale**2
    return 0.5 * scale * float(_Loss(settings, residuals)(squares / scale)[0].sum())


_REASONS = {
    0: "the evaluations ran out",
    1: "the gradient vanishes",
    2: "the cost no longer changes",
    3: "parameters no longer change",
    4: "neither cost nor parameters change",
}


def _kept(settings: Settings, file: Path | None) -> list[dict[str, Any]]:
    if file is None or not file.exists():
        return []
    content = json.loads(file.read_text(encoding="utf-8"))
    if content.get("study") != signature(settings):
        raise StudyError(
            f"{file}: is of another study, or of this one before it changed; give another "
            "folder, or remove it"
        )
    starts: list[dict[str, Any]] = content["starts"]
    return starts


def _looked_at(
    settings: Settings, pool: Pool, box: Box, best: dict[str, Any], done: list[dict[str, Any]]
) -> Fit:
    residuals = Residuals(settings, pool, box)
    unknowns = np.array(best["unknowns"])
    errors = residuals(unknowns)
    jacobian = residuals.jacobian(unknowns)
    if settings.estimator.loss != "linear":
        jacobian, errors = _weighted(settings, residuals, jacobian, errors)
    found = Found(
        point=unknowns[: residuals.count],
        cost=best["cost"],
        converged=best["converged"],
        reason=best["reason"],
        evaluations=sum(each["evaluations"] for each in done),
    )
    starts = [
        {"cost": each["cost"], **box.values(np.array(each["unknowns"])[: residuals.count])}
        for each in done
    ]
    return Fit(found, unknowns, errors, jacobian, residuals.sizes, starts)


def _weighted(
    settings: Settings, residuals: Residuals, jacobian: Any, errors: np.ndarray
) -> tuple[Any, np.ndarray]:
    """Rows as iteratively reweighted least squares has them at the solution."""
    from scipy import sparse

    slope = _Loss(settings, residuals)((errors / settings.estimator.loss_scale) ** 2)[1]
    root = np.sqrt(slope)
    if sparse.issparse(jacobian):
        return sparse.diags(root) @ jacobian, root * errors
    return root[:, None] * jacobian, root * errors


def degrees(fitted: Fit) -> int:
    """Rows less unknowns, at least 1."""
    return max(len(fitted.residuals) - len(fitted.unknowns), 1)


def noise(settings: Settings, fitted: Fit) -> float:
    """The factor of all sigmas that the residuals ask for; 1 where these are to be believed."""
    if not settings.uncertainty.scale:
        return 1.0
    return math.sqrt(float(fitted.residuals @ fitted.residuals) / degrees(fitted))
