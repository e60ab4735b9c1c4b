# SPDX-License-Identifier: Apache-2.0
"""Presses a peg that touches its hole at two points, and tells whether it slides or jams.

The jamming diagram of [Whitney1982]: a peg of radius r is l deep in its hole and touches it with
its end on one side and with its flank on the other, on the rim. A force F_x across, F_z along the
hole and a moment M about the middle of the end act on it. The two normal forces and their friction
balance F_x and M, and F_z overcomes the friction, while

    |M / (r F_z) - mu (1 + lambda) F_x / F_z| < lambda,    lambda = l / (2 r mu).

Outside of these lines it jams. Signs: the peg leans towards +x, so that its end touches at -x, and
M is about +y, which is what makes it lean further.

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


def place(data: mujoco.MjData, width: float, azimuth: float) -> None:
    """Puts the peg where it touches a hole of that width [m] at two points.

    It leans towards +x, turned by `azimuth` [rad] about the axis of the hole, itself included.
    """
    angle = tilt(width)
    end = np.array([RADIUS * math.cos(angle) - width / 2, 0.0, UPPER_FACE - DEPTH])
    axis = np.array([math.sin(angle), 0.0, math.cos(angle)])
    middle = end + [0.0, 0.0, RADIUS * math.sin(angle)] + LENGTH / 2 * axis
    about_hole = np.array([math.cos(azimuth / 2), 0.0, 0.0, math.sin(azimuth / 2)])
    leaning = np.array([math.cos(angle / 2), 0.0, math.sin(angle / 2), 0.0])
    mujoco.mju_rotVecQuat(data.qpos[:3], middle, about_hole)
    mujoco.mju_mulQuat(data.qpos[3:7], about_hole, leaning)


def place_loaded(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    contact: vc.Contact,
    clearance: float,
    azimuth: float = 0.0,
) -> None:
    """Puts the peg so deep into the walls that the friction there can carry the load."""
    touching = 2 * RADIUS + clearance
    low, high = 0.0, 0.2 * clearance
    for _ in range(30):
        sink = 0.5 * (low + high)
        place(data, touching + sink, azimuth)
        mujoco.mj_forward(model, data)
        enough = FRICTION * contact.sites(data)["normal_force"].sum() > LOAD
        low, high = (low, sink) if enough else (sink, high)


def loaded_model(scene: Path) -> mujoco.MjModel:
    """The scene without gravity, with the time step and the slip speed of the presses."""
    model = vc.load(scene)
    model.opt.timestep = TIMESTEP
    model.opt.gravity[:] = 0.0
    model.numeric("volcontact/material/assembly/slip_speed").data[0] = SLIP_SPEED
    return model


def end_of(data: mujoco.MjData) -> np.ndarray:
    """The middle of the peg's lower end [m], shape (3,)."""
    peg = data.body("peg")
    return peg.xpos - LENGTH / 2 * peg.xmat.reshape(3, 3)[:, 2]


def press(
    scene: Path, clearance: float, across: float, moment: float, *, azimuth: float = 0.0
) -> Pressed:
    """Presses the peg of a scene, free of gravity.

    Args:
        scene: a scene with a free body `peg`.
        clearance: diameter of the hole less that of the peg [m].
        across: F_x / F_z [-].
        moment: M / (r F_z) [-].
        azimuth: of x in all of this, about the axis of the hole [rad].
    """
    model = loaded_model(scene)
    data = mujoco.MjData(model)
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "peg")
    c, s = math.cos(azimuth), math.sin(azimuth)
    force = LOAD * np.array([across * c, across * s, -1.0])
    couple = LOAD * RADIUS * moment * np.array([-s, c, 0.0])
    with vc.attach(model) as contact:
        place_loaded(model, data, contact, clearance, azimuth)
        start = end_of(data)
        for _ in range(round(DURATION / TIMESTEP)):
            arm = end_of(data) - data.xpos[body]
            data.xfrc_applied[body, :3] = force
            data.xfrc_applied[body, 3:] = couple + np.cross(arm, force)
            mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        arm = end_of(data) - data.xpos[body]
        turning = data.xmat[body].reshape(3, 3) @ data.qvel[3:6]
        speed = data.qvel[2] + np.cross(turning, arm)[2]
        travel = (start - end_of(data))[2]
        return Pressed(-float(speed), float(travel), len(contact.sites(data)))


def statics(scene: Path, clearance: float, across: float) -> float:
    """M / (r F_z) at which the peg is about to slide, from normals and centroids of its two sites.

    What the diagram does with corners and an upright peg: three equations of balance in the plane
    for two normal forces, with full friction, and the moment.
    """
    model = loaded_model(scene)
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        place_loaded(model, data, contact, clearance)
        sites = contact.sites(data)
    balance = np.zeros((3, 3))
    peg = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, "peg")
    for column, site in enumerate(sites):
        on_peg = site["normal"] if site["geom_a"] == peg else -site["normal"]
        upwards = np.array([-on_peg[2], 0.0, on_peg[0]])
        upwards *= np.sign(upwards[2])
        force = on_peg + FRICTION * upwards
        torque = np.cross(site["centroid"] - end_of(data), force)
        balance[:, column] = force[0], force[2], torque[1]
    balance[2, 2] = 1.0
    moment = np.linalg.solve(balance, [-across, 1.0, 0.0])[2]  # for F_z = 1
    return float(moment) / RADIUS


def bisect(scene: Path, clearance: float, across: float, *, azimuth: float = 0.0) -> float:
    """M / (r F_z) from which on the peg jams, to 0.2 % of lambda; the rest as in `press`."""
    low, high = 0.8, 1.2  # in lambdas, about the boundary
    for _ in range(7):
        share = 0.5 * (low + high)
        moment = boundary(across) + (share - 1.0) * slenderness()
        jammed = press(scene, clearance, across, moment, azimuth=azimuth).jammed
        low, high = (low, share) if jammed else (share, high)
    return boundary(across) + (0.5 * (low + high) - 1.0) * slenderness()


def main() -> None:
    """Prints where pegs begin to jam, beside the diagram and the statics."""
    print("M / (r F_z), and its distance from the diagram in % of lambda")
    for name, clearance in (("scene", 0.2e-3), ("scene_tight", 0.02e-3)):
        for across in (-1.0, 0.0, 1.0):
            diagram = boundary(across)
            found = [f(FOLDER / f"{name}.xml", clearance, across) for f in (statics, bisect)]
            off = [100 * (moment - diagram) / slenderness() for moment in found]
            print(
                f"{name:12}F_x/F_z {across:+.0f}: diagram {diagram:.3f}, statics of the sites "
                f"{found[0]:.3f} ({off[0]:+.1f} %), jams from {found[1]:.3f} ({off[1]:+.1f} %)"
            )


if __name__ == "__main__":
    main()
