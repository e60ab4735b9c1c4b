# SPDX-License-Identifier: Apache-2.0
"""The three lines that matter, under the figures of a run or of a comparison."""

from __future__ import annotations

import numpy as np

from volcontact.report.comparison import Comparison, is_seated, peak
from volcontact.report.design_pose import DesignPose, angle_between
from volcontact.report.units import angle, digits, quantity, ratio
from volcontact.running.recording import Recording

_AT_REST = 1e-3  # [m/s]


def closing(run: Recording, design: DesignPose | None) -> list[str]:
    """How a run ended, what contact carried, and where the energy went."""
    return [_end(run, design), _load(run), _energy(run)]


def closing_of_two(comparison: Comparison) -> list[str]:
    """How each run ended, and in what they differ."""
    a, b = comparison.runs
    lines = [f"{run.contact}: {_end(run, comparison.design)}; {_load(run)}" for run in (a, b)]
    if not a.bodies or len(a.time) == 0 or len(b.time) == 0:
        return [*lines, _energy(a)]
    shift = np.linalg.norm(b.position[-1] - a.position[-1], axis=1)
    body = int(np.argmax(shift))
    turn = float(angle_between(a.quaternion[-1, body], b.quaternion[-1, body]))
    line = f"apart at the end: {quantity(float(shift[body]), 'm')} and {angle(turn)}"
    line += f" ({a.bodies[body]})"
    forces = [float(run.contact_force.max()) for run in (a, b)]
    if min(forces) > 0.0:
        line += f"; the native peak force is {ratio(forces[1], forces[0])}"
    return [*lines, line]


def _end(run: Recording, design: DesignPose | None) -> str:
    if run.stopped is not None:
        return run.stopped
    speed = float(run.speed[-1].max(initial=0.0))
    text = f"ends after {digits(float(run.time[-1]))} s, "
    text += "at rest" if speed < _AT_REST else f"moving at {quantity(speed, 'm/s')}"
    if design is not None:
        text += f", {'seated' if is_seated(run, design) else 'not seated'}"
    return text


def _load(run: Recording) -> str:
    most = peak(run, "force")
    if most.value == 0.0:
        return "nothing touched"
    row = int(np.argmax(run.contact_force))
    return (
        f"contact force at most {quantity(float(run.contact_force[row]), 'N')} at "
        f"{digits(float(run.time[row]))} s, {quantity(float(run.contact_force[-1]), 'N')} at the "
        f"end; overlap at most {quantity(float(run.penetration.max()), 'm')} deep"
    )


def _energy(run: Recording) -> str:
    rest = quantity(float(np.abs(run.unbalance()).max()), "J")
    if run.contact == "native":
        taken = -float(run.outside_work[-1, -1])
        return f"energy: contact took {quantity(taken, 'J')}; unaccounted for: {rest} at most"
    spent = float(run.dissipated[-1].sum())
    return f"energy: contact dissipated {quantity(spent, 'J')}; unaccounted for: {rest} at most"
