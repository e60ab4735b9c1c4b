# SPDX-License-Identifier: Apache-2.0
"""The tables in tests/benchmarks/results, and what was asked: for the performance page."""

from __future__ import annotations

import csv
import hashlib
from dataclasses import dataclass
from pathlib import Path

RESULTS = Path(__file__).resolve().parents[3] / "tests" / "benchmarks" / "results"


@dataclass(frozen=True)
class Asked:
    """What is asked of a pair.

    Attributes:
        title: on the page
        error: of V, relative [-]
        time: of one query [us]
        benchmarks: of the C++ benchmarks; the slowest counts
        case: of the comparison with other libraries, which has the error
    """

    title: str
    error: float
    time: float
    benchmarks: tuple[str, ...]
    case: str


ASKED = (
    Asked(
        "half-space - sphere", 1e-13, 0.05, ("ground_ball", "ball_ground"), "half-space - sphere"
    ),
    Asked(
        "half-space - ellipsoid",
        1e-13,
        0.05,
        ("ground_ellipsoid", "ellipsoid_ground"),
        "half-space - ellipsoid",
    ),
    Asked("sphere - sphere", 1e-13, 0.05, ("ball_ball",), "sphere - sphere"),
    Asked("half-space - box", 1e-12, 0.2, ("ground_box", "box_ground"), "half-space - box"),
    Asked("box at rest on a box", 1e-12, 1.0, ("box_box_face",), "box - box at rest"),
    Asked("box - box", 1e-12, 1.0, ("box_box_over_edge", "box_box_shallow"), "box - box"),
    Asked("box - box, a tenth and more inside", 1e-12, 1.0, ("box_box_deep",), "box - box"),
    Asked(
        "polytopes of 32 faces, shallow", 1e-12, 4.0, ("gem_gem_shallow",), "polytope - polytope"
    ),
    Asked(
        "half-space - cylinder, any tilt",
        1e-8,
        2.0,
        ("ground_can", "can_ground", "ground_can_lying"),
        "half-space - cylinder",
    ),
    Asked(
        "half-space - capsule",
        1e-8,
        2.0,
        ("ground_pill", "ground_pill_lying"),
        "half-space - capsule",
    ),
    Asked("half-space - torus", 1e-4, 10.0, ("ground_ring",), "half-space - torus"),
    Asked("ellipsoid over a box edge", 1e-5, 4.0, ("ellipsoid_over_box_edge",), "box - ellipsoid"),
    Asked(
        "tilted cylinder, rim in a box face",
        1e-4,
        10.0,
        ("can_cap_edge_into_box_face",),
        "box - cylinder",
    ),
    Asked(
        "sphere on the rim of a bored block",
        1e-8,
        4.0,
        ("ball_on_rim_of_bore",),
        "bored block - sphere",
    ),
    Asked(
        "peg in a bore, clearance 0.3 mm",
        1e-4,
        15.0,
        ("peg_in_bore_300um",),
        "bored block - peg 0.3 mm",
    ),
    Asked(
        "peg in a bore, clearance 0.02 mm",
        1e-4,
        15.0,
        ("peg_in_bore_20um",),
        "bored block - peg 0.02 mm",
    ),
    Asked(
        "peg in a bore, 0.3 mm, by the octree",
        1e-2,
        3000.0,
        ("peg_in_bore_clearance_3_percent/1/real_time",),
        "bored block - peg 0.3 mm, octree",
    ),
    Asked(
        "peg in a bore, 0.02 mm, by the octree",
        1e-2,
        3000.0,
        ("peg_in_bore_clearance_20_um/1/real_time",),
        "bored block - peg 0.02 mm, octree",
    ),
)


def read(name: str, folder: Path = RESULTS) -> list[dict[str, str]]:
    """One table of the results, line by line."""
    with (folder / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


CPP_TABLES = ("lines", "octree", "pair")
_SCALE = {"ns": 1e-3, "us": 1.0, "ms": 1e3}


def medians(clock: str = "cpu_time") -> dict[str, float]:
    """Time of every C++ benchmark [us]: `cpu_time` of its first thread, or `real_time`."""
    return {
        row["name"].removesuffix("_median"): float(row[clock]) * _SCALE[row["time_unit"]]
        for name in CPP_TABLES
        for row in read(name)
        if row["name"].endswith("_median")
    }


def digest() -> str:
    """Of all results: the plots carry it, so that a test knows whether they are up to date."""
    total = hashlib.sha256()
    for name in (*CPP_TABLES, "conditions", "mesh_pairs", "peers", "steps"):
        total.update((RESULTS / f"{name}.csv").read_bytes())
    return total.hexdigest()[:16]


def in_cpp(case: str) -> dict[str, str]:
    """Our own line of a pair in the comparison."""
    return next(row for row in read("peers") if row["case"] == case and row["variant"] == "in C++")


def times_of(asked: Asked) -> list[float]:
    """Of the benchmarks of a pair [us]."""
    measured = medians()
    return [measured[name] for name in asked.benchmarks]


def span(microseconds: float) -> str:
    """A time as people say it."""
    if microseconds < 1.0:
        return f"{1e3 * microseconds:.3g} ns"
    if microseconds < 1e3:
        return f"{microseconds:.3g} us"
    if microseconds < 1e6:
        return f"{microseconds / 1e3:.3g} ms"
    return f"{microseconds / 1e6:.3g} s"


def small(number: str) -> str:
    """An error as people write it: 2e-7, not 2.03e-07."""
    if not number:
        return ""
    mantissa, _, exponent = f"{float(number):.0e}".partition("e")
    return "0" if float(number) == 0.0 else f"{mantissa}e{int(exponent)}"


def digits(ratio: float) -> str:
    """Two digits, three near 1, without an exponent: 12,000."""
    if ratio >= 10.0:
        return f"{float(f'{ratio:.2g}'):,.0f}"
    return f"{ratio:.2f}" if 0.5 < ratio < 2.0 else f"{ratio:.2g}"


def is_ours(row: dict[str, str]) -> bool:
    """Whether a line of the comparison is ours, timed in C++."""
    return row["library"] == "volcontact" and row["variant"] == "in C++"


def by_scene() -> dict[str, dict[str, dict[str, str]]]:
    """The steps, by scene and kind of contact."""
    scenes: dict[str, dict[str, dict[str, str]]] = {}
    for row in read("steps"):
        scenes.setdefault(row["scene"], {})[row["contact"]] = row
    return scenes


def by_native(kinds: dict[str, dict[str, str]]) -> float:
    """Time of volumetric contact by that of native contact."""
    return float(kinds["volumetric"]["time_us"]) / float(kinds["native"]["time_us"])
