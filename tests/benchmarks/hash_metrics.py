# SPDX-License-Identifier: Apache-2.0
"""One hash for each ordered pair of solids and engine, of all numbers at many poses.

Two builds whose tables are equal compute the same bits: for a change that moves walls alone.

    ./run python tests/benchmarks/hash_metrics.py --out before.csv   # on the one, then on the other
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import volcontact as vc

ENGINES = ("auto", "closed_form", "clip", "lines", "columns", "octree")
SLOW = "octree"  # is asked for one pose in a hundred
SIZE = 0.3  # of every solid, about [m]
NUMBERS = (
    "volume", "volume_error", "area", "area_vector", "area_moment", "counter_area", "centroid",
    "inertia", "depth", "depth_moment", "flatness",
)  # fmt: skip


def solids() -> dict[str, Any]:
    """One of each kind, and what is composed of them."""
    block = vc.Box(half_sizes=(0.3, 0.3, 0.2))
    corners = np.array(list(itertools.product((-0.2, 0.2), (-0.15, 0.15), (-0.25, 0.25))))
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)]
    faces += [(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    return {
        "half_space": vc.HalfSpace(),
        "sphere": vc.Sphere(radius=0.3),
        "ellipsoid": vc.Ellipsoid(semi_axes=(0.2, 0.25, 0.3)),
        "capsule": vc.Capsule(radius=0.15, half_length=0.2),
        "cylinder": vc.Cylinder(radius=0.2, half_length=0.25),
        "frustum": vc.Frustum(bottom_radius=0.3, top_radius=0.1, half_length=0.2),
        "box": vc.Box(half_sizes=(0.2, 0.25, 0.15)),
        "torus": vc.Torus(major_radius=0.3, minor_radius=0.1),
        "polytope": vc.ConvexPolytope(vertices=corners * (1.0 + 0.1 * np.arange(8)[:, None])),
        "mesh": vc.Mesh(vertices=corners, faces=np.array(faces)),
        "bored": block - vc.Cylinder(radius=0.15, half_length=0.4),
        "cup": block - vc.Frustum(bottom_radius=0.05, top_radius=0.2, half_length=0.2),
        "union": vc.Sphere(radius=0.2) + vc.Box(half_sizes=(0.3, 0.1, 0.1)),
    }


def pose(rng: np.random.Generator, special: bool) -> NDArray[np.float64]:
    """A turn and a shift; `special` ones are parallel, a third of them coaxial."""
    X = np.eye(4)
    if not special:
        q = rng.normal(size=4)
        w, x, y, z = q / np.linalg.norm(q)
        X[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    X[:3, 3] = rng.uniform(-1.2 * SIZE, 1.2 * SIZE, size=3)
    if special and rng.uniform() < 1 / 3:
        X[:2, 3] = 0.0
    return X


def rows(poses: int) -> Iterator[tuple[str, str, str, int, str]]:
    """Names of the solids, engine, number of poses that touch, hash."""
    named = solids()
    for (a, solid_a), (b, solid_b) in itertools.product(named.items(), repeat=2):
        for engine in ENGINES:
            rng = np.random.default_rng(7)
            digest, touching, slow = hashlib.sha256(), 0, 0
            for number in range(poses):
                X_AB = pose(rng, special=number % 4 == 0)
                try:
                    found = vc.interference(solid_a, solid_b, X_AB, engine=engine)
                except ValueError:  # not served
                    break
                touching += found.volume > 0.0
                slow += found.engine == SLOW
                for metrics in (found, *found.sites):
                    for name in NUMBERS:
                        digest.update(np.asarray(getattr(metrics, name), dtype=float).tobytes())
                if slow > poses // 100:
                    break
            yield a, b, engine, touching, digest.hexdigest()[:16]


def main() -> None:
    """Writes the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--poses", type=int, default=400, help="for each pair and engine")
    parser.add_argument("--out", type=Path, required=True)
    arguments = parser.parse_args()
    with arguments.out.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["a", "b", "engine", "touching", "sha256"])
        for row in rows(arguments.poses):
            writer.writerow(row)


if __name__ == "__main__":
    main()
