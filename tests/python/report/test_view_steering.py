# SPDX-License-Identifier: Apache-2.0
"""The viewer under somebody's hands: pulling at bodies, going back in time, clips."""

import os
import shutil
import subprocess
import sys
from ctypes.util import find_library

import imageio_ffmpeg
import mujoco
import numpy as np
import pytest
from view_pages import SCENE, happens, like, needs_browser, page, shot, stage

from volcontact.cli import main
from volcontact.view import Stage
from volcontact.view.clip import write_clip
from volcontact.view.hand import Hand
from volcontact.view.history import History, Snapshot
from volcontact.view.playback import record

__all__ = ["page", "stage"]  # fixtures
CRATE = 1
GREEN = (30, 140, 60)
DRIVEN = """
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body name="slider" pos="0 0 0.3">
      <joint name="slide" type="slide" axis="1 0 0" damping="1"/>
      <geom name="slider" type="sphere" size="0.05" mass="1"/>
    </body>
  </worldbody>
  <actuator><motor name="push" joint="slide"/></actuator>
  <keyframe><key name="aside" qpos="0.4"/></keyframe>
</mujoco>
"""


# ---- The hand ------------------------------------------------------------------------------------


@pytest.mark.skipif(not hasattr(mujoco.MjvPerturb(), "localmass"), reason="an older viewer's force")
def test_hand_pulls_as_the_mouse_does_in_mujocos_viewer():
    """At rest: MuJoCo's own force, by its own function."""
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = mujoco.MjData(model)
    data.qpos[3:7] = np.array([0.9, 0.1, 0.3, 0.2]) / np.sqrt(0.95)
    mujoco.mj_forward(model, data)
    point, target = np.array([0.1, -0.05, 0.08]), np.array([0.3, 0.2, 0.5])
    pull = mujoco.MjvPerturb()
    pull.select, pull.localpos, pull.active = 1, point, int(mujoco.mjtPertBit.mjPERT_TRANSLATE)
    scene = mujoco.MjvScene(model, 100)
    camera, option = mujoco.MjvCamera(), mujoco.MjvOption()
    mujoco.mjv_updateScene(model, data, option, pull, camera, 7, scene)
    mujoco.mjv_initPerturb(model, data, scene, pull)
    pull.refselpos = target
    mujoco.mjv_applyPerturbForce(model, data, pull)
    expected = data.xfrc_applied[1].copy()
    data.xfrc_applied[:] = 0.0
    hand = Hand()
    hand.take(CRATE, point)
    hand.move(target)
    hand.apply(model, data)
    assert data.xfrc_applied[1] == pytest.approx(expected, rel=1e-9)


def test_a_hand_holds_a_weight_by_the_stretch_of_its_spring(stage):
    """m g = k m' s; in the middle of a face the mass that is felt is half of the cube's.

    The mobilities there are 1/m along the normal and 1/m + (a/2)^2 / (m a^2 / 6) across.
    """
    stage.hand.take(CRATE, np.array([0.0, 0.0, 0.1]))
    stage.hand.move(np.array([0.0, 0.0, 0.6]))
    stage.step(4000)
    held, target = stage.hand.ends(stage.data)
    assert target - held == pytest.approx([0.0, 0.0, 9.81 / (100.0 * 0.5)], abs=1e-6)
    stage.hand.let_go()
    stage.step(3000)
    (drawing,) = stage.drawings()
    assert drawing.normal[2] == 1.0 and stage.data.qpos[2] < 0.1


def test_a_hand_leaves_other_forces_alone(stage):
    stage.data.xfrc_applied[1] = 1.0, 2.0, 3.0, 0.0, 0.0, 0.0
    stage.hand.take(CRATE, np.zeros(3))
    stage.hand.move(np.array([0.1, 0.0, 0.3]))
    stage.step(10)
    assert stage.data.xfrc_applied[1] == pytest.approx([1.0, 2.0, 3.0, 0.0, 0.0, 0.0], abs=1e-12)
    assert stage.data.qvel[2] > 0.0


# ---- History -------------------------------------------------------------------------------------


def test_going_back_and_on_gives_the_same_bits(stage):
    stage.step(300)  # it has landed and slides on
    stage.data.qvel[0] = 0.5
    stage.step(50)
    time = stage.data.time
    stage.step(100)
    state = stage.data.qpos.copy(), stage.data.qvel.copy()
    stage.show(time)
    assert stage.paused and stage.data.time == time
    stage.step(100)
    assert np.array_equal(stage.data.qpos, state[0]) and np.array_equal(stage.data.qvel, state[1])


def test_what_was_seen_later_is_forgotten_when_the_scene_goes_another_way(stage):
    for _ in range(5):
        stage.step(10)
    assert len(stage.history) == 6 and stage.history.end == pytest.approx(0.05)
    stage.show(0.021)
    assert stage.data.time == pytest.approx(0.02)
    stage.step(3)
    assert stage.history.end == pytest.approx(0.023)
    stage.reset()
    assert len(stage.history) == 1 and stage.history.end == 0.0


def test_history_forgets_its_oldest_where_memory_ends():
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = mujoco.MjData(model)
    size = Snapshot(data).size
    history = History(most_bytes=3.5 * size)
    with pytest.raises(ValueError, match="nothing is recorded"):
        history.at(0.0)
    for i in range(6):
        data.time = 0.1 * i
        history.add(Snapshot(data))
    assert len(history) == 3 and history.begin == pytest.approx(0.3)
    assert [history.at(t) for t in (0.0, 0.34, 0.36, 9.0)] == [0, 0, 1, 2]


def test_record_steps_as_simulate_does_and_is_driven():
    from volcontact.running.driving import Drive
    from volcontact.running.simulation import simulate

    drive = Drive(keyframe="aside", controls={"push": 2.0})
    run = simulate(DRIVEN, duration=0.4, drive=drive, frame_interval=None)
    with record(DRIVEN, 0.4, drive=drive) as stage:
        assert stage.data.qpos[0] == 0.4 and not stage.can_pull
        stage.show(9.0)
        assert stage.data.time == pytest.approx(0.4) and stage.data.qpos[0] == run.qpos[-1, 0]
        stage.show(0.2)
        row = int(np.argmin(np.abs(run.time - stage.data.time)))
        assert stage.data.qpos[0] == run.qpos[row, 0]
    with Stage(DRIVEN, drive=drive) as live:
        live.step(200)
        assert live.data.qpos[0] == run.qpos[-1, 0]


def test_home_and_end_go_through_what_was_seen(stage):
    from volcontact.view.window import _Keys

    keys = _Keys(stage)
    for _ in range(3):
        stage.step(5)
    keys(268)
    assert stage.data.time == pytest.approx(0.010) and stage.paused
    keys(268)
    keys(269)
    keys(269)
    keys(269)  # there is no more
    assert stage.data.time == pytest.approx(0.015)


# ---- Clips ---------------------------------------------------------------------------------------


def test_a_clip_has_what_was_seen_at_the_speed_of_the_viewer(stage, tmp_path):
    path = tmp_path / "seen.mp4"
    for _ in range(20):
        stage.step(10)
    before = stage.data.qpos.copy(), stage.data.time
    stage.speed = 0.5
    # 0.2 s at half of the speed are 0.4 s of 30 pictures each.
    assert write_clip(stage, path, size=(320, 240)) == 13
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(str(path))
    assert frames == 13 and seconds == pytest.approx(13 / 30, abs=0.02)
    assert np.array_equal(stage.data.qpos, before[0]) and stage.data.time == before[1]
    with pytest.raises(ValueError, match=r"must end in \.mp4"):
        write_clip(stage, tmp_path / "seen.avi")


@pytest.mark.parametrize(
    ("name", "said"), [("seen.gif", "must end in .mp4"), ("no/seen.mp4", "no such folder: no")]
)
def test_a_clip_that_cannot_be_is_refused_at_once(name, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.xml").write_text(SCENE)
    with pytest.raises(SystemExit):
        main(["view", "scene.xml", "--browser", "--clip", name])
    assert said in capsys.readouterr().err


def test_view_starts_where_it_is_told_and_writes_a_clip(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.xml").write_text(DRIVEN)
    command = ["view", "scene.xml", "--browser", "--port", "8141", "--seconds", "0.5"]
    command += ["--keyframe", "aside", "--ctrl", "push=1", "--record", "0.2", "--clip", "run.mp4"]
    assert main(command) == 0
    assert "written: run.mp4, 7 pictures" in capsys.readouterr().out
    assert (tmp_path / "run.mp4").stat().st_size > 1000
    assert main([*command[:-8], "--keyframe", "asude"]) == 1
    assert "no keyframe 'asude'; did you mean" in capsys.readouterr().err


# ---- With a mouse --------------------------------------------------------------------------------


@pytest.mark.soak
@needs_browser
def test_the_mouse_pulls_at_a_body_in_the_browser(page, stage, tmp_path, monkeypatch):
    """`./run test` has the hand without a mouse, above, and another browser in test_view.py."""
    monkeypatch.chdir(tmp_path)
    shown, page, faults = page
    height = stage.data.qpos[2]
    stage.paused = False
    shown.run(seconds=1.0)
    page.mouse.move(345, 190)  # on the crate
    page.mouse.down()
    for i in range(1, 9):
        page.mouse.move(345, 190 - 20 * i)
        shown.run(seconds=0.2)
    assert happens(
        shown, lambda: stage.hand.grip is not None and stage.data.qpos[2] > height + 5e-3
    )
    assert stage.hand.grip.geom == CRATE
    assert happens(shown, lambda: like(shot(page, "pulled.png"), GREEN) > 100)
    page.mouse.up()
    assert happens(shown, lambda: stage.hand.grip is None)
    assert happens(shown, lambda: stage.data.qpos[2] < height + 1e-3)
    assert faults == []


@pytest.mark.once
@needs_browser
def test_the_slider_goes_back_in_time_and_a_clip_is_sent(page, stage, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shown, page, faults = page
    stage.reset()
    for _ in range(25):
        stage.step(8)
    assert happens(shown, lambda: page.get_by_text("t = 0.200 s").count() > 0)
    slider = page.locator(".mantine-Slider-root").nth(1).bounding_box()
    across = slider["x"] + 0.5 * slider["width"]
    page.mouse.click(across, slider["y"] + 0.5 * slider["height"])
    assert happens(shown, lambda: stage.data.time < 0.15)
    assert stage.data.time == pytest.approx(0.1, abs=0.02) and stage.paused
    assert len(stage.history) == 26
    sent = []
    page.on("download", lambda download: sent.append(download))
    page.get_by_text("Save a clip").click()
    # Playwright hears of it when it is asked something.
    assert happens(shown, lambda: isinstance(page.title(), str) and bool(sent))
    path = tmp_path / "clip.mp4"
    sent[0].save_as(path)
    frames, _ = imageio_ffmpeg.count_frames_and_secs(str(path))
    assert frames == 7  # 0.2 s
    assert faults == []


has_window = (
    hasattr(mujoco, "Renderer")
    and shutil.which("Xvfb") is not None
    and find_library("Xtst") is not None
)
WINDOW = """
import ctypes, os, sys, threading, time
from ctypes.util import find_library
import mujoco.viewer
from volcontact.view import Stage, window

library, tests = (ctypes.CDLL(find_library(name)) for name in ("X11", "Xtst"))
library.XOpenDisplay.restype = ctypes.c_void_p
display = ctypes.c_void_p(library.XOpenDisplay(None))
unsigned = ctypes.c_ulong
control = library.XKeysymToKeycode(display, unsigned(0xFFE3))
windows, launch = [], mujoco.viewer.launch_passive

def launched(*arguments, **options):
    windows.append(launch(*arguments, **options))
    return windows[-1]

mujoco.viewer.launch_passive = launched

def event(kind, *numbers):
    getattr(tests, f"XTestFake{kind}Event")(display, *numbers, unsigned(0))
    library.XFlush(display)

def select():  # by a double click: two within a quarter of a second, as the viewer sees them
    for _ in range(20):
        event("Motion", -1, 340, 260)
        time.sleep(0.5)
        for pressed in (1, 0, 1, 0):
            event("Button", 1, pressed)
            time.sleep(0.02)
        time.sleep(1.5)
        if windows[0].perturb.select == 1:
            return
    os._exit(3)

def drag():
    time.sleep(5.0)
    select()
    event("Key", control, 1)
    event("Button", 3, 1)
    for i in range(1, 100):
        event("Motion", -1, 340, max(260 - 8 * i, 20))
        time.sleep(0.15)
        if stage.data.xfrc_applied[1, 2] > 5.0 and stage.data.qpos[2] > height + 1e-5:
            os._exit(0)
    os._exit(4)

with Stage(sys.argv[1]) as stage:
    stage.step(800)
    height = stage.data.qpos[2]
    threading.Thread(target=drag).start()
    window.show(stage)
"""


@pytest.mark.soak
@pytest.mark.skipif(not has_window, reason="no viewer to draw into, or Xvfb or libxtst6 is missing")
def test_the_mouse_pulls_at_a_body_in_mujocos_window(tmp_path):
    """`./run test` has the hand without a mouse, above."""
    (tmp_path / "scene.xml").write_text(SCENE)
    environment = {k: v for k, v in os.environ.items() if k not in ("MUJOCO_GL", "DISPLAY")}
    display = ["xvfb-run", "-a", "-s", "-screen 0 1200x900x24"]
    done = subprocess.run(
        [*display, sys.executable, "-c", WINDOW, str(tmp_path / "scene.xml")],
        check=False,
        env={**environment, "LIBGL_ALWAYS_SOFTWARE": "1"},
        cwd=tmp_path,
        timeout=150,
    )
    assert done.returncode == 0, {3: "nothing was selected", 4: "no force came"}
