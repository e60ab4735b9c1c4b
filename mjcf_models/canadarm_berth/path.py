# SPDX-License-Identifier: Apache-2.0
"""Writes path.xml: how the seven joints take the battery box to its seat.

The set point of each joint goes at a constant speed from where the box is 250 mm above its seat
towards the seat, and stops where all joints together push with 150 N: the shoulder and the elbow a
little beyond the seat, the wrist a little before it. The whole path is off by what the arm is
misaligned. With the same lag for all joints, damping over stiffness, the set points run ahead by
this time.

    ./run python mjcf_models/canadarm_berth/path.py
"""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np

FOLDER = Path(__file__).parent
SEATED = np.radians([0.0, 0.0, 40.0, 80.0, 60.0, 0.0, 0.0])
RISE = 0.25  # [m]
SPEED = 0.01  # [m/s]
PUSH = 150.0  # [N]
OFF = np.array([0.004, -0.003, 0.0, *np.radians([0.01, -0.01, 0.02])])  # at the grasp [m, rad]
STIFFNESS = 2e5  # [N m/rad]
LAG = 0.5  # [s]
GRASP = np.array([0.0, 0.0, 0.543])  # seated [m]


def arm() -> mujoco.MjModel:
    """The scene, whatever path it has now."""
    return mujoco.MjModel.from_xml_path(str(FOLDER / "scene.xml"))


def jacobian(model: mujoco.MjModel, data: mujoco.MjData, q: np.ndarray) -> np.ndarray:
    """Of place and turning of the grasp, shape (6, 7); the data are at q then."""
    data.qpos[:] = q
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    linear, angular = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jacSite(model, data, linear, angular, 0)
    return np.vstack([linear, angular])


def error(data: mujoco.MjData, height: float) -> np.ndarray:
    """What is left to the pose of the box upright at a height above the seat [m, rad]."""
    turned = data.site_xmat[0].reshape(3, 3)
    away = 0.5 * (
        np.cross(turned[:, 0], [1.0, 0.0, 0.0])
        + np.cross(turned[:, 1], [0.0, 1.0, 0.0])
        + np.cross(turned[:, 2], [0.0, 0.0, 1.0])
    )
    target = GRASP + np.array([0.0, 0.0, height])
    return np.concatenate([target - data.site_xpos[0], away])


def solve(model: mujoco.MjModel, data: mujoco.MjData, height: float) -> np.ndarray:
    """The joints with the box upright at a height above the seat, nearest to the seated ones."""
    q = SEATED.copy()
    for _ in range(20):
        along = jacobian(model, data, q)
        q += np.linalg.pinv(along) @ error(data, height)
    return q


def path() -> str:
    """The text of path.xml."""
    model = arm()
    data = mujoco.MjData(model)
    high, seat = solve(model, data, RISE), solve(model, data, 0.0)
    at_seat = jacobian(model, data, seat)
    off = np.linalg.pinv(at_seat) @ OFF
    pushing = at_seat[:3].T @ [0.0, 0.0, -PUSH] / STIFFNESS
    start, end = high + off, seat + off + pushing
    velocity = (seat - high) * SPEED / RISE
    velocity[np.abs(velocity) < 1e-9] = 0.0
    start = np.where(velocity == 0.0, end, start)
    ahead = start + LAG * velocity
    names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, i) for i in range(model.njnt)]

    def numbers(values: np.ndarray) -> str:
        return " ".join(f"{value:.9g}" for value in values + 0.0)

    lines = [
        "<!-- SPDX-License-Identifier: Apache-2.0 -->",
        "<!-- Written by path.py. The activations are the set points of the joints [rad]. -->",
        '<mujoco model="canadarm_path">',
        "  <actuator>",
    ]
    for name, low, top in zip(names, np.minimum(ahead, end), np.maximum(ahead, end), strict=True):
        lines.append(
            f'    <general class="arm" name="{name}" joint="{name}" '
            f'actrange="{low - 1e-9:.9g} {top + 1e-9:.9g}"/>'
        )
    lines += [
        "  </actuator>",
        "",
        "  <keyframe>",
        f'    <key name="start" qpos="{numbers(start)}"',
        f'      qvel="{numbers(velocity)}"',
        f'      act="{numbers(ahead)}"',
        f'      ctrl="{numbers(velocity)}"/>',
        f'    <key name="seated" qpos="{numbers(seat)}"',
        f'      act="{numbers(seat)}"/>',
        "  </keyframe>",
        "</mujoco>",
        "",
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    (FOLDER / "path.xml").write_text(path())
