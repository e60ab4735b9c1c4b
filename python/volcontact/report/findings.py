# SPDX-License-Identifier: Apache-2.0
"""What two runs tell, in plain sentences computed from their data."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from volcontact.report.comparison import (
    Comparison,
    first_touch,
    is_seated,
    largest_rise,
    offset_from,
    peak,
)
from volcontact.report.design_pose import DesignPose, angle_between
from volcontact.report.units import angle, area, digits, nominal, quantity, ratio
from volcontact.running.outside_work import CHANNELS as OUTSIDE
from volcontact.running.recording import CHANNELS, Recording

_AT_REST = 1e-3  # [m/s]
_SAME = 1e-9  # poses that are told as one [m], [rad]
_NO_WORK = 1e-12  # of a channel that is not told [J]
_RISE = 1e-6  # of an energy that is worth a word [J], and of its range [-]
_NATIVE = OUTSIDE.index("native")
_WORKERS = {
    "actuators": "actuators",
    "dampers": "dampers",
    "limits": "limits and friction of joints, and equalities,",
    "native": "contacts that are left to MuJoCo",
}

Verdict = Literal["good", "bad", "plain"]


@dataclass(frozen=True)
class Finding:
    """One sentence or two about one thing.

    Attributes:
        title: the thing.
        text: the sentences.
        verdict: "good" or "bad" where the data decide it, else "plain".
    """

    title: str
    text: str
    verdict: Verdict = "plain"


def findings(comparison: Comparison) -> list[Finding]:
    """Everything worth a sentence, the most important first."""
    found = list(_trouble(comparison))
    if comparison.design is not None:
        found.append(_seating(comparison, comparison.design))
    found.append(_rest(comparison))
    found.extend(_final_pose(comparison))
    found.extend(_forces(comparison))
    found.extend(_peaks(comparison))
    found.extend(_sensors(comparison))
    found.extend(_penetration(comparison))
    found.extend(_places(comparison))
    found.append(_energy(comparison))
    found.append(_cost(comparison))
    return found


def _name(run: Recording) -> str:
    return {"volumetric": "Volumetric contact", "native": "Native contact"}[run.contact]


def _trouble(comparison: Comparison) -> Iterator[Finding]:
    for run in comparison.runs:
        if run.stopped is not None:
            yield Finding("Stopped", f"{_name(run)}: {run.stopped}.", "bad")
        if run.warnings:
            counts = ", ".join(f"{name} {count} times" for name, count in run.warnings.items())
            yield Finding("MuJoCo warnings", f"{_name(run)}: {counts}.", "bad")
        if run.dropped:
            text = f"{_name(run)}: in {run.dropped} evaluations a force was no finite number."
            yield Finding("Forces left out", text, "bad")


def _seating(comparison: Comparison, design: DesignPose) -> Finding:
    sentences = []
    for run in comparison.runs:
        offset = offset_from(run, design)
        seated = "seats the" if is_seated(run, design) else "does not seat the"
        sentences.append(
            f"{_name(run)} {seated} {_plain(design.body)}: it ends "
            f"{quantity(offset.distance[-1], 'm')} and {angle(float(offset.angle[-1]))} from its "
            "design pose."
        )
    sentences.append(
        f"Seated means within {nominal(design.position_tolerance, 'm')} and "
        f"{design.angle_tolerance:g}°, slower than {nominal(design.speed_tolerance, 'm/s')}."
    )
    verdict: Verdict = "good" if is_seated(comparison.volumetric, design) else "bad"
    return Finding("Seating", " ".join(sentences), verdict)


def _rest(comparison: Comparison) -> Finding:
    sentences = []
    for run in comparison.runs:
        speed = float(run.speed[-1].max(initial=0.0))
        state = "at rest" if speed < _AT_REST else "still moving"
        since = _resting_since(run)
        below = f", slower than {nominal(_AT_REST, 'm/s')} since {digits(since)} s" if since else ""
        sentences.append(f"{_name(run)} ends {state}, at {quantity(speed, 'm/s')}{below}.")
    return Finding("Rest", " ".join(sentences))


def _resting_since(run: Recording) -> float | None:
    moving = np.flatnonzero(run.speed.max(axis=1, initial=0.0) >= _AT_REST)
    if len(moving) == 0 or moving[-1] + 1 >= len(run.time):
        return None
    return float(run.time[moving[-1] + 1])


def _final_pose(comparison: Comparison) -> Iterator[Finding]:
    a, b = comparison.runs
    if not a.bodies:
        return
    shift = b.position[-1] - a.position[-1]
    body = int(np.argmax(np.linalg.norm(shift, axis=1)))
    turn = float(angle_between(a.quaternion[-1, body], b.quaternion[-1, body]))
    x, y, z = shift[body]
    if float(np.linalg.norm(shift[body])) < _SAME and turn < _SAME:
        text = f"The {_plain(a.bodies[body])} ends in the same pose in both runs."
        yield Finding("Final pose", text)
        return
    height = "as high as"
    if abs(z) >= 1e-6:
        height = f"{quantity(abs(z), 'm')} {'higher' if z > 0.0 else 'lower'} than"
    yield Finding(
        "Final pose",
        f"The {_plain(a.bodies[body])} ends {quantity(float(np.linalg.norm(shift[body])), 'm')} "
        f"and {angle(turn)} apart in the two runs: under native contact {height} under "
        f"volumetric contact and {quantity(float(np.hypot(x, y)), 'm')} to the side.",
    )


def _forces(comparison: Comparison) -> Iterator[Finding]:
    sentences = []
    for run in comparison.runs:
        touch = first_touch(run)
        if touch is None:
            sentences.append(f"{_name(run)}: nothing touches.")
            continue
        peak = int(np.argmax(run.contact_force))
        sentences.append(
            f"{_name(run)} begins at {digits(touch)} s and peaks with "
            f"{quantity(run.contact_force[peak], 'N')} at {digits(float(run.time[peak]))} s; at "
            f"the end its forces add up to {quantity(float(run.contact_force[-1]), 'N')}"
            f"{_share_of_weight(run)}."
        )
    a, b = (float(run.contact_force.max()) for run in comparison.runs)
    if a > 0.0 and b > 0.0:
        sentences.append(f"The native peak is {ratio(b, a)}.")
    yield Finding("Contact force", " ".join(sentences))


def _peaks(comparison: Comparison) -> Iterator[Finding]:
    limits = comparison.limits
    verdict: Verdict = "plain"
    sentences = []
    loads: tuple[tuple[Literal["force", "torque"], str, float | None], ...] = (
        ("force", "N", limits.force),
        ("torque", "N m", limits.torque),
    )
    for run in comparison.runs:
        for load, unit, limit in loads:
            most = peak(run, load)
            if most.value == 0.0:
                continue
            text = (
                f"{_name(run)}: the largest {load} of one place is {quantity(most.value, unit)}, "
                f"at {digits(most.time)} s between {most.geoms[0]} and {most.geoms[1]}"
            )
            if limit is not None:
                over = most.value > limit
                text += f", {'above' if over else 'within'} the limit of {nominal(limit, unit)}"
                if run is comparison.volumetric and verdict != "bad":
                    verdict = "bad" if over else "good"
            sentences.append(text + ".")
    if sentences:
        yield Finding("Load of one place", " ".join(sentences), verdict)


def _sensors(comparison: Comparison) -> Iterator[Finding]:
    """Sensors that the scene gives a limit: names end in what they measure."""
    verdict: Verdict = "good"
    sentences = []
    for run in comparison.runs:
        for name, limit in comparison.limits.sensors.items():
            if name not in run.sensors:
                raise ValueError(
                    f"the scene's peak_limits name sensor {name!r}; its sensors are: "
                    f"{', '.join(run.sensors) or 'none'}"
                )
            values = run.sensors[name]
            row = int(values.argmax())
            unit = "N m" if name.endswith("torque") else "N" if name.endswith("force") else ""
            over = values[row] > limit
            if over and run is comparison.volumetric:
                verdict = "bad"
            sentences.append(
                f"{_name(run)}: {name.replace('_', ' ')} peaks with "
                f"{quantity(float(values[row]), unit)} at {digits(float(run.time[row]))} s, "
                f"{'above' if over else 'within'} the limit of {nominal(limit, unit)}."
            )
    if sentences:
        yield Finding("Limits of the scene", " ".join(sentences), verdict)


def _share_of_weight(run: Recording) -> str:
    if run.weight <= 0.0:
        return ""
    share = float(run.contact_force[-1]) / run.weight
    return f", {digits(share)} times the weight of {quantity(run.weight, 'N')}"


def _penetration(comparison: Comparison) -> Iterator[Finding]:
    a, b = comparison.runs
    if a.penetration.max() <= 0.0 and b.penetration.max() <= 0.0:
        return
    yield Finding(
        "Penetration",
        f"The deepest site reaches {quantity(a.penetration.max(), 'm')} under volumetric and "
        f"{quantity(b.penetration.max(), 'm')} under native contact "
        f"(native {ratio(b.penetration.max(), a.penetration.max())}); at the end it is "
        f"{quantity(a.penetration[-1], 'm')} and {quantity(b.penetration[-1], 'm')}.",
    )


def _places(comparison: Comparison) -> Iterator[Finding]:
    a, b = comparison.runs
    if a.site_count.max() == 0 and b.site_count.max() == 0:
        return
    text = (
        f"At most {_count(a, 'site')} at once under volumetric and "
        f"{_count(b, 'contact point')} under native contact; at the end {a.site_count[-1]} and "
        f"{b.site_count[-1]}."
    )
    if a.frames and len(a.frames[-1].sites):
        sites = a.frames[-1].sites
        patches = area(float(sites["area"].sum()))
        text += f" The volumetric patches then cover {patches} in projection; points have no area."
    yield Finding("Contact places", text)


def _count(run: Recording, noun: str) -> str:
    number = int(run.site_count.max())
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _energy(comparison: Comparison) -> Finding:
    a, b = comparison.runs
    spent = float(a.dissipated[-1].sum())
    channels = ", ".join(
        f"{name} {quantity(value, 'J')}"
        for name, value in zip(CHANNELS, a.dissipated[-1], strict=True)
        if spent > 0.0 and value > 1e-3 * spent
    )
    text = "Volumetric contact does nothing."
    if a.site_count.any() or spent > 0.0:
        text = (
            f"Volumetric contact {_does(float(a.work[-1]))}, and {quantity(spent, 'J')} are "
            f"dissipated{f' ({channels})' if channels else ''}{_made_by_step(a)}."
        )
    text += _outside(a, native=False) + _unaccounted(a)
    by_contact = float(b.outside_work[-1, _NATIVE])
    did = _does(by_contact) if b.site_count.any() else "does nothing"
    text += f" Native contact {did}.{_outside(b, native=True)}{_unaccounted(b)}"
    if b.site_count.any():
        text += " It keeps no account of what it stores and dissipates."
    rise = largest_rise(b.energy - b.outside_work[:, :_NATIVE].sum(axis=1))
    if rise > max(_RISE, _RISE * float(np.ptp(b.energy))):
        text += (
            f" What it left, less what others put in, once stood {quantity(rise, 'J')} above an "
            "earlier value."
        )
    return Finding("Energy", text)


def _does(work: float) -> str:
    """What contact forces do on the motion."""
    verb = "take" if work <= 0.0 else "give"
    return f"{verb}s {quantity(abs(work), 'J')} {'from' if work <= 0.0 else 'to'} the motion"


def _outside(run: Recording, *, native: bool) -> str:
    """What else does work: actuators, dampers, limits, and in mixed scenes native contact."""
    told = []
    for i, name in enumerate(OUTSIDE):
        work = run.outside_work[:, i]
        if (native and i == _NATIVE) or float(np.abs(work).max()) <= _NO_WORK:
            continue
        who = _WORKERS[name]
        told.append(
            f"{who} {'put in' if work[-1] >= 0.0 else 'take'} {quantity(abs(float(work[-1])), 'J')}"
        )
    if run.driven.any():
        told.append(f"mocap bodies put in {quantity(float(run.driven[-1]), 'J')}")
    if not told:
        return ""
    sentence = ", ".join(told)
    return f" {sentence[0].upper()}{sentence[1:]}."


def _unaccounted(run: Recording) -> str:
    rest = run.unbalance()
    return (
        f" Unaccounted for: {quantity(float(np.abs(rest).max()), 'J')} at most, "
        f"{quantity(abs(float(rest[-1])), 'J')} at the end."
    )


def _made_by_step(run: Recording) -> str:
    """What neither the elastic energy nor the laws account for, where it is worth a word."""
    made = float(run.numerical[-1])
    if abs(made) <= 1e-3 * float(run.dissipated[-1].sum()):
        return ""
    return (
        f": {quantity(abs(made), 'J')} too {'much' if made < 0.0 else 'little'}, which is the "
        "error of a finite step in impacts and falls with it"
    )


def _cost(comparison: Comparison) -> Finding:
    a, b = (run.microseconds_per_step for run in comparison.runs)
    return Finding(
        "Cost",
        f"A step takes {quantity(1e-6 * a, 's')} under volumetric and {quantity(1e-6 * b, 's')} "
        f"under native contact (medians): {digits(a / b) if b > 0.0 else 'not comparable'} times.",
    )


def _plain(name: str) -> str:
    return name.replace("_", " ")
