# SPDX-License-Identifier: Apache-2.0
"""The list of `./run release` sees what is not done."""

import datetime
import importlib
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import volcontact as vc

ROOT = Path(__file__).parents[3]
VERSIONED = ("pyproject.toml", "CITATION.cff", "plugin/c_api/volcontact.h")


@pytest.fixture
def releasing(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "python"))
    yield importlib.import_module("tasks.releasing")
    for name in [name for name in sys.modules if name.partition(".")[0] == "tasks"]:
        del sys.modules[name]


@pytest.fixture
def checkout(tmp_path):
    """A checkout with what the list reads, all of it done but for wheels, site and tests."""
    for name in VERSIONED:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    (tmp_path / "CHANGELOG.md").write_text(
        "# Changelog\n\n## Unreleased\n\n## 0.1.0 - 2026-12-01\n\n### Added\n\n- All.\n"
    )
    git(tmp_path, "init", "-q")
    git(tmp_path, "add", ".")
    git(tmp_path, "-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "-m", "All")
    return tmp_path


def git(folder, *words):
    subprocess.run(["git", "-C", folder, *words], check=True)


def left(releasing, checkout):
    """What is to do, but for what is built."""
    built = ("a wheel of", "the site", "tests have")
    items = releasing.checklist(checkout)
    return [item.what for item in items if not item.done and not item.what.startswith(built)]


def test_version_is_the_same_everywhere(releasing):
    items = [item for item in releasing.checklist(ROOT) if "has version" in item.what]
    assert len(items) == 3 and all(item.done for item in items)


def test_package_has_the_version_of_its_project(releasing):
    assert vc.__version__ == releasing.version_of(ROOT)


def test_version_is_written_by_hand_nowhere_else(releasing):
    version = releasing.version_of(ROOT)
    files = subprocess.run(
        ["git", "-C", ROOT, "grep", "-lwF", version, "--", "*.cmake", "*CMakeLists.txt", "*.py",
         "*.h", "*.cc", "*.in", "*.cff", "*.toml", ":!tests"],
        capture_output=True, text=True, check=True,
    ).stdout.split()  # fmt: skip
    assert files == ["CITATION.cff", "pyproject.toml"]


def test_a_new_version_is_written_everywhere(releasing, checkout):
    log = checkout / "CHANGELOG.md"
    begun = "## Unreleased\n\n### Fixed\n\n- It.\n"
    log.write_text(log.read_text().replace("## Unreleased\n", begun))
    releasing.write_version(checkout, "1.12.3")
    git(checkout, "-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "-a", "-m", "1.12.3")
    assert left(releasing, checkout) == []
    assert releasing.version_of(checkout) == "1.12.3"
    assert "\nversion: 1.12.3\n" in (checkout / "CITATION.cff").read_text()
    header = (checkout / "plugin/c_api/volcontact.h").read_text()
    assert "\n#define VC_VERSION 11203\n" in header
    unreleased, new, old = log.read_text().partition("# Changelog\n")[2].split("\n## ")[1:]
    assert unreleased.strip() == "Unreleased" and old.startswith("0.1.0 - ")
    assert new.startswith(f"1.12.3 - {datetime.date.today()}\n\n### Fixed\n\n- It.")


def test_what_is_no_version_is_not_written(releasing, checkout):
    with pytest.raises(Exception, match=r"'next' is not a version such as 0\.2\.0"):
        releasing.write_version(checkout, "next")
    assert left(releasing, checkout) == []


def test_nothing_is_left_where_all_is_done(releasing, checkout):
    assert left(releasing, checkout) == []


@pytest.mark.parametrize(
    ("name", "old", "new", "what"),
    [
        ("CITATION.cff", "version: 0.1.0", "version: 0.0.9", "CITATION.cff has version 0.0.9"),
        ("plugin/c_api/volcontact.h", "VC_VERSION 100", "VC_VERSION 200", "has version 200"),
        ("CHANGELOG.md", "## 0.1.0 - 2026-12-01", "## 0.1.0", "has a section 0.1.0 with its date"),
        ("CHANGELOG.md", "### Added", "### New", "the parts of CHANGELOG.md have the usual names"),
    ],
)
def test_what_is_not_done_is_told(releasing, checkout, name, old, new, what):
    path = checkout / name
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    found = left(releasing, checkout)
    assert any(what in line for line in found)
    assert "nothing is uncommitted" in found


def test_a_version_that_has_its_tag_is_not_released_twice(releasing, checkout):
    git(checkout, "tag", "v0.1.0")
    assert left(releasing, checkout) == ["there is no tag v0.1.0 yet"]
