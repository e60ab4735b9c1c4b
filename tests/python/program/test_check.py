# SPDX-License-Identifier: Apache-2.0
"""`volcontact check`: what is wrong with a scene in one line each, and what else it prints."""

import json

import pytest
from PIL import Image

import volcontact as vc
from volcontact.cli import main

SCENE = """
<mujoco>
  <option timestep="0.001" {option}/>
  {asset}
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body name="crate" pos="0 0 {height}">{joint}<geom name="crate" {geom} mass="1"/></body>
    {more}
  </worldbody>
  <custom>{custom}</custom>
</mujoco>
"""
BOX = 'type="box" size=".1 .1 .1"'
WEDGE = (
    '<asset><mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1" '
    'face="0 2 1  0 1 3  1 2 3"/></asset>'
)


def scene(*custom, height=0.1, geom=BOX, joint="<freejoint/>", **parts):
    parts = {"option": "", "asset": "", "more": "", **parts}
    return SCENE.format(custom="".join(custom), height=height, geom=geom, joint=joint, **parts)


def number(key, data=1):
    return f'<numeric name="volcontact/{key}" data="{data}"/>'


def listed(name, geom="crate", sign=1):
    element = f'<element objtype="geom" objname="{geom}" prm="{sign}"/>'
    return f'<tuple name="volcontact/{name}">{element}</tuple>'


STIFF = listed("material/steel") + listed("material/iron", "floor")
STIFF += number("material/steel/stiffness", 1e13) + number("material/iron/stiffness", 1e13)
INSIDE = (
    '<body pos="0 0 .1"><freejoint/><geom name="pip" type="sphere" size=".02" mass="1"/></body>'
)

# What is wrong: the scene, and what its author is told to change.
WRONG = {
    "misspelt key": (
        scene(listed("material/wood"), number("material/wood/stifness", 1e7)),
        "did you mean 'volcontact/material/wood/stiffness'?",
    ),
    "value out of range": (
        scene(listed("material/wood"), number("material/wood/stiffness", -1)),
        "must be > 0",
    ),
    "key without a tuple": (
        scene(number("material/wood/stiffness", 1e7)),
        'there is no <tuple name="volcontact/material/wood">',
    ),
    "misspelt geom": (scene(listed("material/wood", "crat")), "did you mean 'crate'?"),
    "two materials": (
        scene(listed("material/wood"), listed("material/steel")),
        "a geom has one material",
    ),
    "two laws": (
        scene(
            listed("material/wood"),
            number("material/wood/normal_law/volume_spring"),
            listed("material/stone", "floor"),
            number("material/stone/normal_law/hunt_crossley"),
        ),
        "choose one in a volcontact/pair/<name> that lists the two",
    ),
    "part without a sign": (scene(listed("solid/part", sign=0)), 'write prm="1" to add it'),
    "open mesh": (
        scene(geom='type="mesh" mesh="wedge"', asset=WEDGE),
        "mend it with `volcontact mesh repair`",
    ),
    "nothing moves": (scene(joint=""), "no two geoms can touch: give a body a joint"),
    "overlap at the start": (scene(height=0.06), "overlap by 40 mm at the start: move them apart"),
    "inside at the start": (scene(more=INSIDE), "one is inside the other at the start"),
    "too stiff for explicit steps": (
        scene(STIFF, number("option/implicit/off")),
        'write <option timestep="',
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_scene_is_told_in_one_line_what_to_change(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text, advice = WRONG[name]
    (tmp_path / "scene.xml").write_text(text)
    status = main(["check", "scene.xml"])
    lines = [line for line in capsys.readouterr().err.splitlines() if advice in line]
    assert len(lines) == 1
    assert lines[0].startswith("error: " if status else "warning: ")


def test_good_scene_raises_no_warning(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.xml").write_text(scene())
    assert main(["check", "scene.xml"]) == 0
    assert capsys.readouterr().err == ""


def explicit_step(text):
    with vc.attach(vc.load(text)) as contact:
        return contact.description["pairs"][0]["explicit_step"]


def test_longest_explicit_step_is_that_of_the_largest_face():
    """h^2 k_v A / m = 0.5 with two sides of 1e7 N/m^3 in series, A = 0.04 m^2, m = 1 kg."""
    assert explicit_step(scene()) == pytest.approx((0.5 / (0.5e7 * 0.04)) ** 0.5, rel=1e-9)


@pytest.mark.parametrize(
    ("custom", "advice"),
    [("", "steps of 0.001 s suit all pairs"), (STIFF, "are implicit where contact is stiff")],
)
def test_advice_on_the_step(custom, advice, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.xml").write_text(scene(custom))
    assert main(["check", "scene.xml", "--json"]) == 0
    assert advice in json.loads(capsys.readouterr().out)["advice"]


def test_picture_shows_the_start(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.xml").write_text(scene(height=0.0999))
    assert (
        main(["check", "scene.xml", "--picture", "a.png", "--width", "80", "--height", "60"]) == 0
    )
    assert "picture: a.png" in capsys.readouterr().out
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (80, 60)
        assert len(picture.convert("RGB").getcolors(80 * 60)) > 20  # something is drawn


def test_names_are_given_where_the_scene_has_them(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = scene(height=0.06).replace('name="floor" ', "")
    (tmp_path / "scene.xml").write_text(text)
    assert main(["check", "scene.xml"]) == 0
    assert "geom 0 and crate overlap" in capsys.readouterr().err


@pytest.mark.parametrize("width", ["50", "80", "300"])
def test_no_word_is_cut_on_a_narrow_terminal(width, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", width)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.xml").write_text(scene())
    assert main(["check", "scene.xml"]) == 0
    printed = capsys.readouterr().out
    assert "…" not in printed
    for word in ("crate", "stiffness", "implicit"):
        assert word in printed


def test_restitution_is_not_shown_where_damping_holds(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "300")
    monkeypatch.chdir(tmp_path)
    custom = [number("material/m/damping", 2), listed("material/m")]
    (tmp_path / "scene.xml").write_text(scene(*custom))
    assert main(["check", "scene.xml"]) == 0
    materials, pairs = capsys.readouterr().out.split("Materials")[1].split("Pairs")
    for part in (materials, pairs):
        assert "damping" in part
        assert "restitution" not in part  # nor its speed floor
    custom = [number("material/m/restitution", 0.5), listed("material/m")]
    (tmp_path / "scene.xml").write_text(scene(*custom))
    assert main(["check", "scene.xml"]) == 0
    materials, pairs = capsys.readouterr().out.split("Materials")[1].split("Pairs")
    assert "restitution [-]" in materials and "restitution [-]" in pairs
    assert "restitution speed floor" in pairs
