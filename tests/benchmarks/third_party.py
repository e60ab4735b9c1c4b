# SPDX-License-Identifier: Apache-2.0
"""Runs scenes of dm_control, metaworld, robosuite and gymnasium-robotics under both contacts.

    ./run python tests/benchmarks/third_party.py build/third_party --install

The wheels (56, 40, 527 and 26 MB) go into the folder given, without what they depend on: their
MJCF is all that is needed. Each scene is compiled by MuJoCo, gets its data, and is then attached
without a key in it. The two contacts step in turns, and the processor time
of the thread counts. Writes one row a scene to results/third_party.csv, of which
docs/generate/make_third_party.py makes the page. Needs MuJoCo 3.3 or later, to put the parts of
robosuite together.
"""

from __future__ import annotations

import argparse
import csv
import ctypes
import subprocess
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

import volcontact as vc
from volcontact.running.simulation import warnings_of

RESULT = Path(__file__).parent / "results" / "third_party.csv"
PACKAGES = {
    "dm-control": "1.0.50",
    "metaworld": "3.1.1",
    "robosuite": "1.5.2",
    "gymnasium-robotics": "1.4.2",
}
STEPS = 2000
BLOCK = 10  # steps of one contact before the other's turn
MATERIAL = {"stiffness": 1e9}  # k_v [N/m^3]; friction stays that of the geoms
OPTIONS = {"mesh": "exact_or_hull"}
SWING = 0.2  # of half the range of each actuator
KINDS = ("volumetric", "native")
MEASURES = ("us", "contacts", "depth", "speed", "warnings")
COLUMNS = (
    *("package", "scene", "mujoco", "dofs", "geoms", "pairs", "hulls", "timestep", "integrator"),
    *(f"{kind}_{measure}" for kind in KINDS for measure in MEASURES),
    *("said", "refused"),
)

Maker = Callable[[Path], mujoco.MjModel]


def file(name: str) -> Maker:
    """A scene in one file."""
    return lambda folder: mujoco.MjModel.from_xml_path(str(folder / name))


def with_implicitfast(name: str) -> Maker:
    """One of RK4, which `attach` says does not go with stiff contact, as it advises."""

    def make(folder: Path) -> mujoco.MjModel:
        model = mujoco.MjModel.from_xml_path(str(folder / name))
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        return model

    return make


def assembled(arena: str, part: str, position: tuple[float, float, float], *, free: bool) -> Maker:
    """A part of robosuite's in one of its arenas, as its environments put them together."""

    def make(folder: Path) -> mujoco.MjModel:
        assets = folder / "robosuite" / "models" / "assets"
        scene = mujoco.MjSpec.from_file(str(assets / arena))
        other = mujoco.MjSpec.from_file(str(assets / part))
        body = other.worldbody.first_body()
        if free:
            body.add_freejoint()
        frame = scene.worldbody.add_frame(pos=position)
        frame.attach_body(body, "part_", "")
        return scene.compile()

    return make


def on_a_floor(name: str, height: float) -> Maker:
    """A walker above a plane, as the arenas of dm_control have it."""

    def make(folder: Path) -> mujoco.MjModel:
        scene = mujoco.MjSpec.from_file(str(folder / name))
        scene.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=(10.0, 10.0, 0.1))
        body = scene.worldbody.first_body()
        body.pos = (0.0, 0.0, height)
        if not body.joints:
            body.add_freejoint()
        return scene.compile()

    return make


SUITE, WALKERS = "dm_control/suite", "dm_control/locomotion/walkers/assets"
METAWORLD = "metaworld/assets/sawyer_xyz"
GYMNASIUM = "gymnasium_robotics/envs/assets"
SUITE_SCENES = (
    *("ball_in_cup", "cheetah", "dog", "finger", "fish", "hopper", "humanoid", "humanoid_CMU"),
    *("manipulator", "quadruped", "stacker", "walker"),
)
SCENES: dict[tuple[str, str], Maker] = {
    **{("dm-control", name): file(f"{SUITE}/{name}.xml") for name in SUITE_SCENES},
    ("dm-control", "dog v2"): file(f"{WALKERS}/dog_v2/dog.xml"),
    ("dm-control", "fruitfly"): file(f"{WALKERS}/fruitfly_v2/floor.xml"),
    ("dm-control", "rodent"): on_a_floor(f"{WALKERS}/rodent.xml", 0.08),
    ("dm-control", "humanoid CMU 2020"): on_a_floor(f"{WALKERS}/humanoid_CMU_V2020.xml", 1.1),
    ("dm-control", "jumping ball"): on_a_floor(
        f"{WALKERS}/jumping_ball/jumping_ball_with_head.xml", 0.6
    ),
    ("metaworld", "assembly peg"): file(f"{METAWORLD}/sawyer_assembly_peg.xml"),
    ("metaworld", "peg insertion side"): file(f"{METAWORLD}/sawyer_peg_insertion_side.xml"),
    ("metaworld", "hammer"): file(f"{METAWORLD}/sawyer_hammer.xml"),
    ("metaworld", "bin picking"): file(f"{METAWORLD}/sawyer_bin_picking.xml"),
    ("metaworld", "drawer"): file(f"{METAWORLD}/sawyer_drawer.xml"),
    ("robosuite", "square nut on pegs"): assembled(
        "arenas/pegs_arena.xml", "objects/square-nut.xml", (0.23, 0.1, 0.95), free=True
    ),
    ("robosuite", "can in bins"): assembled(
        "arenas/bins_arena.xml", "objects/can.xml", (0.1, -0.25, 0.95), free=True
    ),
    ("robosuite", "panda at a table"): assembled(
        "arenas/table_arena.xml", "robots/panda/robot.xml", (-0.56, 0.0, 0.912), free=False
    ),
    ("gymnasium-robotics", "fetch, pick and place"): file(f"{GYMNASIUM}/fetch/pick_and_place.xml"),
    ("gymnasium-robotics", "hand, block"): file(f"{GYMNASIUM}/hand/manipulate_block.xml"),
    ("gymnasium-robotics", "hand, egg"): file(f"{GYMNASIUM}/hand/manipulate_egg.xml"),
    ("gymnasium-robotics", "adroit, pen"): file(f"{GYMNASIUM}/adroit_hand/adroit_pen.xml"),
    ("gymnasium-robotics", "adroit, door"): file(f"{GYMNASIUM}/adroit_hand/adroit_door.xml"),
    ("gymnasium-robotics", "franka kitchen"): file(
        f"{GYMNASIUM}/kitchen_franka/kitchen_assets/kitchen_env_model.xml"
    ),
    ("gymnasium-robotics", "ant, implicitfast for RK4"): with_implicitfast(
        "gymnasium_robotics/envs/mujoco/assets/ant.xml"
    ),
    ("gymnasium-robotics", "half cheetah, implicitfast for RK4"): with_implicitfast(
        "gymnasium_robotics/envs/mujoco/assets/half_cheetah.xml"
    ),
    ("gymnasium-robotics", "hopper, implicitfast for RK4"): with_implicitfast(
        "gymnasium_robotics/envs/mujoco/assets/hopper.xml"
    ),
    ("gymnasium-robotics", "humanoid, implicitfast for RK4"): with_implicitfast(
        "gymnasium_robotics/envs/mujoco/assets/humanoid.xml"
    ),
    ("gymnasium-robotics", "walker, implicitfast for RK4"): with_implicitfast(
        "gymnasium_robotics/envs/mujoco/assets/walker2d.xml"
    ),
}


def main() -> None:
    """Runs all and writes the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="with a folder for each package")
    parser.add_argument("--install", action="store_true", help="fetch the packages first")
    parser.add_argument("--steps", type=int, default=STEPS)
    parser.add_argument("--only", default="", help="scenes with this word in their name")
    parser.add_argument("--out", type=Path, default=RESULT)
    arguments = parser.parse_args()
    if arguments.install:
        install(arguments.folder)
    rows = []
    for (package, scene), make in SCENES.items():
        if arguments.only in scene:
            row = {"package": package, "scene": scene}
            row |= examine(lambda p=package, m=make: m(arguments.folder / p), arguments.steps)
            rows.append(row)
            print(" | ".join(f"{name} {row[name]}" for name in COLUMNS if row.get(name, "") != ""))
    with arguments.out.open("w", encoding="utf-8", newline="") as table:
        writer = csv.DictWriter(table, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def install(folder: Path) -> None:
    """Unpacks the wheels, each into a folder of its own."""
    uv = Path(__file__).parents[2] / ".venv" / "tools" / "bin" / "uv"
    for package, version in PACKAGES.items():
        target = ["--target", str(folder / package), f"{package}=={version}"]
        subprocess.run([str(uv), "pip", "install", "-q", "--no-deps", *target], check=True)


def examine(make: Callable[[], mujoco.MjModel], steps: int) -> dict[str, Any]:
    """The row of one scene, under both contacts."""
    model, native = make(), make()
    row: dict[str, Any] = {
        "mujoco": mujoco.__version__,
        "dofs": model.nv,
        "geoms": model.ngeom,
        "timestep": model.opt.timestep,
        "integrator": mujoco.mjtIntegrator(model.opt.integrator).name.removeprefix("mjINT_"),
    }
    runs = {"native": Run(native)}
    run = Run(model)  # its data are there before attach, as an environment has them
    try:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            contact = vc.attach(model, material=MATERIAL, options=OPTIONS)
    except ValueError as error:
        row["refused"] = str(error)
    else:
        run.contact = contact
        runs["volumetric"] = run
        alerts = [str(w.message) for w in said]
        row["said"] = "; ".join(alert.split(":")[0] for alert in alerts)
        hulls = [alert for alert in alerts if "convex hull" in alert]
        row["hulls"] = hulls[0].count(", ") + 1 if hulls else 0
        row["pairs"] = len(contact.description["pairs"])
    passive = passive_callback()
    ours = passive.value
    for timed in (False, True):
        for one in runs.values():
            one.reset()
        for _ in range(0, steps, BLOCK):
            for kind, one in runs.items():
                passive.value = ours if kind == "volumetric" else None
                one.time() if timed else one.look()
    passive.value = ours
    for kind, one in runs.items():
        row |= {f"{kind}_{name}": value for name, value in one.numbers().items()}
    if run.contact is not None:
        run.contact.close()
    return row


def passive_callback() -> ctypes.c_void_p:
    """MuJoCo's own variable: under native contact nothing is called."""
    library = next(Path(mujoco.__file__).parent.glob("libmujoco.so*"))
    return ctypes.c_void_p.in_dll(ctypes.CDLL(str(library)), "mjcb_passive")


@dataclass
class Run:
    """A model that steps, its actuators swinging a little about the middle of their range."""

    model: mujoco.MjModel
    contact: vc.Contact | None = None
    spent: list[float] = field(default_factory=list)  # processor time of a step, by blocks [ns]
    contacts: int = 0
    depth: float = 0.0

    def __post_init__(self) -> None:
        self.data = mujoco.MjData(self.model)

    def reset(self) -> None:
        """Back to the begin."""
        if self.model.nkey:
            mujoco.mj_resetDataKeyframe(self.model, self.data, 0)
        else:
            mujoco.mj_resetData(self.model, self.data)

    def controls(self) -> list[np.ndarray]:
        """Of the steps of a block."""
        low, high = self.model.actuator_ctrlrange.T
        times = self.data.time + self.model.opt.timestep * np.arange(BLOCK)
        waves = np.sin(np.pi * times[:, None] + np.arange(self.model.nu))
        return list(0.5 * (low + high) + 0.5 * SWING * (high - low) * waves)

    def time(self) -> None:
        """The steps of a block and nothing between them."""
        controls = self.controls()
        begin = time.thread_time_ns()
        for control in controls:
            self.data.ctrl[:] = control
            mujoco.mj_step(self.model, self.data)
        self.spent.append((time.thread_time_ns() - begin) / BLOCK)

    def look(self) -> None:
        """The steps of a block, and what touches after each."""
        for control in self.controls():
            self.data.ctrl[:] = control
            mujoco.mj_step(self.model, self.data)
            if self.contact is not None:
                sites = self.contact.sites(self.data)
                self.contacts = max(self.contacts, len(sites))
                self.depth = max(self.depth, sites["depth"].max(initial=0.0))
            else:
                touching = self.data.contact.dist[: self.data.ncon]
                self.contacts = max(self.contacts, self.data.ncon)
                self.depth = max(self.depth, -min(touching, default=0.0))

    def numbers(self) -> dict[str, Any]:
        """Of all steps together."""
        count = warnings_of(self.data)
        return {
            "us": f"{1e-3 * np.median(self.spent):.1f}",
            "contacts": self.contacts,
            "depth": f"{self.depth:.3g}",
            "speed": f"{np.abs(self.data.qvel).max(initial=0.0):.3g}",
            "warnings": " ".join(f"{name} {number}" for name, number in count.items()),
        }


if __name__ == "__main__":
    main()
