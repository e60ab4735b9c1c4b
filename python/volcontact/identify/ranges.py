# SPDX-License-Identifier: Apache-2.0
"""Bounds and scales of the parameters of the laws, where a file gives none."""

from __future__ import annotations

import inspect
import re
from typing import Any

import volcontact._volcontact as core

# Field of a law -> low, high, whether on a logarithmic scale. Wide: what is known belongs to the
# file. Whether the laws allow them is asked of the laws.
DEFAULTS: dict[str, tuple[float, float, bool]] = {
    "stiffness": (1e5, 1e11, True),
    "damping": (1e-3, 1e3, True),
    "restitution": (0.01, 1.0, False),
    "restitution_speed_floor": (1e-4, 1.0, True),
    "friction": (0.01, 2.0, False),
    "static_friction": (0.01, 2.0, False),
    "tangential_ratio": (1e-2, 10.0, True),
    "tangential_damping": (0.1, 100.0, True),
    "presliding": (1e-8, 1e-3, True),
    "slip_speed": (1e-5, 1.0, True),
    "bristle_stiffness": (1e2, 1e8, True),
    "bristle_damping": (1e-2, 1e6, True),
    "viscous_friction": (0.0, 100.0, False),
    "stribeck_speed": (1e-4, 1.0, True),
    "dwell_time": (1e-3, 10.0, True),
}
_LAW = re.compile(r"^(Normal|Friction) law '(\w+)'")


def field_of(target: str) -> str:
    """The field of a law that a target of the scene names; empty where it is none."""
    parts = target.split("/")
    if parts[0] == "volcontact" and len(parts) == 4 and parts[1] in ("material", "pair"):
        return parts[3]
    return ""


def laws_with(field: str) -> list[tuple[str, str]]:
    """Kinds and names of the laws that have a field."""
    found = []
    for item in vars(core).values():
        if not isinstance(item, type):
            continue
        said = _LAW.match(inspect.getdoc(item) or "")
        if said and hasattr(item, field):
            found.append((said[1], said[2]))
    return found


def reason_against(field: str, value: float) -> str:
    """Why no law takes the value for its field; empty where one does, or none has the field."""
    reasons = []
    for kind, law in laws_with(field):
        make: Any = core.make_normal if kind == "Normal" else core.make_friction
        given = {field: value}
        if field == "static_friction":
            given["friction"] = min(value, 0.2)
        elif field == "friction" and "static_friction" in dir(make(law)):
            given["static_friction"] = value
        try:
            make(law, **given)
        except ValueError as error:
            reasons.append(str(error))
        else:
            return ""
    return reasons[0] if reasons else ""
