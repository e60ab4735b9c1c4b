# SPDX-License-Identifier: Apache-2.0
"""The report: numbers as people write them, sentences from data, and a page that needs nothing."""

import dataclasses
import json
import re

import numpy as np
import pyarrow.parquet as pq
import pytest

from volcontact.recording import SITE, Frame, Recording
from volcontact.report import Comparison, write_report
from volcontact.report.comparison import (
    first_touch,
    is_seated,
    largest_rise,
    offset_from,
    unbalance,
)
from volcontact.report.description import tables, text
from volcontact.report.design_pose import DesignPose, angle_between, read_design_pose
from volcontact.report.figures import curves, thin
from volcontact.report.findings import findings
from volcontact.report.page import label_of, page, title_of
from volcontact.report.pictures import FramePair, png, side_by_side, write_frames
from volcontact.report.units import angle, area, digits, nominal, quantity, ratio

DESIGN = DesignPose(
    body="box",
    position=np.array([0.0, 0.0, 0.2]),
    quaternion=np.array([1.0, 0.0, 0.0, 0.0]),
    position_tolerance=1e-3,
    angle_tolerance=0.1,
    speed_tolerance=1e-3,
)


LARGER = "larger of: volcontact/material/steel, volcontact/material/tin"


def floor_pair(index: int, geom: str, friction: float, source: str = LARGER) -> dict:
    return {
        "pair": index,
        "geom_a": geom,
        "geom_b": "floor",
        "id_a": index,
        "engine": "clip",
        "friction": friction,
        "sources": {"friction": source},
    }


def recording(contact: str = "volumetric", **changes) -> Recording:
    """A box that sinks from 0.5 m to 0.2 m in 2 s and then lies still: 101 rows."""
    n = 101
    time = np.linspace(0.0, 2.0, n)
    height = np.maximum(0.5 - 0.3 * time, 0.2)
    position = np.zeros((n, 1, 3))
    position[:, 0, 2] = height
    quaternion = np.tile([1.0, 0.0, 0.0, 0.0], (n, 1, 1))
    touching = height <= 0.2
    sites = np.zeros(2, SITE)
    sites["normal"] = (0.0, 0.0, 1.0)
    sites["force"] = (0.0, 0.0, 50.0)
    sites["area"] = 0.01
    sites["depth"] = 1e-5
    potential = 100.0 * height
    dissipated = np.zeros((n, 4))
    dissipated[:, 0] = potential[0] - potential
    values = dict(
        contact=contact,
        timestep=0.02,
        bodies=("box",),
        time=time,
        qpos=np.hstack([position[:, 0], quaternion[:, 0]]),
        qvel=np.zeros((n, 6)),
        position=position,
        quaternion=quaternion,
        speed=np.where(touching, 0.0, 0.3)[:, None],
        spin=np.zeros((n, 1)),
        kinetic=np.zeros(n),
        potential=potential,
        elastic=np.zeros(n),
        dissipated=dissipated,
        contact_force=np.where(touching, 100.0, 0.0),
        largest_site_force=np.where(touching, 50.0, 0.0),
        site_count=np.where(touching, 2, 0),
        penetration=np.where(touching, 1e-5, 0.0),
        step_microseconds=np.full(n - 1, 20.0),
        warnings={},
        stopped=None,
        dropped=0,
        frames=(Frame(0, 0.0, sites[:0]), Frame(n - 1, 2.0, sites)),
        description={
            "options": {"tolerance": 1e-3, "engine": "auto"},
            "materials": {
                "steel": {
                    "key": "volcontact/material/steel",
                    "stiffness": 2e8,
                    "damping": 0.5,
                    "geoms": ["foot", "lid"],
                }
            },
            "pairs": [
                *(floor_pair(i, f"foot_{i}", friction=0.1) for i in range(20)),
                floor_pair(20, "lid", friction=0.2, source="of pair lid"),
            ],
            "warnings": ["the handle touches nothing"],
        },
        weight=100.0,
    )
    return Recording(**{**values, **changes})


def comparison(**changes) -> Comparison:
    values = dict(
        scene="models/battery_box/scene.xml",
        volumetric=recording(),
        native=recording("native"),
        design=DESIGN,
        mujoco_version="9.9.9",
        volcontact_version="1.2.3",
    )
    return Comparison(**{**values, **changes})


def shifted(run: Recording, shift: tuple[float, float, float]) -> Recording:
    return dataclasses.replace(run, position=run.position + np.array(shift))


def sentence(made: Comparison, title: str) -> str:
    (text,) = (finding.text for finding in findings(made) if finding.title == title)
    return text


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.0, "m", "0 m"),
        (1.234e-3, "m", "1.23 mm"),
        (-4.5e-6, "m", "-4.50 µm"),
        (99.96e-3, "m", "100 mm"),
        (0.9999, "N", "1.00 N"),
        (14643743.0, "N", "14.6 MN"),
        (3.3e-12, "m/s", "less than 1 nm/s"),
        (float("nan"), "J", "nan J"),
    ],
)
def test_quantities_have_three_digits_and_a_prefix(value, unit, text):
    assert quantity(value, unit) == text


def test_other_numbers_read_well():
    assert nominal(1e-3, "m") == "1 mm"
    assert nominal(0.5, "s") == "500 ms"
    assert nominal(100.0, "N") == "100 N"
    assert area(0.0345) == "345 cm²"
    assert area(2.5) == "2.50 m²"
    assert area(3e-6) == "3.00 mm²"
    assert digits(12345.6) == "12346"
    assert digits(0.0) == "0"
    assert angle(0.0123) == "0.0123°"
    assert angle(2e-14) == "less than 0.001°"
    assert angle(0.0) == "0°"
    assert ratio(10.0, 2.0) == "5.00 times as large"
    assert ratio(2.0, 10.0) == "5.00 times smaller"
    assert ratio(1.0, 1.01) == "about the same"
    assert ratio(1.0, 0.0) == "not comparable"


@pytest.mark.parametrize("degrees", [1e-7, 0.05, 30.0, 179.0])
def test_angle_between_is_exact_for_small_and_large_turns(degrees):
    # A turn by angle about a unit axis is (cos angle/2, sin angle/2 axis), seen from any start.
    half = np.radians(degrees) / 2
    turn = np.array([np.cos(half), *(np.sin(half) * np.array([2.0, -1.0, 2.0]) / 3.0)])
    identity = np.array([1.0, 0.0, 0.0, 0.0])
    assert angle_between(identity, turn) == pytest.approx(degrees, rel=1e-9)
    assert angle_between(turn, identity) == pytest.approx(degrees, rel=1e-9)
    assert angle_between(identity, -turn) == pytest.approx(degrees, rel=1e-9)


EXPECTED = {
    "body": "box",
    "design_position": [1, 2, 3],
    "design_quaternion": [1, 0, 0, 0],
    "position_tolerance": 2e-3,
    "angle_tolerance_degrees": 0.2,
    "speed_tolerance": 3e-3,
}


def test_design_pose_is_read_from_beside_the_scene(tmp_path):
    scene = tmp_path / "scene.xml"
    assert read_design_pose(scene) is None
    assert read_design_pose("<mujoco/>") is None
    content = {"scenes": {"scene.xml": EXPECTED, "other.xml": {"duration": 1.0}}}
    (tmp_path / "expected.json").write_text(json.dumps(content))
    pose = read_design_pose(scene)
    assert pose.body == "box"
    assert pose.position.tolist() == [1.0, 2.0, 3.0]
    assert pose.quaternion.tolist() == [1.0, 0.0, 0.0, 0.0]
    assert (pose.position_tolerance, pose.angle_tolerance) == (2e-3, 0.2)
    assert pose.speed_tolerance == 3e-3
    assert read_design_pose(tmp_path / "other.xml") is None
    assert read_design_pose(tmp_path / "third.xml") is None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (None, r"expected\.json: cannot be read"),
        ({"design_position": [1, 2]}, r"expected\.json: cannot be read"),
        ({"design_quaternion": "up"}, r"expected\.json: cannot be read"),
    ],
)
def test_unreadable_design_pose_names_its_file(tmp_path, change, message):
    text = "{" if change is None else json.dumps({"scenes": {"scene.xml": {**EXPECTED, **change}}})
    (tmp_path / "expected.json").write_text(text)
    with pytest.raises(ValueError, match=message):
        read_design_pose(tmp_path / "scene.xml")


def test_incomplete_design_pose_names_what_is_missing(tmp_path):
    content = {"scenes": {"scene.xml": {k: v for k, v in EXPECTED.items() if k != "body"}}}
    (tmp_path / "expected.json").write_text(json.dumps(content))
    with pytest.raises(ValueError, match=r"expected\.json: scene\.xml has no 'body'"):
        read_design_pose(tmp_path / "scene.xml")


def test_seated_needs_place_angle_rest_and_a_whole_run():
    run = recording()
    assert is_seated(run, DESIGN)
    assert is_seated(shifted(run, (0.0009, 0.0, 0.0)), DESIGN)
    assert not is_seated(shifted(run, (0.0011, 0.0, 0.0)), DESIGN)
    assert not is_seated(dataclasses.replace(run, speed=run.speed + 0.002), DESIGN)
    assert not is_seated(dataclasses.replace(run, stopped="bad numbers"), DESIGN)
    half = np.radians(0.2) / 2
    tilt = np.tile([np.cos(half), np.sin(half), 0.0, 0.0], (101, 1, 1))
    tilted = dataclasses.replace(run, quaternion=tilt)
    assert not is_seated(tilted, DESIGN)
    assert offset_from(tilted, DESIGN).angle[-1] == pytest.approx(0.2)


def test_design_pose_of_an_unknown_body_names_the_known_ones():
    with pytest.raises(ValueError, match="'lid', the moving bodies are: box"):
        offset_from(recording(), dataclasses.replace(DESIGN, body="lid"))


def test_figures_of_a_run():
    run = recording()
    assert first_touch(run) == pytest.approx(1.0)
    assert first_touch(dataclasses.replace(run, site_count=np.zeros(101, int))) is None
    assert np.abs(unbalance(run)).max() < 1e-12
    assert largest_rise(np.array([5.0, 3.0, 4.5, 1.0, 2.0])) == 1.5
    assert largest_rise(np.array([3.0, 2.0, 1.0])) == 0.0


def test_summary_has_the_documented_keys():
    summary = comparison().summary()
    keys = {
        "steps",
        "dt",
        "microseconds_per_step",
        "max_penetration",
        "final_qpos",
        "energy_initial",
        "energy_final",
        "max_contact_sites",
        "warnings",
    }
    assert keys <= set(summary["volumetric"])
    assert set(summary["volumetric"]) == set(summary["native"])
    assert (summary["mujoco_version"], summary["volcontact_version"]) == ("9.9.9", "1.2.3")
    native = summary["native"]
    assert (native["steps"], native["dt"], native["microseconds_per_step"]) == (100, 0.02, 20.0)
    assert native["final_qpos"] == [0.0, 0.0, 0.2, 1.0, 0.0, 0.0, 0.0]
    assert native["energy_final"] == pytest.approx(20.0)
    assert native["max_contact_sites"] == 2
    assert native["design_pose"]["seated"] is True


def test_findings_say_who_seats():
    made = comparison(native=shifted(recording("native"), (0.0, 0.0, 0.13)))
    first = findings(made)[0]
    assert (first.title, first.verdict) == ("Seating", "good")
    assert "Volumetric contact seats the box: it ends 0 m and 0° from" in first.text
    assert "Native contact does not seat the box: it ends 130 mm and 0° from" in first.text
    assert "within 1 mm and 0.1°, slower than 1 mm/s" in first.text
    failed = comparison(volumetric=shifted(recording(), (0.0, 0.0, 0.13)))
    assert findings(failed)[0].verdict == "bad"


def test_findings_compare_pose_force_depth_places_energy_and_cost():
    native = shifted(recording("native"), (0.003, 0.004, -0.012))
    native = dataclasses.replace(
        native,
        contact_force=10.0 * native.contact_force,
        penetration=4.0 * native.penetration,
        site_count=4 * native.site_count,
        step_microseconds=0.5 * native.step_microseconds,
        kinetic=np.where(native.time > 1.5, 7.0, 0.0),
    )
    made = comparison(native=native)
    pose = sentence(made, "Final pose")
    assert "ends 13.0 mm and 0° apart" in pose  # 3-4-12-13
    assert "12.0 mm lower than under volumetric contact and 5.00 mm to the side" in pose
    force = sentence(made, "Contact force")
    assert "begins at 1.00 s and peaks with 100 N" in force
    assert "1.00 times the weight of 100 N" in force
    assert "The native peak is 10.0 times as large." in force
    depth = sentence(made, "Penetration")
    assert "10.0 µm under volumetric and 40.0 µm under native" in depth
    assert "native 4.00 times as large" in depth
    places = sentence(made, "Contact places")
    assert "At most 2 sites at once under volumetric and 8 contact points" in places
    assert "200 cm²" in places
    energy = sentence(made, "Energy")
    assert "30.0 J are dissipated (normal 30.0 J)" in energy
    assert "loses 23.0 J" in energy  # 30 J of height less the 7 J of motion that appear
    assert "it once stood 7.00 J above an earlier value" in energy
    assert "20.0 µs under volumetric and 10.0 µs" in sentence(made, "Cost")
    assert "2.00 times" in sentence(made, "Cost")


def test_findings_say_what_did_not_come_to_rest():
    moving = dataclasses.replace(recording("native"), speed=np.full((101, 1), 0.05))
    text = sentence(comparison(native=moving), "Rest")
    assert "Volumetric contact ends at rest, at 0 m/s, slower than 1 mm/s since 1.00 s." in text
    assert "Native contact ends still moving, at 50.0 mm/s." in text


def test_trouble_comes_first():
    bad = dataclasses.replace(recording("native"), warnings={"BADQACC": 3}, stopped="gone at 1 s")
    lost = dataclasses.replace(recording(), dropped=4)
    assert findings(comparison(volumetric=lost))[0].title == "Forces left out"
    assert "in 4 evaluations" in sentence(comparison(volumetric=lost), "Forces left out")
    titles = [finding.title for finding in findings(comparison(native=bad))]
    assert titles[:2] == ["Stopped", "MuJoCo warnings"]
    assert "BADQACC 3 times" in sentence(comparison(native=bad), "MuJoCo warnings")


def test_runs_that_never_touch_or_have_no_weight_are_described():
    free = dict(
        site_count=np.zeros(101, int),
        contact_force=np.zeros(101),
        largest_site_force=np.zeros(101),
        penetration=np.zeros(101),
        weight=0.0,
        frames=(),
    )
    made = comparison(volumetric=recording(**free), native=recording("native", **free), design=None)
    assert "nothing touches" in sentence(made, "Contact force")
    assert "never" in page(made, [])


def test_thinned_curve_keeps_its_peaks():
    x = np.linspace(0.0, 1.0, 10_001)
    y = np.sin(20 * x)
    y[7003] = 99.0
    y[7004] = -99.0
    few_x, few_y = thin(x, y, points=200)
    assert len(few_x) <= 202
    assert (few_y.max(), few_y.min()) == (99.0, -99.0)
    assert few_x[few_y.argmax()] == x[7003]
    assert (few_x[0], few_x[-1]) == (x[0], x[-1])
    assert np.all(np.diff(few_x) > 0)


def test_curves_take_their_colours_from_the_page_and_repeat_exactly():
    made = curves(comparison())
    names = [curve.name for curve in made]
    assert names[:2] == ["height", "offset"]
    assert {"force", "penetration", "energy_volumetric", "sites", "timing"} <= set(names)
    assert "offset" not in [curve.name for curve in curves(comparison(design=None))]
    for curve in made:
        assert curve.svg.startswith("<svg")
        assert curve.svg.rstrip().endswith("</svg>")
        assert "var(--muted)" in curve.svg
        assert not re.search(r"#0[123]0[123]0[123]", curve.svg)
    assert [curve.svg for curve in made] == [curve.svg for curve in curves(comparison())]


def pair(with_native: bool = True) -> FramePair:
    picture = np.random.default_rng(1).integers(0, 255, (30, 40, 3), dtype=np.uint8)
    return FramePair(0.2, picture, picture if with_native else None, ("2 contacts", "no contact"))


def test_page_is_one_file_that_asks_nobody():
    text = page(comparison(), [pair(), pair(with_native=False)])
    addresses = set(re.findall(r"https?://[^\"' >]+", text))
    assert all(address.startswith("http://www.w3.org/") for address in addresses)  # XML names
    assert not re.search(r"<link[^>]+href=\"(?!data:)|src=\"(?!data:|\")|@import|<script src", text)
    ids = re.findall(r'\bid="([^"]+)"', text)
    assert len(ids) == len(set(ids))
    assert set(re.findall(r"url\(#([^)]+)\)", text)) <= set(ids)
    assert "prefers-color-scheme: dark" in text
    assert 'name="viewport"' in text


def test_page_shows_settings_parameters_with_units_and_warnings():
    text = page(comparison(), [])
    for expected in (
        "<h1>Battery box</h1>",
        "9.9.9",
        "1.2.3",
        "<dd>20 ms</dd>",
        "stiffness [N/m³]",
        "2e+08",
        "damping [s/m]",
        "the handle touches nothing",
        "17 more",
    ):
        assert expected in text
    assert "<script" not in text  # nothing to play without pictures


def test_page_escapes_what_the_user_wrote():
    text = page(comparison(scene="a<b>x</b>.xml"), [])
    assert "<b>x</b>" not in text
    assert "a&lt;b&gt;x&lt;/b&gt;.xml" in text


@pytest.mark.parametrize(
    ("scene", "title"),
    [
        ("models/battery_box/scene.xml", "Battery box"),
        ("a/peg-in_hole.xml", "Peg in hole"),
        ("<mujoco/>", "Scene"),
    ],
)
def test_title_comes_from_folder_or_file(scene, title):
    assert title_of(scene) == title


def test_label_keeps_the_machine_to_itself():
    assert label_of("/home/me/project/mjcf_models/peg/scene.xml") == "mjcf_models/peg/scene.xml"
    assert label_of("../peg/scene.xml") == "../peg/scene.xml"
    assert label_of("<mujoco/>") == "MJCF text"


def test_description_becomes_tables():
    made = tables(recording().description)
    assert [table.title for table in made] == ["Options", "Materials", "Pairs"]
    options, materials, pairs = made
    assert options.rows == (("tolerance", "0.001", "-"), ("engine", "auto", ""))
    assert materials.columns == ("name", "geoms", "stiffness [N/m³]", "damping [s/m]")
    assert materials.rows == (("steel", "foot, lid", "2e+08", "0.5"),)
    assert pairs.columns == ("pairs", "geoms", "friction [-]", "sources")
    geoms = "foot_0 with floor, foot_1 with floor, foot_2 with floor and 17 more"
    assert pairs.rows[0] == ("20", geoms, "0.1", "friction larger of: steel, tin")
    assert pairs.rows[1] == ("1", "lid with floor", "0.2", "friction of pair lid")
    assert tables(recording().description, sources=False)[2].columns == pairs.columns[:3]


def test_tables_say_once_what_all_rows_share():
    materials, pairs = tables(recording().description)[1:]
    assert materials.note == ""  # a single row keeps its columns
    assert pairs.note == "all: engine clip"
    pair = {"geom_a": "a", "geom_b": "b", "engine": "clip"}
    stiff = [{**pair, "stiffness": 5e9, "friction": mu} for mu in (0.1, 0.2)]
    (table,) = tables({"pairs": stiff, "nothing": [], "mujoco_version": "9"})
    assert table.note == "all: engine clip, stiffness 5e+09 N/m³"


def test_values_read_well():
    assert text(None) == ""
    assert text(True) == "yes"
    assert text(10_000_000_000) == "1e+10"
    assert text((1.0, 2.5)) == "1, 2.5"
    assert text(["a", "b", "c", "d"]) == "a, b, c, d"
    assert text(["a", "b", "c", "d", "e"]) == "a, b, c and 2 more"
    assert text("in series: volcontact/material/a, volcontact/material/b") == "in series: a, b"


def test_picture_files_replace_those_of_a_longer_run(tmp_path):
    write_frames([pair(), pair(), pair()], tmp_path)
    paths = write_frames([pair(), pair(with_native=False)], tmp_path)
    assert [path.name for path in paths] == ["frame_0000.png", "frame_0001.png"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["frame_0000.png", "frame_0001.png"]
    sheet = side_by_side(pair())
    assert sheet.width >= 2 * 40
    assert sheet.height > 30
    assert png(pair().volumetric, colors=16).startswith(b"\x89PNG")


def test_report_writes_every_file(tmp_path):
    made = comparison()
    report = write_report(made, tmp_path / "new" / "folder", renderer=None)
    assert report == tmp_path / "new" / "folder" / "report.html"
    assert report.read_text(encoding="utf-8").startswith("<!doctype html>")
    assert json.loads((report.parent / "summary.json").read_text()) == made.summary()
    table = pq.read_table(report.parent / "trajectory.parquet")
    assert table.num_rows == 202
    assert table.column("contact").to_pylist()[::101] == ["volumetric", "native"]
    np.testing.assert_array_equal(table.column("box.z")[:101], made.volumetric.height[:, 0])
    np.testing.assert_array_equal(
        table.column("dissipated_normal")[:101], made.volumetric.dissipated[:, 0]
    )
    assert table.schema.field("penetration").metadata == {b"unit": b"m"}
    assert table.column("qpos")[100].as_py() == [0.0, 0.0, 0.2, 1.0, 0.0, 0.0, 0.0]
