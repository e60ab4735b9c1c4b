# SPDX-License-Identifier: Apache-2.0
"""The order of a study: rounds of trials, each known once all rounds before it have results."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from volcontact.study.designs import Design
from volcontact.study.file.settings import ADAPTIVE, Settings

Values = dict[str, np.ndarray]


@dataclass(frozen=True)
class Round:
    """Trials that can run at once.

    Attributes:
        first: number of the first one.
        count: how many.
        values: of the inputs of trials of this round, by column.
    """

    first: int
    count: int
    values: Callable[[np.ndarray], Values]


class Plan:
    """All rounds of a study.

    Args:
        settings: of the study.

    Attributes:
        trials: how many there are, at most.
    """

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._is_adaptive = settings.sample.method in ADAPTIVE
        self.response = settings.sample.options.get("response") if self._is_adaptive else None
        if self._is_adaptive:
            self.trials = settings.sample.trials
        else:
            self._design = Design(settings)
            self.trials = self._design.trials

    def rounds(self) -> Iterator[Round]:
        """The rounds; those of an adaptive method are sent the responses of the one before."""
        if not self._is_adaptive:
            yield Round(0, self.trials, self._design.values)
            return
        from volcontact.study import adaptive

        method = getattr(adaptive, self._settings.sample.method)
        steps = method(self._settings)
        first = 0
        responses: np.ndarray | None = None
        while first < self.trials:
            try:
                values = steps.send(responses)
            except StopIteration:
                return
            count = min(len(next(iter(values.values()))), self.trials - first)
            responses = yield _fixed(first, count, values)
            first += count

    def values(self, trial: int) -> dict[str, Any]:
        """Values of one trial of a method that knows all trials beforehand."""
        return row_values(self._design.values(np.array([trial])))[0]


def _fixed(first: int, count: int, values: Values) -> Round:
    def pick(trials: np.ndarray) -> Values:
        return {name: column[trials - first] for name, column in values.items()}

    return Round(first, count, pick)


def row_values(values: Values) -> list[dict[str, Any]]:
    """Columns as rows of Python numbers and texts."""
    lists = {name: column.tolist() for name, column in values.items()}
    names = list(lists)
    return [dict(zip(names, row, strict=True)) for row in zip(*lists.values(), strict=True)]
