# SPDX-License-Identifier: Apache-2.0
"""Volumetric stiffness from a Hertz contact at a stated load.

Spheres: F = 4/3 E* sqrt(R) d^1.5 [Johnson1985, section 4.2]. Cylinders: half width and approach of
[Johnson1985, sections 4.2 and 5.6]. A volume law has other powers of the depth, so the two agree at
one load, and in one respect: `match` says in which.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import volcontact._volcontact as core
from volcontact.identify.analytic import checks
from volcontact.identify.push import Push
from volcontact.identify.readings import Quantity, Reading

MATCHES = ("depth", "stiffness", "energy", "patch")
_SMALL = 0.1  # of a/R: what Hertz's theory takes for small
_YIELDS = 1.6  # largest pressure over the yield stress at which a sphere begins to yield
_HALVINGS = 200


@dataclass(frozen=True)
class Elastic:
    """An elastic material.

    Attributes:
        modulus: Young's, E [Pa]; infinity for a rigid body.
        poisson_ratio: nu [-].
    """

    modulus: float
    poisson_ratio: float = 0.3

    @property
    def compliance(self) -> float:
        """(1 - nu^2) / E [1/Pa]."""
        if not self.modulus > 0.0:
            raise ValueError(f"modulus = {self.modulus:g} [Pa]: must be above 0")
        return (1.0 - checks.poisson(self.poisson_ratio) ** 2) / self.modulus


RIGID = Elastic(math.inf)


@dataclass(frozen=True)
class _Contact:
    """What a theory says at the load: all that a volume law can be matched to."""

    load: float  # [N]
    depth: float  # [m]
    stiffness: float  # dF/d depth [N/m]
    energy: float  # [J]
    area: float  # of the patch [m^2]


def hertz(
    load: float,
    radius: float,
    material: Elastic,
    *,
    other_radius: float = math.inf,
    other: Elastic = RIGID,
    match: str = "depth",
    yield_stress: float | None = None,
) -> Reading:
    """k_v from Hertz's contact of a sphere with a plane or with another sphere.

    Args:
        load: F [N], at which the two agree.
        radius: of the sphere [m].
        material: of the sphere.
        other_radius: of the other sphere [m]; infinity for a plane.
        other: material of the other; rigid when left out.
        match: what agrees at the load: "depth" (so also the force at this depth), "stiffness" (the
            slope of the force, for vibration), "energy" (what is stored, for impacts) or "patch"
            (its area, for spin and rolling).
        yield_stress: of the softer one [Pa], to see whether it yields.

    Returns:
        `stiffness` k_v [N/m^3]; what Hertz says at the load: `depth` [m], `patch_radius` [m],
        `pressure`, the largest [Pa], `contact_stiffness` [N/m].

    Raises:
        ValueError: a number is out of range.
    """
    F = checks.above_zero("load", load, "N")
    checks.above_zero("radius", radius, "m")
    if not other_radius > 0.0:
        raise ValueError(f"other_radius = {other_radius:g} [m]: must be above 0, or infinity")
    R = 1.0 / (1.0 / radius + 1.0 / other_radius)
    modulus = _effective(material, other)
    depth = (9.0 * F**2 / (16.0 * R * modulus**2)) ** (1.0 / 3.0)
    a = math.sqrt(R * depth)
    pressure = 1.5 * F / (math.pi * a**2)
    said = _Contact(F, depth, 2.0 * modulus * a, 0.4 * F * depth, math.pi * a**2)
    below = core.HalfSpace() if math.isinf(other_radius) else core.Sphere(radius=other_radius)
    found = _matched(Push(core.Sphere(radius=radius), below), said, match)
    findings = _outside(a / min(radius, other_radius), pressure, yield_stress)
    strain = 0.2 * a / R
    validity = _validity(match, F, a / R, strain, 1.5, 2.0)
    return _reading("Hertz, spheres", found, said, a, pressure, validity, findings)


def hertz_cylinder(
    load: float,
    radius: float,
    length: float,
    material: Elastic,
    *,
    datum: float,
    other: Elastic = RIGID,
    match: str = "depth",
    yield_stress: float | None = None,
) -> Reading:
    """k_v from the line contact of a cylinder that lies on a plane.

    How far a cylinder sinks hangs on how deep below the surface that is measured: the approach of a
    line contact is that of its axis and a point at the depth `datum` in the plane.

    Args:
        load: F [N], over all of the length.
        radius: of the cylinder [m].
        length: of the contact [m].
        material: of the cylinder.
        datum: depth of the point in the plane [m], such as the thickness of the plate.
        other: material of the plane; rigid when left out.
        match: as for `hertz`.
        yield_stress: of the softer one [Pa].

    Returns:
        As `hertz`; `patch_radius` is half of the width.

    Raises:
        ValueError: a number is out of range.
    """
    F = checks.above_zero("load", load, "N")
    R = checks.above_zero("radius", radius, "m")
    L = checks.above_zero("length", length, "m")
    d = checks.above_zero("datum", datum, "m")
    modulus = _effective(material, other)

    def half_width(force: float) -> float:
        return math.sqrt(4.0 * force / L * R / (math.pi * modulus))

    def approach(force: float) -> float:
        b = half_width(force)
        own = material.compliance * (2.0 * math.log(4.0 * R / b) - 1.0)
        nu = other.poisson_ratio
        plane = other.compliance * (2.0 * math.log(2.0 * d / b) - nu / (1.0 - nu))
        return force / L / math.pi * (own + plane)

    b = half_width(F)
    if d < 2.0 * b:
        raise ValueError(
            f"datum = {d:g} [m]: must lie far below the contact, whose half width is {b:.3g} m"
        )
    step = 1e-5 * F
    slope = (approach(F + step) - approach(F - step)) / (2.0 * step)
    # x = F (p - q ln F), so that the integral of F dx is F (x + F dx/dF) / 4.
    energy = 0.25 * F * (approach(F) + F * slope)
    said = _Contact(F, approach(F), 1.0 / slope, energy, 2.0 * b * L)
    pressure = 2.0 * F / (math.pi * b * L)
    found = _matched(_Lying(R, L), said, match)
    findings = _outside(b / R, pressure, yield_stress)
    validity = _validity(match, F, b / R, 0.25 * b / R, 1.1, 1.5)
    return _reading("Hertz, cylinder on a plane", found, said, b, pressure, validity, findings)


class _Lying:
    """A cylinder on its side on a plane: the overlap in closed form."""

    def __init__(self, radius: float, length: float) -> None:
        self.radius, self.length = radius, length

    def volume(self, depth: float) -> tuple[float, float]:
        R, h = self.radius, min(depth, self.radius)
        chord = math.sqrt(h * (2.0 * R - h))
        area = R * R * math.acos(1.0 - h / R) - (R - h) * chord
        return self.length * area, 2.0 * self.length * chord

    def moment(self, depth: float) -> float:
        """Volume times the depth of its centroid [m^4]."""
        R, h = self.radius, min(depth, self.radius)
        chord = math.sqrt(h * (2.0 * R - h))
        return self.length * 2.0 / 3.0 * chord**3 - (R - h) * self.volume(h)[0]


def _effective(one: Elastic, two: Elastic) -> float:
    compliance = one.compliance + two.compliance
    if not compliance > 0.0:
        raise ValueError("both bodies are rigid: give the modulus of at least one")
    return 1.0 / compliance


def _matched(push: Push | _Lying, said: _Contact, match: str) -> float:
    """k_v, by the depth of the volume law at which what is matched agrees."""
    if match not in MATCHES:
        raise ValueError(f"match = {match!r}: must be one of {', '.join(MATCHES)}")

    def excess(depth: float) -> float:
        volume, area = push.volume(depth)
        if match == "depth":
            return depth - said.depth
        if match == "stiffness":  # F V'/V falls with the depth
            return said.stiffness * volume / (said.load * area) - 1.0
        if match == "energy":  # F Q/V rises
            return said.load * push.moment(depth) / (said.energy * volume) - 1.0
        return area / said.area - 1.0

    low, high = 1e-3 * said.depth, said.depth
    while excess(high) < 0.0:
        low, high = high, 2.0 * high
        if high > 1e4 * said.depth:
            raise ValueError("the load is too large for these bodies: nothing can be matched")
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0.0 else (low, middle)
        if high - low < 1e-13 * high:
            break
    return said.load / push.volume(high)[0]


def _outside(slenderness: float, pressure: float, yield_stress: float | None) -> list[str]:
    lines = []
    if slenderness > _SMALL:
        lines.append(
            f"The patch is {slenderness:.2g} of the radius: beyond {_SMALL:g} Hertz's theory of "
            "small strains does not hold; measure force over depth instead (press)."
        )
    if yield_stress is not None and pressure > _YIELDS * yield_stress:
        lines.append(
            f"The largest pressure, {pressure:.3g} Pa, is above 1.6 times the yield stress: the "
            "contact yields, and no elastic law holds."
        )
    return lines


def _validity(
    match: str, load: float, slenderness: float, strain: float, power: float, volume_power: float
) -> tuple[str, ...]:
    far = 10.0 ** (1.0 / power - 1.0 / volume_power)
    words = {
        "depth": "the depth, so also the force at this depth,",
        "stiffness": "the contact stiffness dF/dx",
        "energy": "the stored energy",
        "patch": "the area of the patch",
    }
    return (
        f"At {load:.4g} N {words[match]} is that of Hertz's contact. The force grows with the "
        f"power {power:g} of the depth there and {volume_power:g} here: measured by this load, the "
        f"volume law goes in {far:.2g} times as far as Hertz at a tenth of it, {1.0 / far:.2g} "
        "times at ten times.",
        f"Small strains: the patch is {slenderness:.2g} of the radius, the strain about "
        f"{strain:.1g}. Elastic, smooth, no adhesion.",
    )


def _reading(
    name: str,
    stiffness: float,
    said: _Contact,
    patch: float,
    pressure: float,
    validity: tuple[str, ...],
    findings: list[str],
) -> Reading:
    return Reading(
        name,
        {
            "stiffness": Quantity(stiffness, "N/m^3"),
            "depth": Quantity(said.depth, "m"),
            "patch_radius": Quantity(patch, "m"),
            "pressure": Quantity(pressure, "Pa"),
            "contact_stiffness": Quantity(said.stiffness, "N/m"),
        },
        validity=validity,
        findings=tuple(findings),
    )
