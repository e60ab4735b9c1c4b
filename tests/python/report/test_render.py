# SPDX-License-Identifier: Apache-2.0
"""Pictures: patches and arrows have the size that perspective gives them."""

import os
import subprocess
import sys

import mujoco
import numpy as np
import pytest

from volcontact.render import Renderer, RenderError, SiteStyle, View, default_view
from volcontact.running.recording import SITE
from volcontact.surface import SiteSurface

SCENE = """
<mujoco>
  <statistic center="0 0 0" extent="1"/>
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <worldbody>
    <geom type="plane" size="3 3 0.1" rgba="0.8 0.8 0.8 1"/>
    <body pos="0 0 0.4"><freejoint/><geom name="ball" type="sphere" size="0.1"/></body>
  </worldbody>
</mujoco>
"""
SIZE = 240
FIELD_OF_VIEW = 45.0  # [degree], vertical, MuJoCo's default
STYLE = SiteStyle(color=(1.0, 0.0, 0.0), reference_force=100.0)


@pytest.fixture
def model():
    return mujoco.MjModel.from_xml_string(SCENE)


def one_site(area: float, force: float) -> np.ndarray:
    sites = np.zeros(1, SITE)
    sites["geom_a"], sites["geom_b"] = 1, 0
    sites["normal"] = (0.0, 0.0, 1.0)
    sites["position"] = (0.6, 0.0, 0.0)  # beside the ball, nothing in front of it
    sites["force"] = (0.0, 0.0, force)
    sites["area"] = area
    return sites


def change(
    renderer: Renderer, model: mujoco.MjModel, sites: np.ndarray, view: View, surfaces=()
) -> np.ndarray:
    """How much of every pixel the sites cover, shape (height, width)."""
    nothing = renderer.draw(model.qpos0, sites=np.zeros(0, SITE), style=STYLE, view=view)
    drawn = renderer.draw(model.qpos0, sites=sites, surfaces=surfaces, style=STYLE, view=view)
    difference = np.abs(drawn.astype(float) - nothing).sum(axis=2)
    return difference / difference.max()


def changed(
    renderer: Renderer, model: mujoco.MjModel, sites: np.ndarray, view: View, surfaces=()
) -> np.ndarray:
    """Which pixels the sites change, shape (height, width)."""
    return change(renderer, model, sites, view, surfaces) > 0.05


def pixels_per_metre(distance: float) -> float:
    return 0.5 * SIZE / np.tan(np.radians(0.5 * FIELD_OF_VIEW)) / distance


@pytest.mark.parametrize("area", [0.01, 0.04])
def test_patch_disc_has_the_area_of_the_patch(model, area):
    view = View(lookat=(0.6, 0.0, 0.0), distance=2.0, azimuth=90.0, elevation=-90.0)
    with Renderer(model, width=SIZE, height=SIZE) as renderer:
        covered = change(renderer, model, one_site(area, force=0.0), view).sum()
    # Pinhole projection, seen along the normal; MuJoCo draws the circle as a polygon.
    assert covered == pytest.approx(area * pixels_per_metre(2.0) ** 2, rel=0.04)


def test_surface_is_drawn_as_it_is_and_thick_enough_to_be_seen(model):
    if not hasattr(mujoco.mjtGeom, "mjGEOM_TRIANGLE"):
        pytest.skip("MuJoCo 2.2 draws no triangles: a disc stands for the patch")
    site = one_site(0.08, force=0.0)
    site["depth"] = 1e-5
    half = np.array([0.2, 0.1])
    corners = half * [[-1, -1], [1, -1], [1, 1], [-1, 1]]
    middle = np.column_stack([0.6 + corners[:, 0], corners[:, 1], np.zeros(4)])
    along = np.array([0.0, 0.0, 0.5e-5])
    rim = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    surface = SiteSurface(middle - along, middle + along, np.array([[0, 1, 2], [0, 2, 3]]), rim)
    above = View(lookat=(0.6, 0.0, 0.0), distance=2.0, azimuth=90.0, elevation=-90.0)
    beside = View(lookat=(0.6, 0.0, 0.0), distance=2.0, azimuth=90.0, elevation=0.0)
    with Renderer(model, width=SIZE, height=SIZE) as renderer:
        rows, columns = (
            np.flatnonzero(changed(renderer, model, site, above, [surface]).any(axis=axis))
            for axis in (1, 0)
        )
        heights = changed(renderer, model, site, beside, [surface]).any(axis=1).sum()
    size = 2 * half * pixels_per_metre(2.0)
    assert [np.ptp(columns), np.ptp(rows)] == pytest.approx(size, abs=4)
    # A twelfth of the size of the patch; the floor is seen edge-on and hides nothing.
    assert heights == pytest.approx(0.08 * np.sqrt(0.08) * pixels_per_metre(2.0), abs=1.5)


def test_arrow_length_grows_with_the_square_root_of_force_and_points_along_it(model):
    # From the side, so near that the thin tip of the arrow is more than a pixel wide.
    view = View(lookat=(0.6, 0.0, 0.15), distance=1.0, azimuth=90.0, elevation=0.0)
    tops = []
    with Renderer(model, width=SIZE, height=SIZE) as renderer:
        for force in (25.0, 100.0):
            rows = np.flatnonzero(changed(renderer, model, one_site(0.0, force), view).any(axis=1))
            tops.append(0.15 + (SIZE / 2 - rows[0]) / pixels_per_metre(1.0))
    assert tops[1] == pytest.approx(0.3, abs=0.015)  # the reference force: 0.3 scene extents
    assert tops[0] == pytest.approx(0.15, abs=0.015)


def test_force_is_drawn_on_the_body_that_moves(model):
    view = View(lookat=(0.6, 0.0, 0.2), distance=3.0, azimuth=90.0, elevation=0.0)
    swapped = one_site(0.0, -100.0)
    swapped["geom_a"], swapped["geom_b"] = 0, 1
    with Renderer(model, width=SIZE, height=SIZE) as renderer:
        plain = changed(renderer, model, one_site(0.0, 100.0), view)
        assert np.array_equal(plain, changed(renderer, model, swapped, view))


def test_picture_has_the_size_asked_and_shows_the_state(model):
    with Renderer(model, width=64, height=48) as renderer:
        before = renderer.draw(model.qpos0)
        again = renderer.draw(model.qpos0)
        moved = renderer.draw(model.qpos0 + np.array([0.3, 0, 0, 0, 0, 0, 0]))
    assert before.shape == (48, 64, 3)
    assert before.dtype == np.uint8
    assert np.array_equal(before, again)
    assert not np.array_equal(before, moved)


def test_scene_without_sky_has_a_pale_background(model):
    with Renderer(model, width=64, height=48) as renderer:
        picture = renderer.draw(model.qpos0, view=View((0, 0, 0), 2.0, elevation=60.0))
    assert picture[:4].min() > 150


def test_first_camera_of_the_scene_is_the_default():
    away = '<camera pos="0 0 1" xyaxes="1 0 0 0 0 1"/></worldbody>'  # level, over the plane
    model = mujoco.MjModel.from_xml_string(SCENE.replace("</worldbody>", away))
    with Renderer(model, width=64, height=48) as renderer:
        first = renderer.draw(model.qpos0)
        chosen = renderer.draw(model.qpos0, view=default_view(model))
        back = renderer.draw(model.qpos0)
    assert np.array_equal(first, back)
    assert not np.array_equal(first, chosen)


def test_camera_is_found_by_name_or_the_known_ones_are_listed():
    cameras = '<camera name="near" pos="0 0 1"/><camera name="far" pos="0 0 9"/></worldbody>'
    model = mujoco.MjModel.from_xml_string(SCENE.replace("</worldbody>", cameras))
    with Renderer(model, width=64, height=48) as renderer:
        near = renderer.draw(model.qpos0, view="near")
        assert np.array_equal(near, renderer.draw(model.qpos0))
        assert not np.array_equal(near, renderer.draw(model.qpos0, view="far"))
        with pytest.raises(ValueError, match="no camera 'side' in the scene; it has: near, far"):
            renderer.draw(model.qpos0, view="side")


def test_two_renderers_do_not_disturb_each_other(model):
    with Renderer(model, width=64, height=48) as one:
        alone = one.draw(model.qpos0)
        with Renderer(model, width=32, height=32) as two:
            assert two.draw(model.qpos0).shape == (32, 32, 3)
            assert np.array_equal(one.draw(model.qpos0), alone)
        assert np.array_equal(one.draw(model.qpos0), alone)


def test_closed_renderer_says_so(model):
    renderer = Renderer(model, width=32, height=32)
    renderer.close()
    renderer.close()
    with pytest.raises(RenderError, match="closed"):
        renderer.draw(model.qpos0)


def test_empty_picture_is_refused(model):
    with pytest.raises(ValueError, match="0 x 48"):
        Renderer(model, width=0, height=48)


def run_python(code: str, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=120,
    )


def test_forgotten_renderer_ends_without_noise():
    code = f"""
import mujoco
from volcontact.render import Renderer
model = mujoco.MjModel.from_xml_string('''{SCENE}''')
renderer = Renderer(model, width=32, height=32)
renderer.draw(model.qpos0)
"""
    done = run_python(code)
    assert (done.returncode, done.stderr) == (0, "")


def test_machine_without_opengl_is_told_what_to_install():
    code = f"""
import mujoco
from volcontact.render import Renderer, RenderError
try:
    Renderer(mujoco.MjModel.from_xml_string('''{SCENE}'''))
except RenderError as error:
    print(error)
"""
    # MuJoCo imports its GL module at once when MUJOCO_GL is set; without it only the renderer does.
    done = run_python(code, PYOPENGL_PLATFORM="wayland", MUJOCO_GL="")
    assert done.returncode == 0, done.stderr
    assert "apt-get install libegl1 libgl1 libgl1-mesa-dri" in done.stdout
    assert len(done.stdout.splitlines()) == 1
