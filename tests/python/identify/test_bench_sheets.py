# SPDX-License-Identifier: Apache-2.0
"""Data sheets: units, constants, templates; what is wrong is told in a line."""

import re

import numpy as np
import pytest
from bench_sheets import FOLDER

from volcontact.identify import direct
from volcontact.identify.direct.layouts import LAYOUTS
from volcontact.identify.direct.sheets import parse_sheet

PRESS = """\
# a = sphere:radius=0.02
# offset [mm] = 0
depth [mm],force [N]
0.1,6.2727
0.2,25.06
0.3,56.3
"""


def test_units_of_head_and_constants_are_read():
    plain = parse_sheet(PRESS, LAYOUTS["press"], "press.csv")
    other = PRESS.replace("[mm],force [N]", "[um],force [kN]")
    other = other.replace("0.1,6.2727", "100,6.2727e-3").replace("0.2,25.06", "200,25.06e-3")
    other = other.replace("0.3,56.3", "300,56.3e-3")
    same = parse_sheet(other, LAYOUTS["press"], "press.csv")
    for name, column in plain.columns.items():
        np.testing.assert_allclose(same.columns[name], column, rtol=1e-12)
    assert plain.constants == {"a": "sphere:radius=0.02", "offset": 0.0}


def test_given_constants_replace_those_of_the_sheet():
    found = parse_sheet(PRESS, LAYOUTS["press"], "p", {"offset": 1e-4, "a": "sphere:radius=1"})
    assert found.constants == {"a": "sphere:radius=1", "offset": 1e-4}
    pull = "speed [mm/s],force [N]\n1,2\n2,3\n"
    found = parse_sheet(pull, LAYOUTS["pull"], "p", {"normal_force": 12.0})
    assert found.constants == {"normal force": 12.0}


def test_comments_and_empty_lines_are_skipped():
    text = "# By hand, at 20 degrees: E = mc^2\n\n" + PRESS + "\n,,\n"
    assert len(parse_sheet(text, LAYOUTS["press"], "p").columns["depth"]) == 3


@pytest.mark.parametrize("test", LAYOUTS)
def test_template_can_be_read_as_it_is(test):
    text = direct.template(test)
    found = direct.read_bench(test, text)
    assert found.values and found.converged
    assert found.mjcf("p").count("volcontact/pair/p/") >= 1
    for item in (*LAYOUTS[test].columns, *LAYOUTS[test].constants):
        assert f"{item.name}" in text


@pytest.mark.parametrize("test", LAYOUTS)
def test_scene_of_the_test_is_complete(test):
    for name in ("scene.xml", f"{test}.xml", "README.md", "expected.json", "sheet.csv"):
        assert (FOLDER / test / name).is_file(), name
    assert f"[{test}]({test}/README.md)" in (FOLDER / "README.md").read_text()


WRONG = {
    "column missing": ("press", PRESS.replace(",force [N]", ""), "there is no column 'force'"),
    "column unknown": ("press", PRESS.replace("force", "forze"), "did you mean 'force'?"),
    "column twice": ("press", PRESS.replace("force [N]", "depth [mm]"), "stands there twice"),
    "unit unknown": ("press", PRESS.replace("[N]", "[kp]"), "'kp' is no unit of 'force'"),
    "unit missing": ("press", PRESS.replace("force [N]", "force"), "write 'force [N]'"),
    "unit of constant": (
        "press",
        PRESS.replace("offset [mm]", "offset [N]"),
        "no unit of 'offset'",
    ),
    "constant unknown": ("press", PRESS.replace("offset", "ofset"), "did you mean 'offset'?"),
    "nan": ("press", PRESS.replace("25.06", "nan"), "line 5: force = nan"),
    "text": ("press", PRESS.replace("25.06", "25 N"), "must be a number"),
    "comma": ("press", PRESS.replace("25.06", '"25,06"'), "write a point, not a comma"),
    "cells": ("press", PRESS.replace("25.06", "25,06"), "separate cells by commas"),
    "empty": ("press", PRESS.replace("25.06", ""), "force is empty"),
    "no table": ("press", "# a = sphere:radius=1\n", "there is no table"),
    "one row": ("press", "\n".join(PRESS.splitlines()[:4]), "has 1 rows"),
    "solid": ("press", PRESS.replace("radius=", "radios="), "write sphere:radius=X"),
    "no solid": ("press", PRESS.replace("# a = sphere:radius=0.02\n", ""), "'a' is missing"),
    "rises": ("drop", "height [mm]\n300\n400\n", "height 2 is not below the one before"),
    "gap": ("drop", "height [mm],interval [ms]\n300,\n200,\n,10\n", "not both"),
    "nothing": ("drop", "drop\n1\n1\n", "there is no column 'height'"),
    "short drop": ("drop", "drop,height [mm]\n1,300\n2,200\n", "has 1 heights"),
    "negative": ("drop", "height [mm]\n-300\n-400\n", "must be above 0"),
    "both": (
        "pull",
        "# normal force [N] = 10\nrest [s],speed [m/s],force [N]\n1,1,3\n,1,3\n",
        "row 1 has both of rest and speed",
    ),
    "neither": (
        "pull",
        "# normal force [N] = 10\nrest [s],speed [m/s],force [N]\n,,3\n,1,3\n",
        "has neither of rest and speed",
    ),
    "no load": ("pull", "speed [m/s],force [N]\n1,3\n2,3\n", "'normal force' is missing"),
    "load": (
        "pull",
        "# normal force [N] = 0\nspeed [m/s],force [N]\n1,3\n2,3\n",
        "must be above 0",
    ),
    "few slides": (
        "pull",
        "# normal force [N] = 10\nspeed [m/s],force [N]\n1,3\n2,3\n",
        "2 samples are too few to find friction",
    ),
    "right angle": ("tilt", "angle [rad]\n20\n21\n", "90 degrees or more"),
    "no rest": ("tilt", "rest [s],angle [deg]\n1,20\n,21\n", "a row has no rest"),
    "acceleration": (
        "tilt",
        "angle [deg],acceleration [m/s^2]\n20,9\n21,9\n",
        "more than that without friction",
    ),
    "backwards": (
        "slip",
        "time [s],displacement [um],force [N]\n" + "".join(f"{-k},{k},{k}\n" for k in range(20)),
        "time does not rise",
    ),
    "few samples": ("slip", "time [s],displacement [um],force [N]\n0,0,0\n1,1,1\n", "at least 12"),
    "still": (
        "slip",
        "time [s],displacement [um],force [N]\n" + "".join(f"{k},0,{k}\n" for k in range(20)),
        "does not change",
    ),
    "no inertia": (
        "spin",
        direct.template("spin").replace("# inertia [kg m^2] = 0.00125", ""),
        "'inertia' is missing",
    ),
    "no weight": (
        "spin",
        direct.template("spin").replace("# mass [kg] = 1", ""),
        "the normal force is missing",
    ),
    "not a test": ("press ", PRESS, "must be one of press, drop"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_sheet_is_told(case):
    test, text, said = WRONG[case]
    with pytest.raises(ValueError, match=re.escape(said)) as told:
        direct.read_bench(test, text)
    assert "\n" not in str(told.value)


def test_wrong_constants_are_told():
    with pytest.raises(direct.SheetError, match=r"did you mean 'normal force'\?"):
        direct.read_bench("pull", direct.template("pull"), given={"normal_farce": 1.0})
    with pytest.raises(direct.SheetError, match="must be a number"):
        direct.read_bench("pull", direct.template("pull"), given={"normal_force": "much"})


def test_no_such_file():
    with pytest.raises(FileNotFoundError, match="no such sheet"):
        direct.bench("press", "nowhere.csv")


def test_file_of_another_kind(tmp_path):
    file = tmp_path / "press.csv"
    file.write_bytes(b"\xff\xfe\x00d\x00e")
    with pytest.raises(direct.SheetError, match="is no text in UTF-8"):
        direct.bench("press", file)
