# SPDX-License-Identifier: Apache-2.0
"""The report: curves, a page that needs nothing, files."""

import csv
import dataclasses
import functools
import json
import re
import xml.etree.ElementTree as ElementTree

import imageio_ffmpeg
import numpy as np
import pyarrow.parquet as pq
import pytest
from PIL import Image
from reports import comparison, pair

from volcontact.report import write_report
from volcontact.report.figures import curves, thin, write_figures
from volcontact.report.page import label_of, page, title_of
from volcontact.report.pictures import png, side_by_side, write_frames, write_movie
from volcontact.report.table import write_table


@functools.cache
def drawn():
    return curves(comparison())


def page_of(made, pairs=()):
    return page(made, list(pairs), drawn())


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


@pytest.mark.once
def test_curves_take_their_colours_from_the_page_and_repeat_exactly():
    made = drawn()
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


def test_page_is_one_file_that_asks_nobody():
    text = page_of(comparison(), [pair(), pair(with_native=False)])
    addresses = set(re.findall(r"https?://[^\"' >]+", text))
    assert all(address.startswith("http://www.w3.org/") for address in addresses)  # XML names
    assert not re.search(r"<link[^>]+href=\"(?!data:)|src=\"(?!data:|\")|@import|<script src", text)
    ids = re.findall(r'\bid="([^"]+)"', text)
    assert len(ids) == len(set(ids))
    assert set(re.findall(r"url\(#([^)]+)\)", text)) <= set(ids)
    assert "prefers-color-scheme: dark" in text
    assert 'name="viewport"' in text


def test_page_shows_settings_parameters_with_units_and_warnings():
    text = page_of(comparison())
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
    assert 'id="slider"' not in text  # nothing to play without pictures


def test_page_escapes_what_the_user_wrote():
    text = page_of(comparison(scene="a<b>x</b>.xml"))
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
    sites = pq.read_table(report.parent / "sites.parquet")
    assert sites.num_rows == len(made.volumetric.sites) + len(made.native.sites)
    assert sites.column("geom_b")[0].as_py() == "box"
    assert sites.schema.field("torque_y").metadata == {b"unit": b"N m"}


def test_csv_files_hold_what_the_parquet_files_hold(tmp_path):
    write_table(comparison().runs, tmp_path / "trajectory.parquet")
    for name in ("trajectory", "sites"):
        table = pq.read_table(tmp_path / f"{name}.parquet")
        with (tmp_path / f"{name}.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        assert len(rows) == table.num_rows
        assert rows[-1]["time [s]"] == str(table.column("time")[-1].as_py()).removesuffix(".0")
    assert rows[0]["force_z [N]"] == "50"


def test_every_figure_is_a_file_that_stands_alone(tmp_path):
    made = curves(comparison())[:2]
    files = write_figures(made, tmp_path)
    assert {file.name for file in files} == {
        f"{curve.name}.{suffix}" for curve in made for suffix in ("svg", "png")
    }
    for file in files:
        if file.suffix == ".png":
            with Image.open(file) as picture:
                assert picture.width > 600 and picture.convert("L").getextrema() != (255, 255)
        else:
            text = file.read_text(encoding="utf-8")
            ElementTree.fromstring(text)
            assert "var(--" not in text and '<rect width="100%"' in text


def test_film_has_one_picture_a_frame_and_the_time_of_the_run(tmp_path):
    pairs = [dataclasses.replace(pair(), time=0.2 * i) for i in range(5)]
    path = tmp_path / "run.mp4"
    assert write_movie(pairs, path)
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(str(path))
    assert frames == 5
    assert seconds == pytest.approx(1.0, abs=0.05)  # the last one stands as long as the others
    assert not write_movie(pairs[:1], path) and not path.exists()


def test_numbers_of_the_curves_stand_in_the_page():
    made = comparison()
    text = page_of(made)
    data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.DOTALL).group(1))
    height = data["curves"]["height"]
    assert [series["label"] for series in height["series"]] == ["volumetric", "native"]
    assert height["series"][0]["y"][-1] == 0.2
    assert 0.0 < height["left"] < 0.3 and 0.9 < height["right"] <= 1.0
    assert (height["start"], height["end"]) == (0.0, 2.0)
    rows = data["sites"]["volumetric"]
    assert rows[0] == []
    assert rows[1][0] == ["floor with box", "50.0 N", "0 N", "2.00 N m", "10.0 µm", "100 cm²"]
