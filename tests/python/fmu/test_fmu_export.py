# SPDX-License-Identifier: Apache-2.0
"""What an FMU holds: valid by FMPy and by the schemas, with the numbers of the scene."""

import itertools
import json
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest

import volcontact as vc
from volcontact.cli import main
from volcontact.fmu import drawing
from volcontact.fmu.units import exponents, limits

fmpy = pytest.importorskip("fmpy", reason="FMPy is missing: pip install fmpy")
MODELS = Path(__file__).parents[3] / "mjcf_models"
SCENES = {
    "bouncing_ball": ["ball", "world"],
    "ball_in_cylinder": ["ball", "world"],
    "tippe_top": ["world", "top"],
    "battery_box": ["battery_box", "world"],
}


def scene(name):
    return MODELS / name / "scene.xml"


def ball_on_floor(**laws):
    return vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(radius=0.05), vc.HalfSpace())],
        normal=vc.HuntCrossley(stiffness=1e8, damping=0.5),
        friction=vc.Bristle(static_friction=0.5, **laws) if laws else None,
    )


def problems(path):
    from fmpy.validation import validate_fmu

    return validate_fmu(str(path))


# The check takes seconds with the many numbers of the battery box: in `./run test` as FMI 2.
VALID = [
    pytest.param(name, fmi, marks=[pytest.mark.soak] if (name, fmi) == ("battery_box", 3) else [])
    for name, fmi in itertools.product(SCENES, [2, 3])
]


@pytest.mark.parametrize(("name", "fmi"), VALID)
def test_fmus_of_scenes_are_valid(tmp_path, name, fmi):
    path = vc.export_fmu(scene(name), tmp_path / f"{name}.fmu", bodies=SCENES[name], fmi=fmi)
    assert problems(path) == []


CHOICES = list(
    itertools.product([2, 3], ["world", "body"], ["quaternion", "matrix"], ["me", "cs", "both"])
)


# In `./run test` every third: any two choices are together in one of them.
@pytest.mark.parametrize(
    ("fmi", "frame", "orientation", "kind"),
    [
        pytest.param(*each, marks=[] if (sum(place) + place[2]) % 3 == 0 else [pytest.mark.soak])
        for each, place in zip(
            CHOICES, itertools.product(range(2), range(2), range(2), range(3)), strict=True
        )
    ],
)
def test_every_choice_is_valid_and_gives_the_force_of_the_model(
    tmp_path, fmi, kind, orientation, frame
):
    model = ball_on_floor(friction=0.3)
    path = vc.export_fmu(
        model, tmp_path / "it's.fmu", bodies=["my ball", "floor"], fmi=fmi, kind=kind,
        orientation=orientation, frame=frame,
    )  # fmt: skip
    assert problems(path) == []
    # The ball half a turn about x, so that the frames differ; 1 mm deep.
    turn = {"quaternion": [0.0, 1.0, 0.0, 0.0], "matrix": [1, 0, 0, 0, -1, 0, 0, 0, -1]}
    name = {"quaternion": "quaternion", "matrix": "rotation"}[orientation]
    starts = {"'my ball'.position": [0.0, 0.0, 0.049], f"'my ball'.{name}": turn[orientation]}
    if fmi == 2:
        starts = {f"{k}[{i + 1}]": v for k, row in starts.items() for i, v in enumerate(row)}
    out = ["'my ball'.force[3]"] if fmi == 2 else ["'my ball'.force"]
    rows = fmpy.simulate_fmu(
        str(path), start_values=starts, stop_time=1e-3, output_interval=1e-3, output=out,
        fmi_type="ModelExchange" if kind == "me" else "CoSimulation",
    )  # fmt: skip
    pose = np.eye(4)
    pose[2, 3] = 0.049
    wanted = model.evaluate(X_WA=pose).force_on_A[2] * (-1 if frame == "body" else 1)
    got = rows[-1][1] if fmi == 2 else rows[-1][1][2]
    assert got == pytest.approx(wanted, rel=1e-12)


def test_units_have_the_exponents_of_what_they_are_made_of():
    assert exponents("N s/m^3") == {"kg": 1, "m": -2, "s": -1}
    assert exponents("rad/s") == {"rad": 1, "s": -1}
    with pytest.raises(ValueError, match="'furlong' is unknown"):
        exponents("furlong/s")
    assert limits("> 0") == (0.0, None)
    assert limits("> 0 and <= 1") == (0.0, 1.0)
    assert limits("0 to 1") == (0.0, 1.0)
    assert limits("any finite number") == (None, None)


def test_parameters_have_unit_range_and_value_of_the_scene(tmp_path):
    path = vc.export_fmu(scene("bouncing_ball"), tmp_path / "a.fmu", bodies=SCENES["bouncing_ball"])
    about = {v.name: v for v in fmpy.read_model_description(str(path)).modelVariables}
    stiffness, restitution = about["law.stiffness"], about["law.restitution"]
    assert (float(stiffness.start), stiffness.unit, stiffness.variability) == (
        1e9,
        "N/m^3",
        "tunable",
    )
    assert (float(restitution.start), restitution.variability) == (0.8, "fixed")
    assert float(restitution.max) == 1.0
    assert about["ball.position[3]"].start == "1.05"


def test_documentation_draws_the_solids_and_lists_every_variable(tmp_path):
    path = vc.export_fmu(scene("tippe_top"), tmp_path / "top.fmu", bodies=["top", "world"])
    with zipfile.ZipFile(path) as fmu:
        page = fmu.read("documentation/index.html").decode()
        assert fmu.read("model.png").startswith(b"\x89PNG")
        assert fmu.read("binaries/linux64/top.so").startswith(b"\x7fELF")
    assert page.count("<polygon") == 3  # two spheres and the table
    for variable in fmpy.read_model_description(str(path)).modelVariables:
        assert re.sub(r"\[\d+\]$", "", variable.name).removeprefix("der(") in page


@pytest.mark.parametrize(
    "solid",
    [
        vc.Sphere(0.1),
        vc.Ellipsoid((0.1, 0.2, 0.3)),
        vc.Capsule(0.1, 0.2),
        vc.Cylinder(0.1, 0.2),
        vc.Frustum(0.1, 0.2, 0.3),
        vc.Box((0.1, 0.2, 0.3)),
        vc.RoundedBox((0.1, 0.2, 0.3), 0.05),
        vc.Torus(0.2, 0.05),
    ],
    ids=lambda solid: type(solid).__name__,
)
def test_the_drawing_of_a_solid_fills_its_bounds(solid):
    text = vc.ContactModel(pairs=[vc.Pair(solid, vc.HalfSpace())], normal=vc.VolumeSpring()).text
    (_, words), _ = drawing._solids(text)
    ((pose, points),) = drawing._points(words)
    assert (pose == np.eye(4)).all()
    low, high = solid.bounds
    assert points.min(axis=0) == pytest.approx(low, rel=1e-9)
    assert points.max(axis=0) == pytest.approx(high, rel=1e-9)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (dict(bodies=["bal", "world"]), "no body 'bal'; it has world, ball; did you mean 'ball'?"),
        (dict(bodies=["ball", "ball"]), "'ball' is named twice"),
        (dict(bodies=["ball"]), "two bodies or more"),
        (dict(bodies=["ball", "world"], fmi=1), "fmi = 1 is none of 2, 3"),
        (dict(bodies=["ball", "world"], kind="xx"), "kind = 'xx' is none of me, cs, both"),
        (dict(bodies=["ball", "world"], slots=0), "slots = 0 must be 1 to 64"),
    ],
)
def test_wrong_arguments_are_told(tmp_path, arguments, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        vc.export_fmu(scene("bouncing_ball"), tmp_path / "a.fmu", **arguments)
    assert list(tmp_path.iterdir()) == []


def test_a_law_of_ones_own_has_no_text():
    class Own(vc.NormalLaw):
        name = "own"

        def evaluate(self, contact, state, elapsed):
            return vc.NormalOutput(magnitude=1e7 * contact.volume)

    with pytest.raises(ValueError, match="own"):
        vc.export_fmu(
            vc.ContactModel(pairs=[vc.Pair(vc.Sphere(0.05), vc.HalfSpace())], normal=Own()), "x.fmu"
        )


def test_merge_joins_platforms_and_refuses_another_unit(tmp_path):
    model, paths = ball_on_floor(), []
    for folder in ("linux", "windows"):
        (tmp_path / folder).mkdir()
        paths.append(vc.export_fmu(model, tmp_path / folder / "ball.fmu"))
    moved = tmp_path / "moved.fmu"  # as if it had been made on Windows
    with zipfile.ZipFile(paths[1]) as old, zipfile.ZipFile(moved, "w") as new:
        for name in old.namelist():
            other = name.replace("linux64/ball.so", "win64/ball.dll")
            new.writestr(other, old.read(name))
    out = tmp_path / "both.fmu"
    assert vc.merge_fmus([paths[0], moved], out) == ["linux64", "win64"]
    assert problems(out) == []
    other = vc.export_fmu(ball_on_floor(friction=0.1), tmp_path / "ball.fmu")
    with pytest.raises(ValueError, match="of another unit"):
        vc.merge_fmus([paths[0], other], out)
    with pytest.raises(ValueError, match="no FMU"):
        vc.merge_fmus([paths[0], scene("tippe_top")], out)


def test_the_command_writes_and_merges(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["fmu", str(scene("bouncing_ball")), "--bodies", "ball", "world", "--fmi", "3",
                 "--kind", "me", "--out", "b.fmu", "--json"]) == 0  # fmt: skip
    assert json.loads(capsys.readouterr().out)["fmu"] == "b.fmu"
    assert problems("b.fmu") == []
    assert main(["fmu", "merge", "b.fmu", "b.fmu", "--out", "c.fmu"]) == 0
    assert "wrote c.fmu" in capsys.readouterr().out
    assert main(["fmu", "none.xml", "--bodies", "a", "b"]) == 1
    assert "no such file: none.xml" in capsys.readouterr().err
