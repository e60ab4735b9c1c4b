# SPDX-License-Identifier: Apache-2.0
"""`volcontact bench`: output, files, exit status."""

import json

import mujoco
import pytest
from bench_sheets import FOLDER

import volcontact as vc
from volcontact.cli import main
from volcontact.cli.bench import TESTS
from volcontact.identify import direct
from volcontact.identify.direct.layouts import LAYOUTS


def sheet_of(test):
    return str(FOLDER / test / "sheet.csv")


def test_it_knows_all_tests():
    assert TESTS.keys() == LAYOUTS.keys()


def test_template_is_printed(capsys):
    assert main(["bench", "pull", "--template"]) == 0
    assert capsys.readouterr().out == direct.template("pull")
    assert main(["bench", "pull", "--template", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["template"] == direct.template("pull")


def test_values_intervals_and_lines_are_printed(capsys):
    assert main(["bench", "press", sheet_of("press")]) == 0
    text = capsys.readouterr().out
    assert "stiffness" in text and "95 % interval" in text and "N/m^3" in text
    assert '<numeric name="volcontact/pair/NAME/stiffness" data="5e+09"/>' in text or (
        "volcontact/pair/NAME/stiffness" in text
    )


def test_json_is_the_content_of_the_file(tmp_path, capsys):
    out = tmp_path / "results"
    assert main(["bench", "pull", sheet_of("pull"), "--out", str(out), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed == json.loads((out / "identified.json").read_text())
    assert printed["parameters"]["dwell_time"]["value"] == pytest.approx(2.0, rel=1e-3)
    assert printed["parameters"]["dwell_time"]["unit"] == "s"
    page = (out / "report.html").read_text()
    assert page.count("<svg") == 2 and "Breakaway after a rest" in page


@pytest.mark.parametrize("test", LAYOUTS)
def test_scene_that_is_written_loads_with_the_values(test, tmp_path):
    found = direct.bench(test, sheet_of(test), tmp_path, report=False)
    model = vc.load(tmp_path / "identified.xml")
    data = mujoco.MjData(model)
    with vc.attach(model):
        for _ in range(20):
            mujoco.mj_step(model, data)
    for name, value in found.parameters().items():
        place = mujoco.mj_name2id(
            model, mujoco.mjtObj.mjOBJ_NUMERIC, f"volcontact/pair/identified/{name}"
        )
        assert model.numeric_data[model.numeric_adr[place]] == pytest.approx(value, rel=1e-8)
    assert not (tmp_path / "report.html").exists()


def test_constants_may_be_given(capsys):
    arguments = ["bench", "pull", sheet_of("pull"), "--given", "normal_force=19.62", "--json"]
    assert main(arguments) == 0
    found = json.loads(capsys.readouterr().out)["parameters"]
    assert found["friction"]["value"] == pytest.approx(0.15, rel=1e-3)


def test_level_widens_the_interval(capsys):
    widths = []
    for level in ("0.5", "0.99"):
        assert main(["bench", "pull", sheet_of("pull"), "--level", level, "--json"]) == 0
        each = json.loads(capsys.readouterr().out)["parameters"]["friction"]
        widths.append(each["high"] - each["low"])
    assert widths[1] > 2.0 * widths[0]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["bench", "press", "nowhere.csv"], "no such sheet: nowhere.csv"),
        (["bench", "pull", sheet_of("press")], "is no column of the test pull"),
    ],
)
def test_wrong_request_is_one_line(arguments, said, capsys):
    assert main(arguments) == 1
    error = capsys.readouterr().err
    assert said in error
    assert len(error.splitlines()) == 1


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["bench", "press"], "give the SHEET, or --template"),
        (["bench", "lift", "sheet.csv"], "invalid choice: 'lift'"),
        (["bench", "press", "sheet.csv", "--level", "2"], "above 0 and below 1"),
    ],
)
def test_wrong_usage_ends_with_status_2(arguments, said, capsys):
    with pytest.raises(SystemExit) as stop:
        main(arguments)
    assert stop.value.code == 2
    assert said in capsys.readouterr().err


def test_fit_that_does_not_converge_is_status_3(monkeypatch, capsys):
    from dataclasses import replace

    real = direct.bench
    monkeypatch.setattr(direct, "bench", lambda *a, **k: replace(real(*a, **k), converged=False))
    assert main(["bench", "press", sheet_of("press")]) == 3
    assert "not converged" in capsys.readouterr().err
