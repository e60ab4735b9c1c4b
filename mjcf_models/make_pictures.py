# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of the scenes: `./run python mjcf_models/make_pictures.py`.

Panels from left to right: some instants under volumetric contact, then, for some scenes and behind
a white line, the end of the same run under MuJoCo's native contact.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib.image
import mujoco
import numpy as np

import volcontact as vc
from volcontact.render import Renderer
from volcontact.running.simulation import to_start

MODELS = Path(__file__).parent


@dataclass(frozen=True)
class Picture:
    """What a picture shows.

    Attributes:
        scene: path below this folder.
        panels: instants under volumetric contact, in order [s], and the camera of the scene.
        native: the same, one panel under native contact, or none.
        size: width and height of a panel [pixel].
    """

    scene: str
    panels: tuple[tuple[float, str], ...]
    native: tuple[float, str] | None = None
    size: tuple[int, int] = (360, 440)


PICTURES = {
    "acu_insert/picture.png": Picture(
        "acu_insert/scene.xml",
        ((0.0, "overview"), (24.0, "overview"), (24.0, "seat")),
        native=(24.0, "seat"),
        size=(400, 400),
    ),
    "battery_insert_0g/picture.png": Picture(
        "battery_insert_0g/scene.xml",
        ((0.0, "carrier"), (8.0, "corner"), (30.0, "carrier")),
        size=(480, 420),
    ),
    "battery_box_mesh/picture.png": Picture(
        "battery_box_mesh/scene.xml",
        ((0.0, "overview"), (0.2, "overview"), (1.0, "overview")),
        native=(3.0, "overview"),
        size=(400, 360),
    ),
    "canadarm_berth/picture.png": Picture(
        "canadarm_berth/scene.xml",
        ((0.0, "arm"), (0.0, "grasp"), (45.0, "grasp")),
        size=(520, 400),
    ),
    "gear_pair/picture.png": Picture(
        "gear_pair/scene.xml",
        ((0.0, "overview"), (0.1, "overview"), (0.1, "teeth")),
        size=(480, 400),
    ),
    "peg_in_hole/picture.png": Picture(
        "peg_in_hole/scene_mesh.xml",
        ((0.0, "overview"), (0.05, "overview"), (0.35, "overview")),
        native=(0.35, "overview"),
    ),
    "rpcm_rails/picture.png": Picture(
        "rpcm_rails/scene.xml",
        ((0.0, "overview"), (9.0, "tongue"), (34.0, "overview")),
        size=(400, 400),
    ),
}


def poses(model: mujoco.MjModel, panels: tuple[tuple[float, str], ...]) -> list[np.ndarray]:
    """The positions at the instants of the panels, each of shape (nq,)."""
    data = mujoco.MjData(model)
    to_start(model, data)
    found = []
    for time, _ in panels:
        while data.time < time - 0.5 * model.opt.timestep:
            mujoco.mj_step(model, data)
        found.append(data.qpos.copy())
    return found


def draw(picture: Picture) -> np.ndarray:
    """The panels side by side, shape (height, width, 3)."""
    scene = MODELS / picture.scene
    model = vc.load(scene)
    with vc.attach(model):
        states = poses(model, picture.panels)
    panels = picture.panels
    if picture.native is not None:
        panels += (picture.native,)
        states += poses(mujoco.MjModel.from_xml_path(str(scene)), (picture.native,))
    width, height = picture.size
    with Renderer(model, width=width, height=height) as renderer:
        drawn = [
            renderer.draw(state, view=camera)
            for state, (_, camera) in zip(states, panels, strict=True)
        ]
    if picture.native is not None:
        drawn.insert(-1, np.full((height, 8, 3), 255, np.uint8))
    return np.concatenate(drawn, axis=1)


def main() -> None:
    """Draws all pictures, or those whose folders are named."""
    for name, picture in PICTURES.items():
        if len(sys.argv) == 1 or name.split("/")[0] in sys.argv[1:]:
            matplotlib.image.imsave(MODELS / name, draw(picture))


if __name__ == "__main__":
    main()
