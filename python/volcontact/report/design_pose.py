# SPDX-License-Identifier: Apache-2.0
"""What a scene is designed for, from `expected.json` beside it: its last pose, its limits."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

FILE_NAME = "expected.json"


@dataclass(frozen=True)
class DesignPose:
    """Where a body should come to rest, and how near counts as seated.

    Attributes:
        body: its name.
        position: [m], world, shape (3,).
        quaternion: (w, x, y, z), shape (4,).
        position_tolerance: [m].
        angle_tolerance: [degree].
        speed_tolerance: [m/s].
    """

    body: str
    position: np.ndarray
    quaternion: np.ndarray
    position_tolerance: float
    angle_tolerance: float
    speed_tolerance: float


def read_design_pose(scene: str | os.PathLike[str]) -> DesignPose | None:
    """The design pose that `expected.json` beside a scene file gives; None where it gives none.

    Raises:
        ValueError: the file is there and cannot be understood.
    """
    with _reading(scene) as expected:
        if "design_position" not in expected:
            return None
        return DesignPose(
            body=str(expected["body"]),
            position=np.array(expected["design_position"], np.float64).reshape(3),
            quaternion=np.array(expected["design_quaternion"], np.float64).reshape(4),
            position_tolerance=float(expected["position_tolerance"]),
            angle_tolerance=float(expected["angle_tolerance_degrees"]),
            speed_tolerance=float(expected["speed_tolerance"]),
        )


def read_peak_limits(scene: str | os.PathLike[str]) -> dict[str, float]:
    """The `peak_limits` of sensors that `expected.json` beside a scene file gives, by name.

    Raises:
        ValueError: the file is there and cannot be understood.
    """
    with _reading(scene) as expected:
        return {str(k): float(v) for k, v in expected.get("peak_limits", {}).items()}


@contextlib.contextmanager
def _reading(scene: str | os.PathLike[str]) -> Iterator[dict[str, Any]]:
    """What the file beside a scene says of it; what goes wrong names the file."""
    text = os.fspath(scene)
    path = Path(text)
    file = path.parent / FILE_NAME
    if text.lstrip().startswith("<") or not file.is_file():
        yield {}
        return
    try:
        scenes: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))["scenes"]
        yield scenes.get(path.name, {})
    except KeyError as error:
        raise ValueError(f"{file}: {path.name} has no {error}") from error
    except (TypeError, ValueError, AttributeError) as error:
        raise ValueError(f"{file}: cannot be read ({error})") from error


def angle_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Angle of the rotation from one unit quaternion to the other [degree].

    Args:
        a: shape (..., 4).
        b: shape (..., 4), broadcast against a.
    """
    # The vector part of conj(a) b; its length is sin(angle / 2), exact where arccos is not.
    vector = a[..., :1] * b[..., 1:] - b[..., :1] * a[..., 1:] - np.cross(a[..., 1:], b[..., 1:])
    scalar = np.abs(np.sum(a * b, axis=-1))
    angle: np.ndarray = np.degrees(2.0 * np.arctan2(np.linalg.norm(vector, axis=-1), scalar))
    return angle
