# SPDX-License-Identifier: Apache-2.0
"""What the processes of an identification are asked to run."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from volcontact.identify.bench import Bench, Values
from volcontact.identify.estimators.costs import trial_cost

KINDS = ("costs", "errors", "raw", "predicted")


class Task(NamedTuple):
    """What to run: values of the parameters, trials by their places, numbers of each trial."""

    kind: str
    values: Values
    trials: list[int]
    moved: np.ndarray | None = None  # shape (all trials, q)


def run_task(bench: Bench, task: Task) -> list[Any]:
    """The result of each trial: a cost, an array of errors, or what `Bench` gives by measure."""
    found: list[Any] = []
    for trial in task.trials:
        moved = None if task.moved is None else task.moved[trial]
        if task.kind == "errors":
            found.append(bench.errors(task.values, trial, moved))
            continue
        call = bench.predicted if task.kind == "predicted" else bench.raw_errors
        result = call(task.values, trial, moved)
        found.append(trial_cost(bench.settings, result) if task.kind == "costs" else result)
    return found
