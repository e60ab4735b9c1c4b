# SPDX-License-Identifier: Apache-2.0
"""The sources of a unit of contact models, for masters that compile it on another platform.

They are those of the core, the C container and the FMI layer, under the Apache License 2.0.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from xml.sax.saxutils import quoteattr

import volcontact
from volcontact.fmu.container import library_folder

# GNU's and Clang's spelling. Contraction would change bits; the square root need not set errno.
OPTIONS = "-std=c++20 -O2 -fPIC -fopenmp -ffp-contract=off -fno-math-errno"
LIBRARIES = ("gomp", "dl")
_INCLUDE = re.compile(
    r'^[ \t]*#[ \t]*(?:include|define[ \t]+VOLCONTACT_SIMD_KERNEL)[ \t]*[<"]([^>"]+)[>"]',
    re.MULTILINE,
)
_HEAD = """// SPDX-License-Identifier: Apache-2.0
#if !defined(_MSC_VER) && __cplusplus < 202002L
#error "compile the sources of this FMU as C++20: see sources/README.txt"
#endif
#define VC_BUILDS_LIBRARY
"""
_README = f"""Sources of this FMU

Compile every file that modelDescription.xml (FMI 2.0) or buildDescription.xml (FMI 3.0) names, with
this folder among those for headers, and link them to one shared library named after the model:

    c++ {OPTIONS} -I. -c FILE
    c++ -shared -fopenmp -o NAME.so *.o -ldl

volcontact is under the Apache License 2.0 (https://www.apache.org/licenses/LICENSE-2.0).
"""


def source_files(fmi: int) -> tuple[dict[str, bytes], list[str]]:
    """Files of the folder `sources`, and which of them to compile.

    Raises:
        RuntimeError: the package has no sources.
    """
    plugin = _plugin()
    return dict(_collected(plugin, fmi)), list(_rooms(plugin, fmi))


def build_description(identifier: str, names: Iterable[str]) -> str:
    """buildDescription.xml of FMI 3.0."""
    files = "\n".join(f"<SourceFile name={quoteattr(name)}/>" for name in names)
    libraries = "\n".join(f'<Library name="{name}" external="true"/>' for name in LIBRARIES)
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiBuildDescription fmiVersion="3.0">
<BuildConfiguration modelIdentifier="{identifier}" description="C++20, with OpenMP; see README.txt">
<SourceFileSet language="C++20" compiler="gcc" compilerOptions="{OPTIONS}">
{files}
<IncludeDirectory name="."/>
</SourceFileSet>
{libraries}
</BuildConfiguration>
</fmiBuildDescription>
"""


def _plugin_places() -> list[Path]:
    """Where the sources may lie: in the package, or in the checkout that it runs from."""
    package = Path(volcontact.__file__)
    places = [library_folder() / "source", package.parent / "source"]
    return places + [folder / "plugin" for folder in package.parents]


def _plugin() -> Path:
    for place in _plugin_places():
        if (place / "fmu" / "instance.cc").is_file():
            return place
    raise RuntimeError("this installation of volcontact has no sources to put into an FMU")


@functools.cache
def _listed(plugin: Path) -> tuple[tuple[str, ...], frozenset[str], tuple[tuple[str, ...], ...]]:
    """Of the core, by its CMakeLists.txt: sources, those to be compiled alone, rooms joined."""
    text = (plugin / "volcontact" / "CMakeLists.txt").read_text()

    def within(command: str) -> str:
        match = re.search(command + r"([^)]*)\)", text)
        if match is None:
            raise RuntimeError(f"the sources of volcontact have no {command!r}")
        return match[1]

    def files(command: str) -> list[str]:
        return re.findall(r"[\w/]+\.cc", within(command))

    units = r"volcontact_unity_by_folder\(volcontact_core ALONE"
    alone = files(units)
    alone += files(r"set\(kernels")
    alone += files(r"set_source_files_properties\((?=model)")
    joined = [tuple(names.split(",")) for names in re.findall(r"[\w/]+,[\w/,]+", within(units))]
    return tuple(files(r"add_library\(volcontact_core STATIC")), frozenset(alone), tuple(joined)


def _rooms(plugin: Path, fmi: int) -> dict[str, list[str]]:
    """Sources that are compiled as one, by the name of the file that includes them."""
    core, alone, joined = _listed(plugin)
    company = {room: "_".join(rooms) for rooms in joined for room in rooms}
    rooms: dict[str, list[str]] = {}
    for name in core:
        folder = name.rpartition("/")[0]
        room = name.removesuffix(".cc") if name in alone else company.get(folder, folder)
        rooms.setdefault(f"core_{room.replace('/', '_')}.cc", []).append(f"volcontact/{name}")
    rooms["container.cc"] = [
        f"c_api/{path.name}" for path in sorted((plugin / "c_api").glob("*.cc"))
    ]
    layer = [path.relative_to(plugin).as_posix() for path in (plugin / "fmu").rglob("*.cc")]
    rooms["layer.cc"] = sorted(name for name in layer if not name.startswith("fmu/fmi"))
    rooms[f"fmi{fmi}.cc"] = [f"fmu/fmi{fmi}.cc"]
    return rooms


def _collected(plugin: Path, fmi: int) -> Iterator[tuple[str, bytes]]:
    """All files, with the headers that they include, theirs and so on."""
    rooms = _rooms(plugin, fmi)
    yield "README.txt", _README.encode()
    for name, members in rooms.items():
        yield name, (_HEAD + "".join(f'#include "{one}"\n' for one in members)).encode()
    waiting = [member for members in rooms.values() for member in members]
    seen = set(waiting)
    while waiting:
        name = waiting.pop()
        text = (plugin / name).read_text()
        yield name, text.encode()
        for included in _INCLUDE.findall(text):
            found = _found(plugin, name, included)
            if found is not None and found not in seen:
                seen.add(found)
                waiting.append(found)


def _found(plugin: Path, by: str, included: str) -> str | None:
    """The file that an include means, by its path in `sources`; None for one of the system."""
    beside = (plugin / by).parent / included
    if beside.is_file():
        return beside.resolve().relative_to(plugin.resolve()).as_posix()
    return included if (plugin / included).is_file() else None
