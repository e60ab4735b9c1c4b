# SPDX-License-Identifier: Apache-2.0
"""The commands of `volcontact` around a simulation: new, metrics, doctor, completion."""

import argparse
import json
import math
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from volcontact.cli import main, make_parser, new
from volcontact.cli.new import TEMPLATES
from volcontact.running.driving import Drive
from volcontact.running.simulation import simulate
from volcontact.typed_solids import SHAPES


def printed(arguments, capsys):
    assert main([*arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


# ---- new -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("template", sorted(TEMPLATES.keys() - {"tour"}))  # that is no scene
def test_template_runs_at_once_and_comes_to_rest(template, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    made = printed(["new", "mine", "--template", template], capsys)
    assert made["scene"] == "mine/scene.xml"
    assert main(["check", "mine/scene.xml"]) == 0
    assert capsys.readouterr().err == ""
    press = Path("mine/press.csv")
    drive = Drive(table=press if press.exists() else None)
    run = simulate("mine/scene.xml", duration=1.5, drive=drive)
    assert not run.warnings and run.stopped is None
    assert run.site_count[-1] > 0
    assert run.speed[-1].max() < 1e-3
    assert run.contact_force[-1] > 0.9 * run.weight


def test_commands_in_the_comments_name_the_new_scene(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["new", "mine"]) == 0
    assert "next: volcontact check mine/scene.xml" in capsys.readouterr().out
    text = (tmp_path / "mine" / "scene.xml").read_text()
    commands = re.findall(r"volcontact (\w+) mine/scene\.xml", text)
    assert commands == ["check", "run", "compare", "view"]
    assert "SCENE" not in text


def test_tour_is_a_notebook_and_is_written_as_it_is(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["new", "mine", "--template", "tour"]) == 0
    assert "next: jupyter lab mine/tour.ipynb" in capsys.readouterr().out
    kept = Path(new.__file__).parents[1] / "templates" / "tour" / "tour.ipynb"
    assert Path("mine/tour.ipynb").read_bytes() == kept.read_bytes()


def test_new_overwrites_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine").mkdir()
    assert main(["new", "mine"]) == 0
    capsys.readouterr()
    assert main(["new", "mine"]) == 1
    assert "mine exists already: name a new folder" in capsys.readouterr().err


# ---- metrics -------------------------------------------------------------------------------------


def test_metrics_of_two_solids_are_those_of_the_cap(capsys):
    solids = ["box:half_sizes=0.1,0.1,0.1", "sphere:radius=0.05"]
    found = printed(["metrics", *solids, "--at", "0", "0", "0.149"], capsys)
    h = 1e-3
    assert found["total"]["volume [m^3]"] == pytest.approx(math.pi * h**2 * (0.15 - h) / 3)
    assert found["total"]["normal [-]"] == pytest.approx([0, 0, -1])
    assert len(found["sites"]) == 1


def test_turns_are_about_the_axes_of_a(capsys):
    """A cylinder lying along y after a turn about x touches the floor with its side."""
    solids = ["half_space", "cylinder:radius=0.02,half_length=0.05"]
    pose = ["--at", "0", "0", "0.0199", "--turn", "90", "0", "45"]
    found = printed(["metrics", *solids, *pose], capsys)
    assert found["total"]["depth [m]"] == pytest.approx(1e-4, rel=1e-6)


def test_metrics_of_a_scene_give_its_sites(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    main(["new", "mine"])
    capsys.readouterr()
    assert printed(["metrics", "mine/scene.xml"], capsys)["sites"] == []
    found = printed(["metrics", "mine/scene.xml", "--time", "2.5"], capsys)
    assert found["time"] == pytest.approx(2.5)
    force = sum(site["normal force [N]"] for site in found["sites"])
    assert force == pytest.approx(9.81, rel=1e-3)  # its damper lets it swing to rest
    assert main(["metrics", "mine/scene.xml", "--time", "1.5"]) == 0
    assert "normal force [N]" in capsys.readouterr().out


def test_metrics_of_a_scene_at_a_keyframe(tmp_path, capsys):
    """A ball of 5 cm, 1 cm in the floor: pi h^2 (3 r - h) / 3."""
    scene = tmp_path / "scene.xml"
    scene.write_text(
        '<mujoco><worldbody><geom type="plane" size="1 1 1"/><body pos="0 0 0.2"><freejoint/>'
        '<geom type="sphere" size="0.05" mass="1"/></body></worldbody>'
        '<keyframe><key name="start" qpos="0 0 0.2 1 0 0 0"/>'
        '<key name="low" qpos="0 0 0.04 1 0 0 0"/></keyframe></mujoco>'
    )
    assert printed(["metrics", str(scene)], capsys)["sites"] == []
    (site,) = printed(["metrics", str(scene), "--keyframe", "low"], capsys)["sites"]
    cap = math.pi * 1e-4 * (0.15 - 0.01) / 3
    assert site["volume [m^3]"] == pytest.approx(cap, rel=1e-9)
    assert main(["metrics", str(scene), "--keyframe", "lwo"]) == 1
    assert "no keyframe 'lwo'; did you mean" in capsys.readouterr().err


def test_metrics_of_mesh_files(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    main(["new", "mine", "--template", "mesh_in_hole"])
    capsys.readouterr()
    part = "mine/meshes/part.obj"
    found = printed(["metrics", "half_space", part, "--at", "0", "0", "0.0499"], capsys)
    polygon = 16 * 0.02**2 * math.sin(2 * math.pi / 32)
    assert found["total"]["volume [m^3]"] == pytest.approx(1e-4 * polygon, rel=1e-5)


@pytest.mark.parametrize("name", SHAPES)
def test_a_solid_without_numbers_is_told_how_to_write_it(name, capsys):
    arguments = ["metrics", "half_space", name]
    if name == "half_space":
        assert main([*arguments]) == 0
        return
    assert main(arguments) == 1
    usage = capsys.readouterr().err.split("write ")[1].strip()
    filled = usage.replace("X,Y,Z", "0.1,0.2,0.3")
    for i in range(filled.count("=X")):
        filled = filled.replace("=X", f"=0.0{3 - i}", 1)
    assert main(["metrics", "half_space", filled]) == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["sphere:radius=-1", "half_space"], "sphere: radius = -1"),
        (["sphere:radius=big", "half_space"], "'big' is no number; write sphere:radius=X"),
        (["ball.stl", "half_space"], "neither a mesh file nor a solid"),
        (["sphere:radius=1"], "give a scene or two solids"),
        (["half_space"] * 3, "give one scene, with --time and --keyframe if wanted, or two solids"),
    ],
)
def test_wrong_solids_are_explained(arguments, message, capsys):
    assert main(["metrics", *arguments]) == 1
    assert message in capsys.readouterr().err


# ---- doctor, completion --------------------------------------------------------------------------


def test_doctor_finds_what_the_tests_need(capsys):
    found = printed(["doctor"], capsys)
    assert found["healthy"]
    states = {line["name"]: line["state"] for line in found["lines"]}
    things = ("adaptor", "a scene", "instruction set", "threads", "pictures")
    for name in (*things, "extra report", "extra view", "extra gym"):
        assert states[name] == "good", name
    assert main(["doctor"]) == 0
    assert "adaptor" in capsys.readouterr().out


def test_doctor_says_what_is_wrong(monkeypatch, capsys):
    def broken():
        raise RuntimeError("built for another MuJoCo")

    monkeypatch.setattr("volcontact._adaptor.adaptor", broken)
    assert main(["doctor", "--json"]) == 1
    lines = json.loads(capsys.readouterr().out)["lines"]
    assert {"name": "adaptor", "state": "bad", "text": "built for another MuJoCo"} in lines


def commands():
    return subcommands(make_parser())


def subcommands(parser):
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            return action.choices
    return {}


def leaf_commands():
    """Parsers of the commands that do something, by name: "study run", not "study"."""
    leaves = {}
    for name, parser in commands().items():
        inner = subcommands(parser)
        leaves |= {f"{name} {n}": p for n, p in inner.items()} if inner else {name: parser}
    return leaves


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_knows_every_command(shell, tmp_path, capsys):
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    for name in commands():
        assert name in script
    if shutil.which(shell):
        (tmp_path / "script").write_text(script)
        subprocess.run([shell, "-n", tmp_path / "script"], check=True)


@pytest.mark.parametrize("name", sorted({*commands(), *leaf_commands()}))
def test_every_command_explains_itself_with_examples(name, capsys):
    with pytest.raises(SystemExit):
        main([*name.split(), "--help"])
    text = capsys.readouterr().out
    assert "examples:" in text and f"volcontact {name}" in text


# `view` shows; what `completion` prints is for a shell.
@pytest.mark.parametrize("name", sorted(set(leaf_commands()) - {"view", "completion"}))
def test_every_command_that_tells_speaks_json(name):
    assert "--json" in leaf_commands()[name].format_help()
