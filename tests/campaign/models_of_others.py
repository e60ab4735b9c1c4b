# SPDX-License-Identifier: Apache-2.0
"""Models that packages ship, as they are, each at its own step, under random controls.

Beside native contact from the same starts and controls: no warning that native contact does not
give, nothing that is no number, and joints at most twice as fast, or as with the same contact at a
tenth of the step. The wheels lie in the folder
VOLCONTACT_THIRD_PARTY, where `campaign.py` puts what is missing.
"""

from __future__ import annotations

import copy
import functools
import importlib.util
import math
import os
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import mujoco
import numpy as np

import volcontact as vc

WORST = "ratio"
NAME = "models_of_others"
KEYS = ("package", "model", "stiffness", "seed")
SHARED = ("package", "model", "seed")  # cases that have these in common share work
COLUMNS = (
    *(*KEYS, "integrator", "timestep", "dofs", "speed", "native_speed", "ratio"),
    *("fine_speed", "fine_warnings", "warnings", "native_warnings", "dropped", "numerical"),
    *("said", "refused"),
)
ROOT = Path(__file__).resolve().parents[2]
STIFFNESSES = (1e7, 1e8, 1e9, 1e10)  # [N/m^3]
SEEDS = 20
SECONDS, MOST_STEPS = 2.0, 1000
HOLD = 50  # steps that a control is held
MOST = 2.0  # times as fast as a joint may be
STANDS = 1e3  # times its inertia that the damping of a joint takes in a step
FINER = 10  # times as many steps, where joints are faster than that
OPTIONS = {"mesh": "exact_or_hull"}

# Wheels, and the folders of theirs whose MJCF files are whole models.
PACKAGES = {
    "dm_control": ("1.0.50", ("dm_control/suite", "dm_control/locomotion/walkers/assets")),
    "gymnasium": ("1.4.0", ("gymnasium/envs/mujoco/assets",)),
}
NOT_ALONE = ("common", "skin", "mesh", "kitchen0")  # parts of models


def folder() -> Path:
    """Where the wheels are unpacked."""
    return Path(os.environ.get("VOLCONTACT_THIRD_PARTY", ROOT / "build" / "third_party"))


@functools.cache
def third_party() -> ModuleType:
    """The scenes of metaworld, robosuite and gymnasium-robotics, and how they are put together."""
    path = ROOT / "tests" / "benchmarks" / "third_party.py"
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module  # where its dataclasses look for it
    spec.loader.exec_module(module)
    return module


def install() -> None:
    """Unpacks what is missing, without what it depends on: the MJCF is all that is needed."""
    uv = ROOT / ".venv" / "tools" / "bin" / "uv"
    versions = {name: version for name, (version, _) in PACKAGES.items()}
    for package, version in (versions | third_party().PACKAGES).items():
        target = folder() / package
        if not target.exists():
            command = [str(uv), "pip", "install", "-q", "--no-deps", "--target", str(target)]
            subprocess.run([*command, f"{package}=={version}"], check=True)


def files() -> dict[tuple[str, str], Path | None]:
    """Every file that may be a model; None: one of third_party.SCENES."""
    found: dict[tuple[str, str], Path | None] = {}
    for package, (_, places) in PACKAGES.items():
        for place in places:
            for path in sorted((folder() / package / place).glob("*.xml")):
                if not any(word in path.stem for word in NOT_ALONE):
                    found[package, path.stem] = path
    return found | dict.fromkeys(third_party().SCENES)


def models() -> list[tuple[str, str]]:
    """Those that MuJoCo compiles and that have joints."""
    found = []
    for key, path in files().items():
        if path is not None:
            try:
                model = compiled(path)
            except (ValueError, mujoco.FatalError):
                continue
            if not model.nv or model.ngeom < 2:
                continue
        found.append(key)
    return found


def compiled(path: Path) -> mujoco.MjModel:
    """The model of a file; a walker that has no ground of its own gets one under its feet."""
    model = mujoco.MjModel.from_xml_path(str(path))
    plane = mujoco.mjtGeom.mjGEOM_PLANE
    if plane in model.geom_type or not hasattr(mujoco, "MjSpec"):
        return model
    spec = mujoco.MjSpec.from_file(str(path))
    spec.worldbody.add_geom(type=plane, size=[10, 10, 1], pos=[0, 0, lowest(model)])
    return spec.compile()


def lowest(model: mujoco.MjModel) -> float:
    """The height of the lowest corner of the boxes around the geoms, where the model starts [m]."""
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_kinematics(model, data)
    up = data.geom_xmat.reshape(-1, 3, 3)[:, 2]
    centre, half = model.geom_aabb[:, :3], model.geom_aabb[:, 3:]
    heights = data.geom_xpos[:, 2] + (up * centre).sum(1) - (np.abs(up) * half).sum(1)
    return float(heights.min())


def cases(sample: int = 1) -> Iterator[dict[str, Any]]:
    """Every model with every stiffness and seed, or one in `sample`."""
    install()
    number = 0
    for package, model in models():
        for stiffness in STIFFNESSES:
            for seed in range(SEEDS):
                if number % sample == 0:
                    yield dict(zip(KEYS, (package, model, stiffness, seed), strict=True))
                number += 1


@functools.lru_cache(maxsize=4)
def original(package: str, name: str) -> mujoco.MjModel:
    """The model of a case; copies of it are stepped."""
    path = files()[package, name]
    if path is None:
        return third_party().SCENES[package, name](folder() / package)
    return compiled(path)


@functools.lru_cache(maxsize=4)
def native(package: str, name: str, seed: int) -> tuple[float, int]:
    """The fastest joint and the warnings of native contact, which knows no stiffness."""
    return driven(original(package, name), seed, None)[:2]


def examine(case: dict[str, Any]) -> dict[str, Any]:
    """The row of a model, a stiffness and a seed."""
    package, name, seed = case["package"], case["model"], case["seed"]
    model = copy.copy(original(package, name))
    integrator = mujoco.mjtIntegrator(model.opt.integrator).name.removeprefix("mjINT_")
    row = case | {
        "integrator": integrator,
        "timestep": model.opt.timestep,
        "dofs": model.nv,
    }
    row["native_speed"], row["native_warnings"] = native(package, name, seed)
    try:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            contact = vc.attach(model, material={"stiffness": case["stiffness"]}, options=OPTIONS)
    except ValueError as error:
        return row | {"refused": str(error)}
    with contact:
        row["said"] = "; ".join(str(w.message).split(":")[0] for w in said)
        row["speed"], row["warnings"], more = driven(model, seed, contact)
    known = row["native_speed"]
    if not row["speed"] <= MOST * known:
        model.opt.timestep /= FINER
        with vc.attach(model, material={"stiffness": case["stiffness"]}, options=OPTIONS) as fine:
            row["fine_speed"], row["fine_warnings"], _ = driven(model, seed, fine, FINER)
        if not row["fine_warnings"]:
            known = max(known, row["fine_speed"])
    return row | more | {"ratio": row["speed"] / max(known, 1e-9)}


def driven(
    model: mujoco.MjModel, seed: int, contact: vc.Contact | None, finer: int = 1
) -> tuple[float, int, dict[str, Any]]:
    """The fastest joint and the number of warnings, from a random start with random controls."""
    numbers = np.random.default_rng(seed)
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    data.qvel[:] = 0.1 * numbers.standard_normal(model.nv)
    # Joints that are damped so as to stand: MuJoCo refuses the deceleration of any motion there.
    data.qvel[model.dof_damping * model.opt.timestep * finer > STANDS * model.dof_M0] = 0.0
    limited = model.actuator_ctrllimited.astype(bool)
    low = np.where(limited, model.actuator_ctrlrange[:, 0], -1.0)
    high = np.where(limited, model.actuator_ctrlrange[:, 1], 1.0)
    fastest = 0.0
    steps = min(MOST_STEPS, round(SECONDS / (model.opt.timestep * finer)))
    for step in range(steps * finer):
        if step % (HOLD * finer) == 0:
            data.ctrl[:] = numbers.uniform(low, high)
        mujoco.mj_step(model, data)
        speed = np.abs(data.qvel).max(initial=0.0)
        if not math.isfinite(speed):
            fastest = math.inf
            break
        fastest = max(fastest, float(speed))
    count = int(sum(warning.number for warning in data.warning))
    if contact is None:
        return fastest, count, {}
    more = {"dropped": contact.dropped(data), "numerical": contact.energy(data).numerical}
    return fastest, count, more


def is_sound(row: dict[str, Any]) -> bool:
    """No more warnings than with native contact, and joints that are not too fast."""
    if row.get("refused"):
        return True
    quiet = int(row["warnings"] or 0) <= int(row["native_warnings"] or 0)
    return quiet and not int(row.get("dropped") or 0) and float(row["ratio"]) <= MOST
