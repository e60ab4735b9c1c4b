# SPDX-License-Identifier: Apache-2.0
"""The program `volcontact`: results, exit status and messages."""

import io
import json
import re
from pathlib import Path

import mujoco
import pytest
from rich.console import Console

import volcontact
from volcontact.cli import main
from volcontact.cli.terminal import ProgressBars

SCENE = """
<mujoco>
  <option timestep="0.001" gravity="0 0 {gravity}"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="ball" pos="0 0 0.06">
      <freejoint/>
      <geom name="ball" type="sphere" size="0.05" mass="1"/>
    </body>
  </worldbody>
</mujoco>
"""


@pytest.fixture
def scene(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its log into the current folder
    path = tmp_path / "ball.xml"
    path.write_text(SCENE.format(gravity=-9.81))
    return str(path)


@pytest.fixture
def wild_scene(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "wild.xml"
    path.write_text(SCENE.format(gravity=-1e13))  # more than MuJoCo accepts as an acceleration
    return str(path)


def test_run_prints_how_it_ended(scene, capsys):
    assert main(["run", scene, "--duration", "0.1"]) == 0
    output = capsys.readouterr()
    assert "Largest contact force" in output.out
    assert "volumetric" in output.out
    assert output.err == ""


def test_material_and_option_act_without_a_key_in_the_file(scene, capsys):
    keys = ["--material", "stiffness=4e8", "--material", "friction_law=bristle"]
    keys += ["--option", "target=passive"]
    assert main(["check", scene, "--json", *keys]) == 0
    description = json.loads(capsys.readouterr().out)
    (pair,) = description["pairs"]
    assert (pair["stiffness"], pair["friction_law"]) == (2e8, "bristle")
    assert description["options"]["target"] == "passive"
    depths = []
    for stiffness in ("1e8", "4e8"):
        arguments = ["run", scene, "--duration", "2", "--material", f"stiffness={stiffness}"]
        assert main([*arguments, "--json"]) == 0
        depths.append(json.loads(capsys.readouterr().out)["volumetric"]["max_penetration"])
    assert depths[1] < 0.6 * depths[0]
    with pytest.raises(SystemExit):
        main(["run", scene, "--material", "stiffness"])
    assert "must be NAME=VALUE" in capsys.readouterr().err
    for wrong in ("stiffness=hard", "friction=1,2"):
        with pytest.raises(SystemExit):
            main(["run", scene, "--material", wrong])
        name, value = wrong.split("=")
        assert f"{name} takes a number, got '{value}'" in capsys.readouterr().err
    assert main(["run", scene, "--material", "stifness=1"]) == 1
    assert "did you mean" in capsys.readouterr().err


def test_run_prints_json_and_nothing_else(scene, capsys):
    assert main(["run", scene, "--duration", "0.1", "--contact", "native", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert set(result) == {"native", "mujoco_version", "volcontact_version"}
    assert (result["native"]["steps"], result["native"]["dt"]) == (100, 0.001)


def test_run_writes_its_numbers(scene, tmp_path, capsys):
    out = tmp_path / "results"
    arguments = ["run", scene, "--duration", "0.05", "--timestep", "5e-4", "--out", str(out)]
    assert main(arguments) == 0
    assert "results" in capsys.readouterr().out
    summary = json.loads((out / "summary.json").read_text())
    assert summary["volumetric"]["dt"] == 5e-4
    assert (out / "trajectory.parquet").stat().st_size > 0


def test_compare_writes_the_report_with_pictures(scene, tmp_path, capsys):
    out = tmp_path / "report"
    arguments = ["compare", scene, "--duration", "0.2", "--frame-interval", "0.1"]
    arguments += ["--width", "64", "--height", "48", "--out", str(out)]
    assert main(arguments) == 0
    assert "report.html" in capsys.readouterr().out
    names = sorted(path.name for path in (out / "frames").iterdir())
    assert names == ["frame_0000.png", "frame_0001.png", "frame_0002.png"]
    assert (out / "report.html").read_text(encoding="utf-8").count("data:image/png") == 2 * 3 + 2
    summary = json.loads((out / "summary.json").read_text())
    assert summary["volcontact_version"] == volcontact.__version__
    assert summary["volumetric"]["steps"] == summary["native"]["steps"] == 200


def test_compare_without_pictures_prints_json(scene, tmp_path, capsys):
    out = tmp_path / "report"
    arguments = ["compare", scene, "--duration", "0.05", "--no-frames", "--json", "--out", str(out)]
    assert main(arguments) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["report"] == str(out / "report.html")
    assert "data:image/png" not in (out / "report.html").read_text(encoding="utf-8")


def test_check_shows_what_was_understood(scene, capsys):
    assert main(["check", scene]) == 0
    text = capsys.readouterr().out
    assert "ball" in text
    assert "floor" in text
    assert main(["check", scene, "--json"]) == 0
    description = json.loads(capsys.readouterr().out)
    assert {"options", "materials", "solids", "pairs", "warnings"} <= set(description)


@pytest.mark.parametrize("command", [["run"], ["compare", "--no-frames"]])
def test_mujoco_warning_is_named_and_is_a_failure(wild_scene, command, capsys):
    assert main([command[0], wild_scene, "--duration", "0.01", *command[1:]]) == 3
    error = capsys.readouterr().err
    assert "MuJoCo warned of BADQACC 1 times" in error
    assert "the state became unusable at t = 0 s" in error


@pytest.mark.parametrize("command", ["run", "compare", "check"])
def test_unreadable_scene_is_one_line_and_no_traceback(command, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.xml").write_text("<mujoco>\n  <worldbody><goem/></worldbody>\n</mujoco>")
    assert main([command, "bad.xml"]) == 1
    output = capsys.readouterr()
    assert output.out == ""
    assert len(output.err.splitlines()) == 1
    assert output.err.startswith("error: ")
    assert "goem" in output.err
    assert main([command, "bad.xml", "--json"]) == 1
    assert "goem" in json.loads(capsys.readouterr().out)["error"]


def test_unknown_key_is_named_by_check(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    custom = '<custom><numeric name="volcontact/option/tolerence" data="1e-3"/></custom></mujoco>'
    text = SCENE.format(gravity=-9.81).replace("</mujoco>", custom)
    (tmp_path / "typo.xml").write_text(text)
    assert main(["check", "typo.xml"]) == 1
    error = capsys.readouterr().err
    assert "volcontact/option/tolerence" in error
    assert "volcontact/option/tolerance" in error
    assert len(error.splitlines()) == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "nowhere.xml"], "no such file: nowhere.xml"),
        (["run", "SCENE", "--duration", "-1"], "'-1' must be a number above 0"),
        (["run", "SCENE", "--timestep", "1 ms"], "'1 ms' must be a number above 0"),
        (["compare", "SCENE", "--width", "0"], "must be a whole number from 16 to 4096"),
        (["fly"], "invalid choice: 'fly'"),
    ],
)
def test_wrong_usage_ends_with_status_2(arguments, message, scene, capsys):
    with pytest.raises(SystemExit) as stop:
        main([scene if argument == "SCENE" else argument for argument in arguments])
    assert stop.value.code == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [[], ["run"], ["compare"], ["check"]])
def test_help_has_examples(arguments, capsys):
    with pytest.raises(SystemExit) as stop:
        main([*arguments, "--help"])
    assert stop.value.code == 0
    text = capsys.readouterr().out
    assert "examples:" in text
    assert f"volcontact {arguments[0] if arguments else 'check'} scene.xml" in text


def test_version_names_both_programs(capsys):
    with pytest.raises(SystemExit):
        main(["--version"])
    assert volcontact.__version__ in capsys.readouterr().out


def test_bars_appear_only_when_the_work_takes_a_while(monkeypatch):
    monkeypatch.setattr("volcontact.cli.terminal.time.monotonic", iter([0.0, 0.1, 5.0]).__next__)
    output = io.StringIO()
    console = Console(file=output, force_terminal=True, width=100)
    bars = ProgressBars(console, enabled=True)
    move = bars.task("native contact")
    move(10, 100)
    assert output.getvalue() == ""
    move(50, 100)
    bars.close()
    assert "native contact" in output.getvalue()
    assert "50 %" in output.getvalue()


def test_check_prints_the_line_that_a_hand_written_scene_needs(scene, tmp_path, capsys):
    key = '<custom><numeric name="volcontact/option/tolerance" data="1e-3"/></custom></mujoco>'
    text = Path(scene).read_text().replace("</mujoco>", key)
    Path(scene).write_text(text)
    assert main(["check", scene]) == 0
    (line,) = re.findall(r"<size nuserdata=\"\d+\"/>", capsys.readouterr().out)
    # With that line plain MuJoCo loads a model that can be attached; without, it cannot.
    with pytest.raises(ValueError, match="userdata is too small"):
        volcontact.attach(mujoco.MjModel.from_xml_string(text))
    better = tmp_path / "better.xml"
    better.write_text(text.replace("<worldbody>", f"{line}<worldbody>"))
    with volcontact.attach(mujoco.MjModel.from_xml_path(str(better))):
        pass
    assert main(["check", str(better)]) == 0
    output = capsys.readouterr().out
    assert "the file has room" in output and "<size" not in output
    # Numbers of the user's own come before ours.
    own = tmp_path / "own.xml"
    own.write_text(text.replace("<worldbody>", '<size nuserdata="3"/><worldbody>'))
    assert main(["check", str(own), "--json"]) == 0
    userdata = json.loads(capsys.readouterr().out)["userdata"]
    assert userdata["line"] == f'<size nuserdata="{userdata["needed"] + 3}"/>'
