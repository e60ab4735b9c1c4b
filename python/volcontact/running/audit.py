# SPDX-License-Identifier: Apache-2.0
"""The audit of a run: in which step contact made most energy, and where.

Over a step contact may give back what it holds and no more (docs/theory.md, "No energy from
nothing"), so what it made is negative, up to what gravity does meanwhile and an explicit step errs
by.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

_ROUNDING = 1e-12  # of the largest energy of a run


class Audit(NamedTuple):
    """The step of a run in which contact made most energy.

    Attributes:
        made: work of the contacts and what they stored more, less what mocap bodies did on them
            [J]; 0 where contact made none in any step, but for rounding.
        time: at the end of that step [s].
        share: `made` over the kinetic and elastic energy at its begin [-]; 0 where none was made.
        geoms: names of the geoms in contact at its begin, else at its end, those with the largest
            force first.
    """

    made: float
    time: float
    share: float
    geoms: tuple[tuple[str, str], ...]

    def summary(self) -> dict[str, Any]:
        """As of JSON: `made` [J], `time` [s], `share` [-], `geoms`."""
        return {**self._asdict(), "geoms": [list(pair) for pair in self.geoms]}


def worst_step(
    time: np.ndarray,
    made: np.ndarray,
    energy: np.ndarray,
    sites_of: Callable[[int], np.ndarray],
    name_of: Callable[[int], str],
) -> Audit:
    """The worst step of a run.

    Args:
        time: of each instant [s], shape (n,).
        made: in the step that ended there [J], shape (n,).
        energy: kinetic and elastic there [J], shape (n,).
        sites_of: the contact sites at an instant: `geom_a`, `geom_b` and `force`.
        name_of: the name of a geom.

    Returns:
        The audit; its `made` is 0 where nothing was made, and then no geoms are named.
    """
    row = int(np.argmax(made)) if len(made) else 0
    if not len(made) or not made[row] > _ROUNDING * float(np.max(energy)):
        return Audit(0.0, float(time[row]) if len(time) else 0.0, 0.0, ())
    sites = sites_of(row - 1) if row else sites_of(row)
    if not len(sites):
        sites = sites_of(row)
    order = np.argsort(-np.linalg.norm(sites["force"], axis=1), kind="stable")
    pairs = dict.fromkeys(
        (name_of(int(sites["geom_a"][i])), name_of(int(sites["geom_b"][i]))) for i in order
    )
    before = float(energy[max(row - 1, 0)])
    share = float(made[row]) / before if before > 0.0 else float("inf")
    return Audit(float(made[row]), float(time[row]), share, tuple(pairs))
