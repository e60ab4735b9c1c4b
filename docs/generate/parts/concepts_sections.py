# SPDX-License-Identifier: Apache-2.0
"""Sections through two solids, for the pictures of the concepts page."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes

import volcontact as vc
from volcontact.report.palette import VOLUMETRIC

INK, SOLID_A, SOLID_B = "#30363d", "#e4e7eb", "#f6e3c5"
POINTS = 220  # across a section
Distance = Callable[[float, float], float]


def pose(x: float, z: float, degrees: float = 0.0) -> np.ndarray:
    """A pose in the plane y = 0, turned about y."""
    turn = np.radians(degrees)
    X = np.eye(4)
    X[0, [0, 2]] = np.cos(turn), np.sin(turn)
    X[2, [0, 2]] = -np.sin(turn), np.cos(turn)
    X[0, 3], X[2, 3] = x, z
    return X


def distance(solid: vc.Box, X: np.ndarray) -> Distance:
    """Signed distance of points (x, z) of the plane y = 0 to a posed solid."""
    back = np.linalg.inv(X)
    return lambda x, z: solid.signed_distance(back[:3, :3] @ np.array([x, 0.0, z]) + back[:3, 3])


def draw_section(
    axes: Axes, a: Distance, b: Distance, x: tuple[float, float], z: tuple[float, float]
) -> None:
    """Fills both solids and their overlap within x and z; the picture has one scale."""
    shape = POINTS, round(POINTS * (z[1] - z[0]) / (x[1] - x[0]))
    xs, zs = np.linspace(*x, shape[0]), np.linspace(*z, shape[1])
    of_a, of_b = (np.array([[d(u, v) for u in xs] for v in zs]) for d in (a, b))
    for values, color in ((of_a, SOLID_A), (of_b, SOLID_B)):
        axes.contourf(xs, zs, values, levels=[-1e9, 0.0], colors=[color])
        axes.contour(xs, zs, values, levels=[0.0], colors=[INK], linewidths=0.9)
    both = np.maximum(of_a, of_b)
    axes.contourf(xs, zs, both, levels=[-1e9, 0.0], colors=[VOLUMETRIC], alpha=0.75)
    axes.set_aspect("equal")
    axes.set_axis_off()


def arrow(axes: Axes, start: np.ndarray, step: np.ndarray, text: str, color: str = INK) -> None:
    """An arrow in the plane of the section with a name at its tip; points have y, too."""
    x, z = start[0] + step[0], start[2] + step[2]
    style = dict(arrowstyle="-|>,head_width=0.25,head_length=0.5", color=color, lw=1.6)
    axes.annotate("", (x, z), (start[0], start[2]), arrowprops=style | dict(shrinkA=0, shrinkB=0))
    axes.annotate(text, (x, z), xytext=(5, 2), textcoords="offset points", color=color)
