# SPDX-License-Identifier: Apache-2.0
"""How much the errors of a trial count, for estimators that see one number a trial."""

from __future__ import annotations

import numpy as np

from volcontact.identify.bench import LOST
from volcontact.identify.settings import Settings


def rho(loss: str, squares: np.ndarray) -> np.ndarray:
    """Robust losses of squared errors, as scipy has them."""
    if loss == "soft_l1":
        return 2.0 * (np.sqrt(1.0 + squares) - 1.0)
    if loss == "huber":
        return np.where(squares <= 1.0, squares, 2.0 * np.sqrt(squares) - 1.0)
    if loss == "cauchy":
        return np.log1p(squares)
    return squares


def trial_cost(settings: Settings, raw: dict[str, np.ndarray]) -> float:
    """Cost of a trial.

    With the loss `absolute` the mean size of the errors of each measure [sigma], added up with
    their weights; else half the sum over all samples of the loss of the squared size.
    """
    estimator = settings.estimator
    total = 0.0
    for each in settings.measures:
        if not each.weight or not raw[each.name].size:
            continue
        size = np.linalg.norm(raw[each.name], axis=1) / each.sigma
        size = np.nan_to_num(size, nan=LOST, posinf=LOST)
        if estimator.loss == "absolute":
            total += each.weight * float(np.mean(np.minimum(size, LOST)))
        else:
            scale = estimator.loss_scale
            squares = each.weight * (size / scale) ** 2
            total += 0.5 * scale**2 * float(np.sum(rho(estimator.loss, squares)))
    return total
