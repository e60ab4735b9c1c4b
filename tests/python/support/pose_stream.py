# SPDX-License-Identifier: Apache-2.0
"""A stream of poses through the core and through MuJoCo, written to a file.

A program of its own, so that one test can run it under several releases of MuJoCo:

    python pose_stream.py OUT.npz
"""

import sys
from pathlib import Path

import mujoco
import numpy as np

import volcontact as vc

SCENE = Path(__file__).parents[3] / "mjcf_models/battery_box/scene.xml"
POSES = 400


def pose(position, axis, angle):
    """A 4x4 pose from sums and products alone, which every NumPy rounds alike."""
    x, y, z = axis
    s, c = 2 * angle / (1 + angle * angle), (1 - angle * angle) / (1 + angle * angle)
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    square = np.array(
        [[sum(k[i, m] * k[m, j] for m in range(3)) for j in range(3)] for i in (0, 1, 2)]
    )
    made = np.eye(4)
    made[:3, :3] = np.eye(3) + s * k + (1 - c) * square
    made[:3, 3] = position
    return made


def through_the_core():
    """Forces, energies and states of pairs of many shapes along a motion: every bit counts."""
    mesh = vc.Mesh(
        vertices=np.vstack([np.zeros(3), 0.1 * np.eye(3)]),
        faces=np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)], np.int32),
    )
    solids = [
        (vc.Box(half_sizes=(0.1, 0.08, 0.05)), vc.Box(half_sizes=(0.3, 0.3, 0.05))),
        (vc.Sphere(radius=0.05), vc.HalfSpace()),
        (vc.Cylinder(radius=0.05, half_length=0.05), vc.Box(half_sizes=(0.3, 0.3, 0.05))),
        (vc.Torus(major_radius=0.06, minor_radius=0.05), vc.HalfSpace()),
        (mesh, vc.Box(half_sizes=(0.3, 0.3, 0.05))),
    ]
    rows = []
    for a, b in solids:
        model = vc.ContactModel(
            pairs=[vc.Pair(a, b)],
            normal=vc.HuntCrossley(stiffness=1e8, damping=0.7),
            friction=vc.Bristle(friction=0.15, coupling="quadrature"),
        )
        top = 0.0 if isinstance(b, vc.HalfSpace) else 0.05
        state = None
        for i in range(POSES // 4):
            t = i / POSES
            X = pose((0.01 * t, 0.02 * t * t, top + 0.0495 - 0.002 * t), (0.0, 0.6, 0.8), 0.01 * t)
            V = np.array([0.0, 0.1, 0.3 + t, 0.01, 0.02, -0.01])
            report = model.evaluate(X_WA=X, V_WA=V, state=state, elapsed=1e-3)
            state = report.state
            sums = [report.elastic_energy, report.metrics.volume]
            rows.append([*report.force_on_A, *report.torque_on_A, *report.torque_on_B, *sums])
    return np.array(rows)


def through_mujoco():
    """Generalized forces of the contacts of the battery box along a motion into its seat."""
    model = vc.load(SCENE)
    model.opt.timestep = 1e-4  # explicit: forces are those of the poses
    data = mujoco.MjData(model)
    rows = []
    with vc.attach(model) as contact:
        start = data.qpos.copy()
        touched = 0
        for i in range(POSES):
            t = i / POSES
            data.time = 1e-4 * i
            data.qpos[:] = start
            data.qpos[2] -= 0.2 * t
            data.qpos[0] += 0.002 * t * t
            data.qvel[:] = (0.02, 0.01, -0.3 * t, 0.1, -0.2, 0.3 * t)
            mujoco.mj_forward(model, data)
            rows.append(data.qfrc_applied.copy())
            touched += len(contact.sites(data)) > 0
    assert touched > POSES // 10
    return np.array(rows)


if __name__ == "__main__":
    np.savez(sys.argv[1], core=through_the_core(), mujoco=through_mujoco())
