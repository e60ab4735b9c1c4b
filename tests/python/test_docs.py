# SPDX-License-Identifier: Apache-2.0
"""The documentation is true: its code runs, its links lead somewhere, its tables are the code's."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from types import ModuleType
from typing import Any

import mujoco
import pytest

import volcontact as vc

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "plugin" / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
SOURCES = [
    path
    for folder in ("plugin", "python", "tests")
    for suffix in ("h", "cc", "py")
    for path in sorted((ROOT / folder).rglob(f"*.{suffix}"))
]
STEPS = 20  # enough for MuJoCo to complain about a scene that does not work

_FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"(?<!\!)\[[^\]\n]+\]\(([^)\s]+)\)")
_CITATION = re.compile(r"\[([A-Z][A-Za-z]*\d{4}|CSA|Drake|MuJoCo|Simbody)\b[^\]]*\](?!\()")
_SECTION = re.compile(r"docs/theory\.md, [\"']([^\"']+)[\"']")


def blocks(page: Path, language: str) -> list[tuple[int, str]]:
    """Line number and text of every fenced block of the language."""
    text = page.read_text(encoding="utf-8")
    return [
        (text.count("\n", 0, found.start(2)) + 1, found.group(2))
        for found in _FENCE.finditer(text)
        if found.group(1) == language
    ]


def anchor(heading: str) -> str:
    """The anchor a heading gets on the page."""
    kept = re.sub(r"[^\w\- ]", "", heading.strip().lower())
    return kept.replace(" ", "-")


def headings(page: Path) -> list[str]:
    """Headings of the page, code blocks left out."""
    prose = _FENCE.sub("", page.read_text(encoding="utf-8"))
    return re.findall(r"^#+ +(.+?) *$", prose, re.MULTILINE)


def make_components() -> ModuleType:
    """docs/make_components.py as a module."""
    path = ROOT / "docs" / "make_components.py"
    spec = importlib.util.spec_from_file_location("make_components", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_python_blocks_run(page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks of one page run in order and share their names, as a reader would type them."""
    monkeypatch.chdir(ROOT)
    names: dict[str, Any] = {"__name__": page.stem}
    for line, text in blocks(page, "python"):
        # Leading newlines make the line numbers of a traceback those of the page.
        exec(compile("\n" * (line - 1) + text, str(page), "exec"), names)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_mjcf_blocks_load_and_step(page: Path) -> None:
    for line, text in blocks(page, "xml"):
        if "<mujoco" not in text:
            continue
        model = vc.load(text)
        data = mujoco.MjData(model)
        with vc.attach(model):
            for _ in range(STEPS):
                mujoco.mj_step(model, data)
        raised = [warning for warning in data.warning if warning.number]
        assert not raised, f"{page.name}:{line}: MuJoCo warnings {raised}"


def test_components_page_is_generated_from_the_field_tables() -> None:
    module = make_components()
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), (
        "run './run python docs/make_components.py'"
    )


def test_components_page_lists_every_component() -> None:
    """Independent of the generator's parsing: every public law and solid has its section."""
    page = (ROOT / "docs" / "components.md").read_text(encoding="utf-8")
    for name in vc.__all__:
        item = getattr(vc, name)
        if not isinstance(item, type) or item in (vc.NormalForce, vc.Friction):
            continue
        if issubclass(item, (vc.NormalForce, vc.Friction)) or hasattr(item, "own_metrics"):
            assert f"Python: `{name}`" in page


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    prose = _FENCE.sub("", page.read_text(encoding="utf-8"))
    for target in _LINK.findall(prose):
        if "://" in target:
            continue
        path, _, fragment = target.partition("#")
        linked = (page.parent / path).resolve() if path else page
        assert linked.exists(), f"{page.name}: no file {target}"
        if fragment:
            anchors = [anchor(heading) for heading in headings(linked)]
            assert fragment in anchors, f"{page.name}: no heading for {target}"


def test_every_section_the_code_names_exists() -> None:
    known = set(headings(ROOT / "docs" / "theory.md"))
    named = {
        (section, path.name)
        for path in SOURCES
        # A comment may break the line inside the name of a section.
        for section in _SECTION.findall(
            re.sub(r"\s*\n\s*(///?|#)?\s*", " ", path.read_text(encoding="utf-8"))
        )
    }
    assert named, "the code refers to no section of docs/theory.md"
    missing = sorted((section, name) for section, name in named if section not in known)
    assert not missing


def test_every_citation_is_in_the_bibliography() -> None:
    bibliography = (ROOT / "docs" / "references.md").read_text(encoding="utf-8")
    keys = set(re.findall(r"^\| \[(\w+)\] \|", bibliography, re.MULTILINE))
    assert keys
    cited = {
        key for page in PAGES for key in _CITATION.findall(page.read_text(encoding="utf-8"))
    }
    assert cited <= keys, f"not in docs/references.md: {sorted(cited - keys)}"
