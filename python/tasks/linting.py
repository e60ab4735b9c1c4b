# SPDX-License-Identifier: Apache-2.0
"""`./run lint` and `./run format`: the same tools on the same files, checking or changing."""

from __future__ import annotations

from pathlib import Path

from tasks.shell import ROOT, Stopped, run, stop
from tasks.sites import tool_environment

_CPP = (".h", ".inc", ".c", ".cc")


def format_files() -> None:
    """Changes files; what no formatter can mend is told."""
    tool_environment("lint")
    run("ruff", "check", "-q", "--fix", "--exit-zero", ".")
    run("ruff", "format", "-q", ".")
    run("clang-format", "-i", *_cpp_sources())
    run("ruff", "check", "-q", ".")


def lint() -> None:
    """Checks alone; all of them, whatever the first says."""
    python = tool_environment("lint")
    checks: list[tuple[str | Path, ...]] = [
        ("clang-format", "--dry-run", "-Werror", *_cpp_sources()),
        ("ruff", "format", "-q", "--check", "."),
        ("ruff", "check", "-q", "."),
        ("shellcheck", "run", ".ci/run"),
        ("pymarkdown", "scan", *_pages()),
        ("proselint", "check", "--config", ROOT / "docs" / "proselint.json", *_pages()),
        (python, ROOT / "tests" / "test_layering.py"),
        (python, ROOT / "tests" / "test_includes.py"),
    ]
    failed = [Path(check[0]).name for check in checks if not _passes(check)]
    if failed:
        stop(f"found fault: {', '.join(failed)}")


def _passes(check: tuple[str | Path, ...]) -> bool:
    try:
        run(*check)
    except Stopped:
        return False
    return True


def _cpp_sources() -> list[Path]:
    return sorted(
        path.relative_to(ROOT)
        for top in ("plugin", "python", "tests")
        for path in (ROOT / top).rglob("*")
        if path.suffix in _CPP
    )


def _pages() -> list[Path]:
    places = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *ROOT.glob("*/README.md")]
    return sorted(path.relative_to(ROOT) for path in places)
