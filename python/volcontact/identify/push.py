# SPDX-License-Identifier: Apache-2.0
"""One solid pushed into another along a straight line: overlap over depth."""

from __future__ import annotations

from typing import Any

import numpy as np

import volcontact._volcontact as core

_FINEST = 1e-15  # of the size of the solid: where touch is looked for
_TOLERANCE = 1e-6  # of the volume
_NEWTON = 60


class Push:
    """Solid A above solid B, pushed down along -z.

    Args:
        a: the solid that moves.
        b: the solid that rests, at the origin; a half-space fills z <= 0.
        X_BA: where A just touches B, or near to that, shape (4, 4); None finds it above B.

    Raises:
        ValueError: the two do not meet along z.
    """

    def __init__(self, a: Any, b: Any, X_BA: np.ndarray | None = None) -> None:
        self._a, self._b = a, b
        if X_BA is None:
            self._pose = np.eye(4)
            self._pose[2, 3] = self._touch()
        else:
            self._pose = np.array(X_BA, float)

    @property
    def height(self) -> float:
        """Of the origin of A over that of B where they just touch [m]."""
        return float(self._pose[2, 3])

    def metrics(self, depth: float) -> core.VolumeMetrics:
        """Of the overlap in the frame of B, when A has gone down by `depth` [m] since touch."""
        pose = self._pose.copy()
        pose[2, 3] -= depth
        return core.interference(self._b, self._a, pose, tolerance=_TOLERANCE)

    def volume(self, depth: float) -> tuple[float, float]:
        """Volume [m^3] and its slope over the depth, the projected area [m^2]."""
        if depth <= 0.0:
            return 0.0, 0.0
        found = self.metrics(depth)
        return found.volume, abs(float(found.area_vector[2]))

    def volumes(self, depths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The same of many depths, shape (n,) each."""
        pairs = np.array([self.volume(float(depth)) for depth in depths]).reshape(-1, 2)
        return pairs[:, 0], pairs[:, 1]

    def moment(self, depth: float) -> float:
        """Elastic energy per stiffness [m^4]: docs/theory.md, "Depth moment"."""
        return float(self.metrics(depth).depth_moment)

    def depth_of(self, volume: float) -> float:
        """Depth at which the overlap has a volume [m].

        Raises:
            ValueError: the overlap never becomes so large.
        """
        low, high = 0.0, 1e-3 * self._reach()
        while self.volume(high)[0] < volume:
            low, high = high, 2.0 * high
            if high > 4.0 * self._reach():
                raise ValueError(
                    f"the overlap never has {volume:.3g} m^3: the load is too large for this "
                    "stiffness and these solids"
                )
        depth = high
        for _ in range(_NEWTON):
            found, slope = self.volume(depth)
            if found < volume:
                low = depth
            else:
                high = depth
            step = (found - volume) / slope if slope > 0.0 else 0.0
            guess = depth - step
            if not low < guess < high:
                guess = 0.5 * (low + high)
            if abs(guess - depth) <= 1e-14 * high:
                return guess
            depth = guess
        return depth

    def _reach(self) -> float:
        """Size of the smaller solid along z [m]."""
        ends = [
            high[2] - low[2]
            for low, high in (solid.bounds for solid in (self._a, self._b))
            if np.isfinite([low, high]).all()
        ]
        return float(min(ends)) if ends else 1.0

    def _touch(self) -> float:
        """Height at which A begins to overlap B, by bisection."""
        low_a, high_a = self._a.bounds
        _, high_b = self._b.bounds
        top = float(high_b[2]) if np.isfinite(high_b[2]) else 0.0
        size = float(high_a[2] - low_a[2])
        apart = top - float(low_a[2])  # of the bounding boxes
        deep = apart - 0.5 * min(size, self._reach())
        if not self._meets(deep):
            raise ValueError(
                "the two solids do not meet along z: let A lie above B, or choose which is A"
            )
        while apart - deep > _FINEST * size:
            middle = 0.5 * (apart + deep)
            if self._meets(middle):
                deep = middle
            else:
                apart = middle
        return deep

    def _meets(self, height: float) -> bool:
        pose = np.eye(4)
        pose[2, 3] = height
        return core.interference(self._b, self._a, pose, tolerance=1e-3).volume > 0.0
