# SPDX-License-Identifier: Apache-2.0
"""Volumetric stiffness from a measured or computed force-depth curve of two solids.

Least squares of F = k_v V(x - x_0) (1 + a v), with V the exact overlap of the two solids: the law
`hunt_crossley`, docs/theory.md, "Normal force".
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from volcontact.identify.estimators import regression
from volcontact.identify.estimators.regression import Fit
from volcontact.identify.push import Push
from volcontact.identify.readings import LEVEL, Curve, Quantity, Reading

_TREND = 0.05  # of the force: what no volume law explains is told from here on
_LAW_POWER = 0.02  # of 1: a power of the volume so near to 1 is that of the law
_PASSES = 30


def force_depth(
    depths: Sequence[float] | np.ndarray,
    forces: Sequence[float] | np.ndarray,
    a: Any,
    b: Any,
    *,
    speeds: Sequence[float] | np.ndarray | None = None,
    offset: float | None = None,
    X_BA: np.ndarray | None = None,
    level: float = LEVEL,
    name: str = "force over depth",
) -> Reading:
    """k_v from a force-depth curve of two given solids.

    Args:
        depths: readings of the gauge x [m], rising as A goes into B, shape (n,).
        forces: F [N], shape (n,).
        a: the solid that is pressed in, along -z.
        b: the solid that it is pressed into; a half-space fills z <= 0.
        speeds: at which A goes in [m/s], shape (n,); zeros or None: the readings are at rest.
        offset: reading of the gauge x_0 at touch [m]; None finds it.
        X_BA: pose of A where the two just touch, shape (4, 4); None finds it above B.
        level: of the intervals.
        name: of the reading.

    Returns:
        `stiffness` k_v [N/m^3], `offset` x_0 [m], `damping` a [s/m] where there are speeds, and
        `power` p of F ~ V^p, which is 1 for a volume law. Findings say where the curve is none.

    Raises:
        ValueError: shapes differ, nothing touches, or there are too few readings.
    """
    x, F = np.asarray(depths, float), np.asarray(forces, float)
    if x.ndim != 1 or x.shape != F.shape:
        raise ValueError(f"depths have the shape {x.shape} and forces {F.shape}: give as many")
    v = np.zeros(len(x)) if speeds is None else np.asarray(speeds, float)
    if v.shape != x.shape:
        raise ValueError(f"speeds have the shape {v.shape} and depths {x.shape}: give as many")
    if len(x) and np.corrcoef(x, F)[0, 1] < 0.0:
        raise ValueError("the force falls with the depth: the gauge must read more as A goes in")
    if len(x) < 2 or not np.any(F > 0.0):
        raise ValueError(f"{len(x)} readings with force are too few: press in several steps")
    push = Push(a, b, X_BA)
    curve = _Curve(push, x, F, v, offset)
    found = curve.fit()
    power = curve.power(found)
    grid = np.linspace(min(0.0, float(np.min(x)) - curve.zero(found)), curve.deepest(found), 200)
    values = {"stiffness": found.quantity("stiffness", "N/m^3", level)}
    written = ["stiffness"]
    if offset is None:
        values["offset"] = _plain(found.quantity("offset", "m", level))
    findings = [line for line in found.untold() if not line.startswith("offset")]
    if curve.has_speeds:
        values["damping"], lines = _damping(found, level)
        findings = [line for line in findings if not line.startswith("damping")] + lines
        if values["damping"].told:
            written.append("damping")
    values["power"] = power.quantity("power", "-", level)
    findings += curve.misfits(found, values["power"])
    deepest = curve.deepest(found)
    return Reading(
        name,
        values,
        validity=(
            f"Depths up to {deepest:.3g} m and forces up to {F.max():.3g} N; deeper the law "
            "extrapolates.",
            "The pose of the two solids as given: another face, edge or corner is another curve, "
            "with the same k_v as far as the volume law holds.",
        ),
        findings=tuple(findings),
        written=tuple(written),
        curves=(
            Curve(
                "Force over depth",
                "depth [m]",
                "force [N]",
                x - curve.zero(found),
                F,
                grid,
                found["stiffness"] * push.volumes(grid)[0],
            ),
        ),
        converged=found.converged,
        level=level,
    )


def _plain(value: Quantity) -> Quantity:
    """An offset may well be 0: it is told however its interval lies about that."""
    return Quantity(value.value, value.unit, value.deviation, value.low, value.high)


def _damping(found: Fit, level: float) -> tuple[Quantity, list[str]]:
    each = found.quantity("damping", "s/m", level)
    told = bool(each.told and each.value > 0.0)
    low = max(each.low, 0.0)
    each = Quantity(each.value, each.unit, each.deviation, low, each.high, told)
    if told:
        return each, []
    line = "damping cannot be told from these data: the press is too slow for it. Drop the part."
    if np.isfinite(each.high):
        line = (
            f"damping above {each.high:.3g} s/m is out; below it nothing can be told. {line[43:]}"
        )
    return each, [line]


class _Curve:
    """Residuals of a force-depth curve and their derivatives."""

    def __init__(
        self, push: Push, x: np.ndarray, F: np.ndarray, v: np.ndarray, offset: float | None
    ) -> None:
        self.push, self.x, self.F, self.v, self.offset = push, x, F, v, offset
        self.has_speeds = bool(np.any(v != 0.0))

    def zero(self, found: Fit) -> float:
        return found["offset"] if self.offset is None else self.offset

    def deepest(self, found: Fit) -> float:
        return float(self.x.max()) - self.zero(found)

    def _first(self) -> tuple[float, float]:
        """Guess of offset and stiffness: the least squares of a scan of offsets."""
        if self.offset is not None:
            offsets = np.array([self.offset])
        else:
            pressed = self.x[0.02 * self.F.max() < self.F]
            span = float(self.x.max() - pressed.min())
            offsets = pressed.min() - np.linspace(-0.2, 3.0, 65) * max(span, 1e-12)
        best = (np.inf, float(offsets[0]), 1.0)
        for zero in offsets:
            V = self.push.volumes(self.x - zero)[0]
            if not V @ V > 0.0:
                continue
            k = float(V @ self.F / (V @ V))
            cost = float(np.sum((k * V - self.F) ** 2))
            if cost < best[0]:
                best = (cost, float(zero), k)
        if not np.isfinite(best[0]):
            raise ValueError(
                "at these depths the two solids do not touch: see to offset and the sign of depth"
            )
        return best[1], best[2]

    def fit(self) -> Fit:
        """Gauss-Newton with exact derivatives, halved where it does not descend."""
        zero, k = self._first()
        names = ["stiffness"] + ["offset"] * (self.offset is None)
        names += ["damping"] * self.has_speeds
        if len(self.x) < len(names):
            raise ValueError(
                f"{len(self.x)} readings are too few to find {', '.join(names)}: press in more "
                "steps"
            )
        state = np.array([k, zero, 0.0])  # k, x0, k a
        used = [0] + [1] * (self.offset is None) + [2] * self.has_speeds
        errors, slopes = self._at(state)
        converged = False
        for _ in range(_PASSES):
            matrix = slopes[:, used]
            size = np.linalg.norm(matrix, axis=0)
            size[size == 0.0] = 1.0
            step = np.linalg.lstsq(matrix / size, -errors, rcond=1e-12)[0] / size
            factor = 1.0
            while factor > 1e-6:
                trial = state.copy()
                trial[used] += factor * step
                new = self._at(trial)
                if new[0] @ new[0] <= errors @ errors:
                    break
                factor *= 0.5
            else:
                converged = True  # nothing descends: as near as rounding lets it
                break
            moved = np.abs(trial - state) / np.array([abs(state[0]), self._span(), abs(state[0])])
            state, (errors, slopes) = trial, new
            if moved.max() < 1e-13:
                converged = True
                break
        freedom = len(self.x) - len(used)
        noise = float(np.sqrt(errors @ errors / freedom)) if freedom > 0 else np.nan
        # From k and k a to k and a.
        matrix = slopes[:, used].copy()
        if self.has_speeds:
            damping = state[2] / state[0]
            matrix[:, 0] += damping * slopes[:, 2]
            matrix[:, -1] = state[0] * slopes[:, 2]
        values = np.array([state[0], state[1], state[2] / state[0]])[used]
        covariance = regression.covariance_of(matrix) * (noise**2 if freedom > 0 else 1.0)
        return Fit(tuple(names), values, covariance, errors, noise, freedom, converged)

    def _span(self) -> float:
        return float(np.ptp(self.x))

    def _at(self, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        V, area = self.push.volumes(self.x - state[1])
        factor = state[0] + state[2] * self.v
        slopes = np.stack([V, -factor * area, self.v * V], axis=1)
        return factor * V - self.F, slopes

    def power(self, found: Fit) -> Fit:
        """P of F ~ V^p, from the readings with force, each weighted by its own size."""
        V = self.push.volumes(self.x - self.zero(found))[0]
        good = (V > 0.0) & (max(5.0 * found.noise, 0.02 * self.F.max()) < self.F)
        if np.count_nonzero(good) < 3:
            good = (V > 0.0) & (self.F > 0.0)
        factor = 1.0 + (found["damping"] if self.has_speeds else 0.0) * self.v[good]
        weight = self.F[good]  # equal errors of F are errors of ln F that fall with it
        matrix = np.stack([np.log(V[good]), np.ones(int(good.sum()))], axis=1)
        data = np.log(self.F[good] / factor)
        return regression.linear(weight[:, None] * matrix, weight * data, ["power", "level"])

    def misfits(self, found: Fit, power: Quantity) -> list[str]:
        """Where the curve is no volume law."""
        lines = []
        is_law = power.low - _LAW_POWER <= 1.0 <= power.high + _LAW_POWER
        if np.isfinite(power.low) and not is_law:
            lines.append(
                f"The force grows with the power {power.value:.3g} of the volume "
                f"({power.low:.3g} to {power.high:.3g}), that of a volume law with 1: k_v is a "
                "mean over these depths. Press at the load of the application alone, or as deep."
            )
        V = self.push.volumes(self.x - self.zero(found))[0]
        order = np.argsort(self.x)
        errors, scale = found.residuals[order], np.maximum(self.F[order], 0.05 * self.F.max())
        off = np.abs(errors) > _TREND * scale
        deep = V[order] > 0.0
        where = self.x[order][off & deep] - self.zero(found)
        if len(where) and not is_law:
            lines.append(
                f"It is off by more than {100 * _TREND:g} % at {len(where)} of {len(off)} "
                f"readings, at depths from {where.min():.3g} to {where.max():.3g} m."
            )
        return lines
