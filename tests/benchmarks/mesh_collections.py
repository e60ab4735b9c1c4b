# SPDX-License-Identifier: Apache-2.0
"""Judges every mesh of metaworld and robosuite, and asks those that are solids for their contact.

    ./run volcontact mesh --help  # builds volcontact-cgal
    ./run python tests/benchmarks/mesh_collections.py --install build/collections

The wheels of both (40 and 527 MB) go into the folder given, without what they depend on. Writes one
row a mesh to results/mesh_collections.csv. Without --install it takes the folder as it is.
"""

from __future__ import annotations

import argparse
import collections
import csv
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import volcontact as vc
from volcontact.meshes import cgal
from volcontact.meshes.judging import Judgement, judge
from volcontact.meshes.reading import read_mesh
from volcontact.meshes.topology import weld
from volcontact.meshes.triangles import MeshFileError, Triangles

RESULT = Path(__file__).parent / "results" / "mesh_collections.csv"
PACKAGES = {"metaworld": "3.1.1", "robosuite": "1.5.2"}
SUFFIXES = {".stl", ".obj", ".ply", ".off"}
POSES = 1000
KINDS = ("open_edges", "crowded_edges", "flipped_edges", "faces_without_area", "faces_twice")
COLUMNS = (
    *("package", "file", "format", "faces", "points", "parts", "size", "verdict", "repaired"),
    "findings",
    *KINDS,
    *("crossings", "volume", "read_ms", "judge_ms", "poses", "touching", "not_ok", "not_finite"),
    *("impossible", "ask_us", "refused"),
)


def main() -> None:
    """Judges all, writes the table and prints the sums."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="with a folder for each package")
    parser.add_argument("--install", action="store_true", help="fetch the packages first")
    parser.add_argument("--poses", type=int, default=POSES, help="of each solid [%(default)s]")
    parser.add_argument("--out", type=Path, default=RESULT)
    arguments = parser.parse_args()
    if cgal.program() is None:
        sys.exit(f"crossing faces must be looked for: {cgal.MISSING}")
    if arguments.install:
        install(arguments.folder)
    rows = []
    for package in PACKAGES:
        for path in files(arguments.folder / package):
            row = examine(path, arguments.poses)
            row |= {"package": package, "file": str(path.relative_to(arguments.folder / package))}
            rows.append(row)
    with arguments.out.open("w", encoding="utf-8", newline="") as table:
        writer = csv.DictWriter(table, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    for text, count in collections.Counter(row["verdict"] for row in rows).most_common():
        print(f"{count:5d} {text}")


def install(folder: Path) -> None:
    """Unpacks the wheels, each into a folder of its own."""
    uv = Path(__file__).parents[2] / ".venv" / "tools" / "bin" / "uv"
    for package, version in PACKAGES.items():
        target = ["--target", str(folder / package), f"{package}=={version}"]
        subprocess.run([str(uv), "pip", "install", "-q", "--no-deps", *target], check=True)


def files(folder: Path) -> Iterator[Path]:
    """All mesh files that can be read, in a fixed order."""
    if not folder.is_dir():
        sys.exit(f"{folder}: there is no such folder. Say --install.")
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() in SUFFIXES and path.is_file():
            yield path


def examine(path: Path, poses: int) -> dict[str, Any]:
    """The row of one file."""
    begin = time.perf_counter()
    try:
        mesh = read_mesh(path)
    except MeshFileError as error:
        return {"verdict": "unreadable", "refused": str(error).removeprefix(f"{path}: ")}
    read = time.perf_counter()
    judgement = judge(mesh)
    judged = time.perf_counter()
    counts = {finding.kind: finding.count for finding in judgement.findings}
    row: dict[str, Any] = {
        "format": mesh.format,
        "faces": len(mesh.faces),
        "points": judgement.welded_vertices,
        "parts": judgement.parts,
        "size": " ".join(f"{x:.6g}" for x in judgement.size),
        "verdict": verdict(judgement),
        "findings": " ".join(counts),
        "crossings": judgement.crossings,
        "volume": "" if judgement.moments is None else f"{judgement.moments.volume:.6g}",
        "read_ms": f"{1e3 * (read - begin):.1f}",
        "judge_ms": f"{1e3 * (judged - read):.1f}",
    }
    if not judgement.bounds_volume:
        row["repaired"] = repaired(mesh)
    row |= {name: counts.get(name, 0) for name in KINDS}
    if judgement.closed and judgement.oriented and judgement.outward and poses:
        row |= ask(mesh, poses)
    return row


def verdict(judgement: Judgement) -> str:
    """One word or two."""
    if judgement.bounds_volume:
        return "solid"
    if judgement.closed and judgement.oriented and judgement.outward:
        return "closed, faces cross" if judgement.crossings else "closed, with faults"
    return "closed, not oriented" if judgement.closed else "open"


def repaired(mesh: Triangles) -> str:
    """The verdict after `volcontact mesh repair`."""
    try:
        _, result = cgal.repair(mesh.vertices, mesh.faces, weld=0.0, fill=True)
    except (RuntimeError, MeshFileError) as error:
        return f"failed: {error}"
    return verdict(judge(result))


def ask(mesh: Triangles, poses: int) -> dict[str, Any]:
    """Contact with a box of half its size in random poses, and with a half-space."""
    vertices, faces = weld(mesh.vertices, mesh.faces)
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    half = 0.5 * (vertices.max(axis=0) - vertices.min(axis=0))
    try:
        solid = vc.Mesh(vertices - middle, faces)
    except ValueError as error:
        return {"refused": str(error)}
    others = (vc.Box(half_sizes=np.maximum(0.5 * half, 1e-3 * half.max())), vc.HalfSpace())
    random = np.random.default_rng(len(faces))
    sums = collections.Counter[str]()
    begin = time.perf_counter()
    for number in range(poses):
        X = random_pose(random, half)
        metrics = vc.interference(solid, others[number % 2], X)
        sums["touching"] += metrics.touching
        sums["not_ok"] += metrics.status not in ("ok", "contained")
        numbers = [metrics.volume, *metrics.centroid, *metrics.inertia.ravel()]
        numbers += [*metrics.area_vector, *metrics.area_moment, metrics.area, metrics.depth_moment]
        sums["not_finite"] += not np.isfinite(numbers).all()
        # No part of a solid is larger than it or less than nothing.
        sums["impossible"] += not 0.0 <= metrics.volume <= 8.0 * half.prod() * (1.0 + 1e-9)
    spent = time.perf_counter() - begin
    counts = {name: sums[name] for name in ("touching", "not_ok", "not_finite", "impossible")}
    return {"poses": poses, **counts, "ask_us": f"{1e6 * spent / poses:.1f}"}


def random_pose(random: np.random.Generator, half: np.ndarray) -> np.ndarray:
    """Of a body whose origin lies somewhere in the box around the mesh, or a little outside."""
    quaternion = random.normal(size=4)
    w, x, y, z = quaternion / np.linalg.norm(quaternion)
    X = np.eye(4)
    X[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    X[:3, 3] = random.uniform(-1.3, 1.3, 3) * half
    return X


if __name__ == "__main__":
    main()
