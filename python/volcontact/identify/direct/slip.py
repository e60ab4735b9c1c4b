# SPDX-License-Identifier: Apache-2.0
"""Micro-slip loop: sigma_0 and sigma_1 from the dynamic stiffness of a contact that sticks.

Within the friction the law `bristle` is z' = s u + (1 - s)(mu_C f d(u) - sigma_0 z) / sigma_1 with
s = exp(-u^2 / v_s^2) near 1 (docs/theory.md, "Bristles"). Force and displacement of a loop are
fitted by a sine each, K = F / X of these is the dynamic stiffness, and

    K(w) = sigma_0 - m w^2 + i w (sigma_1 + sigma_2).

What (1 - s) adds is of the order U mu_C f / (v_s^2 sigma_1) for loops of the peak speed U. Where
friction, normal force and v_s are given it is taken off, to first order.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from volcontact.identify.direct.sheets import Sheet, SheetError
from volcontact.identify.estimators import regression
from volcontact.identify.readings import LEVEL, Curve, Quantity, Reading

_PERIODS = 1.5  # least of a loop
_SAMPLES = 12  # least of a loop
_HARMONICS = 3
_ELLIPSE = 0.03  # of the first harmonic: a third one beyond is no ellipse
_SMALL = 0.01  # of a correction: beyond, the next order counts
_ROUNDS = 20
_ROUNDING = 1e-12  # of K
_SCATTER = 2.5  # of loops, in standard deviations: the law misses something
_NAMES = ("bristle_stiffness", "sum of bristle_damping and viscous_friction", "mass")


@dataclass(frozen=True)
class Loop:
    """One loop as two sines.

    Attributes:
        label: of the sheet.
        omega: [rad/s].
        amplitude: of the displacement [m].
        stiffness: complex, force over displacement [N/m].
        covariance: of its real and imaginary part, shape (2, 2) [N^2/m^2].
        third: third harmonic of the force over the first [-].
        freedom: samples less what was fitted.
    """

    label: str
    omega: float
    amplitude: float
    stiffness: complex
    covariance: np.ndarray
    third: float
    freedom: int


def slip(sheet: Sheet, *, level: float = LEVEL) -> Reading:
    """Reads a micro-slip test.

    Args:
        sheet: `time`, `displacement` and `force` of one or more loops, each of one frequency; the
            constants `viscous friction`, `mass` that rides on the contact, and `normal force`,
            `friction`, `stribeck speed` for the correction.
        level: of the intervals.

    Returns:
        `bristle_stiffness` [N/m], `bristle_damping` [N s/m], `viscous_friction` where it is given;
        `mass` [kg] where it is not given and the frequencies tell it.

    Raises:
        SheetError: the sheet does not have what the test needs.
    """
    loops = [_loop(sheet, label, rows) for label, rows in sheet.groups("loop")]
    correction = _Correction(sheet)
    given_mass = sheet.number("mass") if "mass" in sheet.constants else None
    frequencies = np.array([loop.omega for loop in loops])
    finds_mass = given_mass is None and np.ptp(frequencies) > 0.2 * frequencies.max()
    names = [_NAMES[0], _NAMES[1], *([_NAMES[2]] if finds_mass else [])]
    viscous = sheet.number("viscous friction", 0.0)
    offsets = np.zeros(len(loops), complex)
    for _ in range(_ROUNDS):
        fit = _regress(loops, offsets, given_mass or 0.0, names)
        sigma_0, total = fit[_NAMES[0]], fit[_NAMES[1]]
        new = np.array([correction.of(loop, sigma_0, total - viscous) for loop in loops])
        done = np.abs(new - offsets).max() <= 1e-12 * abs(sigma_0)
        offsets = new
        if done:
            break
    values = {"bristle_stiffness": fit.quantity(_NAMES[0], "N/m", level)}
    sum_ = fit.quantity(_NAMES[1], "N s/m", level)
    values["bristle_damping"] = _less(sum_, viscous)
    if viscous > 0.0:
        values["viscous_friction"] = Quantity(viscous, "N s/m")
    if finds_mass:
        values["mass"] = fit.quantity("mass", "kg", level)
    findings = _findings(sheet, fit, values, loops, offsets, correction, given_mass)
    return Reading(
        "slip",
        values,
        validity=tuple(_validity(loops, correction)),
        findings=tuple(findings),
        choices=("friction_law/bristle",),
        curves=tuple(_curves(sheet, loops)),
        converged=fit.converged,
        level=level,
    )


def _less(known: Quantity, part: float) -> Quantity:
    value, half = known.value - part, 0.5 * (known.high - known.low)
    told = known.told and value > 0.0 and not half > 0.5 * value
    return Quantity(value, known.unit, known.deviation, known.low - part, known.high - part, told)


class _Correction:
    """What the end of sticking adds to the dynamic stiffness, to first order."""

    def __init__(self, sheet: Sheet) -> None:
        wanted = ("normal force", "friction", "stribeck speed")
        self.missing = [name for name in wanted if name not in sheet.constants]
        self.is_given = not self.missing
        if self.is_given:
            self._kinetic = sheet.number("normal force") * sheet.number("friction")
            self._stribeck = sheet.number("stribeck speed")

    def of(self, loop: Loop, sigma_0: float, sigma_1: float) -> complex:
        """To be taken off K of a loop [N/m].

        With x = X sin wt and e = U^2 / v_s^2 the fundamental of z' is
        (U + e (8 mu f / (3 pi sigma_1) - 3 U / 4)) cos wt - e sigma_0 X / (4 sigma_1) sin wt.
        """
        if not self.is_given or sigma_1 <= 0.0:
            return 0.0
        X, w = loop.amplitude, loop.omega
        U = w * X
        e = (U / self._stribeck) ** 2
        C = e * (8.0 / (3.0 * math.pi) * self._kinetic / sigma_1 - 0.75 * U)
        D = -e * sigma_0 * X / (4.0 * sigma_1)
        # z = (C sin - D cos) / w more; the force sigma_0 z + sigma_1 z', over X.
        return complex(sigma_0 * C / w + sigma_1 * D, -sigma_0 * D / w + sigma_1 * C) / X


def _regress(
    loops: list[Loop], offsets: np.ndarray, mass: float, names: list[str]
) -> regression.Fit:
    """Linear least squares of real and imaginary parts."""
    rows, data = [], []
    for loop, offset in zip(loops, offsets, strict=True):
        k = loop.stiffness - offset + mass * loop.omega**2
        # Whitened: parts of one standard deviation that do not hang together.
        white = np.linalg.inv(np.linalg.cholesky(loop.covariance))
        matrix = np.array([[1.0, 0.0, -(loop.omega**2)], [0.0, loop.omega, 0.0]])[:, : len(names)]
        rows.append(white @ matrix)
        data.append(white @ np.array([k.real, k.imag]))
    stacked = np.concatenate(rows)
    fit = regression.linear(stacked, np.concatenate(data), names)
    if fit.freedom > 0 and fit.noise > _SCATTER:
        return fit
    # The noise of the samples is known from many of them, and explains the scatter of the loops.
    covariance = regression.covariance_of(stacked)
    return replace(
        fit, covariance=covariance, noise=1.0, freedom=sum(loop.freedom for loop in loops)
    )


def _loop(sheet: Sheet, label: str, rows: np.ndarray) -> Loop:
    where = f"{sheet.source}: loop {label!r}" if label else sheet.source
    t, x, F = (sheet.columns[name][rows] for name in ("time", "displacement", "force"))
    if len(t) < _SAMPLES:
        raise SheetError(f"{where} has {len(t)} samples; a loop needs at least {_SAMPLES}")
    if np.any(np.diff(t) <= 0.0):
        raise SheetError(
            f"{where}: time does not rise; give each loop a label in the column 'loop'"
        )
    if not np.ptp(x) > 0.0 or not np.ptp(F) > 0.0:
        raise SheetError(f"{where}: displacement or force does not change")
    omega = _frequency(t, F, where)
    basis = _sines(t, omega)
    parts, errors = [], []
    for data in (x, F):
        found = _solved(basis, data)
        parts.append(found)
        freedom = max(len(t) - basis.shape[1], 1)
        errors.append(float(np.sum((basis @ found - data) ** 2)) / freedom)
    X, force = (complex(part[0], -part[1]) for part in parts)  # of exp(i w t)
    third = math.hypot(parts[1][4], parts[1][5]) / abs(force)
    K = force / X
    # K changes by (dF - K dX) / X with what noise does to the two sines.
    shape = np.linalg.inv(basis.T @ basis)[:2, :2]
    covariance = np.zeros((2, 2))
    for factor, variance in ((1.0 / X, errors[1]), (-K / X, errors[0])):
        turn = np.array([[factor.real, factor.imag], [factor.imag, -factor.real]])
        covariance += variance * turn @ shape @ turn.T
    covariance += (_ROUNDING * abs(K)) ** 2 * np.eye(2)
    freedom = max(len(t) - basis.shape[1], 1)
    return Loop(label, omega, abs(X), K, covariance, third, freedom)


def _sines(t: np.ndarray, omega: float) -> np.ndarray:
    """Columns cos, sin of each harmonic, then a constant and a drift."""
    middle = t - t.mean()
    columns = []
    for order in range(1, _HARMONICS + 1):
        columns += [np.cos(order * omega * middle), np.sin(order * omega * middle)]
    return np.stack([*columns, np.ones(len(t)), middle / np.ptp(t)], axis=1)


def _solved(basis: np.ndarray, data: np.ndarray) -> np.ndarray:
    """Least squares by normal equations: sines are well apart."""
    found: np.ndarray = np.linalg.solve(basis.T @ basis, basis.T @ data)
    return found


def _frequency(t: np.ndarray, F: np.ndarray, where: str) -> float:
    """Angular frequency of the force by least squares, from its periodogram on."""
    from scipy import optimize

    span = float(np.ptp(t))
    least = 2.0 * math.pi * _PERIODS / span
    most = 0.8 * math.pi / float(np.median(np.diff(t)))

    scan = np.arange(0.5 * least, most, 1.0 / span)
    if len(scan) < 2:
        raise SheetError(f"{where}: fewer than {_PERIODS:g} periods, or too few samples in each")
    power = np.abs(np.exp(1j * np.outer(scan, t - t[0])) @ (F - F.mean()))
    best = float(scan[int(np.argmax(power))])

    def residual(x: np.ndarray) -> np.ndarray:
        basis = _sines(t, float(x[0]))
        error: np.ndarray = basis @ _solved(basis, F) - F
        return error

    polished = optimize.least_squares(residual, [best], x_scale=best, xtol=1e-14, ftol=1e-15)
    omega = float(polished.x[0])
    if omega < least:
        raise SheetError(
            f"{where}: is shorter than {_PERIODS:g} periods: record at least two of each frequency"
        )
    return omega


def _findings(
    sheet: Sheet,
    fit: regression.Fit,
    values: dict[str, Quantity],
    loops: list[Loop],
    offsets: np.ndarray,
    correction: _Correction,
    mass: float | None,
) -> list[str]:
    lines = []
    if not values["bristle_stiffness"].told:
        lines.append("bristle_stiffness cannot be told from these data.")
    if not values["bristle_damping"].told:
        lines.append(
            "bristle_damping cannot be told from these data: its force is lost in that of the "
            "stiffness. Take loops of a higher frequency, and of the same peak speed."
        )
    if "viscous friction" not in sheet.constants:
        lines.append(
            "Micro-slip tells the sum of bristle_damping and viscous_friction; the latter is taken "
            "as 0. Sliding at several speeds tells it (pull)."
        )
    if mass is None and "mass" not in values:
        lines.append(
            "The mass that rides on the contact is not given and one frequency does not tell it: "
            "bristle_stiffness is too low by mass times w^2."
        )
    for loop in loops:
        if loop.third > _ELLIPSE:
            lines.append(
                f"Loop {loop.label or 1} is no ellipse: its third harmonic is "
                f"{100 * loop.third:.2g} % of the first. It leaves pre-sliding; take a smaller one."
            )
    largest = float(np.max(np.abs(offsets) / [abs(loop.stiffness) for loop in loops]))
    if correction.is_given and largest > _SMALL:
        lines.append(
            f"The loops are quick for stribeck_speed: the correction is {100 * largest:.2g} %, and "
            "what it leaves out about the square of that. Take slower loops."
        )
    return lines


def _validity(loops: list[Loop], correction: _Correction) -> list[str]:
    low, high = (f([loop.amplitude for loop in loops]) for f in (min, max))
    slow, fast = (f([loop.omega for loop in loops]) / (2.0 * math.pi) for f in (min, max))
    lines = [
        f"Amplitudes from {low:.3g} to {high:.3g} m and frequencies from {slow:.3g} to {fast:.3g} "
        "Hz, at the normal load of the test: sigma_0 is that of the whole site, in N/m, and the "
        "law does not let it change with the load."
    ]
    if correction.is_given:
        lines.append("What sticking loses at these speeds is taken off, to first order.")
    else:
        peak = max(loop.omega * loop.amplitude for loop in loops)
        lines.append(
            f"Peak speed U = {peak:.3g} m/s, with U mu_C f far below sigma_1 v_s^2; give "
            f"{', '.join(correction.missing)} to have this taken off."
        )
    return lines


def _curves(sheet: Sheet, loops: list[Loop]) -> list[Curve]:
    curves = []
    for loop, (_, rows) in zip(loops, sheet.groups("loop"), strict=True):
        x, F = sheet.columns["displacement"][rows], sheet.columns["force"][rows]
        turn = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 200))
        curves.append(
            Curve(
                f"Loop {loop.label or 1}, {loop.omega / (2.0 * math.pi):.3g} Hz",
                "displacement [m]",
                "force [N]",
                x,
                F,
                x.mean() + loop.amplitude * turn.imag,
                F.mean() + (loop.amplitude * loop.stiffness * turn).imag,
            )
        )
    return curves
