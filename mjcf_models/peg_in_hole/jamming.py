# SPDX-License-Identifier: Apache-2.0
"""Presses a peg that touches its hole at two points, and tells whether it slides or jams.

The jamming diagram of [Whitney1982]: a peg of radius r is l deep in its hole and touches it with its
end on one side and with its flank on the other, on the rim. A force F_x across, F_z along the hole and
a moment M about the middle of the end act on it. The two normal forces and their friction balance
F_x and M, and F_z overcomes the friction, while

    |M / (r F_z) - mu (1 + lambda) F_x / F_z| < lambda,    lambda = l / (2 r mu).

Outside of these lines it jams. Signs: the peg leans towards +x, so that its end touches at -x, and M
is about +y, which is what makes it lean further.

    ./run python mjcf_models/peg_in_hole/jamming.py
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

import volcontact as vc

FOLDER = Path(__file__).parent
RADIUS = 0.004  # [m]
LENGTH = 0.05  # [m]
UPPER_FACE = 0.029  # height of the plate's upper face [m]
FRICTION = 0.4
DEPTH = 0.006  # of the end in the hole at the start [m]
LOAD = 1.0  # F_z [N]
DURATION = 0.02  # [s]
SLIP_SPEED = 0.005  # from which friction has its full strength [m/s]
TIMESTEP = 1e-5  # [s]


@dataclass(frozen=True)
class Pressed:
    """How a pressed peg ended.

    Attributes:
        speed: of its end down the hole, at the end [m/s].
        travel: of its end down the hole since the start [m].
        sites: number of contact sites at the end.
    """

    speed: float
    travel: float
    sites: int

    @property
    def jammed(self) -> bool:
        """Friction carries the load: the peg creeps below the slip speed of its regularisation."""
        return self.speed < SLIP_SPEED


def slenderness(depth: float = DEPTH) -> float:
    """The lambda of the diagram [-]."""
    return depth / (2 * RADIUS * FRICTION)


def boundary(across: float, depth: float = DEPTH) -> float:
    """M / (r F_z) beyond which a peg that leans to +x jams, for across = F_x / F_z [-]."""
    ratio = slenderness(depth)
    return ratio + FRICTION * (1 + ratio) * across


def tilt(width: float) -> float:
    """Angle at which the peg touches a hole of that width at two points [rad].

    2 r cos t + l sin t = width.
    """
    return math.asin(width / math.hypot(2 * RADIUS, DEPTH)) - math.atan2(2 * RADIUS, DEPTH)


def place(data: mujoco.MjData, width: float) -> None:
    """Puts the peg where it touches a hole of that width [m] at two points."""
    angle = tilt(width)
    end = np.array([RADIUS * math.cos(angle) - width / 2, 0.0, UPPER_FACE - DEPTH])
    axis = np.array([math.sin(angle), 0.0, math.cos(angle)])
    data.qpos[:3] = end + [0.0, 0.0, RADIUS * math.sin(angle)] + LENGTH / 2 * axis
    data.qpos[3:7] = [math.cos(angle / 2), 0.0, math.sin(angle / 2), 0.0]


def place_loaded(
    model: mujoco.MjModel, data: mujoco.MjData, contact: vc.Contact, clearance: float
) -> None:
    """Puts the peg so deep into the walls that the friction there can carry the load."""
    touching = 2 * RADIUS + clearance
    low, high = 0.0, 0.2 * clearance
    for _ in range(30):
        sink = 0.5 * (low + high)
        place(data, touching + sink)
        mujoco.mj_forward(model, data)
        enough = FRICTION * contact.sites(data)["normal_force"].sum() > LOAD
        low, high = (low, sink) if enough else (sink, high)


def press(scene: Path, clearance: float, across: float, moment: float) -> Pressed:
    """Presses the peg of a scene, free of gravity.

    Args:
        scene: a scene with a free body `peg`.
        clearance: diameter of the hole less that of the peg [m].
        across: F_x / F_z [-].
        moment: M / (r F_z) [-].
    """
    model = vc.load(scene)
    model.opt.timestep = TIMESTEP
    model.opt.gravity[:] = 0.0
    model.numeric("volcontact/material/assembly/slip_speed").data[0] = SLIP_SPEED
    data = mujoco.MjData(model)
    body = model.body("peg").id
    force = LOAD * np.array([across, 0.0, -1.0])
    couple = LOAD * RADIUS * moment * np.array([0.0, 1.0, 0.0])
    with vc.attach(model) as contact:
        place_loaded(model, data, contact, clearance)
        arm = -LENGTH / 2 * data.xmat[body].reshape(3, 3)[:, 2]  # from the middle to the end
        start = data.xpos[body] + arm
        for _ in range(round(DURATION / TIMESTEP)):
            arm = -LENGTH / 2 * data.xmat[body].reshape(3, 3)[:, 2]
            data.xfrc_applied[body, :3] = force
            data.xfrc_applied[body, 3:] = couple + np.cross(arm, force)
            mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        arm = -LENGTH / 2 * data.xmat[body].reshape(3, 3)[:, 2]
        turning = data.xmat[body].reshape(3, 3) @ data.qvel[3:6]
        speed = data.qvel[2] + np.cross(turning, arm)[2]
        travel = start[2] - (data.xpos[body] + arm)[2]
        return Pressed(-float(speed), float(travel), len(contact.sites(data)))


def main() -> None:
    """Presses pegs on either side of the boundary and prints what they do."""
    for name, clearance in (("scene", 0.2e-3), ("scene_tight", 0.02e-3)):
        for across in (-1.0, 0.0, 1.0):
            for share in (0.8, 0.9, 1.1, 1.2):
                moment = boundary(across) + (share - 1.0) * slenderness()
                pressed = press(FOLDER / f"{name}.xml", clearance, across, moment)
                print(f"{name}: F_x/F_z {across:+.1f}, M/(r F_z) {moment:+.3f}: {pressed}")


if __name__ == "__main__":
    main()
