# SPDX-License-Identifier: Apache-2.0
"""What pages have from the code and from the tables of results: a function each."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable

import numpy as np
from make_accuracy import SPREADS, over, short
from make_comparison import VALIDATION
from make_components import CHOICE, FIELD, NAME, laws, number
from make_mjcf_keys import default_material, default_text, quoted, table, words_after
from parts.hosts_tables import host, hosts
from parts.performance_results import ASKED, in_cpp, is_ours, read, small, span, times_of

import volcontact as vc

_STATE = re.compile(r"^    (\w+) \[(.+?)\]: (.+?)$", re.MULTILINE)
_KEEPS = "Keeps, for each contact site:"

# One solid of a kind, to ask the code which engine serves which pair.
_CUBE = np.array([(x, y, z) for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)])
_FACES = np.array(
    [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
)
SOLIDS = {
    "half-space": vc.HalfSpace(),
    "sphere": vc.Sphere(0.1),
    "ellipsoid": vc.Ellipsoid((0.1, 0.08, 0.12)),
    "capsule": vc.Capsule(0.05, 0.08),
    "cylinder": vc.Cylinder(0.08, 0.1),
    "frustum": vc.Frustum(0.1, 0.05, 0.1),
    "torus": vc.Torus(0.1, 0.03),
    "box": vc.Box((0.1, 0.08, 0.12)),
    "rounded box": vc.RoundedBox((0.1, 0.08, 0.12), 0.02),
    "convex polytope": vc.ConvexPolytope(_CUBE),
    "composed solid": vc.Box((0.1, 0.1, 0.1)) - vc.Cylinder(0.05, 0.2),
    "mesh": vc.Mesh(_CUBE, np.vstack([_FACES[:, [0, 1, 2]], _FACES[:, [0, 2, 3]]])),
    "signed distance": vc.SignedDistance(
        lambda points: np.linalg.norm(points, axis=1) - 0.1,
        bounds=((-0.1, -0.1, -0.1), (0.1, 0.1, 0.1)),
    ),
}

# Which engine makes the times of the performance page. Every pair there is in one row here.
TIMED = {
    "closed_form": (
        "half-space - sphere",
        "half-space - ellipsoid",
        "sphere - sphere",
        "half-space - cylinder, any tilt",
        "half-space - capsule",
        "half-space - torus",
    ),
    "clip": (
        "half-space - box",
        "box at rest on a box",
        "box - box",
        "box - box, a tenth and more inside",
        "polytopes of 32 faces, shallow",
    ),
    "lines": (
        "ellipsoid over a box edge",
        "tilted cylinder, rim in a box face",
        "sphere on the rim of a bored block",
        "peg in a bore, clearance 0.3 mm",
        "peg in a bore, clearance 0.02 mm",
    ),
    "octree": ("peg in a bore, 0.3 mm, by the octree", "peg in a bore, 0.02 mm, by the octree"),
}


# ---- Engines -------------------------------------------------------------------------------------


@functools.cache
def chosen() -> dict[tuple[str, str], str]:
    """Which engine `auto` takes for a pair of solids that overlap over edges, in this order.

    A formula must know the overlap over a corner, too.
    """
    over_edge, over_corner = np.eye(4), np.eye(4)
    over_edge[:3, 3] = 0.03, 0.06, 0.05
    over_corner[:3, 3] = 0.08, 0.06, 0.05
    engines = {}
    for a, solid in SOLIDS.items():
        for b, other in SOLIDS.items():
            if (a, b) == ("half-space", "half-space"):
                continue
            engine = vc.interference(solid, other, over_edge, tolerance=0.5).engine
            if engine == "closed_form":
                engine = vc.interference(solid, other, over_corner, tolerance=0.5).engine
            engines[a, b] = engine
    return engines


def is_served(engine: str, a: str, b: str) -> bool:
    """Whether an engine takes a pair when it is asked for; far apart, so that it is quick."""
    X_AB = np.eye(4)
    X_AB[2, 3] = 1.0
    try:
        vc.interference(SOLIDS[a], SOLIDS[b], X_AB, engine=engine)
    except ValueError:
        return False
    return True


def pairs(engine: str) -> str:
    """Which solids an engine serves with which, and where it is the one that `auto` takes."""
    alike: dict[tuple[str, str], list[str]] = {}
    for a in SOLIDS:
        known = [b for b in SOLIDS if (a, b) in chosen()]
        served = [b for b in known if is_served(engine, a, b)]
        first = [b for b in served if chosen()[a, b] == engine]
        asked = [b for b in served if b not in first]
        if served:
            others = "all others" if served == known else ", ".join(asked)
            alike.setdefault((", ".join(first), others if asked else ""), []).append(a)
    rows = [(", ".join(solids), *cells) for cells, solids in alike.items()]
    return table(("solid", "`auto` uses it with", "on request also with"), rows)


def accuracy(engine: str) -> str:
    """Errors over all pairs and poses of the record."""
    rows = [row for row in read("accuracy") if row["engine"] == engine and int(row["poses"])]
    poses = sum(int(row["poses"]) for row in rows)
    held = sum(int(row["bounds_held"]) for row in rows)
    spread = []
    for name, title in SPREADS.items():
        low, high = over(rows, f"{name}_median", np.median), over(rows, f"{name}_worst", max)
        if low is not None:
            spread.append((title, short(low), short(high)))
    return (
        f"{len(rows)} ordered pairs, {poses} poses; within `volume_error` in {100 * held / poses:.3g} % "  # noqa: E501
        "of them. [Pair by pair](../accuracy.md).\n\n"
        + table(("error of", "median of the pairs' medians", "worst of all"), spread)
    )


def times(engine: str) -> str:
    """Time of one query in C++, and its error where it is known."""
    if engine == "columns":
        rows = [
            (row["case"], span(float(row["time_us"])), small(row["volume_error"]))
            for row in read("mesh_pairs")
            if is_ours(row)
        ]
    else:
        timed = [asked for asked in ASKED if asked.title in TIMED[engine]]
        rows = [
            (a.title, span(max(times_of(a))), small(in_cpp(a.case)["volume_error_median"]))
            for a in timed
        ]
    return table(("pair", "time", "error of the volume, median"), rows)


# ---- Laws ----------------------------------------------------------------------------------------


@functools.cache
def default_values() -> dict[str, float]:
    """Of a pair without a material."""
    return default_material()


def parameters(law: str) -> str:
    """Its fields and choices, with ranges and defaults."""
    component = laws()[law]
    made, rows = component(), []
    for field, unit, meaning, _, allowed in FIELD.findall(component.__doc__):
        own = number(getattr(made, field))
        scene = default_text(field, default_values())
        rows.append((f"`{field}`", unit, meaning, allowed, own, scene))
    for field, meaning, words in CHOICE.findall(component.__doc__):
        allowed = quoted(NAME.findall(words))
        own = f"`{getattr(made, field)}`"
        scene = f"`{words_after('material', field)[0]}`"
        rows.append((f"`{field}`", "", meaning, allowed, own, scene))
    head = ("parameter", "unit", "meaning", "allowed", "default", "default material")
    kind = "normal_law" if law in words_after("material", "normal_law") else "friction_law"
    place = f"Python: `vc.{component.__name__}`. MJCF: `volcontact/material/NAME/{kind}/{law}`"
    first = words_after("material", kind)[0] == law
    return f"{place}{', the default' if first else ''}.\n\n" + table(head, rows)


def states(law: str) -> str:
    """What it keeps for each contact site."""
    _, _, kept = laws()[law].__doc__.partition(_KEEPS)
    rows = [(f"`{name}`", unit, meaning) for name, unit, meaning in _STATE.findall(kept)]
    return table(("state", "unit", "meaning"), rows) if rows else "None.\n"


def words(choice: str) -> str:
    """The words of a choice of a material, or of an option."""
    what, name = choice.split("/")
    found = words_after("options" if what == "option" else what, name)
    place = f"option/{name}" if what == "option" else f"material/NAME/{name}"
    return (
        f"MJCF: `volcontact/{place}/WORD`, WORD one of {quoted(found)}; the first is the default.\n"
    )


def validation(what: str) -> str:
    """Rows of the validation page: `Section` or `Section / words a figure begins with`, by `;`."""
    page = VALIDATION.read_text(encoding="utf-8")
    rows = []
    for wanted in what.split("; "):
        title, _, begins = wanted.partition(" / ")
        section = page.split(f"\n## {title}\n")[1].split("\n## ")[0]
        lines = [line.strip("| ").split(" | ") for line in section.splitlines() if "|" in line[:1]]
        found = [line for line in lines[2:] if line[0].startswith(begins) and len(line) >= 5]
        if not found:
            raise ValueError(f"no figure of {title} begins with {begins!r}")
        anchor = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        rows += [(f"[{title}](../validation.md#{anchor})", *line[:5]) for line in found]
    return table(("case", "figure", "unit", "expected", "measured", "error"), rows)


# ---- Packages ------------------------------------------------------------------------------------


def wheels(_: str) -> str:
    """Which wheel was tried with which MuJoCo, by machine."""
    rows = read("wheels")
    parts = []
    for platform in sorted({row["platform"] for row in rows}, reverse=True):
        parts.append(wheels_of([row for row in rows if row["platform"] == platform], platform))
    return "\n".join(parts)


def wheels_of(rows: list[dict[str, str]], platform: str) -> str:
    """The table of one platform."""
    depth = {row["depth_um"] for row in rows}
    pythons = sorted({row["python"] for row in rows}, key=lambda tag: int(tag[3:]))
    releases = sorted({row["mujoco"] for row in rows}, key=lambda r: [int(n) for n in r.split(".")])
    lines = []
    for release in releases:
        how = {row["python"]: row["adaptor"] for row in rows if row["mujoco"] == release}
        lines.append((release, *(how.get(python, "") for python in pythons)))
    head = ("MuJoCo", *(f"CPython {tag[2]}.{tag[3:]}" for tag in pythons))
    return (
        f"Platform `{platform}`; the box came to rest {', '.join(sorted(depth))} um deep in each. "
        "An empty field means that this MuJoCo\nhas no package for that Python, or that the two "
        "were not tried.\n\n" + table(head, lines)
    )


# ---- Releases of MuJoCo --------------------------------------------------------------------------


def releases(_: str) -> str:
    """What the tests of the plugin found on each release."""
    head = ("MuJoCo", "CPython", "tests passed", "failed", "skipped", "for")
    keys = ("mujoco", "python", "passed", "failed", "skipped", "left_out")
    return table(head, [tuple(row[key] for key in keys) for row in read("releases")])


BLOCK: dict[str, Callable[[str], str]] = {
    "pairs": pairs,
    "accuracy": accuracy,
    "times": times,
    "parameters": parameters,
    "states": states,
    "words": words,
    "validation": validation,
    "wheels": wheels,
    "releases": releases,
    "host": host,
    "hosts": hosts,
}
