# SPDX-License-Identifier: Apache-2.0
"""Time of one MuJoCo step under volumetric contact, beside native contact and none; and Drake's.

    ./run python tests/benchmarks/step_benchmark.py

Compare the columns of one run with each other, not with those of another machine.
"""

from __future__ import annotations

import argparse
import csv
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import mujoco
import numpy as np
from field import assembly

import volcontact as vc

MODELS = Path(__file__).parents[2] / "mjcf_models"
ROUNDS = 25
KINDS = ("none", "native", "volumetric")
COLUMNS = (
    *("scene", "contact", "bodies", "pairs", "touching", "steps", "time_us", "q1_us", "q3_us"),
    "speed_mm_s",
)


@dataclass
class Scene:
    """A model and the part of its motion that is timed.

    Attributes:
        name: on the page of results
        model: the model
        settle: seconds before the clock runs, under the contact that is timed [s]
        steps: in one round
        again: each round starts anew after `settle`; False: the rounds follow each other
        with_drake: Drake simulates it too
    """

    name: str
    model: mujoco.MjModel
    settle: float
    steps: int = 200
    again: bool = False
    with_drake: bool = False


@dataclass
class Course:
    """One kind of contact in a scene."""

    kind: str
    scene: Scene
    data: mujoco.MjData = field(init=False)
    times: list[float] = field(default_factory=list)
    pairs: int = 0
    touching: int = 0

    def __post_init__(self) -> None:
        self.data = mujoco.MjData(self.scene.model)
        self._start()

    def _start(self) -> None:
        model = self.scene.model
        mujoco.mj_resetData(model, self.data)
        steps = round(self.scene.settle / model.opt.timestep)
        if steps and self.kind != "none":  # nothing comes to rest without contact
            with contact_of(self.kind, model):
                mujoco.mj_step(model, self.data, steps)

    def run_round(self) -> None:
        """Times some steps."""
        model, data = self.scene.model, self.data
        if self.scene.again or self.kind == "none":
            self._start()
        with contact_of(self.kind, model) as contact:
            mujoco.mj_forward(model, data)
            begin = time.process_time_ns()
            mujoco.mj_step(model, data, self.scene.steps)
            self.times.append(1e-3 * (time.process_time_ns() - begin) / self.scene.steps)
            if contact is not None:
                self.pairs = len(contact.description["pairs"])
                self.touching = len(contact.sites(data))
            elif self.kind == "native":
                self.touching = data.ncon

    def row(self) -> dict[str, object]:
        """A line of the results; times in us, speeds in mm/s."""
        speeds = np.linalg.norm(self.data.qvel.reshape(-1, 6)[:, :3], axis=1)
        speed = 0.0 if self.kind == "none" else speeds.max()
        counts = (self.pairs, self.touching, self.scene.steps * ROUNDS)
        return line(self.scene, self.kind, counts, self.times, speed)


class DrakeCourse:
    """The same scene in Drake, whose steps are so long that fewer will do."""

    STEPS = 10

    def __init__(self, scene: Scene) -> None:
        from peers.drake_steps import DrakeScene

        self.scene, self.times = scene, []
        self.drake = DrakeScene(scene.model)
        self.drake.advance(scene.settle)

    def run_round(self) -> None:
        """Times some steps."""
        begin = time.process_time_ns()
        self.drake.advance(self.STEPS * self.scene.model.opt.timestep)
        self.times.append(1e-3 * (time.process_time_ns() - begin) / self.STEPS)

    def row(self) -> dict[str, object]:
        """A line of the results."""
        counts = (0, self.drake.touching(), self.STEPS * ROUNDS)
        return line(self.scene, "Drake", counts, self.times, self.drake.fastest())


def line(
    scene: Scene, kind: str, counts: tuple[int, int, int], times: list[float], speed: float
) -> dict[str, object]:
    """A line of the results: pairs, touching and steps; times [us]; the fastest body [m/s]."""
    q1, median, q3 = (f"{t:.3f}" for t in np.percentile(times, [25, 50, 75]))
    bodies = scene.model.nv // 6
    values = (scene.name, kind, bodies, *counts, median, q1, q3, f"{1e3 * speed:.2g}")
    return dict(zip(COLUMNS, values, strict=True))


@contextmanager
def contact_of(kind: str, model: mujoco.MjModel) -> Iterator[vc.Contact | None]:
    """The model under volumetric, native or no contact."""
    if kind == "volumetric":
        with vc.attach(model) as contact:
            yield contact
        return
    flags = model.opt.disableflags
    if kind == "none":
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    yield None
    model.opt.disableflags = flags


def scenes() -> Iterator[Scene]:
    """The committed scenes, and some that grow one part of the work."""
    battery_box = MODELS / "battery_box" / "scene.xml"
    seated = vc.load(battery_box)
    seated.qpos0[:] = seated.key("seated").qpos
    yield Scene("battery box, seated", seated, settle=0.5, with_drake=True)
    # The start is cut off: 0.1 s of free fall say nothing.
    yield Scene("battery box, falling into its seat", vc.load(battery_box), 0.1, 900, again=True)
    pile = MODELS / "box_pile" / "scene.xml"
    yield Scene("pile of 20 boxes, at rest", vc.load(pile), settle=3.0, with_drake=True)
    yield Scene("pile of 20 boxes, falling", vc.load(pile), settle=0.0, steps=500, again=True)
    yield Scene("20 boxes on a floor", vc.load(boxes_on_floor(20)), settle=0.5)
    yield Scene("20 boxes in 4 stacks", vc.load(stacks(20)), settle=0.5)
    yield Scene("18 boxes apart", vc.load(boxes_apart(18)), settle=0.0)
    yield from pegs()


def pegs() -> Iterator[Scene]:
    """A peg of 8 mm in a hole of 8.2 mm, each a mesh of 20k triangles."""
    with tempfile.TemporaryDirectory(prefix="volcontact-") as folder:
        path = assembly.with_meshes(Path(folder) / "peg", 160, 60) / "scene_mesh.xml"
        aligned, leaning = vc.load(path), assembly.jamming.loaded_model(path)
    deep = assembly.jamming.UPPER_FACE - assembly.DEPTH + assembly.pegs.LENGTH / 2
    aligned.qpos0[:] = 0.0, 0.0, deep, 1.0, 0.0, 0.0, 0.0
    yield Scene("peg in hole, 20k triangles, aligned", aligned, settle=0.0, again=True)

    data = mujoco.MjData(leaning)
    with vc.attach(leaning) as contact:
        clearance, azimuth = assembly.HOLES["8.2"][1], assembly.ANY_DIRECTION
        assembly.jamming.place_loaded(leaning, data, contact, clearance, azimuth)
    leaning.qpos0[:] = data.qpos
    # So few steps that it does not spring away.
    yield Scene("peg in hole, 20k triangles, at two points", leaning, 0.0, steps=20, again=True)


def boxes_on_floor(count: int) -> str:
    """Boxes that rest on a floor, each with one site; no two of them near."""
    bodies = "".join(_box(0.5 * (i % 5), 0.5 * (i // 5), 0.0999) for i in range(count))
    return _scene(f'<geom type="plane" size="9 9 1" contype="2" conaffinity="2"/>{bodies}')


def boxes_apart(count: int) -> str:
    """Boxes in free flight: count (count - 1) / 2 pairs, all culled."""
    bodies = "".join(_box(0.5 * (i % 5), 0.5 * (i // 5), 1.0) for i in range(count))
    return _scene(bodies, gravity="0 0 0")


def stacks(count: int) -> str:
    """Boxes in stacks of five."""
    bodies = "".join(_box(0.25 * (i // 5), 0.0, 0.0999 + 0.1998 * (i % 5)) for i in range(count))
    return _scene(f'<geom type="plane" size="9 9 1"/>{bodies}')


def _box(x: float, y: float, z: float) -> str:
    return (
        f'<body pos="{x} {y} {z}"><freejoint/>'
        '<geom type="box" size=".1 .1 .1" mass="1" contype="3" conaffinity="3"/></body>'
    )


def _scene(bodies: str, gravity: str = "0 0 -9.81") -> str:
    return (
        f'<mujoco><size nconmax="2000" njmax="8000"/><option timestep="5e-4" gravity="{gravity}"/>'
        f'<default><geom friction=".1 .005 .0001"/></default><worldbody>{bodies}</worldbody>'
        "</mujoco>"
    )


def measure(scene: Scene) -> list[dict[str, object]]:
    """A line for each kind of contact; the kinds take turns."""
    courses: list[Course | DrakeCourse] = [Course(kind, scene) for kind in KINDS]
    if scene.with_drake:
        try:
            courses.append(DrakeCourse(scene))
        except ImportError as missing:
            print(f"Drake is left out: {missing}", flush=True)
    for _ in range(ROUNDS):
        for course in courses:
            course.run_round()
    return [course.row() for course in courses]


def main() -> None:
    """Measures every scene, prints a table and writes CSV."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, help="CSV file to write")
    out = parser.parse_args().out
    print(f"MuJoCo {mujoco.__version__}")
    rows = []
    for scene in scenes():
        for row in measure(scene):
            rows.append(row)
            print(
                f"{row['scene']:41} {row['contact']:12} {row['time_us']:>9} us a step, "
                f"{row['touching']:>4} touching, {row['speed_mm_s']:>8} mm/s",
                flush=True,
            )
    if out:
        with out.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
