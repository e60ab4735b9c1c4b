# SPDX-License-Identifier: Apache-2.0
"""volcontact itself: from Python like the peers, and in a loop in C++."""

from __future__ import annotations

from typing import Any

import numpy as np
import volcontact_timing

import volcontact as vc

from .cases import Case


class FromPython:
    """vc.interference, as a user calls it."""

    library, variant, gives = "volcontact", "from Python", "volume"
    note = "volume, centroid, inertia, area vector and moment, depth, sites"

    def __init__(self, case: Case) -> None:
        self.case, self.pose = case, np.eye(4)

    def place(self, pose: np.ndarray) -> None:
        """Sets the pose of B in A."""
        self.pose = pose

    def ask(self) -> Any:
        """The query."""
        case = self.case
        return vc.interference(
            case.a.ours, case.b.ours, self.pose, engine=case.engine, tolerance=case.tolerance
        )

    def finds(self, answer: Any) -> bool:
        """Whether they overlap."""
        return answer.volume > 0.0

    def volume(self, answer: Any) -> float:
        """The volume [m^3]."""
        return answer.volume


def microseconds_in_cpp(case: Case, poses: np.ndarray, queries: int) -> float:
    """One query without any Python, on one thread: mean processor time over the poses [us]."""
    nanoseconds = volcontact_timing.time_queries(
        case.a.ours,
        case.b.ours,
        poses,
        tolerance=case.tolerance,
        engine=case.engine,
        queries=queries,
    )
    return 1e-3 * nanoseconds


def true_volume(case: Case, pose: np.ndarray) -> tuple[float, float]:
    """Volume [m^3] by something that shares nothing with the engines, and its own error [m^3]."""
    if case.exact is not None:
        return case.exact(case.a, case.b, pose), 0.0
    within = 2.0 * min(case.a.size, case.b.size)
    return volcontact_timing.reference_volume(case.a.ours, case.b.ours, pose, within)
