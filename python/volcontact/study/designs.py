# SPDX-License-Identifier: Apache-2.0
"""Where trials lie in the unit cube, for methods that know all trials beforehand.

Points come in aligned blocks of trials, so that those of a trial depend on the seed and its number
alone, never on who asks for them or on how many trials there are in a batch.
"""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

from volcontact.study.file.settings import Settings
from volcontact.study.inputs import Quantiles, signature_takes

BLOCK = 256


def trial_generator(seed: int, trial: int) -> np.random.Generator:
    """Random numbers of a trial's own, for the user's functions."""
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, 1, trial])))


class Design:
    """The points of a study's trials.

    Args:
        settings: of the study.

    Attributes:
        trials: how many there are; some methods take fewer than were asked for.
    """

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._sample = settings.sample
        self.quantiles = Quantiles(settings)
        self._dimension = self.quantiles.dimension
        self._whole: np.ndarray | None = None
        self.trials = self._sample.trials
        method = self._sample.method
        if method in ("latin_hypercube", "morris", "saltelli"):
            self._whole = getattr(self, f"_{method}")()
            self.trials = len(self._whole)
        elif method == "grid":
            self._lengths = [each.points or len(each.choices) for each in settings.inputs]
            self.trials = int(np.prod(self._lengths))
        self.block = functools.lru_cache(maxsize=8)(self._block)

    def values(self, trials: np.ndarray) -> dict[str, np.ndarray]:
        """Values of the inputs of some trials, by column."""
        blocks, inside = np.divmod(trials, BLOCK)
        parts: dict[str, list[np.ndarray]] = {name: [] for name in self.quantiles.columns}
        order = []
        for number in np.unique(blocks):
            here = np.flatnonzero(blocks == number)
            order.append(here)
            for name, values in self.block(int(number)).items():
                parts[name].append(values[inside[here]])
        back = np.argsort(np.concatenate(order), kind="stable")
        return {name: np.concatenate(values)[back] for name, values in parts.items()}

    def cube(self, number: int) -> np.ndarray:
        """Points of the trials of a block, shape (BLOCK or fewer, dimension)."""
        begin = number * BLOCK
        if self._whole is not None:
            return self._whole[begin : begin + BLOCK]
        if self._sample.method == "sobol":
            return self._sobol(begin)
        if self._sample.method == "grid":
            return self._grid(np.arange(begin, min(begin + BLOCK, self.trials)))
        seed = np.random.SeedSequence([self._sample.seed, 0, number])
        generator = np.random.Generator(np.random.PCG64(seed))
        return generator.random((BLOCK, self._dimension))

    def _block(self, number: int) -> dict[str, np.ndarray]:
        return self.quantiles.values(self.cube(number))

    def _sobol(self, begin: int) -> np.ndarray:
        from scipy.stats import qmc

        engine = qmc.Sobol(self._dimension, scramble=True, **_seeded(qmc.Sobol, self._sample.seed))
        if begin:
            engine.fast_forward(begin)
        return np.asarray(engine.random(BLOCK))

    def _latin_hypercube(self) -> np.ndarray:
        from scipy.stats import qmc

        kind = qmc.LatinHypercube
        engine = kind(self._dimension, **_seeded(kind, self._sample.seed))
        return np.asarray(engine.random(self._sample.trials))

    def _grid(self, trials: np.ndarray) -> np.ndarray:
        """The last input runs fastest. Ends of a bounded distribution are on the grid."""
        cube = np.empty((len(trials), self._dimension))
        rest = trials
        for place in range(self._dimension - 1, -1, -1):
            each, length = self._settings.inputs[place], self._lengths[place]
            rest, index = np.divmod(rest, length)
            cube[:, place] = self._grid_line(each, length)[index]
        return cube

    def _grid_line(self, each: Any, length: int) -> np.ndarray:
        if each.kind == "choice":
            edges = np.concatenate([[0.0], np.cumsum(each.weights)])
            return np.asarray(0.5 * (edges[1:] + edges[:-1]))
        if each.distribution in ("uniform", "loguniform") and length > 1:
            return np.linspace(0.0, 1.0, length)
        return (np.arange(length) + 0.5) / length

    def problem(self) -> dict[str, Any]:
        """The inputs as SALib names them: the unit cube."""
        if self._dimension != len(self._settings.inputs):
            from volcontact.study.file.settings import StudyError

            raise StudyError(
                f"[sample] method = {self._sample.method!r}: takes neither rotations nor inputs "
                "that share a table"
            )
        names = [each.name for each in self._settings.inputs]
        return {
            "num_vars": self._dimension,
            "names": names,
            "bounds": [[0.0, 1.0]] * self._dimension,
        }

    def _morris(self) -> np.ndarray:
        from SALib.sample import morris

        count = max(self._sample.trials // (self._dimension + 1), 2)
        levels = self._sample.options["levels"]
        seed = self._sample.seed % 2**32
        return np.asarray(morris.sample(self.problem(), count, num_levels=levels, seed=seed))

    def _saltelli(self) -> np.ndarray:
        from SALib.sample import sobol

        second = self._sample.options["second_order"]
        each = (2 if second else 1) * self._dimension + 2
        count = 2 ** max(int(np.log2(max(self._sample.trials // each, 2))), 1)
        seed = self._sample.seed % 2**32
        return np.asarray(sobol.sample(self.problem(), count, calc_second_order=second, seed=seed))


def _seeded(kind: Any, seed: int) -> dict[str, Any]:
    name = "rng" if signature_takes(kind.__init__, "rng") else "seed"
    return {name: np.random.default_rng(np.random.SeedSequence([seed, 0]))}
