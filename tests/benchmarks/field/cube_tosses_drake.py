# SPDX-License-Identifier: Apache-2.0
"""The real cube under Drake's contacts, point and hydroelastic: results/cube_tosses_drake.json.

    ./run python tests/benchmarks/field/cube_tosses_drake.py tosses.parquet

Geometry, inertia and friction are those of `identified.xml`; what is Drake's own, stiffness and
dissipation, is chosen on some tosses of the fit from a grid, and judged on the tosses of the page.
Needs Drake (group `benchmark`).
"""

from __future__ import annotations

import json
import logging
import sys
from itertools import product
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from cube_tosses import FOLDER, WIDTH
from pydrake.common.eigen_geometry import Quaternion
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    AddRigidHydroelasticProperties,
    Box,
    HalfSpace,
    ProximityProperties,
)
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialVelocity
from pydrake.multibody.plant import (
    AddMultibodyPlant,
    ContactModel,
    CoulombFriction,
    MultibodyPlantConfig,
)
from pydrake.multibody.tree import RotationalInertia, SpatialInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from volcontact.identify import rotations
from volcontact.identify.measurements import Trial, read_trials
from volcontact.identify.reading import read_settings

logging.getLogger("drake").setLevel(logging.ERROR)

RESULT = Path(__file__).parent / "results" / "cube_tosses_drake.json"
FEWER = 6  # every which toss of the fit the grid sees
DISSIPATIONS = (2.0, 4.0, 8.0)  # [s/m]
STIFFNESS = {"point": (3e3, 1e4, 3e4), "hydroelastic": (1e6, 3e6, 1e7)}  # [N/m], [Pa]


class Cube:
    """The cube on its board, under one kind of contact of Drake."""

    def __init__(self, kind: str, stiffness: float, dissipation: float, friction: float) -> None:
        model = mujoco.MjModel.from_xml_path(str(FOLDER / "identified.xml"))
        builder = DiagramBuilder()
        config = MultibodyPlantConfig(time_step=model.opt.timestep)
        config.discrete_contact_approximation = "lagged"
        self.plant, _ = AddMultibodyPlant(config, builder)
        hydroelastic = kind == "hydroelastic"
        self.plant.set_contact_model(
            ContactModel.kHydroelastic if hydroelastic else ContactModel.kPoint
        )
        body = model.body("cube")
        inertia = SpatialInertia.MakeFromCentralInertia(
            body.mass[0], np.array(body.ipos), RotationalInertia(*body.inertia)
        )
        self.body = self.plant.AddRigidBody("cube", inertia)
        coulomb = CoulombFriction(friction, friction)
        half = model.geom("cube").size
        on_cube, on_board = ProximityProperties(), ProximityProperties()
        if hydroelastic:
            AddCompliantHydroelasticProperties(2 * float(half[0]), stiffness, on_cube)
            AddRigidHydroelasticProperties(on_board)
            AddContactMaterial(dissipation, None, coulomb, on_cube)
            AddContactMaterial(0.0, None, coulomb, on_board)
        else:
            AddContactMaterial(dissipation, stiffness, coulomb, on_cube)
            AddContactMaterial(0.0, 1e12, coulomb, on_board)
        place = RigidTransform()
        world = self.plant.world_body()
        self.plant.RegisterCollisionGeometry(self.body, place, Box(*(2 * half)), "cube", on_cube)
        self.plant.RegisterCollisionGeometry(world, place, HalfSpace(), "board", on_board)
        self.plant.Finalize()
        self.simulator = Simulator(builder.Build())

    def error(self, trial: Trial) -> float:
        """Mean over the frames: position in % of the width, plus degrees."""
        samples = {name: each.values for name, each in trial.samples.items()}
        root = self.simulator.get_mutable_context()
        root.SetTime(0.0)
        context = self.plant.GetMyMutableContextFromRoot(root)
        turn, place = samples["orientation"][0], samples["position"][0]
        pose = RigidTransform(Quaternion(turn / np.linalg.norm(turn)), place)
        self.plant.SetFreeBodyPose(context, self.body, pose)
        spin = rotations.rotate(turn, samples["angular_velocity"][0])
        speed = SpatialVelocity(w=spin, v=samples["velocity"][0])
        self.plant.SetFreeBodySpatialVelocity(context, self.body, speed)
        self.simulator.Initialize()
        total = 0.0
        for time, p, q in zip(
            trial.times, samples["position"], samples["orientation"], strict=True
        ):
            # What begins a run is a step already.
            self.simulator.AdvanceTo(max(float(time) - 0.5 * self.plant.time_step(), 0.0))
            found = self.plant.EvalBodyPoseInWorld(context, self.body)
            there = np.array(found.rotation().ToQuaternion().wxyz())
            angle = rotations.vector(rotations.product(rotations.inverse(q), there))
            off = np.linalg.norm(found.translation() - p) / WIDTH * 100.0
            total += float(off) + float(np.degrees(np.linalg.norm(angle)))
        return total / len(trial.times)


def judged(kind: str, fit: list[Trial], judge: list[Trial], friction: float) -> dict[str, Any]:
    """The best of the grid, on the tosses that it was not chosen on."""
    tried = []
    for stiffness, dissipation in product(STIFFNESS[kind], DISSIPATIONS):
        cube = Cube(kind, stiffness, dissipation, friction)
        cost = float(np.mean([cube.error(trial) for trial in fit]))
        tried.append({"stiffness": stiffness, "dissipation": dissipation, "fit": cost})
        print(kind, tried[-1], flush=True)
    best = min(tried, key=lambda each: each["fit"])
    cube = Cube(kind, best["stiffness"], best["dissipation"], friction)
    by_toss = [cube.error(trial) for trial in judge]
    return {
        **best,
        "grid": tried,
        "fitted_to": len(fit),
        "judge": float(np.mean(by_toss)),
        "median": float(np.median(by_toss)),
        "tosses": len(by_toss),
    }


def main(tosses: Path) -> None:
    """Both kinds of contact."""
    import importlib.metadata

    settings = read_settings(FOLDER / "study.toml", measurements=[tosses])
    fit = read_trials(settings, settings.fit)[::FEWER]
    judge = read_trials(settings, settings.judge)
    text = (FOLDER / "identified.xml").read_text(encoding="utf-8")
    friction = float(text.split('pair/toss/friction" data="')[1].split('"')[0])
    found: dict[str, Any] = {"drake": importlib.metadata.version("drake")}
    for kind in ("hydroelastic", "point"):
        found[kind] = judged(kind, fit, judge, friction)
        RESULT.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
