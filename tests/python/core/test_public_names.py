# SPDX-License-Identifier: Apache-2.0
"""What is public has types, a docstring and a place in the documentation."""

import inspect
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import volcontact as vc

ROOT = Path(__file__).parents[3]
PUBLIC = [name for name in vc.__all__ if not name.startswith("_")]
PAGES = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]


def members(name):
    """Public members that a class of ours defines itself."""
    item = getattr(vc, name)
    if not inspect.isclass(item):
        return []
    return [key for key in vars(item) if not key.startswith("_")]


@pytest.mark.parametrize("name", PUBLIC)
def test_public_name_is_documented(name):
    assert inspect.getdoc(getattr(vc, name)), name
    item = getattr(vc, name)
    undocumented = [k for k in members(name) if not inspect.getdoc(inspect.getattr_static(item, k))]
    # A field of a dataclass, and a table of a law, is told of in the docstring of its class.
    text, fields = inspect.getdoc(item), getattr(item, "__dataclass_fields__", {})
    assert [key for key in undocumented if key not in fields and f"`{key}`" not in text] == []


@pytest.mark.parametrize("name", PUBLIC)
def test_public_name_stands_in_the_documentation(name):
    pattern = re.compile(rf"\b{name}\b")
    assert any(pattern.search(page.read_text(encoding="utf-8")) for page in PAGES)


@pytest.mark.skipif(sys.version_info < (3, 12), reason="older NumPy types are less exact")
def test_package_passes_the_type_checker(tmp_path):
    assert np.lib.NumpyVersion(np.__version__) >= "2.0.0"
    cache = ROOT / "build" / "mypy"
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--cache-dir", str(cache)],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": ""},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
