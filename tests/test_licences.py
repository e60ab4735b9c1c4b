# SPDX-License-Identifier: Apache-2.0
"""CGAL is GPL: it stays in plugin/cgal, which is GPL too, and in no part of the package."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import volcontact
from volcontact.meshes import cgal

ROOT = Path(__file__).resolve().parents[1]
GPL_FOLDER = ROOT / "plugin" / "cgal"
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
LICENCE = re.compile(r"SPDX-License-Identifier: (\S+)")
SOURCES = sorted(
    path
    for top in ("plugin", "python", "tests", "docs", "mjcf_models")
    for path in (ROOT / top).rglob("*")
    if path.suffix in {".h", ".cc", ".inc", ".py", ".txt", ".cmake"} and path.name != "LICENSE"
)


def is_gpl(path: Path) -> bool:
    return GPL_FOLDER in path.parents


def test_every_source_names_the_licence_of_its_folder():
    assert len(SOURCES) > 100
    wrong = []
    for path in SOURCES:
        found = LICENCE.search(path.read_text(encoding="utf-8")[:200])
        expected = "GPL-3.0-or-later" if is_gpl(path) else "Apache-2.0"
        if found is None or found.group(1) != expected:
            wrong.append(str(path.relative_to(ROOT)))
    assert wrong == []


def test_the_gpl_folder_carries_its_licence():
    text = (GPL_FOLDER / "LICENSE").read_text(encoding="utf-8")
    assert text.lstrip().startswith("GNU GENERAL PUBLIC LICENSE\n                       Version 3")


def includes(path: Path) -> set[str]:
    return set(INCLUDE.findall(path.read_text(encoding="utf-8")))


def test_only_the_gpl_folder_includes_cgal_or_itself():
    """Also tests and bindings; `.ci/run` checks the same of every header really included."""
    users = {p for p in SOURCES if any(i.split("/")[0] in {"CGAL", "cgal"} for i in includes(p))}
    assert users and all(map(is_gpl, users))


def test_the_gpl_folder_uses_nothing_of_the_rest():
    """Neither way: the two talk through files and standard output."""
    found = {i for p in SOURCES if is_gpl(p) for i in includes(p)}
    assert not any(i.split("/")[0] in {"volcontact", "adaptor", "c_api"} for i in found)


def test_no_target_of_the_package_is_linked_with_the_program():
    lists = [p for p in SOURCES if p.name == "CMakeLists.txt" and not is_gpl(p)]
    assert not any("volcontact_cgal" in re.sub(r"#.*", "", p.read_text()) for p in lists)
    own = (GPL_FOLDER / "CMakeLists.txt").read_text()
    assert "EXCLUDE_FROM_ALL" in own  # a plain build makes it not
    assert "install(" not in own  # so that no wheel holds it


def names_cgal(path: Path) -> bool:
    content = path.read_bytes()
    return b"__gmp" in content or b"N4CGAL" in content


def test_compiled_modules_hold_no_cgal():
    package = Path(volcontact._volcontact.__file__).parent
    modules = [path for path in package.iterdir() if ".so" in path.suffixes]
    assert modules
    assert not any(map(names_cgal, modules))


def test_the_program_does():
    """Else the search above proves nothing."""
    program = cgal.program()
    if program is None:
        pytest.skip(cgal.MISSING)
    assert names_cgal(Path(program))


def test_the_package_is_declared_apache():
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert 'license = "Apache-2.0"' in text
    assert 'wheel.packages = ["python/volcontact", "python/volcontact_start"]' in text
    assert 'sdist.exclude = ["plugin/cgal"]' in text
