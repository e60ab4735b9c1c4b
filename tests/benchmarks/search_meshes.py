# SPDX-License-Identifier: Apache-2.0
"""Random meshes against random meshes and solids, judged by manifold3d; results/search_meshes.json.

    ./run python tests/benchmarks/search_meshes.py --cases 2000

manifold3d cuts meshes exactly but for rounding, and shares nothing with the engines. Its meshes are
bumpy balls, gears, bored and stepped parts, boxes and prisms, many flush, coaxial or concentric.
Round solids are not compared: what facets leave out is more than an engine's error.
"""

from __future__ import annotations

import argparse
import datetime
import json
import time
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np

import volcontact as vc

RESULT = Path(__file__).parent / "results" / "search_meshes.json"
BOUND = 1e-9  # of the smaller solid, beside the claimed error: manifold3d rounds
EXAMPLES = 3

Mesh = tuple[np.ndarray, np.ndarray]


class Drawer:
    """Draws solids and poses; the same for the same seed."""

    def __init__(self, seed: int) -> None:
        self.random = np.random.default_rng(seed)

    def solid(self) -> manifold3d.Manifold:
        """A mesh of one of the kinds."""
        r = self.random
        size = r.choice([0.1, 0.15, 0.2, 0.3]) if r.random() < 0.5 else r.uniform(0.05, 0.4)
        sides = int(r.integers(3, 24))
        kind = r.integers(8)
        if kind == 0:
            return manifold3d.Manifold.cube(2.0 * self.sizes(), True)
        if kind == 1:
            return manifold3d.Manifold.cylinder(2.0 * size, *r.uniform(0.05, 0.3, 2), sides, True)
        if kind == 2:  # a ring
            outer = manifold3d.Manifold.cylinder(2.0 * size, 0.3, 0.3, sides, True)
            return outer - manifold3d.Manifold.cylinder(4.0 * size, 0.2, 0.2, sides, True)
        if kind == 3:  # a block with a stepped bore
            block = manifold3d.Manifold.cube([0.6, 0.6, 2.0 * size], True)
            narrow = manifold3d.Manifold.cylinder(3.0 * size, 0.1, 0.1, sides, True)
            wide = manifold3d.Manifold.cylinder(2.0 * size, 0.2, 0.2, sides, True)
            return block - narrow - wide.translate([0.0, 0.0, size])
        if kind == 4:  # a bumpy ball
            ball = manifold3d.Manifold.sphere(size, 4 * int(r.integers(3, 8)))
            phase = r.uniform(0.0, 6.0, 3)
            return ball.warp_batch(
                lambda p: p * (1.0 + 0.1 * np.sin(8.0 / size * p + phase).sum(axis=1))[:, None]
            )
        if kind == 5:  # a gear
            angles = np.linspace(0.0, 2.0 * np.pi, 4 * sides, endpoint=False)
            radii = size * np.where(np.arange(4 * sides) % 4 < 2, 1.0, 0.8)
            outline = np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])
            return manifold3d.CrossSection([outline]).extrude(0.1).translate([0, 0, -0.05])
        if kind == 6:  # two boxes as one
            two = manifold3d.Manifold.cube(2.0 * self.sizes(), True).translate(0.5 * self.sizes())
            return manifold3d.Manifold.cube(2.0 * self.sizes(), True) + two
        points = r.normal(size=(int(r.integers(4, 30)), 3)) * self.sizes()
        return manifold3d.Manifold.hull_points(points)

    def sizes(self) -> np.ndarray:
        """Half sizes, many of them round numbers that others have, too."""
        r = self.random
        sizes = np.where(
            r.random(3) < 0.6, r.choice([0.05, 0.1, 0.2, 0.3], 3), r.uniform(0.05, 0.4)
        )
        if r.random() < 0.1:
            sizes[r.integers(3)] *= 10 ** r.uniform(-3, -1)
        return sizes

    def pose(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Random, or axes along axes on a grid of features, half of these a hair off."""
        r = self.random
        X = np.eye(4)
        if r.random() < 0.4:
            q, _ = np.linalg.qr(r.normal(size=(3, 3)))
            X[:3, :3] = q * np.sign(np.linalg.det(q))
            X[:3, 3] = r.uniform(low, high)
            return X
        turns = r.permutation(3)
        X[:3, :3] = np.eye(3)[turns] * r.choice([-1.0, 1.0], 3)
        X[:3, 0] *= np.sign(np.linalg.det(X[:3, :3]))
        X[:3, 3] = r.choice([0.0, 0.0, 0.05, 0.1, 0.2, 0.3, -0.1, -0.2], 3)
        if r.random() < 0.3:
            angle = r.uniform(0.0, 2.0 * np.pi)
            c, s = np.cos(angle), np.sin(angle)
            X[:3, :3] = X[:3, :3] @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        if r.random() < 0.5:
            X[:3, 3] += 10 ** r.uniform(-15, -6) * r.choice([-1.0, 0.0, 1.0], 3)
        return X


def arrays(solid: manifold3d.Manifold) -> Mesh:
    """Vertices and triangles in double precision."""
    mesh = solid.to_mesh64()
    return np.ascontiguousarray(mesh.vert_properties[:, :3]), mesh.tri_verts.astype(np.int32)


def examine(seed: int) -> dict[str, Any]:
    """One case: what both say, and what is wrong."""
    drawer = Drawer(seed)
    a, b = drawer.solid(), drawer.solid()
    row: dict[str, Any] = {"seed": seed}
    if a.is_empty() or b.is_empty():
        return row | {"refused": "empty"}
    low, high = np.array(a.bounding_box()).reshape(2, 3)
    X = drawer.pose(low, high)
    try:
        one, two = vc.Mesh(*arrays(a)), vc.Mesh(*arrays(b))
    except ValueError as error:
        return row | {"refused": str(error)}
    begin = time.perf_counter()
    found = vc.interference(one, two, X)
    row["seconds"] = time.perf_counter() - begin
    back = vc.interference(two, one, np.linalg.inv(X))
    expected = max(0.0, (a ^ b.transform(X[:3])).volume())
    body = min(a.volume(), b.volume())
    row |= {"volume": found.volume, "expected": expected, "status": str(found.status)}
    doubt = BOUND * body
    faults = []
    if not abs(found.volume - expected) <= found.volume_error + doubt:
        faults.append("beyond the bound")
    if not abs(found.volume - back.volume) <= found.volume_error + back.volume_error + doubt:
        faults.append("another volume in the other order")
    if abs(sum(site.volume for site in found.sites) - found.volume) > 1e-9 * found.volume:
        faults.append("sites that do not add up")
    return row | {"faults": faults}


def main() -> None:
    """Runs the cases and writes what came of them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=20_000)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--out", type=Path, default=RESULT)
    arguments = parser.parse_args()
    rows = [examine(seed) for seed in range(arguments.first, arguments.first + arguments.cases)]
    result = {"date": f"{datetime.date.today()}", **summary(rows)}
    arguments.out.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    print({name: value for name, value in result.items() if name != "examples"})
    for example in result["examples"]:
        print("   ", example)


def summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """The counts, the worst error, and the first failures in full."""
    judged = [row for row in rows if "refused" not in row]
    failed = [row for row in judged if row["faults"]]
    kinds: dict[str, int] = {}
    for row in failed:
        for fault in row["faults"]:
            kinds[fault] = kinds.get(fault, 0) + 1
    return {
        "cases": len(judged),
        "refused": len(rows) - len(judged),
        "overlapping": sum(row["expected"] > 0.0 for row in judged),
        "slowest": max((row["seconds"] for row in judged), default=0.0),
        "faults": kinds,
        "examples": failed[:EXAMPLES],
    }


if __name__ == "__main__":
    main()
