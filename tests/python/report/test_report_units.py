# SPDX-License-Identifier: Apache-2.0
"""Numbers as people write them."""

import numpy as np
import pytest
from reports import recording

from volcontact.report.description import tables, text
from volcontact.report.design_pose import angle_between
from volcontact.report.units import angle, area, digits, nominal, quantity, ratio


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
