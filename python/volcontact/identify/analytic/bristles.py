# SPDX-License-Identifier: Apache-2.0
"""Bristle stiffness and damping from pre-sliding (micro-slip) stiffness.

In pre-sliding the law `bristle` is a spring sigma_0 and a damper sigma_1 + sigma_2 (docs/theory.md,
"Bristles"), so its dynamic stiffness is K(w) = sigma_0 + i w (sigma_1 + sigma_2).
"""

from __future__ import annotations

import math

from volcontact.identify.analytic import checks
from volcontact.identify.analytic.hertz import Elastic
from volcontact.identify.readings import Quantity, Reading

_SMALL_SHARE = 0.1  # of the friction that a load may be for the secant to count as the tangent


def bristles_from_microslip(
    stiffness: float,
    *,
    share: float = 0.0,
    mass: float | None = None,
    damping_ratio: float | None = None,
    loss: float | None = None,
    frequency: float | None = None,
    viscous_friction: float = 0.0,
) -> Reading:
    """sigma_0, sigma_1 and sigma_2 from a measured pre-sliding stiffness.

    Give the damping in one of two ways, or not at all: `damping_ratio` with `mass`, of the ringing
    of a part that sticks; or `loss` at a `frequency`, of the micro-slip loop.

    Args:
        stiffness: tangential force over displacement within the friction [N/m].
        share: of the friction that the force of the measurement was [-], 0 for the tangent at the
            start. A secant is corrected to the tangent by the theory of Mindlin's partial slip.
        mass: that rings on the contact [kg].
        damping_ratio: of that ringing, over critical [-].
        loss: loss factor of the loop [-], imaginary over real part of the dynamic stiffness.
        frequency: of the loop [Hz].
        viscous_friction: sigma_2 [N s/m], known from sliding.

    Returns:
        `bristle_stiffness` [N/m] and, where damping is given, `bristle_damping` [N s/m];
        `viscous_friction` [N s/m] where it is not 0.

    Raises:
        ValueError: a number is out of range, or half of a pair is missing.
    """
    checks.above_zero("stiffness", stiffness, "N/m")
    if not 0.0 <= share < 1.0:
        raise ValueError(f"share = {share:g} [-]: must be at least 0 and below 1, where it slides")
    # Displacement under the share q: 3 mu F / (2 k) (1 - (1 - q)^(2/3)) [Johnson1985, section 7.2].
    secant = 1.0 if share == 0.0 else share / (1.5 * (1.0 - (1.0 - share) ** (2.0 / 3.0)))
    sigma_0 = stiffness / secant
    values = {"bristle_stiffness": Quantity(sigma_0, "N/m")}
    findings = []
    total = None
    if damping_ratio is not None or mass is not None:
        if damping_ratio is None or mass is None:
            raise ValueError("damping_ratio and mass belong together: give both")
        checks.above_zero("damping_ratio", damping_ratio, "-")
        checks.above_zero("mass", mass, "kg")
        total = 2.0 * damping_ratio * math.sqrt(sigma_0 * mass)
    if loss is not None or frequency is not None:
        if loss is None or frequency is None:
            raise ValueError("loss and frequency belong together: give both")
        if total is not None:
            raise ValueError("damping_ratio and loss exclude each other: give one of them")
        checks.above_zero("loss", loss, "-")
        total = loss * sigma_0 / (2.0 * math.pi * checks.above_zero("frequency", frequency, "Hz"))
    if total is None:
        findings.append(
            "bristle_damping cannot be told from a stiffness alone: give damping_ratio and mass, "
            "or loss and frequency."
        )
    elif total <= viscous_friction:
        raise ValueError(
            f"viscous_friction = {viscous_friction:g} [N s/m]: must be below the damping of "
            f"micro-slip, {total:.4g} N s/m, which is the sum of sigma_1 and sigma_2"
        )
    else:
        values["bristle_damping"] = Quantity(total - viscous_friction, "N s/m")
        if viscous_friction == 0.0:
            findings.append(
                "Micro-slip tells the sum of bristle_damping and viscous_friction; the latter is "
                "taken as 0. Sliding at several speeds tells it (pull)."
            )
    if viscous_friction > 0.0:
        values["viscous_friction"] = Quantity(viscous_friction, "N s/m")
    if share > _SMALL_SHARE:
        findings.append(
            f"The measurement reached {share:.2g} of the friction: sigma_0 is {1.0 / secant:.3g} "
            "times the measured stiffness, by the theory of partial slip. Measure smaller loops to "
            "be sure."
        )
    return Reading(
        "bristles from micro-slip",
        values,
        validity=(
            "sigma_0 is that of the whole contact site, in N/m, at the normal load of the "
            "measurement: the law does not let it change with the load.",
            "Forces well within the friction, and speeds far below stribeck_speed.",
        ),
        findings=tuple(findings),
        choices=("friction_law/bristle",),
    )


def mindlin(load: float, radius: float, material: Elastic, other: Elastic | None = None) -> Reading:
    """sigma_0 of a Hertz contact: 8 G* a [Mindlin1949], [Johnson1985, section 7.2].

    Args:
        load: normal, F [N].
        radius: relative radius of the two spheres, 1/R = 1/R_A + 1/R_B [m].
        material: of one body.
        other: of the other; None for the same.

    Returns:
        `bristle_stiffness` [N/m], `patch_radius` [m] and `tangential_ratio` [-], that over the
        normal stiffness of Hertz's contact.

    Raises:
        ValueError: a number is out of range, or a body is rigid.
    """
    F = checks.above_zero("load", load, "N")
    R = checks.above_zero("radius", radius, "m")
    two = other or material
    shear = 0.0
    for one in (material, two):
        if not math.isfinite(one.modulus):
            raise ValueError("a rigid body has no shear modulus: give that of the softer one")
        shear += (2.0 - one.poisson_ratio) * 2.0 * (1.0 + one.poisson_ratio) / one.modulus
    modulus = 1.0 / (material.compliance + two.compliance)
    a = (3.0 * F * R / (4.0 * modulus)) ** (1.0 / 3.0)
    tangential = 8.0 * a / shear
    return Reading(
        "Mindlin, tangential stiffness",
        {
            "bristle_stiffness": Quantity(tangential, "N/m"),
            "patch_radius": Quantity(a, "m"),
            "tangential_ratio": Quantity(tangential / (2.0 * modulus * a), "-"),
        },
        validity=(
            f"At the normal load {F:.4g} N; it grows with the cube root of the load, and the law "
            "does not follow that.",
            f"The start of micro-slip; under half of the friction the contact gives "
            f"{1.5 * (1.0 - 0.5 ** (2.0 / 3.0)) / 0.5:.3g} times as much, since its rim slides.",
        ),
        choices=("friction_law/bristle",),
        written=("bristle_stiffness",),
    )
