# SPDX-License-Identifier: Apache-2.0
"""The live viewer in MuJoCo's own window, where the release has one that others may draw into."""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
import threading
import time
from typing import Any

import mujoco
import numpy as np

from volcontact.render import add_geom, add_triangles, default_view, frame_along
from volcontact.report.palette import NATIVE, VOLUMETRIC, rgb
from volcontact.view.drawing import SiteDrawing
from volcontact.view.stage import Stage

_PERIOD = 1.0 / 60.0  # of a picture [s]
_FAREWELL = 5.0  # for the window to close [s]
_DRAWING_SHARE = 0.5  # of the time that may go into finding what to draw
_FRICTION = (1.0, 0.65, 0.1)
_BODY_OPACITY = 0.3
_ARROW_RADIUS = 0.012  # in scene extents
_POINT_RADIUS = 0.01  # of a contact without an area, in scene extents
_EMISSION = 0.7
# Keys that MuJoCo's viewer leaves free.
_RESET, _STEP, _OVERLAY, _CONTACT, _PAUSE = ord("6"), ord("7"), ord("8"), ord("9"), ord(" ")
_BACK, _ON = 268, 269  # of GLFW: Home, End
_KEYS = (
    ("double click", "select a body"),
    ("ctrl, right button", "pull at it"),
    ("space", "pause"),
    ("home, end", "back, on"),
    ("6", "start again"),
    ("7", "one step"),
    ("8", "patches and forces"),
    ("9", "volumetric / native"),
)


def why_no_window() -> str:
    """Why MuJoCo's viewer cannot be used here; empty when it can."""
    if importlib.util.find_spec("mujoco.viewer") is None:
        return f"MuJoCo {mujoco.__version__} has no viewer in Python: use --browser"
    on_linux = sys.platform.startswith("linux")
    if on_linux and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return "there is no display: use --browser, or set DISPLAY"
    try:
        viewer = importlib.import_module("mujoco.viewer")
    except (ImportError, RuntimeError) as error:
        return f"MuJoCo's viewer does not start ({error}): use --browser"
    if not hasattr(viewer, "launch_passive") or not hasattr(viewer.Handle, "user_scn"):
        return f"the viewer of MuJoCo {mujoco.__version__} lets nobody draw: use --browser"
    return ""


def show(stage: Stage, *, seconds: float | None = None) -> None:
    """Steps and draws until the window is closed, or for so many seconds of real time.

    Raises:
        RuntimeError: there is no such viewer here; see `why_no_window`.
    """
    reason = why_no_window()
    if reason:
        raise RuntimeError(reason)
    viewer = importlib.import_module("mujoco.viewer")
    keys = _Keys(stage)
    others = set(threading.enumerate())
    with viewer.launch_passive(
        stage.model, stage.data, key_callback=keys, show_left_ui=False, show_right_ui=False
    ) as window:
        window.opt.flags[int(mujoco.mjtVisFlag.mjVIS_TRANSPARENT)] = True
        _look(window.cam, stage)
        end = None if seconds is None else time.monotonic() + seconds
        last, pause = time.monotonic(), 0.0
        drawn = 0.0
        while window.is_running() and (end is None or time.monotonic() < end):
            now = time.monotonic()
            with window.lock():
                stage.advance(now - last)
                if now - drawn > pause:
                    begin = time.monotonic()
                    _draw(window, stage, keys.overlay)
                    drawn = time.monotonic()
                    pause = (drawn - begin) * (1.0 / _DRAWING_SHARE - 1.0)
            last = now
            window.sync()
            time.sleep(max(0.0, _PERIOD - (time.monotonic() - now)))
    # The window belongs to a thread of its own, which must not outlive the program's display.
    for thread in set(threading.enumerate()) - others:
        thread.join(timeout=_FAREWELL)


class _Keys:
    """What the keys do."""

    def __init__(self, stage: Stage) -> None:
        self.overlay = True
        self._stage = stage

    def __call__(self, key: int) -> None:
        stage = self._stage
        if key == _PAUSE:
            stage.paused = not stage.paused
        elif key == _RESET:
            stage.reset()
        elif key == _STEP:
            stage.paused = True
            stage.step()
        elif key in (_BACK, _ON) and len(stage.history) > 0:
            history = stage.history
            place = history.at(stage.data.time) + (1 if key == _ON else -1)
            stage.show(history[min(max(place, 0), len(history) - 1)].time)
        elif key == _OVERLAY:
            self.overlay = not self.overlay
        elif key == _CONTACT:
            stage.set_contact("native" if stage.contact == "volumetric" else "volumetric")


def _look(camera: mujoco.MjvCamera, stage: Stage) -> None:
    view = default_view(stage.model)
    camera.lookat[:] = view.lookat
    camera.distance, camera.azimuth, camera.elevation = view.distance, view.azimuth, view.elevation


def _draw(window: Any, stage: Stage, overlay: bool) -> None:
    drawings = stage.drawings() if overlay else []
    window.user_scn.ngeom = 0
    color = rgb(VOLUMETRIC if stage.contact == "volumetric" else NATIVE)
    extent = float(stage.model.stat.extent)
    for drawing in drawings:
        draw_site(window.user_scn, drawing, color, extent)
    if hasattr(window, "set_texts"):
        font, grid = mujoco.mjtFontScale.mjFONTSCALE_100, mujoco.mjtGridPos
        left = "\n".join(["contact", "time", *(f"site {i}" for i in range(len(drawings)))])
        state = " (paused)" if stage.paused else ""
        right = [stage.contact, f"{stage.data.time:.3f} s{state}", *(d.label for d in drawings)]
        names, meanings = ("\n".join(column) for column in zip(*_KEYS, strict=True))
        window.set_texts(
            [
                (font, grid.mjGRID_TOPLEFT, left, _ascii("\n".join(right))),
                (font, grid.mjGRID_BOTTOMLEFT, names, meanings),
            ]
        )


def _ascii(text: str) -> str:
    """The viewer's font has no more."""
    for letter, plain in (("²", "^2"), ("³", "^3"), ("µ", "u"), ("μ", "u"), ("·", " ")):
        text = text.replace(letter, plain)
    return text


def draw_site(
    scene: mujoco.MjvScene,
    drawing: SiteDrawing,
    color: tuple[float, float, float],
    extent: float,
) -> None:
    """Adds a site to a scene of MuJoCo's renderer, as far as there is room.

    Args:
        scene: to add to.
        drawing: of the site.
        color: of patch, body and normal force: red, green, blue, each 0 to 1.
        extent: of the scene [m]; arrows are so thick that they are seen in it.
    """
    if drawing.patch is not None and drawing.body is not None:
        add_triangles(scene, drawing.patch, (*color, 1.0), _EMISSION)
        add_triangles(scene, drawing.body, (*color, _BODY_OPACITY), _EMISSION)
    else:
        size = np.full(3, _POINT_RADIUS * extent)
        add_geom(
            scene,
            mujoco.mjtGeom.mjGEOM_SPHERE,
            size,
            drawing.position,
            np.eye(3),
            (*color, 1.0),
            _EMISSION,
        )
    _add_arrow(scene, drawing.position, drawing.normal_arrow, (*color, 1.0), extent)
    _add_arrow(scene, drawing.position, drawing.friction_arrow, (*_FRICTION, 1.0), extent)


def _add_arrow(
    scene: mujoco.MjvScene,
    position: np.ndarray,
    arrow: np.ndarray,
    color: tuple[float, ...],
    extent: float,
) -> None:
    length = float(np.linalg.norm(arrow))
    if length == 0.0:
        return
    thick = _ARROW_RADIUS * extent
    size = np.array([thick, thick, 2.0 * length])  # MuJoCo draws half of this length
    add_geom(
        scene, mujoco.mjtGeom.mjGEOM_ARROW, size, position, frame_along(arrow), color, _EMISSION
    )
