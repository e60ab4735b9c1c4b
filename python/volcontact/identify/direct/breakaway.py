# SPDX-License-Identifier: Apache-2.0
"""The load at which a sled breaks away, from a record of load and displacement.

Until then the sled sticks on its bristles, and its way grows with the load alone. From the moment
t_b on the load is above the friction by r (t - t_b), so the way is

    x = load / sigma_0 + x_0 + r (t - t_b)^3 / (6 m):

the cube root of what is beyond the elastic line is a straight line in time, and t_b is its zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

_STUCK = (0.05, 0.7)  # of the load at the first clear motion: where the elastic line is fitted
_LEAST = 4  # samples for the line of cube roots


@dataclass(frozen=True)
class Breakaway:
    """When and at which load a sled broke away.

    Attributes:
        time: [s].
        load: along the plane, of what was given (force [N], or an angle).
        slope: of the elastic line before it, displacement over load.
    """

    time: float
    load: float
    slope: float


def breakaway(
    time: Sequence[float] | np.ndarray,
    load: Sequence[float] | np.ndarray,
    displacement: Sequence[float] | np.ndarray,
    *,
    threshold: float,
) -> Breakaway:
    """Finds the breakaway in a record of a load that rises steadily.

    Args:
        time: [s], rising, shape (n,).
        load: force [N] or angle of a tilting table [rad], rising, shape (n,).
        displacement: of the sled against its base [m], shape (n,).
        threshold: displacement beyond the elastic line that is clearly seen, several times the
            noise [m]; so small that the sled is still slow against stribeck_speed there.

    Raises:
        ValueError: the record has no breakaway, or too few samples of it.
    """
    t, F, x = (np.asarray(each, float) for each in (time, load, displacement))
    if not (t.shape == F.shape == x.shape) or t.ndim != 1:
        raise ValueError(
            f"time, load and displacement have {t.shape}, {F.shape} and {x.shape} samples: give as "
            "many of each"
        )
    if not threshold > 0.0:
        raise ValueError(f"threshold = {threshold:g} [m]: must be above 0")
    if len(t) < 2 * _LEAST:
        raise ValueError(f"a record of {len(t)} samples is too short: sample it faster")
    first = int(np.argmax(np.abs(x - x[0]) > 20.0 * threshold)) or len(t)
    slope, start = 0.0, float(x[0])
    for _ in range(3):  # where it moves clearly hangs on the elastic line, and the reverse
        seen = F[: max(first, 2)]
        span = seen.max() - seen.min()
        stuck = slice(
            int(np.searchsorted(seen, seen.min() + _STUCK[0] * span)),
            max(int(np.searchsorted(seen, seen.min() + _STUCK[1] * span)), _LEAST),
        )
        if np.ptp(F[stuck]) > 0.0:
            slope, start = (float(c) for c in np.polyfit(F[stuck], x[stuck], 1))
        beyond = x - start - slope * F
        # From where it stays beyond: a sled that was just let go springs back at first.
        below = np.flatnonzero(beyond <= threshold)
        first = int(below[-1]) + 1 if len(below) else 0
        if first >= len(t):
            raise ValueError(
                "the record has no breakaway: the displacement never leaves the elastic line by "
                f"{threshold:g} m; raise the load further, or lower threshold"
            )
    last = (
        first + int(np.argmax(beyond[first:] > 8.0 * threshold))
        if np.any(beyond[first:] > 8.0 * threshold)
        else len(t)
    )
    chosen = slice(first, last)
    if last - first < _LEAST:
        raise ValueError(
            f"only {last - first} samples lie between {threshold:g} and {8.0 * threshold:g} m: "
            "sample faster, or raise the load more slowly"
        )
    root = np.cbrt(beyond[chosen])
    rise, at_zero = np.polyfit(t[chosen] - t[first], root, 1)
    if not rise > 0.0:
        raise ValueError("the sled does not speed up after the breakaway: lower threshold")
    begin = float(t[first] - at_zero / rise)
    return Breakaway(begin, float(np.interp(begin, t, F)), slope)
