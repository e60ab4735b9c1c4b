# SPDX-License-Identifier: Apache-2.0
"""The block diagram of docs/simulink.md: a free body and the contact model in a loop."""

from __future__ import annotations

from make_concepts import Drawn
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch
from parts.concepts_sections import INK

from volcontact.report.palette import NATIVE, VOLUMETRIC

Point = tuple[float, float]
Block = tuple[float, float, float, float]  # left, bottom, width, height

BODY: Block = (3.0, 4.0, 4.4, 2.6)
CONTACT: Block = (3.0, 0.3, 4.4, 2.6)
WORLD: Block = (0.2, 0.3, 1.7, 1.1)
SCOPE: Block = (8.9, 0.3, 1.2, 1.1)
MOTION = (("X_WA", "place, attitude"), ("V_WA", "angular and linear velocity"))
WRENCH = ("force", "torque")


def block_diagram() -> Drawn:
    """What figure 3 of the CSA paper shows, drawn anew: motion one way round, wrench the other."""
    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    axes = figure.subplots()
    axes.set(xlim=(0.0, 12.0), ylim=(0.0, 7.0), aspect="equal")
    axes.set_axis_off()
    block(axes, BODY, "Free body A", "mass, inertia, gravity:\nNewton and Euler")
    block(axes, CONTACT, "Contact model", "volcontact_sfun, or an FMU", VOLUMETRIC)
    block(axes, WORLD, "Body B", "world: at rest")
    block(axes, SCOPE, "Scope", "")
    numbers: list[float] = [*BODY, *CONTACT, *WORLD, *SCOPE]
    for i, (motion, wrench) in enumerate(zip(MOTION, WRENCH, strict=True)):
        right, left = 8.45 - 0.45 * i, 1.95 + 0.45 * i  # the outer wire ends below the inner one
        out, into = 6.1 - 0.5 * i, 1.9 + 0.5 * i
        path = [(7.4, out), (right, out), (right, into), (7.4, into)]
        back = [(3.0, into), (left, into), (left, out), (3.0, out)]
        wire(axes, path)
        wire(axes, back, NATIVE)
        for y in (out, into):
            axes.text(7.25, y, motion[0], fontsize=8, ha="right", va="center")
            axes.text(3.15, y, wrench, fontsize=8, ha="left", va="center", color=NATIVE)
        axes.text(8.65, 3.75 - 0.45 * i, " ".join(motion), fontsize=8, va="center")
        numbers += [n for point in (*path, *back) for n in point]
    axes.text(1.75, 3.5, "wrench on A\nin the world", fontsize=8, ha="right", color=NATIVE)
    wire(axes, [(1.9, 0.8), (3.0, 0.8)])
    wire(axes, [(7.4, 0.8), (8.9, 0.8)])
    axes.text(3.15, 0.8, "X_WB, V_WB", fontsize=8, va="center")
    axes.text(7.25, 0.8, "contact", fontsize=8, ha="right", va="center")
    axes.text(9.5, 1.55, "volume, depth, area,\nsites, energy, power", fontsize=8, ha="center")
    return figure, numbers


def block(axes: Axes, place: Block, title: str, text: str, color: str = INK) -> None:
    """A block with its name, and below it what it does."""
    x, y, width, height = place
    shape = "round,pad=0,rounding_size=0.12"
    axes.add_patch(
        FancyBboxPatch((x, y), width, height, boxstyle=shape, fc="white", ec=color, lw=1.6)
    )
    middle = x + 0.5 * width
    axes.text(
        middle, y + height * (0.66 if text else 0.5), title, ha="center", va="center", weight="bold"
    )
    axes.text(middle, y + 0.4 * height, text, ha="center", va="center", fontsize=8, color=INK)


def wire(axes: Axes, path: list[Point], color: str = INK) -> None:
    """A signal along straight lines, with its arrow at the end."""
    axes.plot(*zip(*path[:-1], strict=True), color=color, lw=1.4, solid_joinstyle="miter")
    style = dict(arrowstyle="-|>,head_width=0.25,head_length=0.5", color=color, lw=1.4)
    axes.annotate("", path[-1], path[-2], arrowprops=style | dict(shrinkA=0, shrinkB=0))
