# SPDX-License-Identifier: Apache-2.0
"""Measures the scenes with meshes: convergence, jamming, time of a step. For docs/assembly.md.

    ./run python tests/benchmarks/field/assembly.py

Four minutes. Times are processor times of one thread, the least of several turns.
"""

from __future__ import annotations

import argparse
import csv
import importlib.util
import math
import shutil
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import mujoco
import numpy as np

import volcontact as vc

ROOT = Path(__file__).parents[3]
RESULTS = Path(__file__).parent / "results"
PEG = ROOT / "mjcf_models" / "peg_in_hole"
GEARS = ROOT / "mjcf_models" / "gear_pair"

HOLES = {"8.2": ("scene", 0.2e-3, 10e-6), "8.02": ("scene_tight", 0.02e-3, 3e-6)}  # sink [m]
DEPTH = 0.006  # of the peg in the hole [m]
PLATE_HEIGHT = 0.0245  # of its middle [m]
SPINS = np.arange(8) * 0.11 + 0.05  # of the peg about its axis [rad]
ANY_DIRECTION = 0.37  # in which no corners of peg and hole meet [rad]
Row = dict[str, Any]


def script(folder: Path, name: str) -> ModuleType:
    """A script that lies beside a scene."""
    spec = importlib.util.spec_from_file_location(f"{folder.name}_{name}", folder / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its dataclasses look there
    spec.loader.exec_module(module)
    return module


pegs = script(PEG, "make_meshes")
jamming = script(PEG, "jamming")
falling = script(PEG, "falling")
gears = script(GEARS, "make_meshes")


# ---- The peg, at rest ----------------------------------------------------------------------------


def turn(axis: int, angle: float) -> np.ndarray:
    """Pose of a turn about a coordinate axis, shape (4, 4)."""
    pose = np.eye(4)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    pose[[i, j], [i, j]] = math.cos(angle)
    pose[i, j], pose[j, i] = -math.sin(angle), math.sin(angle)
    return pose


def two_point_pose(clearance: float, sink: float) -> np.ndarray:
    """The peg in the plate: 6 mm deep, leaning, pressed into both walls by `sink` [m]."""
    pose = turn(1, (clearance + 2 * sink) / DEPTH)
    across = pegs.RADIUS * pose[0, 0] - (pegs.RADIUS + clearance / 2 + sink)
    pose[:3, 3] = [across, 0.0, pegs.PLATE[2] - DEPTH] + pegs.LENGTH / 2 * pose[:3, 2]
    return pose


def wrench(metrics: vc.Interference) -> tuple[np.ndarray, np.ndarray, float]:
    """Force and moment on the plate per stiffness, and the sum of the normal forces."""
    forces = [site.volume * site.normal for site in metrics.sites]
    moments = [np.cross(s.centroid, f) for s, f in zip(metrics.sites, forces, strict=True)]
    return sum(forces), sum(moments), sum(site.volume for site in metrics.sites)


def static_rows(name: str, chords: Iterable[int]) -> Iterator[Row]:
    """Errors of the wrench on the plate beside the exact one: roots of mean squares over spins."""
    _, clearance, sink = HOLES[name]
    pose = two_point_pose(clearance, sink)
    bore = vc.Cylinder(radius=pegs.RADIUS + clearance / 2, half_length=0.01)
    cylinder = vc.Cylinder(radius=pegs.RADIUS, half_length=pegs.LENGTH / 2)
    exact = vc.interference(vc.Box(pegs.PLATE) - bore, cylinder, pose)
    _, moment, normal = wrench(exact)
    for count in chords:
        peg, plate = pegs.peg(count), pegs.plate(clearance, count)
        solids = vc.Mesh(*plate), vc.Mesh(*peg)
        errors, times = [], []
        for spin in SPINS:
            turned = pose @ turn(2, spin)
            start = time.process_time()
            for _ in range(3):
                found = vc.interference(*solids, turned)
            times.append((time.process_time() - start) / 3)
            _, found_moment, found_normal = wrench(found)
            off = np.linalg.norm(found_moment - moment) / np.linalg.norm(moment)
            errors.append([found_normal / normal - 1.0, off])
        mean = np.sqrt(np.mean(np.square(errors), axis=0))
        yield {
            "hole": name,
            "chords": count,
            "triangles": len(peg[1]) + len(plate[1]),
            "sagitta_um": 1e6 * pegs.RADIUS * (1 - math.cos(math.pi / count)),
            "force_error": mean[0],
            "moment_error": mean[1],
            "query_us": 1e6 * min(times),
        }


# ---- The peg, falling ----------------------------------------------------------------------------


def with_meshes(folder: Path, chords: int, rings: int = 1) -> Path:
    """A copy of the peg's scenes, with meshes of its own."""
    shutil.copytree(PEG, folder, ignore=shutil.ignore_patterns("__pycache__", "meshes"))
    pegs.write(folder / "meshes", chords, rings)
    return folder


def step_time(scene: Path) -> float:
    """Time of a step while the peg falls [us]: the least of three turns."""
    model = vc.load(scene)
    steps = round(falling.DURATION / model.opt.timestep)
    times = []
    with vc.attach(model):
        for _ in range(3):
            data = mujoco.MjData(model)
            falling.turn_start(data)
            start = time.process_time()
            mujoco.mj_step(model, data, steps)
            times.append(time.process_time() - start)
    return 1e6 * min(times) / steps


def wrong_steps(found: Any, clearance: float, chords: int) -> tuple[int, int]:
    """Steps with contact, and those of them whose volume is off by more than 5 %.

    A step may spend less on a pair of meshes than a question of its own, and samples what costs
    more.
    """
    plate, peg = vc.Mesh(*pegs.plate(clearance, chords)), vc.Mesh(*pegs.peg(chords))
    touching = wrong = 0
    rotation = np.zeros(9)
    for position, quaternion, volume in zip(
        found.positions, found.quaternions, found.volumes, strict=True
    ):
        mujoco.mju_quat2Mat(rotation, quaternion)
        pose = np.eye(4)
        pose[:3, :3] = rotation.reshape(3, 3)
        pose[:3, 3] = position - [0.0, 0.0, PLATE_HEIGHT]
        whole = vc.interference(plate, peg, pose).volume
        if max(whole, volume) > 1e-16:
            touching += 1
            wrong += abs(whole - volume) > 0.05 * max(whole, volume)
    return touching, wrong


def peg_rows() -> Iterator[Row]:
    """Wrench and motion, mesh by mesh."""
    for name, (scene, clearance, _) in HOLES.items():
        exact = falling.fall(PEG / f"{scene}.xml")
        yield {"hole": name, "chords": 0, "step_us": step_time(PEG / f"{scene}.xml")}
        for row in static_rows(name, (32, 64, 128, 256, 512)):
            with tempfile.TemporaryDirectory(prefix="volcontact-") as folder:
                copy = with_meshes(Path(folder) / "peg", row["chords"]) / f"{scene}_mesh.xml"
                found = falling.fall(copy)
                row["step_us"] = step_time(copy)
            row["path_error_um"] = 1e6 * np.abs(found.positions - exact.positions).max()
            row["touching"], row["wrong"] = wrong_steps(found, clearance, row["chords"])
            yield row


# ---- Jamming -------------------------------------------------------------------------------------


def jamming_rows() -> Iterator[Row]:
    """Pegs pressed on both sides of the boundary."""
    shares = (-0.6, -0.4, -0.2, -0.1, 0.02, 0.1, 0.2, 0.4)
    for name, (scene, clearance, _) in HOLES.items():
        for across in np.linspace(-2.0, 2.0, 9):
            for share in shares:
                moment = jamming.boundary(across) + share * jamming.slenderness()
                pressed = jamming.press(PEG / f"{scene}.xml", clearance, across, moment)
                yield {
                    "hole": name,
                    "across": across,
                    "moment": moment,
                    "speed": pressed.speed,
                    "jammed": int(pressed.jammed),
                }


def boundary_rows() -> Iterator[Row]:
    """Where pegs begin to jam with F_x = 0, exact and as meshes, beside the diagram."""
    diagram = jamming.boundary(0.0)
    for name, (scene, clearance, _) in HOLES.items():
        found = jamming.bisect(PEG / f"{scene}.xml", clearance, 0.0)
        yield {"hole": name, "chords": 0, "triangles": 0, "off": found / diagram - 1.0}
        for chords, rings in ((64, 1), (128, 1), (256, 1), (160, 60)):
            with tempfile.TemporaryDirectory(prefix="volcontact-") as folder:
                copy = with_meshes(Path(folder) / "peg", chords, rings) / f"{scene}_mesh.xml"
                found = jamming.bisect(copy, clearance, 0.0, azimuth=ANY_DIRECTION)
            triangles = len(pegs.peg(chords, rings)[1])
            off = found / diagram - 1.0
            yield {"hole": name, "chords": chords, "triangles": triangles, "off": off}


# ---- Gears ---------------------------------------------------------------------------------------


def gear_rows() -> Iterator[Row]:
    """How smooth the transmission is, for flanks of more and more chords."""
    for chords in (5, 10, 20, 40):
        with tempfile.TemporaryDirectory(prefix="volcontact-") as folder:
            copy = Path(folder) / "gears"
            shutil.copytree(GEARS, copy, ignore=shutil.ignore_patterns("__pycache__", "meshes"))
            gears.write(copy / "meshes", chords)
            model = vc.load(copy / "scene.xml")
        data, rows = mujoco.MjData(model), []
        with vc.attach(model):
            start = time.process_time()
            for _ in range(round(0.13 / model.opt.timestep)):
                mujoco.mj_step(model, data)
                rows.append([*data.qpos, *data.qvel])
            spent = time.process_time() - start
        table = np.array(rows)[round(0.03 / model.opt.timestep) :]
        lag = table[:, 1] + table[:, 0] / 2
        yield {
            "chords": chords,
            "triangles": sum(len(gears.mesh(g, chords)[1]) for g in (gears.PINION, gears.WHEEL)),
            "lag_mrad": 1e3 * lag.mean(),
            "ripple_mrad": 1e3 * np.ptp(lag),
            "speed_ripple": np.std(table[:, 3]) / abs(np.mean(table[:, 3])),
            "step_us": 1e6 * spent / len(rows),
        }


# ---- Time of a step ------------------------------------------------------------------------------


def pressed_time(scene: Path, clearance: float) -> float:
    """Time of a step with the peg jammed at two points [us]: the least of five turns.

    In a direction in which no corners of peg and hole meet.
    """
    model = jamming.loaded_model(scene)
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        jamming.place_loaded(model, data, contact, clearance, ANY_DIRECTION)
        start = data.qpos.copy()
        times = []
        for _ in range(5):
            data.qpos[:], data.qvel[:] = start, 0.0
            begin = time.process_time()
            mujoco.mj_step(model, data, 20)
            times.append((time.process_time() - begin) / 20)
    return 1e6 * min(times)


def step_rows() -> Iterator[Row]:
    """The peg at two points of contact, exact and as meshes."""
    for name, (scene, clearance, _) in HOLES.items():
        exact = pressed_time(PEG / f"{scene}.xml", clearance)
        yield {"hole": name, "triangles": 0, "step_us": exact}
        for chords, rings in ((64, 1), (128, 1), (256, 1), (160, 60)):
            with tempfile.TemporaryDirectory(prefix="volcontact-") as folder:
                copy = with_meshes(Path(folder) / "peg", chords, rings)
                found = pressed_time(copy / f"{scene}_mesh.xml", clearance)
            triangles = len(pegs.peg(chords, rings)[1])
            yield {"hole": name, "triangles": triangles, "step_us": found}


def write(path: Path, rows: Iterable[Row]) -> None:
    """Writes a table; numbers with four digits."""
    table = list(rows)
    columns = list(dict.fromkeys(key for row in table for key in row))
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        for row in table:
            writer.writerow({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in row.items()})


TABLES = {
    "peg": peg_rows,
    "jamming": jamming_rows,
    "boundary": boundary_rows,
    "gears": gear_rows,
    "steps": step_rows,
}


def main() -> None:
    """Measures all tables, or those that are named."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("tables", nargs="*", help=f"of {', '.join(TABLES)}; all of them if none")
    for name in parser.parse_args().tables or TABLES:
        write(RESULTS / f"assembly_{name}.csv", TABLES[name]())


if __name__ == "__main__":
    main()
