# SPDX-License-Identifier: Apache-2.0
"""Wrong studies: one line that says what, where and how to put it right, before any trial."""

from __future__ import annotations

import re

import pytest
from study_files import FUNCTION_STUDY, SCENE_STUDY, function_study, scene_study

import volcontact as vc
from volcontact.cli import main

# What is replaced in the study of the sliding box, and what the message must say.
WRONG = {
    "environment": (
        'scene = "scene.xml"',
        'environment = "volcontact/OruInsertion-v0"',
        "environment = .* is unknown; did you mean 'volcontact/ORUInsertion-v0'",
    ),
    "environment and scene": (
        'scene = "scene.xml"',
        'environment = "volcontact/ORUInsertion-v0"\nscene = "scene.xml"',
        "give either environment or scene, not both",
    ),
    "key of the scene": (
        "volcontact/material/all/friction",
        "volcontact/material/all/frictoin",
        "target 'volcontact/material/all/frictoin': .*did you mean "
        "'volcontact/material/all/friction'",
    ),
    "element": ("geom/block/size/2", "geom/blok/size/2", "no geom 'blok'; did you mean 'block'"),
    "kind of element": ("geom/block/size/2", "gem/block/size/2", "no element 'gem'.*'geom'"),
    "attribute": (
        "std = 0.001\ntarget",
        'std = 0.001\nmode = "add"\ntarget = "geom/block/pos/2"\n#',
        "gives no such attribute",
    ),
    "index": ("geom/block/size/2", "geom/block/size/3", "index must be from 0 to 2"),
    "joint": ("qvel/block/0", "qvel/blok/0", "no joint 'blok'; did you mean 'block'"),
    "index of a joint": ("qvel/block/0", "qvel/block/6", "index must be from 0 to 5"),
    "target": ("qvel/block/0", "speed of block", "must be volcontact/"),
    "negative size": ("mean = 0.02", "mean = -0.02", r"trial \d+ \(.*height = -.*size"),
    "negative friction": ("low = 0.1", "low = -2.1", r"trial \d+ \(friction = -.*friction"),
    "distribution": ('"norm"', '"nrom"', r"\[vary.height\] distribution = 'nrom': .*'norm'"),
    "parameter": ("std = 0.001", "stdd = 0.001", r"\[vary.height\] stdd: is unknown; .*'std'"),
    "scale": ("std = 0.001", "std = -0.001", "norm is not defined for .*std = -0.001"),
    "ends": ("high = 0.5", "high = 0.05", "high must be above low"),
    "quantity": (
        '"position/block/x"',
        '"position/blok/x"',
        "no body 'blok'; did you mean 'block'",
    ),
    "kind of quantity": ('"speed/block"', '"sped/block"', "'sped/block': is unknown"),
    "axis": ('"position/block/x"', '"position/block"', "position/BODY/x, y or z"),
    "condition": ("[0.08, 0.2]", "[0.2, 0.08]", "low must not be above high"),
    "no success": (
        '"position/block/x" = [0.08, 0.2]\n"speed/block" = [0.0, 0.01]',
        "",
        r"\[success\]: there is no success criterion",
    ),
    "place": ('wall = ["wall"]', 'wall = ["wal"]', "no such geom; did you mean 'wall'"),
    "body of the pose": ('body = "block"', 'body = "blok"', r"\[pose\] body = 'blok'"),
    "two columns": ("{ x = ", "{ speed = ", "two columns of this name"),
    "key": ("duration = 0.4", "duraton = 0.4", "duration is missing"),
    "unknown key": ("trials = 12", "trails = 12", "trails: is unknown; did you mean 'trials'"),
    "table": ("[pose]", "[poze]", "poze: is unknown; did you mean 'pose'"),
    "trials": ("trials = 12", "trials = 0", "trials = 0: must be a whole number from 1"),
    "method": ("[sample]", '[sample]\nmethod = "sobl"', "method = 'sobl': .*'sobol'"),
    "scene": ('"scene.xml"', '"scen.xml"', "scene = 'scen.xml': there is no such file"),
    "toml": ("[sample]", "[sample", "study.toml: .*line"),
    "gain": (
        "qvel/block/0",
        "control/speed",
        r"there is no controller; add the table \[control\]",
    ),
    "keyframe": ('name = "slide"', 'name = "slide"\nkeyframe = "up"', "no such keyframe"),
    "rotation": (
        '"norm"\nmean = 0.02\nstd = 0.001',
        '"rotation"',
        "a rotation goes to qpos/JOINT",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_study_is_one_line_before_any_trial(case, tmp_path, capsys):
    before, after, message = WRONG[case]
    assert before in SCENE_STUDY
    path = scene_study(tmp_path, SCENE_STUDY.replace(before, after, 1))
    out = tmp_path / "out"
    assert main(["study", "run", str(path), "--out", str(out), "--engine", "serial"]) == 1
    said = capsys.readouterr().err
    assert re.search(message, " ".join(said.split())), said
    assert said.count("error:") == 1 and "Traceback" not in said
    assert not out.exists()
    with pytest.raises(vc.StudyError) as error:
        vc.Study(path).check()
    assert "\n" not in str(error.value)


FUNCTION_WRONG = {
    "function": ('"trial"', '"trail"', "function = 'trail': .*did you mean 'trial'"),
    "python": ('python = "functions.py"\n', "", "python is missing"),
    "column": ("sum = [-inf", "som = [-inf", r"\[success\] \"som\": .*'sum'"),
    "target": ("[sample]", 'target = "qpos/peg"\n[sample]', "has no scene"),
    "response": (
        "trials = 40",
        'trials = 40\nmethod = "optimise"\nresponse = "som"',
        "response = 'som': is no column.*'sum'",
    ),
    "correlation": (
        "[sample]",
        '[[correlation]]\ninputs = ["x", "z"]\nmatrix = [[1, 0], [0, 1]]\n[sample]',
        "z is no input with a distribution",
    ),
    "matrix": (
        "[sample]",
        '[[correlation]]\ninputs = ["x", "y"]\nmatrix = [[1, 2], [2, 1]]\n[sample]',
        "positive definite",
    ),
    "grid": ("trials = 40", 'trials = 40\nmethod = "grid"', r"points = ... in \[vary.x\]"),
    "table": (
        'distribution = "norm"',
        'table = "gone.csv"',
        "table = 'gone.csv': there is no such file",
    ),
    "reserved": ("[vary.x]", "[vary.trial]", "a name is letters"),
}


@pytest.mark.parametrize("case", FUNCTION_WRONG)
def test_wrong_study_of_a_function(case, tmp_path):
    before, after, message = FUNCTION_WRONG[case]
    assert before in FUNCTION_STUDY
    path = function_study(tmp_path, FUNCTION_STUDY.replace(before, after, 1))
    with pytest.raises(vc.StudyError, match=message):
        vc.Study(path).check()


def test_column_of_a_table_that_is_no_number(tmp_path):
    (tmp_path / "gaps.csv").write_text("gap,width\n0.1,2\n0.2,wide\n")
    for column, message in (
        ("gup", "did you mean 'gap'"),
        ("width", "line 3.*'wide' is no number"),
    ):
        text = FUNCTION_STUDY.replace(
            'distribution = "norm"', f'table = "gaps.csv"\ncolumn = "{column}"', 1
        )
        with pytest.raises(vc.StudyError, match=message):
            vc.Study(function_study(tmp_path, text))


def test_folder_below_a_file_cannot_be_written(tmp_path):
    path = function_study(tmp_path)
    with pytest.raises(vc.StudyError, match=r"cannot be written to .*--out"):
        vc.Study(path).run(path / "out", engine="serial")


def test_check_shows_what_is_drawn(tmp_path, capsys):
    path = scene_study(tmp_path)
    picture = tmp_path / "inputs.svg"
    assert main(["study", "check", str(path), "--picture", str(picture)]) == 0
    assert "slide: monte_carlo, 12 trials" in capsys.readouterr().out
    drawn = picture.read_text()
    assert drawn.lstrip().startswith("<?xml") and drawn.count('<g id="axes_') == 3
