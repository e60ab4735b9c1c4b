# SPDX-License-Identifier: Apache-2.0
"""Runs of the programs in python/examples/hosts, and MuJoCo's run of the same scenes."""

from __future__ import annotations

import functools
import importlib
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import mujoco
import numpy as np

import volcontact as vc

ROOT = Path(__file__).parents[3]
EXAMPLES = ROOT / "python" / "examples" / "hosts"
HOSTS = {"scipy": "scipy", "drake": "pydrake", "dart": "dartpy", "basilisk": "Basilisk"}
FREE_FALL = float(np.sqrt(2.0 * np.sqrt(0.9**2 - 0.5**2) / 9.81))  # to the wall of the bore [s]


@dataclass(frozen=True)
class Run:
    """A run of a scene.

    Attributes:
        times: of the samples, shape (n,) [s].
        poses: of the body, shape (n, 4, 4).
        events: what happened when [s].
        touches: what the host itself found as events [s].
    """

    times: np.ndarray
    poses: np.ndarray
    events: dict[str, float]
    touches: tuple[float, ...] = ()


def module(name: str) -> ModuleType:
    """A program of python/examples/hosts, or the scenes they share."""
    if str(EXAMPLES) not in sys.path:
        sys.path.insert(0, str(EXAMPLES))
    return importlib.import_module(name)


@functools.cache
def in_host(host: str, name: str) -> Run:
    """The run of one of `HOSTS`."""
    scene = module("two_scenes").SCENES[name]()
    times, poses, *touches = module(f"{host}_scenes").run(scene)
    return Run(times, poses, scene.events(times, poses), *map(tuple, touches))


@functools.cache
def in_mujoco(name: str) -> Run:
    """The reference: the scene of mjcf_models, from its keyframe, at the step of its file."""
    scenes = module("two_scenes")
    scene = scenes.SCENES[name]()
    model = vc.load(str(ROOT / "mjcf_models" / name / "scene.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    every = round(scenes.SAMPLE / model.opt.timestep)
    times, poses = [], []
    with vc.attach(model):
        for i in range(round(scene.duration / scenes.SAMPLE) + 1):
            if i:
                mujoco.mj_step(model, data, every)
            mujoco.mj_kinematics(model, data)
            pose = np.eye(4)
            pose[:3, :3], pose[:3, 3] = data.xmat[1].reshape(3, 3), data.xpos[1]
            times.append(data.time)
            poses.append(pose)
    rows = np.array(times), np.array(poses)
    return Run(*rows, scene.events(*rows))
