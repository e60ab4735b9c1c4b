# SPDX-License-Identifier: Apache-2.0
"""Lets the peg of a scene fall through its hole and records the way it takes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

import volcontact as vc

DURATION = 0.07  # the peg has not landed yet [s]


@dataclass(frozen=True)
class Fall:
    """What the peg did. Rows belong to the beginnings of the steps.

    Attributes:
        positions: of the peg [m], shape (n, 3).
        quaternions: of the peg, shape (n, 4).
        volumes: of the overlap with the plate [m^3], shape (n,).
    """

    positions: np.ndarray
    quaternions: np.ndarray
    volumes: np.ndarray


def turn_start(data: mujoco.MjData) -> None:
    """Turns the start about the axis of the hole, by 0.4 rad, and the peg about its own.

    As the scenes have it, corners of peg and hole meet in the plane of the motion, so that polygons
    touch where circles do: meshes look better than they are.
    """
    about_hole = np.array([math.cos(0.2), 0.0, 0.0, math.sin(0.2)])
    about_peg = np.array([math.cos(0.15), 0.0, 0.0, math.sin(0.15)])
    mujoco.mju_rotVecQuat(data.qpos[:3], data.qpos[:3].copy(), about_hole)
    turned = np.zeros(4)
    mujoco.mju_mulQuat(turned, about_hole, data.qpos[3:7].copy())
    mujoco.mju_mulQuat(data.qpos[3:7], turned, about_peg)


def fall(scene: Path, *, turned: bool = True) -> Fall:
    """Runs a scene until just before the peg lands.

    Args:
        scene: one with a free body `peg`.
        turned: start with `turn_start`.
    """
    model = vc.load(scene)
    data = mujoco.MjData(model)
    if turned:
        turn_start(data)
    states, volumes = [], []
    with vc.attach(model) as contact:
        for _ in range(round(DURATION / model.opt.timestep)):
            states.append(data.qpos.copy())
            mujoco.mj_step(model, data)
            volumes.append(float(contact.sites(data)["volume"].sum()))
    table = np.array(states)
    return Fall(table[:, :3], table[:, 3:7], np.array(volumes))
