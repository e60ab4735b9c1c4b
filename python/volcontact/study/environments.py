# SPDX-License-Identifier: Apache-2.0
"""Gymnasium environments as the head of a study: scene, start, controller, limits and goal."""

from __future__ import annotations

from typing import Any

from volcontact.messages.spelling import nearest
from volcontact.study.file.settings import StudyError

ENVIRONMENTS = ("volcontact/ORUInsertion-v0",)
_WHOLE = ("success", "pose", "jammed")  # one thing each, not to be mixed with the environment's


def with_environment(content: dict[str, Any], file: str) -> dict[str, Any]:
    """The tables of a study with those of the environment that it names filled in.

    What the study says itself stands.

    Raises:
        StudyError: there is no such environment, or a scene beside it.
    """
    head = content.get("study")
    if not isinstance(head, dict) or "environment" not in head:
        return content
    head = dict(head)
    name = head.pop("environment")
    if name not in ENVIRONMENTS:
        raise StudyError(
            f"{file} [study] environment = {name!r}: is unknown{nearest(str(name), ENVIRONMENTS)}"
        )
    for key in ("scene", "function"):
        if key in head:
            raise StudyError(f"{file} [study]: give either environment or {key}, not both")
    merged = {**content, "study": head}
    for table, defaults in _oru_insertion().items():
        own = merged.get(table)
        if own is None:
            merged[table] = defaults
        elif isinstance(own, dict) and table not in _WHOLE:
            merged[table] = {**defaults, **own}
    return merged


def _oru_insertion() -> dict[str, dict[str, Any]]:
    from volcontact.gym import oru_insertion as env
    from volcontact.gym.scene_files import scene_file

    def sensors(kind: str) -> list[str]:
        return [f"sensor/carrier_{kind}_{axis}" for axis in "xyz"]

    slow = [-env.SEATED_SPEED, env.SEATED_SPEED]
    return {
        "study": {
            "scene": str(scene_file(env.SCENE)),
            "timestep": env.TIMESTEP,
            "keyframe": "above",
        },
        "control": {"policy": "force_guided", "period": env.CONTROL_PERIOD},
        "pose": {"body": "battery_box", "keyframe": "seated"},
        "end": {
            "duration": env.CONTROL_PERIOD * env.MOST_ACTIONS,
            "force_limit": env.FORCE_LIMIT,
            "torque_limit": env.TORQUE_LIMIT,
            "force": sensors("force"),
            "torque": sensors("torque"),
        },
        "success": {
            "distance": [0.0, env.SEATED_DISTANCE],
            "angle": [0.0, env.SEATED_ANGLE],
            **{f"qvel/carrier_{axis}": slow for axis in "xyz"},
            "sensor/carrier_force_z": [float("-inf"), -env.SEATED_PUSH],
        },
    }
