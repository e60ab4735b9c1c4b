# SPDX-License-Identifier: Apache-2.0
"""Roll-out: rolling resistance from how a body that rolls slows down.

The law has the torque k_v a K w (docs/theory.md, "Rolling resistance"), and friction acts at the
centroid of the overlap, at the arm r below the middle, where nothing slips. So

    (I + m r^2) dw/dt = -k_v a K w,

an exponential decay. A constant part, as of rolling on dust or of hysteresis, is none of the law.
"""

from __future__ import annotations

import math

from volcontact.identify.direct.decay import Decay, fit_parts, parts_told
from volcontact.identify.direct.sheets import Sheet
from volcontact.identify.direct.solids import load_of, pressed, solids_of
from volcontact.identify.readings import LEVEL, Reading, scaled

_LABELS = {
    "rate": "angular velocity [rad/s]",
    "angle": "angle [rad]",
    "speed": "angular velocity [rad/s]",
    "distance": "angle [rad]",
}
_PART = 0.02  # of the torque at the mean rate: a constant part beyond it is told


def roll(sheet: Sheet, *, level: float = LEVEL) -> Reading:
    """Reads a roll-out test.

    Args:
        sheet: `time` and one of `rate`, `angle`, `speed`, `distance`; the constants `a` and `b`,
            `inertia`, `mass`, `stiffness` and, where it is not the weight, `normal force`.
        level: of the intervals.

    Returns:
        `damping` a [s/m]; `decay` l [1/s]; `rolling_torque` per rate, k_v a K [N m s]; and
        `constant_torque` [N m], which the law does not have.

    Raises:
        ValueError: the sheet does not have what the test needs.
    """
    a, b = solids_of(sheet)
    mass, inertia = sheet.number("mass"), sheet.number("inertia")
    stiffness = sheet.number("stiffness")
    contact = pressed(a, b, stiffness, load_of(sheet))
    arm = contact.arm
    decay = Decay(
        sheet,
        {"rate": 1.0, "angle": 1.0, "speed": 1.0 / arm, "distance": 1.0 / arm},
        {"rate": False, "angle": True, "speed": False, "distance": True},
    )
    rolled = inertia + mass * arm**2
    fit, both = fit_parts(decay, "linear")
    constant = both is not None and parts_told(both)
    if constant and both is not None:
        fit = both
    slow, fast = decay.span()
    per_rate = rolled / (stiffness * contact.second_moment)
    each = fit.quantity("linear", "1/s", level)
    values = {
        "damping": scaled(each, per_rate, "s/m"),
        "decay": each,
        "rolling_torque": scaled(each, rolled, "N m s"),
    }
    findings = []
    if not values["damping"].told or values["damping"].value <= 0.0:
        findings.append(
            "damping cannot be told from these data: the body hardly slows down as the law says. "
            "Roll longer or faster, or take rolling/off."
        )
    if constant:
        torque = scaled(fit.quantity("constant", "rad/s^2", level), rolled, "N m")
        values["constant_torque"] = torque
        share = fit["constant"] / (fit["constant"] + fit["linear"] * 0.5 * (slow + fast))
        if share > _PART:
            arm_of_it = torque.value / contact.load
            findings.append(
                f"{100 * share:.2g} % of the resistance does not fall with the speed: a torque of "
                f"{torque.value:.3g} N m, a rolling resistance of {arm_of_it:.3g} m. The law has "
                "none; add it as frictionloss of a joint, or as a torque of your own."
            )
    elif both is not None and not both.quantity("linear", "-").told:
        findings.append(
            "Whether the resistance falls with the speed, as in the law, or is constant cannot be "
            f"told from these data: the rate went from {fast:.3g} to {slow:.3g} rad/s alone. Roll "
            "until it is a third."
        )
    limit = contact.load * math.sqrt(2.0 * contact.second_moment * stiffness / contact.load)
    largest = values["rolling_torque"].value * fast
    if largest > limit:
        findings.append(
            f"The law limits the torque to {limit:.3g} N m, and here it would be {largest:.3g} N m "
            "at the start: leave the quickest part out."
        )
    told = values["damping"].told and values["damping"].value > 0.0
    return Reading(
        "roll",
        values,
        validity=(
            f"Rates from {slow:.3g} to {fast:.3g} rad/s, rolling without slip on a straight level "
            "line; a table that leans by 1 mrad adds as much as a rolling resistance of 1 mrad of "
            "the radius: roll both ways and take the mean.",
            f"k_v as given: the damping found is proportional to k_v / {stiffness:.4g} N/m^3 for a "
            "ball. It should agree with that of the drop test; if it does not, take the drop test "
            "for impacts and rolling/off with a torque of your own.",
        ),
        findings=tuple(findings),
        choices=("rolling/on",) if told else ("rolling/off",),
        written=("damping",) if told else (),
        curves=tuple(decay.curves(fit, _LABELS[decay.name])),
        converged=fit.converged,
        level=level,
    )
