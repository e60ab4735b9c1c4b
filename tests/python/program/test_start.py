# SPDX-License-Identifier: Apache-2.0
"""The first page keeps its word: its commands, in its order, end well."""

import re
import shlex
import shutil
from pathlib import Path

import pytest

from volcontact.cli import main

ROOT = Path(__file__).parents[3]
MOST_COMMANDS = 9  # fewer than ten from a clone to a scene of one's own


def commands() -> list[list[str]]:
    page = (ROOT / "docs" / "start.md").read_text(encoding="utf-8")
    block = re.search(r"```sh\n(.*?)```", page, re.DOTALL)
    lines = [line.partition("#")[0].strip() for line in block[1].splitlines()]
    return [shlex.split(line) for line in lines if line]


def test_fewer_than_ten_commands_lead_to_a_scene_of_ones_own():
    assert len(commands()) <= MOST_COMMANDS
    assert commands()[0][:2] == ["git", "clone"]


@pytest.mark.once
def test_every_command_of_the_first_page_ends_well(tmp_path, monkeypatch):
    """All but the clone and the demonstration, which other tests and every run of CI make.

    Runs and the view are cut short.
    """
    short = {"run": ["--duration", "0.2"], "compare": ["--duration", "0.2"]}
    monkeypatch.chdir(tmp_path)
    done = []
    for words in commands():
        if words[:2] == ["./run", "volcontact"]:
            arguments = [*words[2:], *short.get(words[2], [])]
            assert main(["0.5" if word == "5" else word for word in arguments]) == 0, words
            done.append(words[2])
        elif words[0] == "cp":
            shutil.copy(ROOT / words[1], words[2])
        else:
            assert words[0] == "git" or words[1] == "demo", words
    assert done == ["new", "mesh", "check", "run", "compare", "view"]
