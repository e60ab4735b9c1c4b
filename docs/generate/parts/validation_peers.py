# SPDX-License-Identifier: Apache-2.0
"""The table of other engines on the validation page."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from parts.performance_results import by_native, by_scene, medians, read

if TYPE_CHECKING:
    from case import Case

# What other engines make of some of these: title, their figure, our case, our figure of it.
PEERS = (
    (
        "creep at 0.9 of the friction cone",
        "Drake SAP 1e-3 mm/s; MuJoCo 2.5 mm/s",
        "incline",
        "creep in 60 s at 0.9 of the cone",
    ),
    (
        "tumbling box without dissipation, relative error of energy",
        "OpenSim 1e-5; MuJoCo 12 %",
        "tumbling_box",
        "error of energy, step 0.0001 s",
    ),
    (
        "the same, box on edges of boxes",
        "Drake's hydroelastic cubes gain energy (its issue 18241)",
        "potential",
        "grate, potential: error of energy",
    ),
    (
        "rotational stiffness of a flat patch over Winkler's",
        "Drake 0.67; MuJoCo 3.0",
        "flat_patch",
        "tilt stiffness over Winkler's",
    ),
    (
        "disc that slides and spins: time to rest over the exact 0.45542 s",
        "Drake 1.003",
        "spinning_disc",
        "quadrature: rest",
    ),
    (
        "stiffest contact that an explicit step of 2 ms bears, K h^2/m",
        "an explicit spring 4; Drake's lagged model 1e10 Pa; MuJoCo any, of its own solver",
        "stiff_contact",
        "largest K h^2/m at rest",
    ),
    (
        "the same, implicit: boxes thrown at 1e6 times that, largest energy over first",
        "an explicit spring is lost at 4 times",
        "implicit_contact",
        "largest energy over first, 1e+06 times the limit",
    ),
)
# Times: title, the file of the table in tests/benchmarks/results, the case, the others in it.
TIMES = (
    ("half-space - sphere", "peers", "half-space - sphere"),
    ("half-space - ellipsoid", "peers", "half-space - ellipsoid"),
    ("sphere - sphere", "peers", "sphere - sphere"),
    ("half-space - box", "peers", "half-space - box"),
    ("box - box", "peers", "box - box"),
    ("box - cylinder", "peers", "box - cylinder"),
    ("box - ellipsoid", "peers", "box - ellipsoid"),
    ("peg in bore, 0.02 mm", "peers", "bored block - peg 0.02 mm"),
    ("mesh - mesh, 1.3k triangles", "mesh_pairs", "bumpy balls, 1.3k"),
    ("mesh - mesh, 20k triangles", "mesh_pairs", "bumpy balls, 20k"),
    ("mesh - mesh, 82k triangles", "mesh_pairs", "bumpy balls, 82k"),
)
OTHERS = ("MuJoCo, native", "manifold3d", "CGAL", "Drake, hydroelastic")
STEPS = (
    ("battery box, one step of 1 ms", "battery box, seated"),
    ("pile of 20 boxes, one step", "pile of 20 boxes, at rest"),
)


def number(value: float) -> str:
    """A number of the page."""
    return "none" if math.isnan(value) else f"{value:.6g}"


def peers(cases: dict[str, Case]) -> str:
    """The section: figures, and times as ratios of one run."""
    lines = [
        "## Beside other engines\n",
        "Figures of the others as measured for this project's design, on their releases of then; "
        "ours as above.\n",
        "| what | others | here |",
        "| --- " * 3 + "|",
    ]
    for title, others, name, figure_name in PEERS:
        figure = next(f for f in cases[name].figures if f.name == figure_name)
        value = figure.measured
        if "over the exact" in title:
            value /= figure.expected
        unit = "" if figure.unit in ("-", "s") else f" {figure.unit}"
        lines.append(f"| {title} | {others} | {number(value)}{unit} |")
    return "\n".join([*lines, "", *_times()]) + "\n"


def _times() -> list[str]:
    """The others' time over ours, from the run of the benchmarks."""
    lines = [
        "Times, from [performance.md](performance.md): how many times as long as ours the others "
        "take, in one run on one machine. MuJoCo gives points and depths, Drake a surface, "
        "manifold3d and CGAL a volume (manifold3d of 64 segments where the solids are round).\n",
        f"| what | ours [us] | {' | '.join(OTHERS)} |",
        "| --- " * (2 + len(OTHERS)) + "|",
    ]
    for title, table, case in TIMES:
        rows = [row for row in read(table) if row["case"] == case]
        ours = next(float(r["time_us"]) for r in rows if r["variant"] == "in C++")
        cells = [_ratio(rows, other, ours) for other in OTHERS]
        lines.append(f"| {title} | {ours:.3g} | {' | '.join(cells)} |")
    scenes = by_scene()
    for title, scene in STEPS:
        kinds = scenes[scene]
        ours = float(kinds["volumetric"]["time_us"])
        drake = f"{float(kinds['Drake']['time_us']) / ours:.3g}" if "Drake" in kinds else ""
        lines.append(f"| {title} | {ours:.3g} | {1.0 / by_native(kinds):.2g} | | | {drake} |")
    wall = medians("real_time")
    name = "peg_in_bore_clearance_20_um"
    one, two = (wall[f"{name}/{n}/real_time"] for n in (1, 2))
    lines.append(
        f"\nThe octree on two threads, peg at 0.02 mm: {one / two:.2f} times as fast as on one."
    )
    return lines


def _ratio(rows: list[dict[str, str]], other: str, ours: float) -> str:
    library, _, variant = other.partition(", ")
    for row in rows:
        if row["library"] == library and row["variant"].startswith(variant):
            return f"{float(row['time_us']) / ours:.3g}"
    return ""
