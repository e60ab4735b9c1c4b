# SPDX-License-Identifier: Apache-2.0
"""The block diagram of docs/simulink.md: a free body and the contact model in a loop."""

from __future__ import annotations

from concepts_sections import INK
from make_concepts import Drawn
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

from volcontact.report.palette import NATIVE, VOLUMETRIC

Point = tuple[float, float]
Block = tuple[float, float, float, float]  # left, bottom, width, height

BODY: Block = (3.0, 4.0, 4.4, 2.6)
CONTACT: Block = (3.0, 0.3, 4.4, 2.6)
WORLD: Block = (0.2, 0.3, 1.7, 1.1)
SCOPE: Block = (8.9, 0.3, 1.2, 1.1)
MOTION = ("X_WA  place, attitude", "V_WA  angular velocity, velocity")
WRENCH = ("force on A", "torque on A")


def block_diagram() -> Drawn:
    """What figure 3 of the CSA paper shows, drawn anew: motion one way round, wrench the other."""
    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    axes = figure.subplots()
    axes.set(xlim=(0.0, 10.4), ylim=(0.0, 7.0), aspect="equal")
    axes.set_axis_off()
    block(axes, BODY, "Free body A", "mass, moments of inertia, gravity;\nNewton and Euler, 6 freedoms")
    block(axes, CONTACT, "Contact model", "volcontact_sfun, or an FMU", VOLUMETRIC)
    block(axes, WORLD, "Body B", "X_WB, V_WB")
    block(axes, SCOPE, "Scope", "")
    numbers: list[float] = [*BODY, *CONTACT, *WORLD, *SCOPE]
    for i, (motion, wrench) in enumerate(zip(MOTION, WRENCH, strict=True)):
        right, left = 8.0 + 0.45 * i, 2.3 - 0.45 * i
        out, into = 5.8 - 0.9 * i, 2.5 - 0.5 * i
        path = [(7.4, out), (right, out), (right, into), (7.4, into)]
        back = [(3.0, into), (left, into), (left, out), (3.0, out)]
        wire(axes, path)
        wire(axes, back, NATIVE)
        axes.text(8.95, 3.75 - 0.45 * i, motion, fontsize=8, ha="left", va="center", color=INK)
        axes.text(1.75, 3.75 - 0.45 * i, wrench, fontsize=8, ha="right", va="center", color=NATIVE)
        numbers += [n for point in (*path, *back) for n in point]
    wire(axes, [(1.9, 0.85), (3.0, 0.85)])
    wire(axes, [(7.4, 0.85), (8.9, 0.85)])
    axes.text(8.15, 1.0, "volume, depth,\nsites, energy,\npower", fontsize=8, ha="center")
    return figure, numbers


def block(axes: Axes, place: Block, title: str, text: str, color: str = INK) -> None:
    """A block with its name, and below it what it does."""
    x, y, width, height = place
    axes.add_patch(
        FancyBboxPatch(
            (x, y), width, height, boxstyle="round,pad=0,rounding_size=0.12", fc="white", ec=color, lw=1.6
        )
    )
    middle = x + 0.5 * width
    axes.text(
        middle, y + height * (0.62 if text else 0.5), title, ha="center", va="center", weight="bold"
    )
    axes.text(middle, y + 0.3 * height, text, ha="center", va="center", fontsize=8, color=INK)


def wire(axes: Axes, path: list[Point], color: str = INK) -> None:
    """A signal along straight lines, with its arrow at the end."""
    axes.plot(*zip(*path[:-1], strict=True), color=color, lw=1.4, solid_joinstyle="miter")
    style = dict(arrowstyle="-|>,head_width=0.25,head_length=0.5", color=color, lw=1.4)
    axes.annotate("", path[-1], path[-2], arrowprops=style | dict(shrinkA=0, shrinkB=0))
