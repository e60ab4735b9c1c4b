# SPDX-License-Identifier: Apache-2.0
"""The transcript of the first ten minutes is of the present commands, which still do as it says."""

import csv
import importlib.util
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from volcontact.cli import main

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "tutorials" / "ten_minutes.md").read_text(encoding="utf-8")
RECORD = ROOT / "tests" / "benchmarks" / "results" / "install.csv"


def _steps():
    path = ROOT / "docs" / "generate" / "parts" / "ten_minutes_steps.py"
    spec = importlib.util.spec_from_file_location("ten_minutes_steps", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its dataclasses look there
    spec.loader.exec_module(module)
    return module


STEPS = _steps()
TYPED = (*STEPS.INSTALL, *STEPS.START, *STEPS.OWN, *STEPS.PRESS)


def typed(command):
    """The arguments of a command of volcontact, its run cut short."""
    words = shlex.split(command)
    assert words[0] == "volcontact"
    if words[1] == "run" and "--plot" not in words:
        words += ["--duration", "0.02"]
    return ["0.2" if word == "1.5" else word for word in words[1:]]


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    """A folder in which every command of the page that ends well has been typed."""
    folder = tmp_path_factory.mktemp("newcomer")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for step in TYPED:
            if step.file is not None:
                Path(step.file[0]).write_text(step.file[1])
            if step.command.startswith("volcontact "):
                assert main(typed(step.command)) == 0, step.command
    return folder


def test_page_has_every_command_and_every_error():
    for step in TYPED:
        assert f"$ {step.command}" in PAGE, step.command
    for slip in STEPS.SLIPS:
        (row,) = [line for line in PAGE.splitlines() if line.startswith(f"| `{slip.wrong}` |")]
        assert slip.says in row and f"`{slip.right}`" in row


def test_commands_end_well_and_leave_a_curve(home):
    assert [path.suffix for path in sorted((home / "press/results/figures").iterdir())] == [
        ".png",
        ".svg",
    ]
    done = subprocess.run(
        [sys.executable, "read.py"], cwd=home, capture_output=True, text=True, check=True
    )
    assert "largest" in done.stdout


@pytest.mark.parametrize("slip", STEPS.SLIPS, ids=lambda slip: slip.wrong)
def test_errors_are_one_line_and_name_their_fix(slip, home, tmp_path, monkeypatch, capsys):
    shutil.copytree(home, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    if "volcontact[view]" in slip.says:
        monkeypatch.setitem(sys.modules, "viser", None)
    assert main(shlex.split(slip.wrong)[1:]) == 1
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert slip.says in line
    if slip.right.startswith("volcontact") and "--browser" not in slip.right:
        assert main(shlex.split(slip.right)[1:]) == 0


def test_installing_took_no_longer_than_it_may():
    with RECORD.open(encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert float(row["allowed_s"]) == 20.0
    assert float(row["install_s"]) < 20.0
    assert f"volcontact      {row['install_s']} s" in PAGE
