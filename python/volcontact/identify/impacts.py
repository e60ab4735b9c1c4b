# SPDX-License-Identifier: Apache-2.0
"""What the weight does during an impact: the restitution of a body that falls onto a plate.

With the approach speed v, m v dv / (1 + a v) = m g dx / (1 + a v) - k_v V dx. Over the whole impact
the last term vanishes, and with G(v) = (a v - ln(1 + a v)) / a^2

    G(-v_o) = G(v_i) + g I,   I = int dx / (1 + a v) = - int_{-v_o}^{v_i} a x(v) / (1 + a v)^2 dv,

to first order with the x(v) of an impact without weight, k_v Q(x) = m (G(v_i) - G(v)) and Q the
depth moment (docs/theory.md, "Depth moment"). Without the weight it is docs/theory.md,
"Restitution".
"""

from __future__ import annotations

import numpy as np

from volcontact.identify.analytic.restitution import restitution_of
from volcontact.identify.push import Push

_NODES = 48
_DEPTHS = 160
_SLOW = 1e-7  # of a v: no damping


class Impacts:
    """Impacts of a body of a mass under gravity.

    Args:
        push: of the body onto the plate.
        stiffness: k_v [N/m^3].
        mass: [kg].
        gravity: [m/s^2].
        fastest: impact that is asked for [m/s].
    """

    def __init__(
        self, push: Push, stiffness: float, mass: float, gravity: float, fastest: float
    ) -> None:
        self._gravity = gravity
        deepest = 1e-6
        while stiffness * push.moment(deepest) < 1.1 * mass * fastest**2:
            deepest *= 1.3
        depths = np.geomspace(1e-6 * deepest, deepest, _DEPTHS)
        moments = np.array([push.moment(float(depth)) for depth in depths])
        self._per_mass = stiffness / mass
        self._log_volumes = np.log(push.volumes(depths)[0])
        self._log_depths = np.log(depths)
        self._log_energies = np.log(stiffness / mass * moments)
        nodes, weights = np.polynomial.legendre.leggauss(_NODES)
        # v = middle + half sin(t) makes the cube roots at both ends smooth.
        self._sines = np.sin(0.5 * np.pi * nodes)
        self._weights = 0.5 * np.pi * weights * np.cos(0.5 * np.pi * nodes)

    def share(self, damping: float, speed: float) -> float:
        """Restitution with the weight over that without it [-]."""
        a, v = damping, speed
        if a * v < _SLOW:
            return 1.0
        at, x, half = self._path(a, v)
        out = restitution_of(a * v) * v
        integral = -a * half * float(np.sum(self._weights * x / (1.0 + a * at) ** 2))
        wanted = float(_integral(a, np.array(v))) + self._gravity * integral
        new = out
        for _ in range(20):
            error = float(_integral(a, np.array(-new))) - wanted
            step = error * (1.0 - a * new) / new
            new = max(new - step, 1e-3 * out)
            if abs(step) < 1e-14 * out:
                break
        return new / out

    def duration(self, damping: float, speed: float) -> float:
        """How long an impact lasts, its weight left out [s]."""
        a = max(damping, _SLOW / speed)
        at, x, half = self._path(a, speed)
        volumes = np.exp(np.interp(np.log(x), self._log_depths, self._log_volumes))
        return half * float(np.sum(self._weights / (self._per_mass * volumes * (1.0 + a * at))))

    def _path(self, a: float, v: float) -> tuple[np.ndarray, np.ndarray, float]:
        """Speeds on the way, depths there, and half the range of the speeds."""
        out = restitution_of(a * v) * v
        middle, half = 0.5 * (v - out), 0.5 * (v + out)
        at = middle + half * self._sines
        energy = np.maximum(_integral(a, v) - _integral(a, at), 1e-300)
        x = np.exp(np.interp(np.log(energy), self._log_energies, self._log_depths))
        return at, x, half


def _integral(a: float, v: float | np.ndarray) -> np.ndarray:
    """G(v)."""
    found: np.ndarray = (a * np.asarray(v) - np.log1p(a * np.asarray(v))) / a**2
    return found
