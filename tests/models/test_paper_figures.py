# SPDX-License-Identifier: Apache-2.0
"""mjcf_models/make_paper_figures.py: every figure is drawn, here from short runs."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

SCRIPT = Path(__file__).parents[2] / "mjcf_models" / "make_paper_figures.py"


@pytest.fixture(scope="module")
def figures():
    spec = importlib.util.spec_from_file_location("make_paper_figures", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def check(paths: list[Path], names: list[str]) -> None:
    assert [path.name for path in paths] == names
    for path in paths:
        picture = np.asarray(Image.open(path).convert("L"))
        assert min(picture.shape) > 300
        assert picture.std() > 5.0  # not a blank sheet


def test_ball(figures, tmp_path: Path):
    check(figures.ball_path(tmp_path, 0.5), ["ball_path_xyz.png", "ball_path_xy.png"])


def test_tippe_top(figures, tmp_path: Path):
    check(figures.tippe_top_tilt(tmp_path, 0.1), ["tippe_top_tilt.png"])


def test_battery_box_falls_from_its_start(figures, tmp_path: Path):
    check(figures.battery_box_frames(tmp_path, 2), ["battery_box.png"])
    rows = figures.watched("battery_box/scene.xml", 0.2, 0.1, lambda d: (d.qpos[2],))
    assert rows[0, 1] - rows[-1, 1] == pytest.approx(0.5 * 9.81 * 0.2**2, rel=0.5)  # it falls


def test_events_are_those_of_the_tilt(figures):
    time = np.linspace(0.0, 8.0, 8001)
    tilt = np.interp(time, [0.0, 0.2, 1.5, 2.0, 4.0, 6.0, 8.0], [0.1, 0.0, 2.0, 3.0, 2.9, 1.9, 1.5])
    upright, touches, falls = figures._events(time, tilt)
    assert time[upright] == pytest.approx(0.2, abs=2e-3)
    assert tilt[touches] == pytest.approx(np.arccos(-10.0 / 13.0), abs=3e-3)  # acos((5 - 15)/13)
    assert tilt[falls] == pytest.approx(np.radians(120.0), abs=2e-3)
