# SPDX-License-Identifier: Apache-2.0
"""The folder of `run --out` in the viewers: recorded forces, scrubbing, clips, and no stepping."""

import re
from pathlib import Path

import imageio_ffmpeg
import mujoco
import numpy as np
import pytest
from view_pages import BLUE, happens, like, needs_browser, page, shot
from view_windows import has_window, picture_of_window

from volcontact.cli import main
from volcontact.running.driving import Drive
from volcontact.running.simulation import simulate
from volcontact.view.playback import stride
from volcontact.view.recorded import open_recorded

__all__ = ["page"]  # a fixture
# A block of 1 kg at rest on a slope: gravity leans. Friction holds it by what its springs keep.
SLOPE = """
<mujoco>
  <option timestep="0.001" gravity="-2.8990 0 -9.3719"/>
  <statistic center="0 0 0.1" extent="0.5"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1" rgba="0.9 0.9 0.9 1"/>
    <body name="block" pos="0 0 0.1"><freejoint/>
      <geom type="box" size=".1 .1 .1" mass="1" rgba="0.8 0.8 0.8 1"/></body>
  </worldbody>
  <keyframe><key name="aside" qpos="-0.15 0 0.1 1 0 0 0"/></keyframe>
  <custom>
    <numeric name="volcontact/option/implicit/auto" data="1"/>
  </custom>
</mujoco>
"""
SLIDE = '<joint type="slide"/>'
ALONG, ACROSS = 2.8990, 9.3719  # what holds the block along the slope and across it [N]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A run of 0.4 s in `results`, and its scene."""
    monkeypatch.chdir(tmp_path)
    Path("slope.xml").write_text(SLOPE)
    run = ["run", "slope.xml", "--duration", "0.4", "--out", "results", "--keyframe", "aside"]
    assert main(run) == 0
    return tmp_path / "results"


@pytest.fixture
def stage(folder):
    with open_recorded(folder) as stage:
        yield stage


@pytest.fixture
def no_steps(monkeypatch):
    """Nothing may be stepped."""

    def refuse(*_):
        raise AssertionError("mj_step was called")

    monkeypatch.setattr(mujoco, "mj_step", refuse)


def test_friction_is_that_of_the_run_and_not_of_its_poses(stage):
    """The weight along the slope: springs that start anew at a pose carry none of it."""
    stage.show(0.4)
    sites, shapes = stage.contacts_of(stage.data)
    assert len(sites) == len(shapes) == 1 and not shapes[0].is_empty
    sign = 1.0 if stage.model.geom_bodyid[sites["geom_a"][0]] else -1.0
    assert sign * sites["force"][0] == pytest.approx([ALONG, 0.0, ACROSS], rel=1e-3)
    points, _ = shapes[0].patch
    assert points.min(axis=0)[:2] == pytest.approx(stage.data.qpos[:2] - 0.1, abs=2e-3)
    (drawing,) = stage.drawings()
    assert drawing.patch is not None and "9.37" in drawing.label


def test_every_instant_is_that_of_the_run(stage, request):
    assert len(stage.history) == 401 and not stage.can_pull
    drive = Drive(keyframe="aside")
    run = simulate("slope.xml", duration=0.4, frame_interval=None, drive=drive)
    request.getfixturevalue("no_steps")
    for row in (0, 137, 400):
        stage.show(run.time[row])
        assert stage.paused and stage.data.time == run.time[row]
        assert np.array_equal(stage.data.qpos, run.qpos[row])
        assert np.array_equal(stage.data.qvel, run.qvel[row])
        assert np.linalg.norm(stage.contacts_of(stage.data)[0]["force"], axis=1).sum() == (
            pytest.approx(run.contact_force[row], rel=1e-12)
        )


def test_a_long_run_is_thinned_and_a_short_one_is_not():
    assert stride(400, 1e-3) == 1
    assert stride(6000, 1e-3) == 8  # 120 pictures a second
    assert stride(1200, 1e-4) == 2


@pytest.mark.once
def test_the_two_runs_of_a_comparison_are_told_apart(folder):
    assert main(["compare", "slope.xml", "--duration", "0.1", "--no-frames", "--out", "both"]) == 0
    with open_recorded("both") as stage:
        assert stage.contact == "volumetric"
    with open_recorded("both", contact="native") as stage:
        stage.show(0.1)
        sites, shapes = stage.contacts_of(stage.data)
        assert stage.contact == "native" and len(sites) == 4 and len(shapes) == 0
        assert stage.data.ncon == 4
    with pytest.raises(ValueError, match="no run under native contact, but one under volumetric"):
        open_recorded(folder, contact="native")


def test_keys_of_the_command_line_hold_again(folder):
    """A mesh that is no solid is refused but for the option that the run was given."""
    text = SLOPE.replace(
        "<worldbody>",
        """<asset><mesh name="open" vertex="0 0 0  .1 0 0  0 .1 0  0 0 .1  .1 .1 .1"
        face="0 2 1  0 1 3  0 3 2"/></asset><worldbody>
        <geom type="mesh" mesh="open" pos="0.5 0.5 0"/>""",
    )
    Path("open.xml").write_text(text)
    run = ["run", "open.xml", "--duration", "0.01", "--out", "hull"]
    assert main(run) == 1
    assert main([*run, "--option", "mesh=exact_or_hull"]) == 0
    with pytest.warns(RuntimeWarning, match="no solid: open"), open_recorded("hull") as stage:
        assert len(stage.history) == 11


def test_a_scene_that_moved_or_changed_is_said(folder, capsys):
    scene = Path("slope.xml").rename("moved.xml")
    assert main(["view", "results", "--browser"]) == 1
    assert "is no longer at" in capsys.readouterr().err
    with open_recorded(folder, scene=scene) as stage:
        assert stage.history.end == pytest.approx(0.4)
    scene.write_text(SLOPE.replace("<freejoint/>", SLIDE).replace("-0.15 0 0.1 1 0 0 0", "0.2"))
    with pytest.raises(ValueError, match="7 numbers of qpos were recorded, the scene has 1"):
        open_recorded(folder, scene=scene)
    scene.write_text(SLOPE.replace('name="floor"', 'name="ground"'))
    with pytest.raises(ValueError, match="it has no geom 'floor'"):
        open_recorded(folder, scene=scene)


@pytest.mark.parametrize(
    ("arguments", "status", "said"),
    [
        (["empty"], 2, "empty holds no trajectory.parquet: `volcontact run SCENE --out empty`"),
        (["results", "--ctrl", "push=1"], 1, "--ctrl drives a scene, and results is a recorded"),
        (["results", "--record", "1"], 1, "--record drives a scene"),
        (["slope.xml", "--scene", "slope.xml"], 1, "--scene is for a folder"),
    ],
)
def test_what_makes_no_sense_is_said(arguments, status, said, folder, capsys):
    Path("empty").mkdir()
    try:
        got = main(["view", "--browser", *arguments])
    except SystemExit as error:
        got = error.code
    assert got == status
    assert said in " ".join(capsys.readouterr().err.split())


@pytest.mark.once
def test_view_of_a_folder_writes_a_clip(folder, capsys, no_steps):
    command = ["view", "results", "--browser", "--port", "8151", "--seconds", "0.5"]
    assert main([*command, "--speed", "0.5", "--clip", "run.mp4"]) == 0
    assert "written: run.mp4, 25 pictures" in capsys.readouterr().out  # 0.8 s and the first
    frames, _ = imageio_ffmpeg.count_frames_and_secs("run.mp4")
    assert frames == 25


@pytest.mark.soak
@needs_browser
def test_the_browser_shows_a_folder_and_scrubs_it(page, stage, no_steps):
    """`./run test` has the window that shows it, and another browser in test_view.py."""
    shown, page, faults = page
    stage.show(0.4)
    assert happens(shown, lambda: like(shot(page, "recorded.png"), BLUE) > 3000)
    page.get_by_text(re.compile(r"friction 2\.9\d* N")).wait_for()
    slider = page.locator(".mantine-Slider-root").nth(1).bounding_box()
    page.mouse.click(slider["x"] + 0.5 * slider["width"], slider["y"] + 0.5 * slider["height"])
    assert happens(shown, lambda: stage.data.time < 0.3)
    assert stage.data.time == pytest.approx(0.2, abs=0.04) and stage.paused
    sent = []
    page.on("download", lambda download: sent.append(download))
    page.get_by_text("Save a clip").click()
    assert happens(shown, lambda: isinstance(page.title(), str) and bool(sent))
    sent[0].save_as("clip.mp4")
    frames, _ = imageio_ffmpeg.count_frames_and_secs("clip.mp4")
    assert frames == 13  # 0.4 s
    assert faults == []


@pytest.mark.once
@pytest.mark.skipif(not has_window, reason="MuJoCo has no viewer to draw into, or Xvfb is missing")
def test_the_window_shows_a_folder(folder, tmp_path):
    picture = picture_of_window(
        'open_recorded("results")', "stage.show(0.4)", "window_recorded.png", tmp_path
    )
    assert like(picture, BLUE) > 1000
