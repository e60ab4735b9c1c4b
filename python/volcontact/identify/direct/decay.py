# SPDX-License-Identifier: Apache-2.0
"""How something that turns slows down: dw/dt = -c - l w, from rates or from angles."""

from __future__ import annotations

import numpy as np

from volcontact.identify.direct.sheets import Sheet, SheetError
from volcontact.identify.estimators import regression
from volcontact.identify.estimators.regression import Fit
from volcontact.identify.readings import Curve

_LEAST = 3  # samples of a run
_STOPPED = 0.02  # of the fastest rate: what follows is left out
_CHANCE = 4.0  # standard deviations: below it a second part is not taken in
_REACH = 2  # samples to each side, of a rate


def rates(t: np.ndarray, rate: float, linear: float, constant: float) -> np.ndarray:
    """w(t) of what starts with `rate`."""
    if abs(linear) * float(np.max(t, initial=0.0)) < 1e-9:
        found: np.ndarray = rate - constant * t - rate * linear * t
        return found
    gone = -np.expm1(-linear * t) / linear
    found = rate - (linear * rate + constant) * gone
    return found


def angles(t: np.ndarray, rate: float, linear: float, constant: float) -> np.ndarray:
    """The integral of that."""
    x = linear * t
    small = np.abs(x) < 1e-3
    safe = np.where(small, 1.0, x)
    # (1 - exp(-x)) / x and (x - 1 + exp(-x)) / x^2, by series where they cancel.
    first = np.where(small, 1.0 - x / 2.0 + x**2 / 6.0 - x**3 / 24.0, -np.expm1(-safe) / safe)
    second = np.where(
        small,
        0.5 - x / 6.0 + x**2 / 24.0 - x**3 / 120.0,
        (safe + np.expm1(-safe)) / safe**2,
    )
    found: np.ndarray = rate * t * first - constant * t**2 * second
    return found


class Decay:
    """All runs of a sheet.

    Args:
        sheet: with `time` and one of the columns.
        columns: names by what one of them is in turns of the body: 1 for a rate or an angle.
        slowest: rate below which samples are left out [rad/s].

    Raises:
        SheetError: there is no column, or a run is too short.
    """

    def __init__(
        self,
        sheet: Sheet,
        columns: dict[str, float],
        is_angle: dict[str, bool],
        slowest: float = 0.0,
    ) -> None:
        used = [name for name in columns if sheet.has(name)]
        if len(used) != 1:
            said = "none of the columns" if not used else "more than one of the columns"
            raise SheetError(f"{sheet.source}: has {said} {', '.join(columns)}: give one of them")
        self.name = used[0]
        self.of_angles = is_angle[self.name]
        self.runs: list[tuple[np.ndarray, np.ndarray]] = []
        self.left_out = 0
        for label, rows in sheet.groups("run"):
            t, data = sheet.columns["time"][rows], sheet.columns[self.name][rows]
            there = np.isfinite(data)
            t, data = t[there], data[there] * columns[self.name]
            where = f"{sheet.source}: run {label!r}" if label else sheet.source
            if len(t) > 1 and np.any(np.diff(t) <= 0.0):
                raise SheetError(
                    f"{where}: time does not rise; give each run a label in the column 'run'"
                )
            speed = _speeds(t, data) if self.of_angles and len(t) > 1 else np.abs(data)
            slow = np.flatnonzero(speed < max(slowest, _STOPPED * float(speed.max(initial=0.0))))
            end = int(slow[0]) if len(slow) else len(t)
            self.left_out += len(t) - end
            t, data = t[:end], data[:end]
            if len(t) < _LEAST:
                raise SheetError(
                    f"{where}: has {len(t)} samples above the slowest speed that counts; a run "
                    f"needs at least {_LEAST}"
                )
            sign = np.sign(data[-1] - data[0]) if self.of_angles else np.sign(data[0])
            self.runs.append((t - t[0], sign * data))

    def fit(self, *, linear: bool = True, constant: bool = True) -> Fit:
        """L [1/s] and c [rad/s^2], with the rate of each run at its start, and its angle."""
        names = ["linear"] * linear + ["constant"] * constant
        starts = []
        for t, data in self.runs:
            if self.of_angles:
                head = slice(0, max(3, len(t) // 5))
                slope = float(np.polyfit(t[head], data[head], 1)[0])
                starts += [slope, float(data[0])]
            else:
                starts.append(float(data[0]))
        first = self._first(linear, constant)
        per = 2 if self.of_angles else 1
        count = len(names)

        def residuals(x: np.ndarray) -> np.ndarray:
            l = x[0] if linear else 0.0  # noqa: E741
            c = x[count - 1] if constant else 0.0
            parts = []
            for place, (t, data) in enumerate(self.runs):
                own = x[count + per * place : count + per * (place + 1)]
                if self.of_angles:
                    parts.append(own[1] + angles(t, own[0], l, c) - data)
                else:
                    parts.append(rates(t, own[0], l, c) - data)
            return np.concatenate(parts)

        each = ["start rate", "start angle"][:per]
        own_names = [f"{word} {place + 1}" for place in range(len(self.runs)) for word in each]
        return regression.fit(residuals, [*first, *starts], [*names, *own_names])

    def _first(self, linear: bool, constant: bool) -> list[float]:
        """Guesses from the mean deceleration of the first run."""
        t, data = self.runs[0]
        if self.of_angles:
            second, first, _ = np.polyfit(t, data, 2)
            rate, slowing = float(first), max(-2.0 * float(second), 1e-12)
        else:
            rate = float(data[0])
            slowing = max(float(data[0] - data[-1]) / float(t[-1]), 1e-12)
        if linear and constant:
            return [0.5 * slowing / abs(rate), 0.5 * slowing]
        return [slowing / abs(rate)] if linear else [slowing]

    def span(self) -> tuple[float, float]:
        """Least and largest rate [rad/s]."""
        speeds = [_speeds(t, data) if self.of_angles else np.abs(data) for t, data in self.runs]
        return (min(float(v.min()) for v in speeds), max(float(v.max()) for v in speeds))

    def curves(self, fit: Fit, label: str) -> list[Curve]:
        """Each run beside the law."""
        l = fit["linear"] if "linear" in fit.names else 0.0  # noqa: E741
        c = fit["constant"] if "constant" in fit.names else 0.0
        found = []
        for place, (t, data) in enumerate(self.runs):
            grid = np.linspace(0.0, float(t[-1]), 200)
            rate = fit[f"start rate {place + 1}"]
            line = rates(grid, rate, l, c)
            if self.of_angles:
                line = fit[f"start angle {place + 1}"] + angles(grid, rate, l, c)
            found.append(Curve(f"Run {place + 1}", "time [s]", label, t, data, grid, line))
        return found


def _speeds(t: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Rates over a few samples, so that noise does not look like rest."""
    reach = min(_REACH, len(t) - 1)
    place = np.arange(len(t))
    low, high = np.maximum(place - reach, 0), np.minimum(place + reach, len(t) - 1)
    found: np.ndarray = np.abs((angle[high] - angle[low]) / (t[high] - t[low]))
    return found


def parts_told(fit: Fit) -> bool:
    """Whether the data tell both parts of the decay, and neither is chance."""
    return all(
        fit.quantity(name, "-").told and fit[name] > _CHANCE * fit.deviation(name)
        for name in ("linear", "constant")
    )


def fit_parts(decay: Decay, law: str) -> tuple[Fit, Fit | None]:
    """The decay of the law alone, and that with both parts where the data are enough for it.

    Args:
        decay: of the test.
        law: the part that the law has, "linear" or "constant".
    """
    alone = decay.fit(linear=law == "linear", constant=law == "constant")
    count = sum(len(t) for t, _ in decay.runs)
    per = 2 if decay.of_angles else 1
    if count <= 2 + per * len(decay.runs):
        return alone, None
    return alone, decay.fit()
