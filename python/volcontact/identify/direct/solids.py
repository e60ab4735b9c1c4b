# SPDX-License-Identifier: Apache-2.0
"""The two solids of a sheet, and their contact under its normal load."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

import volcontact._volcontact as core
from volcontact.identify.direct.sheets import Sheet, SheetError
from volcontact.identify.push import Push
from volcontact.typed_solids import solid

STANDARD_GRAVITY = 9.80665


def solids_of(sheet: Sheet) -> tuple[Any, Any]:
    """A, and B below it.

    Raises:
        SheetError: a solid is not there, or not written as one.
    """
    words = sheet.word("a"), sheet.word("b", "half_space")
    try:
        return solid(words[0]), solid(words[1])
    except (ValueError, OSError) as error:
        raise SheetError(f"{sheet.source}: {error}") from error


def load_of(sheet: Sheet) -> float:
    """The normal force, or the weight of the mass [N].

    Raises:
        SheetError: neither is there.
    """
    if "normal force" in sheet.constants:
        return sheet.number("normal force")
    if "mass" in sheet.constants:
        return sheet.number("mass") * sheet.number("gravity", STANDARD_GRAVITY)
    raise SheetError(
        f'{sheet.source}: the normal force is missing; write "# normal force [N] = value" or '
        '"# mass [kg] = value" above the table, or give it with --given'
    )


@dataclass(frozen=True)
class Pressed:
    """The contact of two solids under a load.

    Attributes:
        load: [N].
        depth: [m].
        patch_radius: sqrt of the projected area over pi [m].
        arm: from the origin of A down to the centroid of the overlap [m].
        second_moment: of the overlap along x, int x^2 dV about the centroid [m^5].
        gyration_radius: r_g of the patch [m].
        levers: spin torque over mu times the load, by coupling [m].
    """

    load: float
    depth: float
    patch_radius: float
    arm: float
    second_moment: float
    gyration_radius: float
    levers: dict[str, float]


def pressed(a: Any, b: Any, stiffness: float, load: float) -> Pressed:
    """The contact at rest under a load."""
    push = Push(a, b)
    volume = load / stiffness
    depth = push.depth_of(volume)
    found = push.metrics(depth)
    inertia = np.asarray(found.inertia)
    second = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    area = abs(float(found.area_vector[2]))
    gyration = math.sqrt(float(inertia[2, 2]) / found.volume)
    pose = np.eye(4)
    pose[2, 3] = push.height - depth
    return Pressed(
        load,
        depth,
        math.sqrt(area / math.pi),
        float(pose[2, 3] - found.centroid[2]),
        float(second[0, 0]),
        gyration,
        {word: _lever(a, b, pose, stiffness, word) for word in ("ellipsoid", "quadrature")},
    )


def _lever(a: Any, b: Any, pose: np.ndarray, stiffness: float, coupling: str) -> float:
    """Spin torque per friction force, asked of the law itself."""
    model = core.ContactModel(
        pairs=[core.Pair(a, b)],
        normal=core.VolumeSpring(stiffness=stiffness),
        friction=core.RegularizedCoulomb(friction=1.0, slip_speed=1e-9, coupling=coupling),
    )
    twist = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    report = model.evaluate(X_WA=pose, V_WA=twist, X_WB=np.eye(4), V_WB=np.zeros(6))
    normal = abs(float(report.force_on_A[2]))
    return abs(float(report.torque_on_A[2])) / normal
