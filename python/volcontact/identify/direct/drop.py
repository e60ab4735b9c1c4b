# SPDX-License-Identifier: Apache-2.0
"""Drop: damping, or restitution with its floor, from bounce heights or times between bounces.

A body that falls from the height h meets the plate with sqrt(2 g h) and rises to the height of what
it keeps of that. Speeds of all bounces of a drop follow from the first by e(v), which is not
measured itself but found with the law: so the noise of one height is that of one sample.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from volcontact.identify.analytic.restitution import compared, damping_number, restitution_of
from volcontact.identify.direct.sheets import Sheet, SheetError
from volcontact.identify.direct.solids import STANDARD_GRAVITY, solids_of
from volcontact.identify.estimators import regression
from volcontact.identify.estimators.regression import Fit
from volcontact.identify.impacts import Impacts
from volcontact.identify.push import Push
from volcontact.identify.readings import LEVEL, Curve, Quantity, Reading

_Law = Callable[[np.ndarray, float], float]  # numbers of the law, speed -> restitution
_WEIGHTS = ("a", "mass", "stiffness")  # what the correction for the weight needs
_ROUNDS = 3  # of the correction
_FAR = 5.0  # times the noise of the other law: no floor makes up for it
_GAINED = 6.0  # variances that a floor must explain


def drop(sheet: Sheet, *, level: float = LEVEL) -> Reading:
    """Reads a drop test.

    Args:
        sheet: with `height` or `interval`, and `drop` where there are several.
        level: of the intervals.

    Returns:
        `damping` [s/m]; `restitution` [-] with `restitution_speed_floor` [m/s] where the slowest
        bounces tell it; the residuals of e under either law. The law that fits better is written.

    Raises:
        SheetError: the sheet does not have what the test needs.
    """
    bounces = _Bounces(sheet)
    speeds, ratios = bounces.speeds()
    guess = float(np.median(ratios))
    middle = float(np.median(speeds))
    number = damping_number(min(max(guess, 0.01), 0.999))
    by_damping = bounces.fit(["damping"], [number / middle], _constant_damping)
    by_constant = bounces.fit(["restitution"], [guess], _constant_restitution)
    by_floor = None
    if by_constant.noise < _FAR * by_damping.noise:
        by_floor = _with_floor(bounces, guess, speeds, by_constant)
    best = by_constant if by_floor is None else by_floor
    is_constant = best.noise < by_damping.noise or not math.isfinite(by_damping.noise)
    misfits = [
        bounces.misfit(by_damping, _constant_damping),
        bounces.misfit(best, _floored if by_floor else _constant_restitution),
    ]
    values = {
        "damping": by_damping.quantity("damping", "s/m", level),
        "restitution": best.quantity("restitution", "-", level),
    }
    written = ["restitution"] if is_constant else ["damping"]
    findings = compared(speeds, misfits, is_constant)
    if by_floor is not None:
        values["restitution_speed_floor"] = best.quantity("restitution_speed_floor", "m/s", level)
        written += ["restitution_speed_floor"] * is_constant
    elif is_constant:
        findings.append(
            "restitution_speed_floor cannot be told from these data: it lies below "
            f"{speeds.min():.3g} m/s, the slowest impact."
        )
    values["residual_of_damping"] = Quantity(misfits[0], "-")
    values["residual_of_restitution"] = Quantity(misfits[1], "-")
    speeds, ratios = bounces.speeds()
    chosen = best if is_constant else by_damping
    findings += [line for line in chosen.untold() if not line.startswith("speed of")]
    law = (_floored if by_floor else _constant_restitution) if is_constant else _constant_damping
    grid = np.linspace(1e-3 * speeds.max(), 1.05 * float(speeds.max()), 200)
    line = np.array([law(chosen.values, v) for v in grid])
    title = "Restitution over speed"
    return Reading(
        "drop",
        values,
        validity=(
            f"Impacts from {speeds.min():.3g} to {speeds.max():.3g} m/s, straight, without spin.",
            bounces.of_weight(),
            "Air is left out: drop small heavy parts from small heights.",
        ),
        findings=tuple(findings),
        written=tuple(written),
        curves=(Curve(title, "speed of the impact [m/s]", "e [-]", speeds, ratios, grid, line),),
        converged=chosen.converged,
        level=level,
    )


def _constant_damping(numbers: np.ndarray, speed: float) -> float:
    return restitution_of(float(numbers[0]) * speed)


def _constant_restitution(numbers: np.ndarray, speed: float) -> float:
    return float(numbers[0])


def _floored(numbers: np.ndarray, speed: float) -> float:
    """Below the floor the damping is that of an impact at the floor."""
    if speed >= numbers[1]:
        return float(numbers[0])
    return restitution_of(damping_number(float(numbers[0])) / float(numbers[1]) * speed)


def _with_floor(bounces: _Bounces, guess: float, speeds: np.ndarray, plain: Fit) -> Fit | None:
    """The law with a floor, where it explains more than chance would."""
    fits = []
    for part in (0.1, 0.3, 0.5, 0.7):
        floor = float(np.quantile(speeds, part)) * 1.05
        try:
            fits.append(
                bounces.fit(["restitution", "restitution_speed_floor"], [guess, floor], _floored)
            )
        except ValueError:
            return None
    best = min(fits, key=lambda fit: float(fit.residuals @ fit.residuals))
    floor = best["restitution_speed_floor"]
    if best.freedom <= 0 or not speeds.min() < floor < speeds.max():
        return None
    gained = float(plain.residuals @ plain.residuals - best.residuals @ best.residuals)
    return best if gained > _GAINED * best.noise**2 else None


class _Bounces:
    """Heights or intervals of all drops of a sheet."""

    def __init__(self, sheet: Sheet) -> None:
        self._gravity = sheet.number("gravity", STANDARD_GRAVITY)
        self._touch = sheet.number("contact time", 0.0)
        self._impacts = self._with_weight(sheet)
        self.of_heights = sheet.has("height")
        name = "height" if self.of_heights else "interval"
        if self.of_heights and sheet.has("interval"):
            raise SheetError(f"{sheet.source}: give heights or intervals, not both")
        if not sheet.has(name):
            raise SheetError(
                f"{sheet.source}: there is no column 'height' and no column 'interval'"
            )
        self.drops = []
        for label, rows in sheet.groups("drop"):
            data = sheet.columns[name][rows]
            if not np.isfinite(data).all():
                raise SheetError(
                    f"{sheet.source}: drop {label!r} has an empty {name}: speeds follow from one "
                    "bounce to the next, so end the drop there"
                )
            if len(data) < 2:
                raise SheetError(
                    f"{sheet.source}: drop {label!r} has {len(data)} {name}s; give at least two"
                )
            rising = np.flatnonzero(np.diff(data) >= 0.0)
            if len(rising):
                raise SheetError(
                    f"{sheet.source}: in drop {label!r} {name} {rising[0] + 2} is not below the "
                    "one before: a new drop needs a new label in the column 'drop'"
                )
            self.drops.append(data)
        self._touches = [np.full(len(data), self._touch) for data in self.drops]

    def _speed(self, measured: np.ndarray, touches: np.ndarray) -> np.ndarray:
        speeds: np.ndarray = 0.5 * self._gravity * (measured - touches)
        if self.of_heights:
            speeds = np.sqrt(2.0 * self._gravity * measured)
        return speeds

    def _measured(self) -> list[np.ndarray]:
        return [
            self._speed(data, touches)
            for data, touches in zip(self.drops, self._touches, strict=True)
        ]

    def speeds(self) -> tuple[np.ndarray, np.ndarray]:
        """Of impacts, and their restitutions, as they are measured."""
        found = self._measured()
        before = np.concatenate([v[:-1] for v in found])
        after = np.concatenate([v[1:] for v in found])
        return before, after / before

    def _with_weight(self, sheet: Sheet) -> Impacts | None:
        if any(name not in sheet.constants for name in _WEIGHTS):
            return None
        heights = sheet.columns.get("height", np.empty(0))
        intervals = 0.125 * self._gravity * sheet.columns.get("interval", np.empty(0)) ** 2
        highest = float(np.nanmax(np.concatenate([heights, intervals])))
        return Impacts(
            Push(*solids_of(sheet)),
            sheet.number("stiffness"),
            sheet.number("mass"),
            self._gravity,
            1.5 * math.sqrt(2.0 * self._gravity * highest),
        )

    def of_weight(self) -> str:
        """What is said of the weight during an impact."""
        if self._impacts is not None:
            return "The weight during an impact is taken off, to first order."
        return (
            "The weight during an impact is left out: it lowers e by about the weight over the "
            f"largest force of the impact. Give {', '.join(_WEIGHTS)} to have it taken off."
        )

    def _predicted(
        self,
        first: float,
        shares: np.ndarray,
        touches: np.ndarray,
        numbers: np.ndarray,
        law: _Law,
    ) -> np.ndarray:
        speeds = [first]
        for share in shares:
            speeds.append(speeds[-1] * share * law(numbers, speeds[-1]))
        v = np.array(speeds)
        intervals: np.ndarray = 2.0 * v / self._gravity + touches
        return v**2 / (2.0 * self._gravity) if self.of_heights else intervals

    def _weighed(
        self, fit: Fit, count: int, law: _Law
    ) -> tuple[list[np.ndarray], list[np.ndarray]]:
        """What the weight makes of each restitution, and how long the impacts last."""
        found, lasting = [], []
        for first, data in zip(fit.values[count:], self.drops, strict=True):
            speed, shares = float(first), []
            # An interval begins with the impact before its flight; that of the first came in with
            # about as much more as the law says.
            touches = [self._lasting(fit.values[:count], speed / law(fit.values, speed), law)]
            for _ in range(len(data) - 1):
                e = law(fit.values[:count], speed)
                share = 1.0
                if self._impacts is not None:
                    share = self._impacts.share(damping_number(e) / speed, speed)
                shares.append(share)
                touches.append(self._lasting(fit.values[:count], speed, law))
                speed *= share * e
            found.append(np.array(shares))
            lasting.append(np.array(touches))
        return found, lasting

    def _lasting(self, numbers: np.ndarray, speed: float, law: _Law) -> float:
        if self._impacts is None:
            return self._touch
        return self._impacts.duration(damping_number(law(numbers, speed)) / speed, speed)

    def misfit(self, fit: Fit, law: _Law) -> float:
        """Root mean square of the errors of e, each impact at its measured speed."""
        count = len(fit.names) - len(self.drops)
        shares_of, self._touches = self._weighed(fit, count, law)
        speeds, ratios = self.speeds()
        shares = np.concatenate(shares_of)
        found = [share * law(fit.values, v) for share, v in zip(shares, speeds, strict=True)]
        return float(np.sqrt(np.mean((np.array(found) - ratios) ** 2)))

    def fit(self, names: list[str], start: list[float], law: _Law) -> Fit:
        """Numbers of the law, with the first speed of each drop."""
        count = len(names)
        firsts = [float(v[0]) for v in self._measured()]
        every = [*names, *(f"speed of drop {place + 1}" for place in range(len(firsts)))]
        low = [1e-9] * len(every)
        high = [math.inf] * len(every)
        if names[0] == "restitution":
            high[0] = 1.0
        shares = [np.ones(len(data) - 1) for data in self.drops]
        touches = [np.full(len(data), self._touch) for data in self.drops]

        def residuals(x: np.ndarray) -> np.ndarray:
            rows = zip(x[count:], shares, touches, self.drops, strict=True)
            parts = [
                self._predicted(first, share, touch, x[:count], law) - data
                for first, share, touch, data in rows
            ]
            return np.concatenate(parts)

        found = regression.fit(residuals, [*start, *firsts], every, low=low, high=high)
        for _ in range(_ROUNDS if self._impacts is not None else 0):
            shares, touches = self._weighed(found, count, law)
            found = regression.fit(residuals, found.values.tolist(), every, low=low, high=high)
        return found
