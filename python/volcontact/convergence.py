# SPDX-License-Identifier: Apache-2.0
"""How much of a figure is the step's: the same run at the step, at half of it, and so on."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import median
from typing import TYPE_CHECKING, Any, Literal

import mujoco

from volcontact.given_keys import Values
from volcontact.running.recording import ContactKind, Recording

if TYPE_CHECKING:
    from volcontact.report.design_pose import DesignPose
    from volcontact.running.driving import Drive

__all__ = ["Convergence", "Estimate", "converge", "estimate"]

Kind = Literal["converges", "settled", "erratic", "none"]
Progress = Callable[[int, int, str], None]

LEVELS = 5  # halvings and the run itself
WITHIN = 0.01
_SHRINKS = 0.8  # of a difference to the next, at most, where a figure converges
_ALIKE = 0.5  # orders of two pairs of differences that agree
_ROUNDING = 1e-12
NOTHING, LEAST = {"degree": 1e-3}, 1e-9  # below which nobody cares how little, in other units
_ORDERS = (0.3, 4.0)  # believed
# Factors of safety of [Roache1998]: where three runs or more agree on the order, and where not.
_SAFE, _UNSURE = 1.25, 3.0


@dataclass(frozen=True)
class Estimate:
    """One figure over the runs.

    Attributes:
        name: of the figure.
        unit: SI, "degree" for angles.
        values: by run, the longest step first; None where a run has no such figure.
        kind: "converges": its differences shrink from step to step; "settled": they do not, and
            the last runs differ by less than what was asked; "erratic": neither, so there is no
            value to converge to, only a distribution; "none": some run has no such figure.
        order: observed order in the step; None but where it converges.
        limit: extrapolated to no step; the last value where it settled; None else.
        error: of `limit`, either way.
        step: longest step from which on the figure is within what was asked [s]; may be shorter
            than any that was run; None where that is not known.
    """

    name: str
    unit: str
    values: tuple[float | None, ...]
    kind: Kind
    order: float | None = None
    limit: float | None = None
    error: float | None = None
    step: float | None = None

    @property
    def error_of_first(self) -> float | None:
        """How far the run with the longest step is from the limit."""
        first = self.values[0]
        return None if first is None or self.limit is None else first - self.limit

    def spread(self) -> tuple[float, float, float]:
        """Least, median and largest value of all runs."""
        values = [value for value in self.values if value is not None]
        return min(values), median(values), max(values)

    def summary(self) -> dict[str, Any]:
        """As of JSON."""
        return {
            "name": self.name,
            "unit": self.unit,
            "values": list(self.values),
            "kind": self.kind,
            "order": self.order,
            "limit": self.limit,
            "error": self.error,
            "step": self.step,
        }


@dataclass(frozen=True)
class Convergence:
    """All figures of a scene over its runs.

    Attributes:
        steps: of the runs, the longest first [s].
        within: what was asked of a figure, relative [-].
        estimates: by figure.
        geometry: by figure, how much the finest run changes when overlaps are asked for ten times
            as closely; none without that run.
        runs: of the steps, without their frames. One that stopped early, or was warned of, says
            nothing of the step: look at `stopped`, `warnings` and `dropped`.
    """

    steps: tuple[float, ...]
    within: float
    estimates: tuple[Estimate, ...]
    geometry: tuple[float | None, ...] = ()
    runs: tuple[Recording, ...] = ()

    def summary(self) -> dict[str, Any]:
        """As of JSON."""
        changes = self.geometry or (None,) * len(self.estimates)
        return {
            "steps": list(self.steps),
            "within": self.within,
            "figures": [
                {**one.summary(), "change_with_tolerance": change}
                for one, change in zip(self.estimates, changes, strict=True)
            ],
        }


@dataclass(frozen=True)
class Blow:
    """The hardest blow of a run.

    Attributes:
        force: largest sum of the contact forces [N].
        time: of it [s].
        lasts: how long it stays above half of that [s].
    """

    force: float
    time: float
    lasts: float


def blow_of(run: Recording) -> Blow | None:
    """The hardest blow of a run; None where nothing is touched, or where its force only rests.

    A force that lies above half of its peak from the first touch to the end is a load, not a blow.
    """
    force = run.contact_force
    top = int(force.argmax())
    if not force[top] > 0.0:
        return None
    above = force >= 0.5 * force[top]
    first = last = top
    while first > 0 and above[first - 1]:
        first -= 1
    while last < len(force) - 1 and above[last + 1]:
        last += 1
    if last == len(force) - 1 and not force[:first].any():
        return None
    return Blow(float(force[top]), float(run.time[top]), (last - first + 1) * run.timestep)


def converge(
    scene: str | os.PathLike[str] | mujoco.MjModel,
    *,
    duration: float,
    timestep: float | None = None,
    levels: int = LEVELS,
    within: float = WITHIN,
    contact: ContactKind = "volumetric",
    quantities: Sequence[str] = (),
    material: Values | None = None,
    options: Values | None = None,
    drive: Drive | None = None,
    with_tolerance: bool = True,
    first: Recording | None = None,
    progress: Progress | None = None,
) -> Convergence:
    """Runs a scene at its step, at half of it, and so on, and estimates what each figure tends to.

    Args:
        scene: path of an MJCF file, MJCF text, or a model (which is not changed).
        duration: [s].
        timestep: the longest [s]; None takes the scene's.
        levels: how many runs, each at half the step of the one before; 3 or more.
        within: relative error that is asked of a figure [-].
        contact: "volumetric" or "native".
        quantities: words of the names of the figures that are wanted; none: all.
        material: of volumetric contact, as `volcontact.attach` takes it.
        options: likewise.
        drive: where a run starts and its controls over time, as of `simulate`.
        with_tolerance: whether the finest run is made once more with a tenth of the tolerance.
        first: the run at the longest step, where it is there already.
        progress: called with (steps done, steps in all, which run).

    Returns:
        The estimates. Formulas: docs/convergence.md.

    Raises:
        SimulationError: a request out of range, or no figure has such a name.
        ValueError: the scene cannot be read or understood.
    """
    from volcontact.report.design_pose import read_design_pose
    from volcontact.running.simulation import SimulationError, simulate

    if levels < 3:
        raise SimulationError(f"levels = {levels} must be 3 or more: an order takes three runs")
    if not 0.0 < within < 1.0:
        raise SimulationError(f"within = {within:g} must be above 0 and below 1")

    design = None if isinstance(scene, mujoco.MjModel) else read_design_pose(str(scene))

    def run(step: float | None, name: str, extra: Values | None = None) -> Recording:
        def told(done: int, total: int) -> None:
            if progress is not None:
                progress(done, total, name)

        return simulate(
            scene,
            contact=contact,
            duration=duration,
            timestep=step,
            frame_interval=None,
            material=material,
            options={**dict(options or {}), **dict(extra or {})} or None,
            drive=drive,
            follow=() if design is None else (design.body,),
            progress=told,
        )

    runs = [first if first is not None else run(timestep, "1")]
    longest = runs[0].timestep
    steps = tuple(longest / 2**level for level in range(levels))
    runs += [run(step, f"1/{2**level}") for level, step in enumerate(steps) if level]
    rows = [_figures(one, design, quantities) for one in runs]
    estimates = tuple(
        estimate(name, unit, [row[name][1] for row in rows], steps, within)
        for name, (unit, _) in rows[0].items()
    )
    geometry: tuple[float | None, ...] = ()
    if with_tolerance and contact == "volumetric":
        tolerance = runs[-1].description["options"]["tolerance"]
        tenth = run(steps[-1], "tolerance / 10", {"tolerance": 0.1 * tolerance})
        fine = _figures(tenth, design, quantities)
        geometry = tuple(
            None if a is None or b is None else a - b
            for a, b in ((fine[name][1], rows[-1][name][1]) for name in rows[0])
        )
    return Convergence(steps, within, estimates, geometry, tuple(runs))


def _figures(
    run: Recording, design: DesignPose | None, quantities: Sequence[str]
) -> dict[str, tuple[str, float | None]]:
    from volcontact.report.key_figures import measured
    from volcontact.running.simulation import SimulationError

    every = {
        name: (unit, value if value is not None and math.isfinite(value) else None)
        for name, unit, value in measured(run, design)
    }
    if not quantities:
        return every
    words = [word.lower() for word in quantities]
    chosen = {
        name: rest for name, rest in every.items() if any(word in name.lower() for word in words)
    }
    if not chosen:
        raise SimulationError(
            f"no figure has {' or '.join(repr(word) for word in quantities)} in its name; there "
            f"are: {', '.join(every)}"
        )
    return chosen


def estimate(
    name: str,
    unit: str,
    values: Sequence[float | None],
    steps: Sequence[float],
    within: float = WITHIN,
) -> Estimate:
    """What a figure tends to as its steps are halved.

    Args:
        name: of the figure.
        unit: of it.
        values: by step, three or more.
        steps: each half of the one before [s].
        within: relative error that is asked of it [-].

    Returns:
        The estimate, by Richardson's extrapolation with the observed order [Roache1998].
    """
    known = [value for value in values if value is not None]
    if len(known) < len(values):
        return Estimate(name, unit, tuple(values), "none")
    scale, nothing = max(abs(value) for value in known), NOTHING.get(unit, LEAST)
    differences = [b - a for a, b in pairwise(known)]
    # What has come to nothing, or to the last digit, has no order.
    is_still = scale <= nothing or max(map(abs, differences[-2:])) <= _ROUNDING * scale
    orders = None if is_still else _orders(differences[-3:])
    if orders is None:
        last = known[-3:]
        limit, error = known[-1], max(last) - min(last)
        if error > max(within * scale, nothing):
            return Estimate(name, unit, tuple(known), "erratic")
        step = _step_within(known, steps, limit, _asked(within, limit, scale, nothing))
        return Estimate(name, unit, tuple(known), "settled", None, limit, error, step)
    order = min(max(sum(orders) / len(orders), _ORDERS[0]), _ORDERS[1])
    agree = len(orders) > 1 and max(orders) - min(orders) <= _ALIKE
    beyond = differences[-1] / (2.0**order - 1.0)
    error = (_SAFE if agree else _UNSURE) * abs(beyond)
    limit = known[-1] + beyond
    asked = _asked(within, limit, scale, nothing)
    step = _step_within(known, steps, limit, asked)
    if step is None:
        step = steps[-1] * (asked / abs(beyond)) ** (1.0 / order)
    return Estimate(name, unit, tuple(known), "converges", order, limit, error, step)


def _orders(differences: Sequence[float]) -> list[float] | None:
    """Order of each pair of differences; None where one does not shrink, or turns round."""
    orders = []
    for a, b in pairwise(differences):
        if a * b <= 0.0 or abs(b) > _SHRINKS * abs(a):
            return None
        orders.append(math.log2(abs(a / b)))
    return orders


def _asked(within: float, limit: float, scale: float, nothing: float) -> float:
    return max(within * (abs(limit) if limit != 0.0 else scale), nothing)


def _step_within(
    values: Sequence[float], steps: Sequence[float], limit: float, asked: float
) -> float | None:
    """The longest step from which on all values are that near to the limit; None where none is."""
    found = None
    for value, step in zip(reversed(values), reversed(steps), strict=True):
        if abs(value - limit) > asked:
            break
        found = step
    return found
