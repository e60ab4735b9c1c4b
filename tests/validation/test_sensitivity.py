# SPDX-License-Identifier: Apache-2.0
"""What must not matter: the engine that integrates, and the number of threads."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from case import MODELS, Case, Figure, load, start

import volcontact as vc
from volcontact._mujoco_views import dense


def final_state(scene: str, steps: int, **options: float) -> np.ndarray:
    """Positions and speeds after some steps of a scene with more keys of volcontact/option."""
    text = (MODELS / scene).read_text()
    keys = "".join(
        f'<numeric name="volcontact/option/{key.replace("__", "/")}" data="{value}"/>'
        for key, value in options.items()
    )
    model = load(text[text.index("<mujoco") :].replace("<custom>", "<custom>" + keys))
    data = start(model)
    with vc.attach(model):
        mujoco.mj_step(model, data, steps)
    return np.concatenate([dense(data.qpos), dense(data.qvel)])


def measure() -> Case:
    """The same runs through other engines."""
    case = Case(
        "Engines and threads",
        "The first steps of three scenes, integrated by other engines than the one chosen for "
        "them: the largest difference of any coordinate or speed, against the tolerance of the "
        "octree.",
    )
    for scene, steps, engines in (
        ("tippe_top/scene.xml", 100, ("lines", "octree")),
        ("spinning_disc/scene.xml", 20, ("lines", "octree")),
        ("tumbling_box/scene.xml", 1100, ("octree",)),
    ):
        own = final_state(scene, steps)
        scale = float(np.abs(own).max())
        for engine in engines:
            other = final_state(scene, steps, **{f"engine__{engine}": 1, "tolerance": 1e-4})
            worst = float(np.abs(other - own).max()) / scale
            name = f"{scene.split('/')[0]}, {engine}: difference"
            case.figures.append(Figure(name, "-", 0.0, 1e-4, worst))
    return case


def test_engines_agree() -> None:
    measure().check()


SCENES = (
    "ball_in_cylinder",
    "bouncing_ball",
    "euler_disc",
    "incline",
    "painleve_rod",
    "spinning_disc",
    "tippe_top",
    "tumbling_box",
)


@pytest.mark.parametrize("scene", SCENES)
def test_number_of_threads_changes_no_bit(scene: str) -> None:
    one = final_state(f"{scene}/scene.xml", 2500, threads=1)
    assert (one == final_state(f"{scene}/scene.xml", 2500, threads=2)).all()
