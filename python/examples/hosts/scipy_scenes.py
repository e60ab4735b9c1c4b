# SPDX-License-Identifier: Apache-2.0
"""Both scenes in scipy: a rigid body as 13 equations, `solve_ivp` with an event at the touch."""

from itertools import pairwise

import numpy as np
from scipy import integrate
from two_scenes import GRAVITY, SAMPLE, Memory, Scene, cross, pose, show

METHOD = {"method": "DOP853", "rtol": 1e-9, "atol": 1e-11}


def motion(y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pose and twist of y: position, quaternion, angular velocity in the body, velocity."""
    X = pose(y[:3], y[3:7])
    return X, np.concatenate([X[:3, :3] @ y[7:10], y[10:]])


def slopes(t: float, y: np.ndarray, scene: Scene, memory: Memory) -> np.ndarray:
    """dy/dt by Newton and Euler."""
    X, V = motion(y)
    report = memory.report(t, X, V)
    w, q = y[7:10], y[3:7]
    turn = X[:3, :3].T @ report.torque_on_A - cross(w) @ (scene.inertia * w)
    spin = 0.5 * np.array([-q[1:] @ w, *(q[0] * w + cross(q[1:]) @ w)])
    fall = report.force_on_A / scene.mass + GRAVITY
    return np.concatenate([y[10:], spin, turn / scene.inertia, fall])


def run(scene: Scene) -> tuple[np.ndarray, np.ndarray, list[float]]:
    """Times [s], shape (n,), poses, shape (n, 4, 4), and when the watched gap closed [s].

    `solve_ivp` hides its steps. One call of it is a step that is accepted as a whole: within it
    every evaluation starts from the same memory.
    """
    memory, touches = Memory(scene.contact), []
    back = scene.X_WA[:3, :3].T
    y = np.r_[scene.position, scene.quaternion, back @ scene.V_WA[:3], scene.V_WA[3:]]

    def gap(_: float, y: np.ndarray, *unused: object) -> float:
        return float(scene.gap(pose(y[:3], y[3:7])))

    gap.direction = -1
    times = SAMPLE * np.arange(round(scene.duration / SAMPLE) + 1)
    poses, parts = [scene.X_WA], (scene, memory)
    for span in pairwise(times):
        solved = integrate.solve_ivp(slopes, span, y, args=parts, events=gap, **METHOD)
        y = solved.y[:, -1]
        touches += list(solved.t_events[0])
        memory.keep(span[1], memory.report(span[1], *motion(y)))
        poses.append(motion(y)[0])
    return times, np.array(poses), touches


if __name__ == "__main__":
    show(lambda scene: run(scene)[:2])
