# SPDX-License-Identifier: Apache-2.0
"""A file includes what it uses, itself or by its headers. Also runs as a program, before any build.

The compiler does not see what is missing: with a precompiled header every file has those headers,
and of several files compiled as one a later one has what an earlier one includes. Our types are
read, and names of three standard headers. The build under the thread sanitizer, which
precompiles nothing, sees functions as well.
"""

import functools
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PLACES = ("plugin/volcontact", "plugin/c_api", "plugin/fmu", "tests/core", "tests/c_api")
INCLUDED_FROM = (ROOT / "plugin", ROOT / "tests", ROOT)

# Names of the standard library's headers that are precompiled.
STANDARD = {
    "algorithm": (
        "all_of|any_of|binary_search|clamp|count_if|equal|fill|find|find_if|lower_bound|max"
        "|max_element|min|min_element|minmax|none_of|nth_element|remove_if|replace|reverse|rotate"
        "|sort|stable_sort|unique|upper_bound"
    ),
    "cmath": (
        "abs|acos|asin|atan|atan2|cbrt|ceil|copysign|cos|exp|floor|fmod|hypot|isfinite|isinf|isnan"
        "|log|log2|nextafter|pow|round|sin|sqrt|tan"
    ),
    "vector": "vector",
}
STANDARD_NAME = re.compile(r"\bstd::(?:ranges::)?(\w+)")
HEADERS_OF = {
    name: header for header, names in STANDARD.items() for name in names.split("|")
}  # fmt: skip

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', re.MULTILINE)
NOT_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|^[ \t]*#[ \t]*include[^\n]*'
    r"|\b(?:TEST|INSTANTIATE)\w*\(\w+, \w+",
    re.DOTALL | re.MULTILINE,
)
# In a namespace, which is not indented; and anywhere, also as a parameter of a template.
DECLARED = re.compile(r"^(?:struct|class|enum class|concept|using) ([A-Z]\w+)", re.MULTILINE)
DECLARED_WITHIN = re.compile(
    r"\b(?:struct|class|enum|concept|typename|using|auto|int|Solid|Vector|namespace)(?:\.\.\.)? "
    r"([A-Z]\w+)"
)
WORD = re.compile(r"(?<![\w.:])[A-Z]\w+")


@functools.cache
def code(path: Path) -> str:
    """Without comments, texts and includes."""
    return NOT_CODE.sub(" ", path.read_text(encoding="utf-8"))


@functools.cache
def includes(path: Path) -> tuple[Path | str, ...]:
    """Files of ours, and the names of others."""
    found: list[Path | str] = []
    for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
        places = (folder / name for folder in (path.parent, *INCLUDED_FROM))
        found.append(next((place.resolve() for place in places if place.is_file()), name))
    return tuple(found)


@functools.cache
def reached(path: Path) -> frozenset[Path | str]:
    """All that a file gets by including."""
    seen: set[Path | str] = set()
    waiting: list[Path | str] = [path]
    while waiting:
        one = waiting.pop()
        if one not in seen:
            seen.add(one)
            if isinstance(one, Path):
                waiting += includes(one)
    return frozenset(seen)


@functools.cache
def declared(path: Path) -> frozenset[str]:
    """Types of a header that others may use."""
    return frozenset(DECLARED.findall(code(path)))


@functools.cache
def declared_within(path: Path) -> frozenset[str]:
    """What a name in this file, or in one that includes it, may mean as well."""
    return frozenset(DECLARED_WITHIN.findall(code(path)))


def sources() -> list[Path]:
    return sorted(
        path.resolve()
        for place in PLACES
        for path in (ROOT / place).rglob("*")
        if path.suffix in {".h", ".cc"}
    )


def faults(files: list[Path]) -> list[str]:
    """A line for each name that a file uses and does not include."""
    homes: dict[str, set[Path]] = {}
    for path in files:
        if path.suffix == ".h":
            for name in declared(path):
                homes.setdefault(name, set()).add(path)
    found = []
    for path in files:
        has = reached(path)
        mine = frozenset().union(*(declared_within(one) for one in has if isinstance(one, Path)))
        for name in sorted(set(WORD.findall(code(path))) & homes.keys() - mine):
            home = min(homes[name]).relative_to(ROOT)
            found.append(
                f"{path.relative_to(ROOT)} uses {name}, of {home}, and does not include it"
            )
        used = {HEADERS_OF.get(name) for name in STANDARD_NAME.findall(code(path))} - {None}
        found += [
            f"{path.relative_to(ROOT)} uses std:: of <{header}> and does not include it"
            for header in sorted(used - has)
        ]
    return found


def test_every_file_includes_what_it_uses():
    assert faults(sources()) == []


if __name__ == "__main__":
    lines = faults(sources())
    for line in lines:
        print(line)
    sys.exit(bool(lines))
