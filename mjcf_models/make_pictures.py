# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of the scenes with meshes: `./run python mjcf_models/make_pictures.py`.

Panels from left to right: some instants under volumetric contact, then, behind a white line, the
end of the same run under MuJoCo's native contact.
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

MODELS = Path(__file__).parent


@dataclass(frozen=True)
class Picture:
    """What a picture shows.

    Attributes:
        scene: path below this folder.
        times: instants to draw under volumetric contact [s].
        native_time: instant to draw under native contact [s].
        size: width and height of a panel [pixel].
        camera: of the scene.
    """

    scene: str
    times: tuple[float, ...]
    native_time: float
    size: tuple[int, int] = (360, 440)
    camera: str = "overview"


PICTURES = {
    "peg_in_hole/picture.png": Picture("peg_in_hole/scene_mesh.xml", (0.0, 0.05, 0.35), 0.35),
}


def poses(model: mujoco.MjModel, times: tuple[float, ...]) -> list[np.ndarray]:
    """The positions at these instants [s], in order, each of shape (nq,)."""
    data = mujoco.MjData(model)
    found = []
    for time in times:
        while data.time < time - 0.5 * model.opt.timestep:
            mujoco.mj_step(model, data)
        found.append(data.qpos.copy())
    return found


def draw(picture: Picture) -> np.ndarray:
    """The panels side by side, shape (height, width, 3)."""
    scene = MODELS / picture.scene
    model = vc.load(scene)
    with vc.attach(model):
        states = poses(model, picture.times)
    states += poses(mujoco.MjModel.from_xml_path(str(scene)), (picture.native_time,))
    width, height = picture.size
    with Renderer(model, width=width, height=height) as renderer:
        panels = [renderer.draw(state, view=picture.camera) for state in states]
    line = np.full((height, 8, 3), 255, np.uint8)
    return np.concatenate([*panels[:-1], line, panels[-1]], axis=1)


def main() -> None:
    """Draws all pictures, or those whose folders are named."""
    for name, picture in PICTURES.items():
        if len(sys.argv) == 1 or name.split("/")[0] in sys.argv[1:]:
            matplotlib.image.imsave(MODELS / name, draw(picture))


if __name__ == "__main__":
    main()
