# SPDX-License-Identifier: Apache-2.0
"""The section on triangle meshes of the performance page."""

from __future__ import annotations

from collections.abc import Callable

from parts.performance_results import by_scene, digits, is_ours, read, small, span

EQUAL = 1e-10  # asked of volume, centroid and inertia beside exact booleans, relative
BUDGET = 0.1e6  # of one question of any kind [us]
Row = dict[str, str]

# Pair, title, error of the volume asked, time asked [us].
_ASKED = (
    ("bumpy balls, 1.3k", "bumpy balls, 1.3k triangles each", EQUAL, 20.0),
    ("bumpy balls, 20k", "bumpy balls, 20k", EQUAL, 60.0),
    ("bumpy balls, 82k", "bumpy balls, 82k", EQUAL, 150.0),
    ("mesh 20k - half-space", "mesh of 20k - half-space", EQUAL, 5.0),
    ("mesh 20k - box", "mesh of 20k - box", EQUAL, 10.0),
    ("mesh 20k - sphere", "mesh of 20k - sphere", 1e-3, 20.0),
    ("linked rings, 20k, apart", "linked rings of 20k, apart", EQUAL, BUDGET),
    ("one inside the other, 20k", "one of 20k inside the other", EQUAL, BUDGET),
    ("tilted peg in sleeve, 8k", "tilted peg in sleeve, 8k", EQUAL, BUDGET),
    ("identical meshes, 20k", "identical meshes of 20k", EQUAL, BUDGET),
)
_RATIOS = (("bumpy balls, 1.3k", 20.0), ("bumpy balls, 20k", 80.0))
_STEPS = ("peg in hole, 20k triangles, aligned", "peg in hole, 20k triangles, at two points")
_STEP = 300.0  # [us]

# Columns: title, library and the beginning of its variant.
_COLUMNS = (
    ("volcontact in C++", "volcontact", "in C++"),
    ("from pose to pose", "volcontact", "from pose"),
    ("manifold3d", "manifold3d", ""),
    ("CGAL", "CGAL", ""),
    ("Drake, hydroelastic", "Drake", ""),
    ("MuJoCo, hulls", "MuJoCo", "native"),
    ("MuJoCo, SDF", "MuJoCo", "SDF"),
)

GIVES = """\
| library | what one query gives |
| --- | --- |
| volcontact | volume with all moments, area vector and moment, depth, contact sites |
| manifold3d | the mesh of the overlap and its volume; a sphere or cylinder has 64 segments |
| CGAL | the overlap with exact numbers and its moments; a program of its own (`volcontact-cgal overlap`): reading and building count, its start not |
| Drake, hydroelastic | the surface of equal pressure of a rigid mesh and a compliant solid: half-space, primitive, or a mesh filled with tetrahedra, where one point sees all of its triangles |
| MuJoCo, hulls | contact points of the convex hulls: other solids |
| MuJoCo, SDF | contact points, sought by descent on the distance field of the mesh |
"""  # noqa: E501 (rows of a table)


def rows_by_case() -> dict[str, list[Row]]:
    """The results, pair by pair."""
    cases: dict[str, list[Row]] = {}
    for row in read("mesh_pairs"):
        cases.setdefault(row["case"], []).append(row)
    return cases


def meshes(table: Callable[[tuple[str, ...], list[tuple[str, ...]]], str]) -> str:
    """The section. `table` makes a Markdown table."""
    cases = rows_by_case()
    columns = [
        column for column in _COLUMNS if any(_row(rows, *column[1:]) for rows in cases.values())
    ]
    header = ("pair", *(title for title, _, _ in columns))
    times = [
        (case, *(_time(rows, library, variant) for _, library, variant in columns))
        for case, rows in cases.items()
    ]
    asked, missed = _asked(cases)
    equal = [_equal(case, rows) for case, rows in cases.items()]
    return (
        "## Triangle meshes\n\n"
        "The same triangles at the same poses, alternating in one run (`mesh_benchmark.py`). Bumpy "
        "balls of radius 1 m are sunk 1 % into each other and into the primitives, the box and the "
        "half-space at a face. The sphere has radius 1 m, the cylinder is 1 m thick and 1 m long. "
        "Peg and plate are those of `mjcf_models/peg_in_hole`: 8 mm in 8.2 mm. Numbers of "
        "triangles are per mesh. A worst case may take 0.1 s, the budget of one "
        "query.\n\n"
        "![Times of other libraries relative to ours, meshes](performance/meshes.svg)\n\n"
        + table(("target", "", "measured", ""), asked)
        + f"\n**Missed:** {'; '.join(missed) or 'none'}.\n\n"
        "A result may be less accurate than requested where the budget of its engine runs out: its "
        "status is then `approximate`, and its error is bounded.\n\n"
        + GIVES
        + "\nProcessor time of one query and, in brackets, its ratio to that of volcontact. "
        "Building the solids does not count. Slow libraries are run on fewer poses: "
        "`tests/benchmarks/results/mesh_pairs.csv`.\n\n"
        + table(header, times)
        + "\nLargest differences over the poses between our volume, centroid (relative to the cube "
        "root of the volume) and inertia and those of the exact booleans. For the sphere and the "
        "cylinder, our volume is compared with a formula and with a prism of 4096 sides, which is "
        "itself off by 3e-5:\n\n"
        + table(("pair", "status", "overlaps", "manifold3d", "CGAL", "formula, prism"), equal)
        + f"\n**Contact found by others where there is none:** {_wrong(cases, apart=True)}.\n\n"
        f"**Contact not found by others:** {_wrong(cases, apart=False)}.\n"
    )


def _row(rows: list[Row], library: str, variant: str) -> Row | None:
    found = (r for r in rows if r["library"] == library and r["variant"].startswith(variant))
    return next(found, None)


def _ours(rows: list[Row]) -> Row:
    return next(row for row in rows if is_ours(row))


def _time(rows: list[Row], library: str, variant: str) -> str:
    row = _row(rows, library, variant)
    if row is None:
        return ""
    time = float(row["time_us"])
    if is_ours(row):
        return span(time)
    ratio = time / float(_ours(rows)["time_us"])
    return f"{span(time)} ({digits(ratio) if ratio > 0.01 else f'1 / {digits(1 / ratio)}'})"


def _worst(row: Row | None) -> float | None:
    """The largest of the differences; None where nothing was compared."""
    names = ("volume_error", "centroid_error", "inertia_error")
    numbers = [float(row[name]) for name in names if row[name]] if row else []
    return max(numbers, default=None)


def _volume(row: Row | None) -> float | None:
    return float(row["volume_error"]) if row and row["volume_error"] else None


def _differences(row: Row | None) -> str:
    if row is None or not row["inertia_error"]:
        return ""
    names = ("volume_error", "centroid_error", "inertia_error")
    return ", ".join(_small(row[name]) for name in names)


def _small(number: str) -> str:
    """An error; infinite where one finds an overlap and the other does not."""
    return "no overlap" if number == "inf" else small(number)


def _equal(case: str, rows: list[Row]) -> tuple[str, ...]:
    ours = _ours(rows)
    exact = (_row(rows, library, "") for library in ("manifold3d", "CGAL"))
    found = f"{ours['found']} of {ours['poses']}"
    return (
        case,
        ours["status"],
        found,
        *(_differences(row) for row in exact),
        small(ours["volume_error"]),
    )


def _asked(cases: dict[str, list[Row]]) -> tuple[list[tuple[str, ...]], list[str]]:
    """Lines of the table, and what is missed."""
    lines: list[tuple[str, ...]] = []
    missed: list[str] = []

    def add(what: str, asked: str, measured: str, *, met: bool) -> None:
        lines.append((what, asked, measured, "met" if met else "missed"))
        if not met:
            missed.append(f"{what} ({measured} for {asked.lstrip('<> ')})")

    for case, title, error, limit in _ASKED:
        ours = _ours(cases[case])
        time = float(ours["time_us"])
        add(title, f"< {span(limit)}", span(time), met=time < limit)
        exact = [_worst(_row(cases[case], library, "")) for library in ("manifold3d", "CGAL")]
        found = [e for e in exact if e is not None] if error == EQUAL else [_worst(ours)]
        worst = max((e for e in found if e is not None), default=None)
        if worst is None:
            continue
        flagged = ours["status"] == "approximate"
        if error == EQUAL and flagged:
            found = [_volume(_row(cases[case], library, "")) for library in ("manifold3d", "CGAL")]
            worst = max(e for e in found if e is not None)
            bound = float(ours["volume_bound"])
            what = f"{title}, flagged; error of the volume"
            add(what, f"< {_small(str(bound))}, its bound", _small(str(worst)), met=worst < bound)
            continue
        what = "equal to exact booleans" if error == EQUAL else "error"
        add(f"{title}, {what}", f"< {small(str(error))}", _small(str(worst)), met=worst < error)
    for case, ratio in _RATIOS:
        other = _row(cases[case], "manifold3d", "")
        if other:
            factor = float(other["time_us"]) / float(_ours(cases[case])["time_us"])
            add(f"{case}, manifold3d by ours", f"> {ratio:g}", digits(factor), met=factor > ratio)
    scenes = by_scene()
    for scene in _STEPS:
        time = float(scenes[scene]["volumetric"]["time_us"])
        add(f"{scene}, one step", f"< {span(_STEP)}", span(time), met=time < _STEP)
    return lines, missed


def _wrong(cases: dict[str, list[Row]], *, apart: bool) -> str:
    """Who finds contact at poses without one, or none at poses with one."""
    found = []
    for case, rows in cases.items():
        ours = _ours(rows)
        touching = int(ours["found"])
        if touching not in (0, int(ours["poses"])) or (touching == 0) != apart:
            continue
        for row in rows:
            wrong = int(row["found"]) if apart else int(row["poses"]) - int(row["found"])
            if not is_ours(row) and wrong:
                name = f"{row['library']}, {row['variant']}"
                found.append(f"{name} on {case} ({wrong} of {row['poses']})")
    return "; ".join(found) or "none"
