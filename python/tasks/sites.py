# SPDX-License-Identifier: Apache-2.0
"""`./run docs`: the documentation as a site. A warning is an error."""

from __future__ import annotations

import shutil

from tasks.shell import BUILD, ROOT, VENVS, output_of, run, say

SITE = BUILD / "site"


def build_site(*, quiet: bool = False) -> None:
    """Builds it in build/site, and looks whether it needs a network to be read."""
    python = tool_environment("docs")
    shutil.rmtree(SITE, ignore_errors=True)
    run(
        python, "-m", "sphinx", "-q", "-E", "-W", "--keep-going", "-c", ROOT / "docs",
        "-d", BUILD / "site-cache", ROOT, SITE,
    )  # fmt: skip
    run(python, ROOT / "tests" / "test_site.py", SITE)
    if not quiet:
        say(f"the site is {SITE / 'docs' / 'index.html'}")


def tool_environment(group: str) -> str:
    """The Python of .venv/tools, with the libraries of one dependency group of pyproject.toml."""
    python = VENVS / "tools" / "bin" / "python"
    run("uv", "pip", "install", "-q", "--python", python, "--group", group)
    assert output_of(python, "--version")
    return str(python)
