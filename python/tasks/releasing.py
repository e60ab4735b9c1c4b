# SPDX-License-Identifier: Apache-2.0
"""`./run release`: what must be true before a version is given away, one line each.

The version has one place, pyproject.toml. CMake reads it there, and compiles it into the Python
package. Two files that are read without either hold it once more; `./run release 0.2.0` writes all
three and dates the changelog.
"""

from __future__ import annotations

import datetime
import re
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from tasks.interpreters import VERSIONS
from tasks.shell import BUILD, ROOT, output_of, stop

_SOURCE = r'(?m)^version = "(.+)"$'  # in pyproject.toml
_SECTIONS = {"Added", "Changed", "Fixed", "Removed", "Deprecated", "Security"}


class Item(NamedTuple):
    """One line of the list: whether it is done, and what is to do where it is not."""

    done: bool
    what: str
    todo: str = ""


class Copy(NamedTuple):
    """A file that holds the version once more: where, and how it is written there."""

    name: str
    pattern: str
    written: Callable[[str], str]


def _header_number(version: str) -> str:
    major, minor, patch = map(int, version.split("."))
    return str(10000 * major + 100 * minor + patch)


COPIES = (
    Copy("CITATION.cff", r"(?m)^version: (\S+)$", str),
    Copy("plugin/c_api/volcontact.h", r"(?m)^#define VC_VERSION (\d+)$", _header_number),
)


def release(version: str | None = None) -> None:
    """Writes the version, where one is given; prints the list, and stops where it has to do."""
    if version is not None:
        write_version(ROOT, version)
    items = list(checklist(ROOT))
    for item in items:
        print(f"{'ok   ' if item.done else 'TO DO'}  {item.what}")
        if not item.done:
            print(f"       {item.todo}")
    left = sum(not item.done for item in items)
    if left:
        stop(f"{left} of {len(items)} points are left")


def checklist(root: Path) -> Iterator[Item]:
    """All points of the list for a checkout."""
    version = version_of(root)
    yield Item(version is not None, f"pyproject.toml has version {version}", "write one")
    for copy in COPIES:
        found = re.search(copy.pattern, (root / copy.name).read_text(encoding="utf-8"))
        other = found[1] if found else "none"
        agrees = version is not None and other == copy.written(version)
        yield Item(agrees, f"{copy.name} has version {other}", f"./run release {version}")
    yield from changelog(root, version or "")
    status = output_of("git", "-C", root, "status", "--porcelain")
    yield Item(status == "", "nothing is uncommitted", "commit, or throw away")
    tags = (output_of("git", "-C", root, "tag", "--list", f"v{version}") or "").split()
    yield Item(not tags, f"there is no tag v{version} yet", "raise the version")
    for python in sorted(VERSIONS, key=lambda text: int(text.split(".")[1])):
        tag = "cp" + python.replace(".", "")
        made = list((BUILD / "wheels" / "dist").glob(f"volcontact-{version}-{tag}-*.whl"))
        yield Item(bool(made), f"a wheel of CPython {python}", "./run wheels")
    site = BUILD / "site" / "docs" / "index.html"
    yield Item(_is_newer(site, root), "the site is newer than the last commit", "./run docs")
    tested = BUILD / "test-results"
    reports = list(tested.glob("*-python.xml")) if tested.is_dir() else []
    passed = bool(reports) and all(_passed(path) and _is_newer(path, root) for path in reports)
    yield Item(passed, "tests have passed since the last commit", ".ci/run")


def changelog(root: Path, version: str) -> Iterator[Item]:
    """Whether the version has its section, with parts of the usual names and a date."""
    text = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    found = re.search(
        rf"^## \[?{re.escape(version)}\]? - (\d{{4}}-\d\d-\d\d)$(.*?)(?=^## |\Z)",
        text,
        re.MULTILINE | re.DOTALL,
    )
    yield Item(
        found is not None,
        f"CHANGELOG.md has a section {version} with its date",
        f"./run release {version}",
    )
    parts = set(re.findall(r"^### (.+)$", text, re.MULTILINE))
    yield Item(
        parts <= _SECTIONS,
        "the parts of CHANGELOG.md have the usual names",
        f"rename {', '.join(sorted(parts - _SECTIONS))}",
    )


def version_of(root: Path) -> str | None:
    """The version of pyproject.toml."""
    text = (root / "pyproject.toml").read_text(encoding="utf-8")
    found = re.search(_SOURCE, text)
    return found[1] if found else None


def write_version(root: Path, version: str) -> None:
    """Into pyproject.toml and the copies; what is unreleased in the changelog gets its heading."""
    if not re.fullmatch(r"\d+\.\d+\.\d+", version):
        stop(f"release: {version!r} is not a version such as 0.2.0")
    for copy in (Copy("pyproject.toml", _SOURCE, str), *COPIES):
        path = root / copy.name
        text = path.read_text(encoding="utf-8")
        found = re.search(copy.pattern, text)
        if found is None:
            stop(f"release: {copy.name} has no version")
        path.write_text(
            text[: found.start(1)] + copy.written(version) + text[found.end(1) :], encoding="utf-8"
        )
    path = root / "CHANGELOG.md"
    text = path.read_text(encoding="utf-8")
    if f"\n## {version} - " not in text:
        heading = f"## Unreleased\n\n## {version} - {datetime.date.today()}\n"
        path.write_text(text.replace("## Unreleased\n", heading, 1), encoding="utf-8")


def _is_newer(path: Path, root: Path) -> bool:
    made = subprocess.run(
        ["git", "-C", str(root), "log", "-1", "--format=%ct"],
        capture_output=True,
        text=True,
        check=False,
    ).stdout.strip()
    return path.exists() and made != "" and path.stat().st_mtime > float(made)


def _passed(path: Path) -> bool:
    head = path.read_text(encoding="utf-8", errors="replace")[:2000]
    return 'errors="0"' in head and 'failures="0"' in head
