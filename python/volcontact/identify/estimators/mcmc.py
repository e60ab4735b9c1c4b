# SPDX-License-Identifier: Apache-2.0
"""Samples of the posterior of the parameters, by the affine-invariant ensemble of `emcee`."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from volcontact._files import appearing
from volcontact.identify.estimators.search import Progress
from volcontact.identify.settings import StudyError

LENGTH = 50  # autocorrelation times that a chain must last before it is believed
_CHUNK = 25  # steps between two looks at the clock of the file

LogProbability = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Chain:
    """Samples of a posterior.

    Attributes:
        samples: after burn-in, shape (steps, walkers, n).
        times: integrated autocorrelation time of each unknown [steps], shape (n,).
        accepted: part of the proposals that was taken.
        burn: steps left out at the beginning.
    """

    samples: np.ndarray
    times: np.ndarray
    accepted: float
    burn: int

    @property
    def enough(self) -> bool:
        """Whether it lasts long enough to be believed: `LENGTH` autocorrelation times."""
        return bool(len(self.samples) >= LENGTH * self._longest())

    def _longest(self) -> float:
        return float(np.max(self.times)) if np.isfinite(self.times).all() else math.inf

    def finding(self) -> str:
        """What is to be said of a chain that is too short; else nothing."""
        if self.enough:
            return ""
        time, steps = self._longest(), len(self.samples)
        wanted = "many more" if not math.isfinite(time) else f"{math.ceil(LENGTH * time)} or more"
        return (
            f"The chain is too short to say how well parameters are known: {steps} steps after "
            f"burn-in, autocorrelation time {time:.3g} steps, {LENGTH} times that is needed. "
            f"Intervals are not those of the chain; give mcmc = {wanted} and burn beside them."
        )


@dataclass(frozen=True)
class Request:
    """What is asked of a chain.

    Attributes:
        steps: in all.
        walkers: of the ensemble.
        burn: steps left out.
        seed: of the walk.
        file: that keeps it, so that an interrupted walk goes on; None: none does.
        sign: of the study, in the file.
    """

    steps: int
    walkers: int
    burn: int
    seed: int
    file: Path | None = None
    sign: str = ""


def walk(
    probability: LogProbability,
    middle: np.ndarray,
    spread: np.ndarray,
    request: Request,
    progress: Progress | None = None,
) -> Chain:
    """Walks.

    The same request gives the same chain, also where it was interrupted. [GoodmanWeare2010]

    Args:
        probability: logarithm of the density, up to a constant, of points of shape (m, n): (m,).
        middle: where it begins, shape (n,).
        spread: standard deviations of the first walkers about it, shape (n,).
        request: how long, and by how many.
        progress: called with steps done, in all, and a note.

    Raises:
        ModuleNotFoundError: emcee is not installed.
        StudyError: too few walkers, or the file is of another study.
    """
    import emcee

    count = len(middle)
    if request.walkers < 2 * count + 2:
        raise StudyError(
            f"[uncertainty] walkers = {request.walkers}: {count} unknowns need at least "
            f"{2 * count + 2}; take fewer [nuisance] numbers or trials, or more walkers"
        )
    sampler = emcee.EnsembleSampler(request.walkers, count, probability, vectorize=True)
    kept = _kept(request)
    if kept is None:
        begin = _begin(probability, middle, spread, request)
        draws = np.random.RandomState(request.seed).get_state()
        chain = np.empty((0, request.walkers, count))
        state, accepted = emcee.State(begin, random_state=draws), 0.0
    else:
        chain, accepted = kept["chain"], float(kept["accepted"])
        state = emcee.State(chain[-1], log_prob=kept["probability"], random_state=_unpacked(kept))
    while len(chain) < request.steps:
        steps = min(_CHUNK, request.steps - len(chain))
        sampler.reset()
        state = sampler.run_mcmc(state, steps, skip_initial_state_check=True)
        accepted += float(np.sum(sampler.backend.accepted)) / request.walkers
        chain = np.concatenate([chain, sampler.get_chain()])
        _keep(request, chain, state, accepted)
        if progress is not None:
            progress(len(chain), request.steps, "chain")
    samples = chain[request.burn :]
    times = emcee.autocorr.integrated_time(samples, tol=0, quiet=True)
    return Chain(samples, np.asarray(times), accepted / request.steps, request.burn)


def _begin(
    probability: LogProbability, middle: np.ndarray, spread: np.ndarray, request: Request
) -> np.ndarray:
    """First walkers, drawn anew until each is where something is possible."""
    generator = np.random.default_rng([request.seed, 2])
    begin = np.tile(middle, (request.walkers, 1))
    wrong = np.ones(request.walkers, bool)
    for shrink in 0.5 ** np.arange(30):
        drawn = generator.standard_normal((int(wrong.sum()), len(middle)))
        begin[wrong] = middle + shrink * spread * drawn
        wrong = ~np.isfinite(probability(begin))
        if not wrong.any():
            return begin
    raise StudyError("[uncertainty] mcmc: no walker can begin near the best point")


def _kept(request: Request) -> dict[str, Any] | None:
    if request.file is None or not request.file.exists():
        return None
    with np.load(request.file, allow_pickle=False) as content:
        found = dict(content)
    shape = found["chain"].shape
    if str(found["sign"]) != request.sign or shape[1] != request.walkers:
        raise StudyError(
            f"{request.file}: is of another study, or of this one before it changed; give another "
            "folder, or remove it"
        )
    return found


def _unpacked(kept: dict[str, Any]) -> tuple[str, np.ndarray, int, int, float]:
    place, has_gauss = (int(number) for number in kept["place"])
    return "MT19937", kept["keys"], place, has_gauss, float(kept["gauss"])


def _keep(request: Request, chain: np.ndarray, state: Any, accepted: float) -> None:
    if request.file is None:
        return
    _, keys, place, has_gauss, gauss = state.random_state
    with appearing(request.file) as made, made.open("wb") as out:
        np.savez(
            out,
            sign=request.sign,
            chain=chain,
            probability=state.log_prob,
            accepted=accepted,
            keys=keys,
            place=[place, has_gauss],
            gauss=gauss,
        )
