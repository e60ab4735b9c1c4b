# SPDX-License-Identifier: Apache-2.0
"""The live viewer: what it steps, and what it shows in MuJoCo's window and in the browser."""

import re
import sys

import mujoco
import numpy as np
import pytest
from view_pages import BLUE, PINK, SCENE, happens, like, needs_browser, page, rest, shot, stage
from view_windows import has_window, picture_of_window

from volcontact.cli import main
from volcontact.view.geoms import geom_triangles

__all__ = ["page", "stage"]  # fixtures
GEOMS = """
<mujoco>
  <asset>
    <mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/>
    <hfield name="hill" nrow="3" ncol="4" size="1 2 0.5 0.1"/>
  </asset>
  <worldbody>
    <geom type="box" size=".1 .2 .3"/>
    <geom type="sphere" size=".2"/>
    <geom type="ellipsoid" size=".1 .2 .3"/>
    <geom type="capsule" size=".1 .2"/>
    <geom type="cylinder" size=".1 .2"/>
    <geom type="mesh" mesh="wedge"/>
    <geom type="plane" size="0 0 1"/>
    <geom type="hfield" hfield="hill"/>
  </worldbody>
</mujoco>
"""


# ---- Stage and drawings --------------------------------------------------------------------------


def test_stage_pauses_steps_and_starts_again(stage):
    stage.paused = True
    stage.advance(0.1)
    assert stage.data.time == 0.0
    stage.step(3)
    assert stage.data.time == pytest.approx(3e-3)
    stage.paused = False
    stage.speed = 0.1
    stage.advance(0.1)
    assert stage.data.time == pytest.approx(13e-3)
    stage.reset()
    assert stage.data.time == 0.0 and stage.data.qpos[2] == 0.12


def test_contact_changes_in_mid_motion(stage):
    rest(stage)
    assert stage.contact == "volumetric" and stage.data.ncon == 0
    stage.set_contact("native")
    assert stage.data.ncon == 4 and not stage.data.qfrc_applied.any()
    assert len(stage.contacts_of(stage.data)[0]) == 4
    stage.set_contact("volumetric")
    stage.step(500)
    assert stage.data.ncon == 0 and len(stage.contacts_of(stage.data)[0]) == 1
    assert abs(stage.data.qvel).max() < 1e-3


def test_drawing_of_a_box_at_rest(stage):
    rest(stage)
    (drawing,) = stage.drawings()
    points, faces = drawing.patch
    sides = np.linalg.norm(
        np.cross(
            points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]]
        ),
        axis=1,
    )
    assert 0.5 * sides.sum() == pytest.approx(0.04, rel=0.01)
    # The weight has the reference length; the thin overlap is made thick enough to be seen.
    assert drawing.normal_arrow == pytest.approx([0.0, 0.0, 0.3 * 0.5], abs=1e-3)
    assert np.ptp(drawing.body[0][:, 2]) == pytest.approx(0.08 * 0.2, rel=0.01)
    assert drawing.label.startswith("9.81 N, ")
    assert "400 cm²" in drawing.label


def test_native_contacts_are_points(stage):
    stage.set_contact("native")
    rest(stage)
    drawings = stage.drawings()
    assert len(drawings) == 4
    assert all(drawing.patch is None and drawing.body is None for drawing in drawings)
    assert sum(d.normal_arrow[2] > 0.0 for d in drawings) == 4


def test_every_kind_of_geom_has_triangles():
    model = mujoco.MjModel.from_xml_string(GEOMS)
    volumes = [8 * 0.006, 4 / 3 * np.pi * 0.008, 4 / 3 * np.pi * 0.006]
    volumes += [np.pi * 0.01 * 0.4 + 4 / 3 * np.pi * 0.001, np.pi * 0.01 * 0.4, 1 / 6]
    for geom in range(model.ngeom):
        points, faces = geom_triangles(model, geom)
        assert np.isfinite(points).all() and faces.max() < len(points)
        if geom < len(volumes):  # the others are open
            a, b, c = (points[faces[:, i]] for i in range(3))
            volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
            assert volume == pytest.approx(volumes[geom], rel=0.02)


def test_keys_of_the_window_steer_the_stage(stage):
    from volcontact.view.window import _Keys

    keys = _Keys(stage)
    keys(ord(" "))
    assert stage.paused
    keys(ord("7"))
    assert stage.data.time == pytest.approx(1e-3)
    keys(ord("9"))
    assert stage.contact == "native"
    keys(ord("8"))
    assert not keys.overlay
    keys(ord("6"))
    assert stage.data.time == 0.0


# ---- What is seen --------------------------------------------------------------------------------


def shows_volumetric(picture):
    """The patch, which covers far more than the arrow, and no native contact."""
    return like(picture, BLUE) > 3000 and like(picture, PINK) < 30


def shows_native(picture):
    """Points and arrows, and nothing of the patch; its blue is that of the axes."""
    return like(picture, PINK) > 300 and like(picture, BLUE) < 300


@pytest.mark.once
@needs_browser
def test_browser_shows_patches_and_forces_and_obeys(page, stage, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shown, page, faults = page
    assert happens(shown, lambda: shows_volumetric(shot(page, "volumetric.png")))
    page.get_by_text(re.compile(r"9\.8\d* N, 4[89]\.\d .m deep")).wait_for()
    before = stage.data.time
    page.get_by_text("One step").click()
    assert happens(shown, lambda: stage.data.time != before)
    assert stage.data.time == pytest.approx(before + 1e-3)
    stage.set_contact("native")
    assert happens(shown, lambda: shows_native(shot(page, "native.png")))
    assert faults == []


@pytest.mark.skipif(not has_window, reason="MuJoCo has no viewer to draw into, or Xvfb is missing")
def test_window_shows_patches_and_forces(tmp_path):
    (tmp_path / "scene.xml").write_text(SCENE)
    picture = picture_of_window('Stage("scene.xml")', "stage.step(800)", "window.png", tmp_path)
    assert like(picture, BLUE) > 1000


def test_without_a_display_the_browser_is_named(tmp_path, monkeypatch, capsys):
    (tmp_path / "scene.xml").write_text(SCENE)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    assert main(["view", str(tmp_path / "scene.xml")]) == 1
    assert "use --browser" in capsys.readouterr().err


def test_browser_without_viser_says_what_to_install(tmp_path, monkeypatch, capsys):
    (tmp_path / "scene.xml").write_text(SCENE)
    monkeypatch.setitem(sys.modules, "viser", None)
    assert main(["view", "--browser", str(tmp_path / "scene.xml")]) == 1
    assert 'pip install "volcontact[view]"' in capsys.readouterr().err
