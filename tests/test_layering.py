# SPDX-License-Identifier: Apache-2.0
"""Includes point down, and every source is built. Also runs as a program, before any build."""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PLUGIN = ROOT / "plugin"

# What each folder may include of the project, besides itself; ground floor first.
MAY_INCLUDE = {
    "volcontact/base": set(),
    "volcontact/metrics": {"base"},
    "volcontact/shape": {"base", "metrics"},
    "volcontact/pair": {"base", "metrics", "shape"},
    "volcontact/force": {"base", "metrics"},  # a law knows no shape and no pair
    "volcontact/model": {"base", "metrics", "shape", "pair", "force"},
    "volcontact/step": {"base", "metrics", "force", "model"},  # of bodies it knows motions alone
    "adaptor": {"base", "metrics", "shape", "pair", "force", "model", "step"},
    "c_api": {"base", "metrics", "shape", "pair", "force", "model"},
    "fmu": {"base", "metrics", "model", "c_api"},  # of the model, where a row of states lies
    "simulink": {"c_api"},
    "cgal": set(),  # a program of its own under another licence
}
# Rooms of a floor, and the files that lie in none; each may use those before it. "" stands for all
# other files of the floor itself.
ROOMS = {
    "volcontact/pair": (
        "engine",
        "overlap",
        "overlap_limits",
        "engine_interface",
        "quadrature",
        "convex",
        "window",
        "closed_form",
        "clip",
        "sections",
        "sections/bore",
        "sections/torus",
        "torus_pair",
        "surface_sweep",
        "mesh_columns/crossing",
        "mesh_columns",
        "mesh_columns/in_round",
        "mesh_columns/radial",
        "octree",
        "engines",
        "dispatch",
        "interference",
        "geometric_pair",
        "pressure",
        "picture",
    ),
    "adaptor": (
        "mujoco",
        "keys",
        "geoms",
        "memory",
        "step",
        "scene",
        "evaluation",
        "readings",
        "",
        "run",
    ),
}
# Files of python/bindings; each may use those before it. `bind` stands for all bind_*.cc, which are
# side by side.
BINDINGS = (
    "arrays", "fields", "python_distance", "python_law", "signals", "bindings", "plain_errors",
    "bind", "module",
)  # fmt: skip
MOST_FILES = 25  # in a folder of code
# The only folder that may include each library of others.
OWNER = {"mujoco": "adaptor", "CGAL": "cgal"}
NOWHERE = {"nanobind", "pybind11", "Python.h", "Eigen"}

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def floor_of(path: str) -> str | None:
    """The folder of MAY_INCLUDE that holds a path relative to plugin/, None if there is none."""
    return next((floor for floor in MAY_INCLUDE if path.startswith(floor + "/")), None)


def room_of(floor: str, path: str) -> str | None:
    """The room of a file of a floor, None where that is not known."""
    inside = path.removeprefix(f"{floor}/")
    room = inside.rsplit("/", 1)[0] if "/" in inside else inside.split(".")[0]
    if "/" not in inside and "" in ROOMS[floor]:
        room = ""
    return room if room in ROOMS[floor] else None


def room_fault(source: str, included: str) -> str | None:
    """Why a file of a floor with rooms may not include another of it; None if it may."""
    floor = floor_of(source)
    if floor not in ROOMS or floor_of(included) != floor:
        return None
    rooms = room_of(floor, source), room_of(floor, included)
    for path, room in zip((source, included), rooms, strict=True):
        if room is None:
            return f"{path}: lies in no known room of {floor}"
    if ROOMS[floor].index(rooms[0]) < ROOMS[floor].index(rooms[1]):
        return f"{source}: {rooms[0]} must not include {included}"
    return None


def crowded_folders() -> list[str]:
    """Folders of code with more files than a reader takes in."""
    found = []
    places = [ROOT / top for top in ("plugin", "python", "tests", "docs/generate", "mjcf_models")]
    for folder in sorted(path for top in places for path in top.rglob("*") if path.is_dir()):
        if "__pycache__" in folder.parts or ".hypothesis" in folder.parts:
            continue
        count = sum(path.is_file() for path in folder.iterdir())
        if count > MOST_FILES:
            found.append(f"{folder.relative_to(ROOT)}: {count} files, {MOST_FILES} at most")
    return found


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
        if library in {"volcontact", "adaptor", "c_api", "fmu", "simulink", "cgal"}:
            return f"{source}: {included} lies in no known folder"
        return None
    if target != floor and target.removeprefix("volcontact/") not in MAY_INCLUDE[floor]:
        return f"{source}: {floor} must not include {included}"
    return room_fault(source, included)


def bindings_fault(source: str, included: str) -> str | None:
    """Why a file of python/bindings may not include `included`; None if it may."""
    library = included.split("/")[0]
    if library in {"adaptor", "c_api", "fmu", "cgal", "mujoco", "CGAL"}:
        return f"python/bindings/{source}: must not include {included}"
    if not included.endswith(".h") or "/" in included:
        return None
    ranks = []
    for name in (source, included):
        stem = name.split(".")[0]
        stem = "bind" if stem.startswith("bind_") else stem
        if stem not in BINDINGS:
            return f"python/bindings/{name}: has no place in the order of tests/test_layering.py"
        ranks.append(BINDINGS.index(stem))
    own = source.split(".")[0] == included.split(".")[0]
    if ranks[0] > ranks[1] or own:
        return None
    return f"python/bindings/{source}: must not include {included}"


def bindings_faults() -> list[str]:
    """All includes in python/bindings that point up or sideways, one line each."""
    sources = sorted(p for p in (ROOT / "python/bindings").iterdir() if p.suffix in {".h", ".cc"})
    assert sources
    found = (
        bindings_fault(path.name, included)
        for path in sources
        for included in re.findall(r'^\s*#\s*include\s*"([^"]+)"', path.read_text(), re.MULTILINE)
    )
    return [line for line in found if line]


def include_faults() -> list[str]:
    """All includes under plugin/ that point up, one line each."""
    sources = sorted(p for p in PLUGIN.rglob("*") if p.suffix in {".h", ".c", ".cc", ".inc"})
    assert sources, f"no sources in {PLUGIN}"
    found = (
        fault(path.relative_to(PLUGIN).as_posix(), included)
        for path in sources
        for included in INCLUDE.findall(path.read_text())
    )
    return [line for line in found if line]


def forgotten_sources() -> list[str]:
    """Sources that no CMakeLists.txt above them names: a forgotten test passes unnoticed."""
    found = []
    for top in ("plugin", "python/bindings", "tests"):
        for path in sorted((ROOT / top).rglob("*.cc")):
            lists = next(
                p / "CMakeLists.txt" for p in path.parents if (p / "CMakeLists.txt").exists()
            )
            words = set(re.findall(r"[\w./]+", lists.read_text()))
            name = path.relative_to(lists.parent)
            # A benchmark is named without its suffix.
            if not words & {name.as_posix(), name.with_suffix("").as_posix()}:
                found.append(f"{path.relative_to(ROOT)}: missing in {lists.relative_to(ROOT)}")
    return found


def faults_of_core_tests() -> list[str]:
    """Python tests that run once for all MuJoCo releases, and use MuJoCo all the same."""
    return [
        f"{path.relative_to(ROOT)}:{number}: uses MuJoCo; such tests lie in tests/python"
        for path in sorted((ROOT / "tests" / "python" / "core").rglob("*.py"))
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if re.search(
            r"^\s*(import|from) mujoco\b|\b(vc|volcontact)\.(load|attach|simulate)\(", line
        )
    ]


def faults() -> list[str]:
    """All faults, one line each."""
    return [
        *include_faults(),
        *bindings_faults(),
        *forgotten_sources(),
        *faults_of_core_tests(),
        *crowded_folders(),
    ]


def test_no_include_points_up():
    assert include_faults() == []


def test_no_include_of_the_bindings_points_up():
    assert bindings_faults() == []
    assert bindings_fault("bind_laws.cc", "fields.h") is None
    assert bindings_fault("arrays.cc", "arrays.h") is None
    for source, included in [
        ("fields.h", "bindings.h"),
        ("bind_laws.cc", "bind_model.h"),
        ("bindings.h", "adaptor/volcontact_mujoco.h"),
        ("attic.cc", "fields.h"),
    ]:
        assert bindings_fault(source, included), (source, included)


def test_no_folder_is_crowded():
    assert crowded_folders() == []


def test_every_source_is_built():
    assert forgotten_sources() == []


def test_tests_of_the_core_know_no_mujoco():
    assert faults_of_core_tests() == []


def test_finds_each_kind_of_fault():
    down = fault("volcontact/model/a.h", "volcontact/pair/b.h")
    same = fault("volcontact/pair/octree/a.h", "volcontact/pair/window/b.h")
    system = fault("volcontact/base/a.h", "omp.h")
    assert (down, same, system) == (None, None, None)
    assert fault("adaptor/a.cc", "mujoco/mujoco.h") is None
    assert fault("cgal/a.cc", "CGAL/Surface_mesh.h") is None
    for source, included in [
        ("volcontact/base/a.h", "volcontact/metrics/b.h"),
        ("volcontact/force/a.h", "volcontact/shape/b.h"),
        ("volcontact/force/a.h", "volcontact/pair/b.h"),
        ("volcontact/pair/overlap.h", "volcontact/force/b.h"),
        ("volcontact/model/a.h", "adaptor/b.h"),
        ("volcontact/model/a.cc", "mujoco/mujoco.h"),
        ("c_api/a.cc", "mujoco/mujoco.h"),
        ("simulink/a.c", "volcontact/model/b.h"),
        ("adaptor/a.cc", "CGAL/Surface_mesh.h"),
        ("adaptor/a.cc", "Python.h"),
        ("volcontact/base/a.h", "Eigen/Core"),
        ("volcontact/pair/octree/a.h", "volcontact/misc/b.h"),
        ("volcontact/pair/quadrature/a.h", "volcontact/pair/sections/b.h"),
        ("volcontact/pair/overlap.h", "volcontact/pair/interference.h"),
        ("adaptor/step/a.h", "adaptor/scene/b.h"),
        ("adaptor/scene/a.h", "adaptor/b.h"),
        ("adaptor/attic/a.h", "adaptor/b.h"),
        ("volcontact/pair/cellar/a.h", "volcontact/pair/overlap.h"),
        ("misc/a.h", "vector"),
    ]:
        assert fault(source, included), (source, included)


if __name__ == "__main__":
    lines = faults()
    sys.stdout.writelines(f"{line}\n" for line in lines)
    sys.exit(bool(lines))
