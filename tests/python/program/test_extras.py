# SPDX-License-Identifier: Apache-2.0
"""The package without its extras: what works then, and what says what to install."""

import csv
import importlib.metadata
import re
import sys
from pathlib import Path

import pytest

from volcontact.cli import main
from volcontact.messages.extras import EXTRAS

ROOT = Path(__file__).parents[3]


@pytest.fixture
def without(monkeypatch, tmp_path):
    """Nothing of any extra can be imported."""
    for name in list(sys.modules):
        if name.partition(".")[0] in EXTRAS or name.startswith("volcontact.report."):
            monkeypatch.delitem(sys.modules, name)
    for module in EXTRAS:
        monkeypatch.setitem(sys.modules, module, None)
    monkeypatch.chdir(tmp_path)


def test_a_scene_is_written_checked_run_and_measured_without_extras(without):
    assert main(["new", "scene"]) == 0
    for command in (["check"], ["run", "--duration", "0.1"], ["metrics", "--time", "0.5"]):
        assert main([command[0], "scene/scene.xml", *command[1:]]) == 0
    assert main(["metrics", "box:half_sizes=1,1,1", "sphere:radius=1"]) == 0


@pytest.mark.parametrize(
    ("command", "extra"),
    [
        (["compare", "scene/scene.xml", "--no-frames", "--duration", "0.1"], "report"),
        (["run", "scene/scene.xml", "--duration", "0.1", "--out", "results"], "report"),
        (["view", "scene/scene.xml", "--browser"], "view"),
    ],
)
def test_a_command_that_needs_an_extra_names_it(without, command, extra, capsys):
    assert main(["new", "scene"]) == 0
    assert main(command) == 1
    assert f'pip install "volcontact[{extra}]"' in capsys.readouterr().err


def test_another_missing_module_is_not_hidden(monkeypatch):
    monkeypatch.setitem(sys.modules, "volcontact.running.simulation", None)
    with pytest.raises(ModuleNotFoundError):
        main(["run", str(ROOT / "mjcf_models" / "static_cube" / "scene.xml")])


def test_doctor_names_the_missing_extras(monkeypatch, capsys):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    main(["doctor"])
    text = capsys.readouterr().out
    assert all(f'pip install "volcontact[{extra}]"' in text for extra in set(EXTRAS.values()))


def test_every_module_of_an_extra_is_of_a_package_of_that_extra():
    packages = {"PIL": "pillow", "imageio_ffmpeg": "imageio-ffmpeg"}  # by another name
    required = [
        re.match(r"([\w.-]+).*extra == ['\"](\w+)['\"]", line)
        for line in importlib.metadata.requires("volcontact") or ()
    ]
    declared = {(found[1].lower(), found[2]) for found in required if found}
    assert {
        (packages.get(module, module).lower(), extra) for module, extra in EXTRAS.items()
    } <= declared


def test_record_of_the_wheels_has_every_python():
    """`./run wheels` writes it: each wheel dropped a box under each MuJoCo it can meet."""
    path = ROOT / "tests" / "benchmarks" / "results" / "wheels.csv"
    with path.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {row["python"] for row in rows} >= {"cp310", "cp311", "cp312", "cp313"}
    assert {row["adaptor"] for row in rows} <= {"in the wheel", "compiled at first use"}
    assert ("cp310", "2.2.2") in {(row["python"], row["mujoco"]) for row in rows}
    assert all(float(row["depth_um"]) == pytest.approx(24.525, abs=1e-3) for row in rows)
