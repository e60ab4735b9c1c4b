# SPDX-License-Identifier: Apache-2.0
"""What is drawn of a contact site: its patch, its body, the forces, its numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from volcontact.report.units import area, quantity
from volcontact.surface import SiteSurface, stretch_to_see

_FULL = 0.3  # length of the arrow of the reference force, in scene extents
_LONGEST = 0.8  # arrow, in scene extents
_SHORTEST = 0.01
_LIFT = 0.002  # of patches into the moving body, in scene extents: else the other one hides them

Triangles = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class SiteDrawing:
    """One contact site in world frame. A native contact is a point: it has no patch and no body.

    Attributes:
        position: [m], shape (3,).
        normal: on the moving body, shape (3,).
        normal_arrow: from the position to the tip of the arrow of the normal force on the moving
            body [m], shape (3,); its length grows with the square root of the force.
        friction_arrow: the same of the force across the normal, on the same scale.
        patch: points [m] and triangles of the middle of the overlap, a little lifted into the
            moving body, or None.
        body: points [m] and triangles of the overlap, made thicker by `stretch`, or None.
        stretch: how many times thicker the body is than it is.
        label: its numbers.
    """

    position: np.ndarray
    normal: np.ndarray
    normal_arrow: np.ndarray
    friction_arrow: np.ndarray
    patch: Triangles | None
    body: Triangles | None
    stretch: float
    label: str


def draw_sites(
    model: mujoco.MjModel,
    sites: np.ndarray,
    surfaces: Sequence[SiteSurface | None] = (),
    *,
    stretch: float | None = None,
) -> list[SiteDrawing]:
    """What to draw of contact sites.

    Args:
        model: that they belong to.
        sites: structured array of `volcontact.running.recording.SITE`.
        surfaces: of each of them, None where it has no shape; none for native contacts.
        stretch: how many times thicker bodies are drawn; None makes each thick enough to be seen.
    """
    reference = reference_force(model, sites)
    return [
        _drawing(model, site, surfaces[i] if surfaces else None, reference, stretch)
        for i, site in enumerate(sites)
    ]


def reference_force(model: mujoco.MjModel, sites: np.ndarray) -> float:
    """The force whose arrow has full length [N]: the weight, without gravity the largest force."""
    weight = np.linalg.norm(model.opt.gravity) * model.body_mass[model.body_weldid != 0].sum()
    forces = np.linalg.norm(sites["force"], axis=1)
    return float(weight) or float(forces.max(initial=0.0)) or 1.0


def _drawing(
    model: mujoco.MjModel,
    site: np.void,
    surface: SiteSurface | None,
    reference: float,
    stretch: float | None,
) -> SiteDrawing:
    moves = model.body_weldid[model.geom_bodyid[site["geom_a"]]] != 0
    sign = 1.0 if moves else -1.0
    normal, force = sign * site["normal"], sign * site["force"]
    along = float(force @ normal) * normal
    extent = float(model.stat.extent)
    shape = None if surface is None or surface.is_empty else surface
    if stretch is None:
        stretch = stretch_to_see(site["area"], site["depth"])
    return SiteDrawing(
        position=site["position"].copy(),
        normal=normal,
        normal_arrow=_arrow(along, reference, extent),
        friction_arrow=_arrow(force - along, reference, extent),
        patch=None if shape is None else _lifted(shape.patch, _LIFT * extent * normal),
        body=None if shape is None else shape.body(stretch),
        stretch=stretch,
        label=_label(site, float(np.linalg.norm(along)), float(np.linalg.norm(force - along))),
    )


def _lifted(triangles: Triangles, shift: np.ndarray) -> Triangles:
    return triangles[0] + shift, triangles[1]


def _arrow(force: np.ndarray, reference: float, extent: float) -> np.ndarray:
    magnitude = float(np.linalg.norm(force))
    length = _FULL * extent * np.sqrt(magnitude / reference)
    if length < _SHORTEST * extent:
        return np.zeros(3)
    arrow: np.ndarray = force * (min(length, _LONGEST * extent) / magnitude)
    return arrow


def _label(site: np.void, normal_force: float, friction: float) -> str:
    parts = [quantity(normal_force, "N")]
    if friction > 1e-3 * normal_force:
        parts.append(f"friction {quantity(friction, 'N')}")
    parts.append(f"{quantity(float(site['depth']), 'm')} deep")
    if site["area"] > 0.0:
        parts.append(area(float(site["area"])))
    return ", ".join(parts)
