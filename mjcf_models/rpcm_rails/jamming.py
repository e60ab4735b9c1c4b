# SPDX-License-Identifier: Apache-2.0
"""Pushes a card that leans in its slots, and tells whether it slides or jams.

The card is l deep and leans as far as its clearance lets it: the lower edge of one tongue touches
the end of its slot, the other tongue the mouth of the other slot. A force F pushes along the way
in, at a distance a from the middle, on the side of the mouth. The two normal forces N make the
couple N l = F a, and their friction, mu N on both sides alike, holds F when 2 mu N >= F: the card
jams for

    a >= l / (2 mu),

however wide it is: the drawer that is pulled at one handle. The lean, clearance over depth, is left
out. A card that is less deep than mu times its width may wedge: then the two places of contact lie
in each other's friction cones, and it holds itself by what it is pressed together, without a push.

    ./run python mjcf_models/rpcm_rails/jamming.py
"""

from __future__ import annotations

import contextlib
import math
from pathlib import Path

import mujoco
import numpy as np

import volcontact as vc

SCENE = Path(__file__).parent / "scene_push.xml"
FRICTION = 0.3
HALF_WIDTH, HALF_HEIGHT = 0.118, 0.12  # of the tongues, over both [m]
HALF_GAP = 0.1185  # between the ends of the slots [m]
MOUTH = 0.12  # height of the mouths [m]
LOAD = 20.0  # F [N]
RAMP, DURATION = 0.05, 0.25  # the load rises for so long, and acts [s]
CREEP = 1e-4  # a card that went no further than this is held [m]


def limit(depth: float) -> float:
    """Distance from the middle from which on a push jams the card [m]."""
    return depth / (2 * FRICTION)


def lean(depth: float) -> float:
    """Angle at which the card touches both slots [rad]: gap cos t - l sin t = width."""
    gap = 2 * HALF_GAP
    return math.acos(2 * HALF_WIDTH / math.hypot(gap, depth)) - math.atan2(depth, gap)


def place(data: mujoco.MjData, depth: float) -> None:
    """Puts the card where it touches both slots, its lower edge so deep below the mouths [m]."""
    angle = lean(depth)
    c, s = math.cos(angle), math.sin(angle)
    # The lower edge of the tongue at +y is at y = HALF_GAP and z = MOUTH - depth.
    data.qpos[:3] = [
        0.0,
        HALF_GAP - HALF_WIDTH * c - HALF_HEIGHT * s,
        MOUTH - depth - HALF_WIDTH * s + HALF_HEIGHT * c,
    ]
    data.qpos[3:7] = [math.cos(angle / 2), math.sin(angle / 2), 0.0, 0.0]


def travel(depth: float, aside: float, *, native: bool = False) -> float:
    """How far a card goes in that is pushed `aside` from its middle [m]; the rest as in `jams`."""
    model = mujoco.MjModel.from_xml_path(str(SCENE)) if native else vc.load(SCENE)
    data = mujoco.MjData(model)
    place(data, depth)
    card = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "card")
    start = float(data.qpos[2])
    with contextlib.nullcontext() if native else vc.attach(model):
        for _ in range(round(DURATION / model.opt.timestep)):
            force = np.array([0.0, 0.0, -LOAD * min(1.0, data.time / RAMP)])
            arm = np.array([0.0, -aside, data.qpos[2]]) - data.qpos[:3]
            data.xfrc_applied[card] = [*force, *np.cross(arm, force)]
            mujoco.mj_step(model, data)
    return start - float(data.qpos[2])


def jams(depth: float, aside: float) -> bool:
    """Whether friction holds a card so deep in its slots, pushed `aside` from its middle [m]."""
    return travel(depth, aside) < CREEP


def bisect(depth: float) -> float:
    """Distance from the middle from which on the card jams, to 0.5 % [m]."""
    low, high = 0.8, 1.2
    while high - low > 0.005:
        share = 0.5 * (low + high)
        low, high = (low, share) if jams(depth, share * limit(depth)) else (share, high)
    return 0.5 * (low + high) * limit(depth)


def main() -> None:
    """Prints where cards begin to jam, beside the closed form."""
    for depth in (0.09, 0.12, 0.15):
        found, expected = bisect(depth), limit(depth)
        print(
            f"{1e3 * depth:.0f} mm deep: l/(2 mu) = {1e3 * expected:.1f} mm, jams from "
            f"{1e3 * found:.1f} mm ({100 * (found / expected - 1):+.1f} %)"
        )


if __name__ == "__main__":
    main()
