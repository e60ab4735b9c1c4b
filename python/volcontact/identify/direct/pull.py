# SPDX-License-Identifier: Apache-2.0
"""Pull and tilt: mu_S, mu_C, v_s, sigma_2 and tau_dw from breakaways and steady slides."""

from __future__ import annotations

import math

import numpy as np

from volcontact.identify.direct.friction_law import (
    Breakaways,
    Slides,
    bound_rules,
    fit_friction,
    held,
    sliding,
)
from volcontact.identify.direct.sheets import Sheet, SheetError
from volcontact.identify.direct.solids import STANDARD_GRAVITY
from volcontact.identify.estimators.regression import Fit
from volcontact.identify.readings import LEVEL, Curve, Quantity, Reading

_NAMES = {
    "friction": "-",
    "static_friction": "-",
    "stribeck_speed": "m/s",
    "viscous_friction": "N s/m",
    "dwell_time": "s",
}
_NONE = np.empty(0)
_STEEP = 3.0  # of v_s or tau_dw that a table must reach


def pull(sheet: Sheet, *, level: float = LEVEL) -> Reading:
    """Reads a pull test.

    Args:
        sheet: rows with `rest` are breakaways, rows with `speed` steady slides; the constants
            `normal force` and perhaps `bristle damping`.
        level: of the intervals.

    Returns:
        `friction` and `static_friction` [-]; with breakaways `dwell_time` [s]; with slides
        `stribeck_speed` [m/s] and `viscous_friction` [N s/m].

    Raises:
        SheetError: the sheet does not have what the test needs.
    """
    load = sheet.number("normal force")
    rest = sheet.columns.get("rest", np.full(len(sheet.columns["force"]), math.nan))
    speed = sheet.columns.get("speed", np.full(len(rest), math.nan))
    still, moving = np.isfinite(rest), np.isfinite(speed)
    wrong = np.flatnonzero(still == moving)
    if len(wrong):
        both = "both" if still[wrong[0]] else "neither"
        raise SheetError(
            f"{sheet.source}: row {wrong[0] + 1} has {both} of rest and speed: a row is either a "
            "breakaway after a rest or a slide at a speed"
        )
    friction = sheet.columns["force"] / load
    damping = math.inf
    if "bristle damping" in sheet.constants:
        damping = sheet.number("bristle damping") / load
    breakaways = Breakaways(rest[still], friction[still])
    slides = Slides(speed[moving], friction[moving])
    return _reading("pull", breakaways, slides, load, damping, level)


def tilt(sheet: Sheet, *, level: float = LEVEL) -> Reading:
    """Reads a tilt test.

    Args:
        sheet: `angle` at which the sled breaks away, after `rest`; perhaps the `acceleration` with
            which it then slides at this angle.
        level: of the intervals.

    Returns:
        `static_friction` [-], `friction` [-] and, where rests differ, `dwell_time` [s].

    Raises:
        SheetError: the sheet does not have what the test needs.
    """
    angle = sheet.columns["angle"]
    if np.any(angle >= 0.5 * math.pi):
        raise SheetError(f"{sheet.source}: an angle is 90 degrees or more: check its unit")
    friction = np.tan(angle)
    slides = Slides(_NONE, _NONE)
    kinetic = _NONE
    if sheet.has("acceleration"):
        gravity = sheet.number("gravity", STANDARD_GRAVITY)
        a = sheet.columns["acceleration"]
        kinetic = (friction - a / (gravity * np.cos(angle)))[np.isfinite(a)]
        if np.any(kinetic <= 0.0):
            raise SheetError(
                f"{sheet.source}: an acceleration is more than that without friction at its angle"
            )
        slides = Slides(np.full(len(kinetic), math.inf), kinetic)
    rest = sheet.columns.get("rest", _NONE)
    if len(rest) and not np.isfinite(rest).all():
        raise SheetError(f"{sheet.source}: a row has no rest: fill it in, or leave the column out")
    if len(rest) and np.ptp(rest) > 0.0:
        return _reading("tilt", Breakaways(rest, friction), slides, math.nan, math.inf, level)
    return _one_rest(friction, kinetic, level)


def _one_rest(static: np.ndarray, kinetic: np.ndarray, level: float) -> Reading:
    """Means, where all rests are the same or not known."""
    from volcontact.identify.estimators import regression

    values = {}
    findings = [
        "dwell_time cannot be told from these data: all rests are the same or not known. "
        "static_friction is that of this rest."
    ]
    for name, data in (("friction", kinetic), ("static_friction", static)):
        if len(data):
            fit = regression.linear(np.ones((len(data), 1)), data, [name])
            values[name] = fit.quantity(name, "-", level)
            findings += fit.untold()
    if not len(kinetic):
        findings.append(
            "friction (mu_C) cannot be told from breakaways alone: time how the sled slides, "
            "column acceleration."
        )
    return Reading(
        "tilt",
        values,
        validity=(_FLAT,),
        findings=tuple(findings),
        choices=("friction_law/bristle",) if len(kinetic) else (),
        level=level,
    )


_FLAT = (
    "Sliding without spin and without tipping: pull low, and let the sled be flat against its "
    "height."
)


def _reading(
    name: str, breakaways: Breakaways, slides: Slides, load: float, damping: float, level: float
) -> Reading:
    kinetic_alone = len(slides.speed) > 0 and bool(np.isinf(slides.speed).all())
    fit = (
        fit_kinetic(breakaways, slides)
        if kinetic_alone
        else fit_friction(breakaways, slides, damping)
    )
    values = {}
    for each in fit.names:
        known = fit.quantity(each, _NAMES[each], level)
        if each == "viscous_friction":
            numbers = (known.value, known.deviation, known.low, known.high)
            value, deviation, low, high = (load * number for number in numbers)
            known = Quantity(max(value, 0.0), known.unit, deviation, low, high, low > 0.0)
        values[each] = known
    findings = _findings(fit, values, breakaways, slides, load, damping)
    written = tuple(each for each in values if each != "viscous_friction" or values[each].told)
    return Reading(
        name,
        values,
        validity=tuple(_validity(fit, breakaways, slides, load)),
        findings=tuple(findings),
        choices=("friction_law/bristle",),
        written=written,
        curves=tuple(_curves(fit, breakaways, slides, damping)),
        converged=fit.converged,
        level=level,
    )


def fit_kinetic(breakaways: Breakaways, slides: Slides) -> Fit:
    """Breakaways, and slides so fast that their friction is mu_C."""
    from volcontact.identify.estimators import regression

    data = np.concatenate([breakaways.friction, slides.friction])
    ones = np.ones(len(slides.friction))
    starts = [float(breakaways.rest.max()) * part for part in (0.1, 0.3, 0.7)]
    first = [float(slides.friction.mean()), float(breakaways.friction.max())]
    fits = [
        regression.fit(
            lambda x: np.concatenate([held(breakaways.rest, *x), x[0] * ones]) - data,
            [*first, tau],
            ["friction", "static_friction", "dwell_time"],
            low=[1e-9] * 3,
            groups=np.repeat([0, 1], [len(breakaways.rest), len(slides.speed)]),
        )
        for tau in starts
    ]
    return min(fits, key=lambda fit: float(fit.residuals @ fit.residuals))


def _findings(
    fit: Fit,
    values: dict[str, Quantity],
    breakaways: Breakaways,
    slides: Slides,
    load: float,
    damping: float,
) -> list[str]:
    lines = [line for line in fit.untold() if not line.startswith("viscous")]
    viscous = values.get("viscous_friction")
    if viscous is not None and not viscous.told:
        most = f" above {viscous.high:.3g} N s/m" if math.isfinite(viscous.high) else ""
        lines.append(
            f"viscous_friction{most} is out, and 0 fits as well: it is left away. Faster slides "
            "tell it."
        )
    if values["static_friction"].value < values["friction"].value:
        lines.append(
            "static_friction comes out below friction, which the law does not allow: this pair has "
            "no stiction, or force and speed were mixed up."
        )
    dwell = values.get("dwell_time")
    if dwell is None:
        lines.append("dwell_time cannot be told without breakaways after several rests.")
    elif breakaways.rest.max() < _STEEP * dwell.value and not len(slides.speed):
        lines.append(
            f"The longest rest is {breakaways.rest.max():.3g} s and dwell_time {dwell.value:.3g} "
            "s: static_friction is extrapolated. Let it rest three times as long."
        )
    stribeck = values.get("stribeck_speed")
    if stribeck is None:
        lines.append("stribeck_speed cannot be told without slides at several speeds (pull).")
        if not len(slides.speed):
            lines.append(
                "friction (mu_C) is extrapolated to a rest of 0 s: a slide measures it better."
            )
    elif slides.speed.max() < _STEEP * stribeck.value:
        lines.append(
            f"The fastest slide is below {_STEEP:g} times stribeck_speed: friction (mu_C) is "
            "extrapolated. Slide faster."
        )
    if stribeck is not None and math.isfinite(damping):
        kinetic, static = values["friction"].value, values["static_friction"].value
        if not bound_rules(kinetic, static, stribeck.value, damping):
            lines.append("Between the speeds bristle_damping limits the friction: it was used.")
    return lines


def _validity(fit: Fit, breakaways: Breakaways, slides: Slides, load: float) -> list[str]:
    lines = []
    if len(breakaways.rest):
        lines.append(
            f"Rests from {breakaways.rest.min():.3g} to {breakaways.rest.max():.3g} s, each "
            "counted up to the breakaway, the rise of the load with it; before it a slide far "
            "faster than stribeck_speed that stops at once."
        )
    if len(slides.speed) and np.isfinite(slides.speed).all():
        lines.append(
            f"Speeds from {slides.speed.min():.3g} to {slides.speed.max():.3g} m/s, each held for "
            "several dwell times; bristle_damping at least f (mu_S - mu_C) / (1.57 v_s)"
            + (
                f" = {_least_damping(fit, load):.3g} N s/m, or given as a constant."
                if "stribeck_speed" in fit.names
                else "."
            )
        )
    lines.append(_FLAT)
    return lines


def _least_damping(fit: Fit, load: float) -> float:
    return load * (fit["static_friction"] - fit["friction"]) / (1.57 * fit["stribeck_speed"])


def _curves(fit: Fit, breakaways: Breakaways, slides: Slides, damping: float) -> list[Curve]:
    curves = []
    kinetic, static = fit["friction"], fit["static_friction"]
    if len(breakaways.rest):
        grid = np.linspace(0.0, 1.05 * float(breakaways.rest.max()), 200)
        curves.append(
            Curve(
                "Breakaway after a rest",
                "rest [s]",
                "friction over normal force [-]",
                breakaways.rest,
                breakaways.friction,
                grid,
                held(grid, kinetic, static, fit["dwell_time"]),
            )
        )
    if "stribeck_speed" in fit.names:
        grid = np.linspace(1e-3, 1.05, 400) * float(slides.speed.max())
        numbers = fit["stribeck_speed"], fit["viscous_friction"], damping
        curves.append(
            Curve(
                "Steady sliding",
                "speed [m/s]",
                "friction over normal force [-]",
                slides.speed,
                slides.friction,
                grid,
                sliding(grid, kinetic, static, *numbers),
            )
        )
    return curves
