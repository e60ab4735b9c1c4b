# SPDX-License-Identifier: Apache-2.0
"""What the step of a run costs, as a table and in words."""

from __future__ import annotations

from volcontact.convergence import LEAST, NOTHING, Convergence, Estimate, blow_of
from volcontact.report.key_figures import text_of
from volcontact.report.units import quantity

_LITTLE = 1e-6
_RESOLVED = 10.0  # steps that a blow lasts which is as good as smooth
_SMOOTH = 0.75  # least order of a smooth motion


def heads(found: Convergence) -> tuple[str, ...]:
    """Heads of the columns of `row_of`, but the first."""
    asked = f"{100 * found.within:g} % from"
    return (f"at {_time(found.steps[0])}", "tends to", "+-", "error", "order", asked)


def rows(found: Convergence) -> list[tuple[str, ...]]:
    """Of all figures that have a limit."""
    return [row_of(one) for one in found.estimates if one.limit is not None]


def row_of(one: Estimate) -> tuple[str, ...]:
    """Cells of a figure that has a limit: name, at first, limit, bar, error, order, step."""
    return (
        one.name,
        _number(one.values[0], one),
        _number(one.limit, one),
        _number(one.error, one),
        _share(one.error_of_first or 0.0, one),
        "" if one.order is None else f"{one.order:.1f}",
        "shorter" if one.step is None else _time(one.step),
    )


def sentences(found: Convergence) -> list[str]:
    """Smooth or impacts, the step that would do, what tends to nothing, what hangs on overlaps."""
    return (
        [line for line in (*_motion(found), _step(found), *_erratic(found)) if line]
        + [f"{one.name}: not in every run." for one in found.estimates if one.kind == "none"]
        + _overlaps(found)
    )


def _motion(found: Convergence) -> list[str]:
    blow = blow_of(found.runs[-1]) if found.runs else None
    if not found.runs:
        return []
    if blow is None:
        return ["Smooth: nothing is hit. All figures converge with the order of the integrator."]
    step = found.steps[0]
    count = blow.lasts / step
    hit = (
        f"the hardest blow, {quantity(blow.force, 'N')} at {_time(blow.time)}, lasts "
        f"{_time(blow.lasts)}, {count:.2g} of the steps of {_time(step)}"
    )
    is_resolved = count >= _RESOLVED
    ruled = [one.name for one in found.estimates if _is_ruled(one, found.within, is_resolved)]
    if is_resolved and not ruled:
        return [f"Smooth: {hit}, and every figure converges as in a smooth motion."]
    smooth = [
        one.name for one in found.estimates if one.limit is not None and one.name not in ruled
    ]
    lines = [f"Impacts: {hit}."]
    if ruled:
        lines.append(f"Ruled by impacts: {', '.join(ruled)}.")
    if smooth:
        lines.append(f"Smooth: {', '.join(smooth)}.")
    return lines


def _is_ruled(one: Estimate, within: float, is_resolved: bool) -> bool:
    """Erratic, or off by more than what was asked: by impacts, unless it has a smooth order."""
    if one.kind == "erratic":
        return True
    if one.limit is None or one.error_of_first is None:
        return False
    asked = max(within * abs(one.limit), NOTHING.get(one.unit, LEAST))
    is_off = abs(one.error_of_first) > asked
    return is_off and not (is_resolved and one.order is not None and one.order >= _SMOOTH)


def _step(found: Convergence) -> str:
    """What the step costs, and the one that would do."""
    known = [one for one in found.estimates if one.limit is not None]
    off = [one for one in known if one.step is None or one.step < found.steps[0]]
    percent, step = f"{100 * found.within:g} %", _time(found.steps[0])
    if not known:
        return ""
    if not off:
        return f"Every figure that tends to something is within {percent} at the step of {step}."
    worst = max(
        off, key=lambda one: abs(one.error_of_first or 0.0) / max(abs(one.limit or 0), LEAST)
    )
    costs = f"The step of {step} costs {_share(worst.error_of_first or 0.0, worst)} of "
    costs += worst.name[0].lower() + worst.name[1:]
    steps = [one.step for one in off]
    if None in steps:
        return f"{costs} at most; no step that was tried brings all within {percent}."
    least = min(each for each in steps if each is not None)
    return f"{costs} at most; {_time(least)} would bring all within {percent}."


def _erratic(found: Convergence) -> list[str]:
    lines = []
    for one in found.estimates:
        if one.kind == "erratic":
            low, middle, high = (text_of(value, one.unit) for value in one.spread())
            lines.append(
                f"{one.name} has no value that these steps tend to: {low} to {high}, {middle} in "
                f"the median of {len(one.values)} runs. Impacts that hang on how they are met have "
                "a distribution: take shorter steps, or ask for it with volcontact study."
            )
    return lines


def _overlaps(found: Convergence) -> list[str]:
    lines = []
    for one, change in zip(found.estimates, found.geometry, strict=False):
        scale = max((abs(value) for value in one.values if value is not None), default=0.0)
        if change is None or one.limit is None or abs(change) <= found.within * scale:
            continue
        lines.append(
            f"{one.name} changes by {_number(change, one)} when overlaps are asked for ten times "
            "as closely: give a smaller volcontact/option/tolerance."
        )
    return lines


def _time(seconds: float) -> str:
    return quantity(seconds, "s")


def _number(value: float | None, one: Estimate) -> str:
    nothing = value is not None and abs(value) <= NOTHING.get(one.unit, LEAST)
    return "0" if nothing else text_of(value, one.unit)


def _share(error: float, one: Estimate) -> str:
    if not one.limit or abs(one.limit) <= NOTHING.get(one.unit, LEAST):
        return _number(error, one)
    share = error / abs(one.limit)
    return f"{100.0 * share:+.2g} %" if abs(share) >= _LITTLE else "0"
