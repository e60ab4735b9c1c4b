# SPDX-License-Identifier: Apache-2.0
"""Includes point down. Also runs as a program, before anything is built."""

import re
import sys
from pathlib import Path

PLUGIN = Path(__file__).resolve().parents[1] / "plugin"

# What each folder may include of the project, besides itself; ground floor first.
MAY_INCLUDE = {
    "volcontact/base": set(),
    "volcontact/metrics": {"base"},
    "volcontact/shape": {"base", "metrics"},
    "volcontact/pair": {"base", "metrics", "shape"},
    "volcontact/force": {"base", "metrics"},  # a law knows no shape and no pair
    "volcontact/model": {"base", "metrics", "shape", "pair", "force"},
    "adaptor": {"base", "metrics", "shape", "pair", "force", "model"},
    "c_api": {"base", "metrics", "shape", "pair", "force", "model"},
    "cgal": {"base", "metrics", "shape", "pair"},
}
# The only folder that may include each library of others.
OWNER = {"mujoco": "adaptor", "CGAL": "cgal"}
NOWHERE = {"nanobind", "pybind11", "Python.h"}

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def floor_of(path: str) -> str | None:
    """The folder of MAY_INCLUDE that holds a path relative to plugin/, None if there is none."""
    return next((floor for floor in MAY_INCLUDE if path.startswith(floor + "/")), None)


def fault(source: str, included: str) -> str | None:
    """Why the file `source` (relative to plugin/) may not include `included`; None if it may."""
    floor = floor_of(source)
    if floor is None:
        return f"{source}: lies in no known folder"
    library = included.split("/")[0]
    if library in NOWHERE or OWNER.get(library, floor) != floor:
        return f"{source}: {floor} must not include <{included}>"
    target = floor_of(included)
    if target is None:
        if library in {"volcontact", "adaptor", "c_api", "cgal"}:
            return f"{source}: {included} lies in no known folder"
        return None
    if target != floor and target.removeprefix("volcontact/") not in MAY_INCLUDE[floor]:
        return f"{source}: {floor} must not include {included}"
    return None


def faults() -> list[str]:
    """All faults under plugin/, one line each."""
    sources = sorted(p for p in PLUGIN.rglob("*") if p.suffix in {".h", ".cc"})
    assert sources, f"no sources in {PLUGIN}"
    found = (
        fault(path.relative_to(PLUGIN).as_posix(), included)
        for path in sources
        for included in INCLUDE.findall(path.read_text())
    )
    return [line for line in found if line]


def test_no_include_points_up():
    assert faults() == []


def test_finds_each_kind_of_fault():
    down = fault("volcontact/model/a.h", "volcontact/pair/b.h")
    same = fault("volcontact/pair/closed_form/a.h", "volcontact/pair/b.h")
    system = fault("volcontact/base/a.h", "Eigen/Core")
    assert (down, same, system) == (None, None, None)
    assert fault("adaptor/a.cc", "mujoco/mujoco.h") is None
    assert fault("cgal/a.cc", "CGAL/Surface_mesh.h") is None
    for source, included in [
        ("volcontact/base/a.h", "volcontact/metrics/b.h"),
        ("volcontact/force/a.h", "volcontact/shape/b.h"),
        ("volcontact/force/a.h", "volcontact/pair/b.h"),
        ("volcontact/pair/a.h", "volcontact/force/b.h"),
        ("volcontact/model/a.h", "adaptor/b.h"),
        ("volcontact/model/a.cc", "mujoco/mujoco.h"),
        ("c_api/a.cc", "mujoco/mujoco.h"),
        ("adaptor/a.cc", "CGAL/Surface_mesh.h"),
        ("adaptor/a.cc", "Python.h"),
        ("volcontact/pair/a.h", "volcontact/misc/b.h"),
        ("misc/a.h", "vector"),
    ]:
        assert fault(source, included), (source, included)


if __name__ == "__main__":
    print(*faults(), sep="\n", end="")
    sys.exit(bool(faults()))
