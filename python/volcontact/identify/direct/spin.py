# SPDX-License-Identifier: Apache-2.0
"""Spin-down: friction against spin, and which coupling has it.

A body that spins on the spot with r_g w far above v_s loses spin under the torque mu_C f l, with
the lever l of the coupling: r_g for `ellipsoid`, the mean radius of the patch for `quadrature`, 0
for `none` (docs/theory.md, "Coupling of sliding and spin"). Viscous friction adds sigma_2 r_g^2 w.
"""

from __future__ import annotations

import math

from volcontact.identify.direct.decay import Decay, fit_parts, parts_told
from volcontact.identify.direct.sheets import Sheet
from volcontact.identify.direct.solids import Pressed, load_of, pressed, solids_of
from volcontact.identify.readings import LEVEL, Quantity, Reading, scaled

_FAST = 3.0  # times v_s: where sticking has ended to 1e-4
_LABELS = {"rate": "spin [rad/s]", "angle": "angle [rad]"}


def spin(sheet: Sheet, *, level: float = LEVEL) -> Reading:
    """Reads a spin-down test.

    Args:
        sheet: `time` and `rate` or `angle`; the constants `a`, `b`, `inertia` about the vertical,
            `stiffness`, `mass` or `normal force`; `friction` (mu_C, of a pull) where the coupling
            is to be found, `stribeck speed` to leave out what is too slow.
        level: of the intervals.

    Returns:
        `spin_torque` [N m] and `lever` of the friction [m]; with `friction` given the choice of the
        coupling whose lever is nearest, without it `friction` [-] for the coupling `ellipsoid`;
        `viscous_friction` [N s/m] where the data tell it from 0.

    Raises:
        ValueError: the sheet does not have what the test needs.
    """
    a, b = solids_of(sheet)
    inertia = sheet.number("inertia")
    contact = pressed(a, b, sheet.number("stiffness"), load_of(sheet))
    slowest = _FAST * sheet.number("stribeck speed", 0.0) / contact.gyration_radius
    decay = Decay(sheet, {"rate": 1.0, "angle": 1.0}, {"rate": False, "angle": True}, slowest)
    fit, both = fit_parts(decay, "constant")
    viscous = both is not None and parts_told(both)
    if viscous and both is not None:
        fit = both
    torque = scaled(fit.quantity("constant", "rad/s^2", level), inertia, "N m")
    values = {"spin_torque": torque}
    findings = [] if torque.told else ["spin_torque cannot be told from these data."]
    if viscous:
        factor = inertia / contact.gyration_radius**2
        known = scaled(fit.quantity("linear", "1/s", level), factor, "N s/m")
        values["viscous_friction"] = known
    choices: tuple[str, ...] = ()
    if "friction" in sheet.constants:
        kinetic = sheet.number("friction")
        lever = scaled(torque, 1.0 / (kinetic * contact.load), "m")
        values["lever"] = lever
        choices, lines = _coupling(lever, contact)
        findings += lines
    else:
        factor = 1.0 / (contact.load * contact.levers["ellipsoid"])
        values["friction"] = scaled(torque, factor, "-")
        other = torque.value / (contact.load * contact.levers["quadrature"])
        findings.append(
            "The coupling cannot be told without friction (mu_C) from a pull; friction is that for "
            f"the coupling ellipsoid, and {other:.4g} for quadrature."
        )
    if "stribeck speed" not in sheet.constants:
        findings.append(
            "stribeck speed is not given: samples at which the rim turns slower than three times "
            "it should be left out of the sheet."
        )
    slow, fast = decay.span()
    r = contact.gyration_radius
    return Reading(
        "spin",
        values,
        validity=(
            f"Spins from {slow:.3g} to {fast:.3g} rad/s, slip speeds r_g w from {r * slow:.3g} to "
            f"{r * fast:.3g} m/s with r_g = {r:.4g} m; on the spot, about the vertical.",
            "A flat patch has the r_g of its shape; that of a ball hangs on k_v and the load.",
        ),
        findings=tuple(findings),
        choices=choices,
        curves=tuple(decay.curves(fit, _LABELS[decay.name])),
        converged=fit.converged,
        level=level,
    )


def _coupling(lever: Quantity, contact: Pressed) -> tuple[tuple[str, ...], list[str]]:
    """The coupling whose lever is nearest, and whether the data tell it from the other."""
    levers = {**contact.levers, "none": 0.0}
    order = sorted(levers, key=lambda word: abs(levers[word] - lever.value))
    said = ", ".join(f"{word} {1e3 * length:.4g} mm" for word, length in levers.items())
    lines = []
    inside = [word for word in levers if lever.low <= levers[word] <= lever.high]
    if len(inside) > 1:
        lines.append(
            f"The coupling cannot be told: the lever is {1e3 * lever.value:.4g} mm within "
            f"{1e3 * lever.low:.4g} to {1e3 * lever.high:.4g}, and {said}."
        )
        return (), lines
    off = abs(levers[order[0]] - lever.value)
    if not inside and math.isfinite(lever.low) and off > 0.02 * lever.value:
        lines.append(
            f"The lever is {1e3 * lever.value:.4g} mm, that of no coupling ({said}): friction, "
            "normal force or the size of the patch is not what was given."
        )
        return (), lines
    return (f"coupling/{order[0]}",), lines
