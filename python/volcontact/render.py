# SPDX-License-Identifier: Apache-2.0
"""Off-screen pictures of a scene with its contact sites, on every MuJoCo release.

MuJoCo 2.2 has no `mujoco.Renderer`, so this draws through the calls all releases share. EGL gives
the OpenGL context: no window, no display and no GPU are needed.
"""

from __future__ import annotations

import atexit
import copy
import functools
import os
import weakref
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from volcontact._closing import Closing
from volcontact._mujoco_views import dense
from volcontact.surface import SiteSurface, stretch_to_see

_PACKAGES = "libegl1 libgl1 libgl1-mesa-dri"
_MAX_GEOMS = 10_000
_SHADOW_SIZE = 2048
_BODY_OPACITY = 0.12  # moving bodies while sites are drawn, so that the sites inside are seen
_ARROW_FULL = 0.3  # length of the arrow of the reference force, in scene extents
_ARROW_MAX = 0.8  # longest arrow, in scene extents
_POINT_RADIUS = 0.012  # disc of a contact that has no area, in scene extents
_DISC_THICKNESS = 0.003  # in scene extents; more than the usual penetration
_VOLUME_OPACITY = 0.4
_LIFT = 0.002  # of patches into the moving body, in scene extents: else the other one hides them
_ARROW_RADIUS = 0.007  # in scene extents
_HEADLIGHT = {"ambient": 0.35, "diffuse": 0.6, "specular": 0.1}  # of a scene without a light
_HORIZON = (236, 240, 244)  # background of a scene without sky, RGB
_ZENITH = (202, 212, 222)
_SITE_EMISSION = 0.35  # sites keep their colour in the shade
_SURFACE_EMISSION = 0.9
_THICK = 0.012  # of a volume that is seen in the whole scene, in scene extents
_SMALLEST_ARROW = 0.02  # shorter ones are not drawn, in scene extents


class RenderError(RuntimeError):
    """No picture can be drawn on this machine: the message says what to install."""


@dataclass(frozen=True)
class View:
    """A free camera: where it looks at, from how far and from which side.

    Attributes:
        lookat: [m], world.
        distance: [m].
        azimuth: [degree].
        elevation: [degree], negative looks down.
    """

    lookat: tuple[float, float, float]
    distance: float
    azimuth: float = 135.0
    elevation: float = -22.0


@dataclass(frozen=True)
class SiteStyle:
    """How contact sites are drawn.

    Attributes:
        color: (red, green, blue), each 0 to 1.
        reference_force: the force whose arrow has the full length [N]; lengths grow with the square
            root of the force, so that a resting load stays visible beside an impact.
    """

    color: tuple[float, float, float]
    reference_force: float


class Renderer(Closing):
    """Draws states of one model into arrays. Use as a context manager, or call `close`.

    Args:
        model: the model to draw; a private copy is kept.
        width: of the picture [pixel].
        height: of the picture [pixel].

    Raises:
        RenderError: the machine has no headless OpenGL.
    """

    def __init__(self, model: mujoco.MjModel, *, width: int = 640, height: int = 480) -> None:
        if width < 1 or height < 1:
            raise ValueError(f"picture size {width} x {height} must be positive")
        self._model = _drawable(model, width, height)
        self._data = mujoco.MjData(self._model)
        self._extent = float(self._model.stat.extent)
        self._has_sky = int(mujoco.mjtTexture.mjTEXTURE_SKYBOX) in self._model.tex_type
        self._viewport = mujoco.MjrRect(0, 0, width, height)
        self._option = mujoco.MjvOption()
        self._camera = mujoco.MjvCamera()
        self._look_from(None)
        self._gl: Any = _gl_context(width, height)
        self._context: Any = None
        try:
            self._gl.make_current()
            self._scene = mujoco.MjvScene(self._model, maxgeom=_MAX_GEOMS)
            font = int(mujoco.mjtFontScale.mjFONTSCALE_100)
            self._context = mujoco.MjrContext(self._model, font)
            mujoco.mjr_setBuffer(int(mujoco.mjtFramebuffer.mjFB_OFFSCREEN), self._context)
        except (mujoco.FatalError, RuntimeError) as error:
            self.close()
            raise _no_gl(error) from error
        _open_renderers.add(self)
        _close_all_at_exit()

    def draw(
        self,
        qpos: np.ndarray,
        *,
        sites: np.ndarray | None = None,
        surfaces: Sequence[SiteSurface | None] = (),
        style: SiteStyle | None = None,
        view: View | str | None = None,
        mocap: tuple[np.ndarray, np.ndarray] | None = None,
    ) -> np.ndarray:
        """Draws one state.

        Args:
            qpos: shape (nq,).
            sites: of type `volcontact.running.recording.SITE`; drawn with force arrows, and the
                moving bodies translucent. The arrow shows the force on the body that moves.
            surfaces: shape of each site, drawn as its patch within its translucent volume, which
                is made thicker where it is too thin to be seen. Without, and under MuJoCo 2.2, a
                disc of the area of the patch stands for them.
            style: of the sites; needed with `sites`.
            view: camera, or the name of one of the scene; when None the scene's first camera, or
                one that sees the whole scene.
            mocap: positions [m] and quaternions of the mocap bodies, as in `mjData`; None leaves
                them where the file has them.

        Returns:
            Picture, shape (height, width, 3), uint8.

        Raises:
            ValueError: the scene has no camera of that name.
        """
        if self._context is None:
            raise RenderError("the renderer is closed")
        self._look_from(view)
        self._gl.make_current()
        self._data.qpos[:] = qpos
        if mocap is not None:
            self._data.mocap_pos[:], self._data.mocap_quat[:] = mocap
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mujoco.mj_camlight(self._model, self._data)
        mujoco.mjv_updateScene(
            self._model,
            self._data,
            self._option,
            None,
            self._camera,
            int(mujoco.mjtCatBit.mjCAT_ALL),
            self._scene,
        )
        # A solid shadow of a body that is seen through would hide the sites below it.
        see_through = sites is not None and style is not None
        dense(self._scene.flags)[int(mujoco.mjtRndFlag.mjRND_SHADOW)] = not see_through
        if sites is not None and style is not None:
            self._fade_moving_bodies()
            for i, site in enumerate(sites):
                self._add_site(site, surfaces[i] if surfaces else None, style)
        mujoco.mjr_render(self._viewport, self._scene, self._context)
        return self._pixels()

    def close(self) -> None:
        """Frees the OpenGL context. May be called twice."""
        _open_renderers.discard(self)
        context, self._context = self._context, None
        gl, self._gl = self._gl, None
        if context is not None:
            gl.make_current()
            context.free()
        if gl is not None:
            gl.free()

    def _look_from(self, view: View | str | None) -> None:
        if isinstance(view, str) or (view is None and self._model.ncam > 0):
            self._camera.type = int(mujoco.mjtCamera.mjCAMERA_FIXED)
            self._camera.fixedcamid = 0 if view is None else camera_id(self._model, view)
            return
        view = view or default_view(self._model)
        self._camera.type = int(mujoco.mjtCamera.mjCAMERA_FREE)
        dense(self._camera.lookat)[:] = view.lookat
        self._camera.distance = view.distance
        self._camera.azimuth = view.azimuth
        self._camera.elevation = view.elevation

    def _pixels(self) -> np.ndarray:
        shape = (self._viewport.height, self._viewport.width)
        rgb = np.empty((*shape, 3), np.uint8)
        depth = np.empty(shape, np.float32)
        mujoco.mjr_readPixels(rgb, depth, self._viewport, self._context)
        if not self._has_sky:
            # What is translucent leaves no depth: it was blended with black, which shows how far.
            behind = depth >= 1.0
            share = 1.0 - rgb[behind].max(axis=1, keepdims=True) / 255.0
            rgb[behind] += (share * _background(shape)[behind]).astype(np.uint8)
        return np.flipud(rgb).copy()

    def _fade_moving_bodies(self) -> None:
        moving = int(mujoco.mjtCatBit.mjCAT_DYNAMIC)
        for i in range(self._scene.ngeom):
            geom = self._scene.geoms[i]
            if geom.category == moving:
                dense(geom.rgba)[3] *= _BODY_OPACITY

    def _add_site(self, site: np.void, surface: SiteSurface | None, style: SiteStyle) -> None:
        extent, shade = self._extent, _SITE_EMISSION
        kinds, place = mujoco.mjtGeom, site["position"]
        if surface is None or surface.is_empty or not hasattr(kinds, "mjGEOM_TRIANGLE"):
            radius = np.sqrt(site["area"] / np.pi) or _POINT_RADIUS * extent
            disc = np.array([radius, _DISC_THICKNESS * extent, 0.0])
            frame, color = frame_along(site["normal"]), (*style.color, 0.85)
            add_geom(self._scene, kinds.mjGEOM_CYLINDER, disc, place, frame, color, shade)
        else:
            moves = self._moves(site["geom_a"])
            points, faces = surface.patch
            lift = _LIFT * extent * (site["normal"] if moves else -site["normal"])
            patch = points + lift, faces if moves else faces[:, ::-1]  # it faces the moving body
            body = surface.body(stretch_to_see(site["area"], site["depth"], _THICK * extent))
            add_triangles(self._scene, patch, (*style.color, 1.0), _SURFACE_EMISSION)
            add_triangles(self._scene, body, (*style.color, _VOLUME_OPACITY), _SURFACE_EMISSION)
        force = site["force"] if self._moves(site["geom_a"]) else -site["force"]
        magnitude = float(np.linalg.norm(force))
        length = _ARROW_FULL * extent * np.sqrt(magnitude / style.reference_force)
        if length < _SMALLEST_ARROW * extent:
            return
        length = min(length, _ARROW_MAX * extent)
        thick = _ARROW_RADIUS * extent
        arrow = np.array([thick, thick, 2.0 * length])  # MuJoCo draws half of this size
        frame = frame_along(force)
        add_geom(self._scene, kinds.mjGEOM_ARROW, arrow, place, frame, (*style.color, 1.0), shade)

    def _moves(self, geom: int) -> bool:
        return bool(self._model.body_weldid[self._model.geom_bodyid[geom]] != 0)


def add_geom(
    scene: mujoco.MjvScene,
    kind: mujoco.mjtGeom,
    size: np.ndarray,
    position: np.ndarray,
    frame: np.ndarray,
    color: tuple[float, ...],
    emission: float,
) -> None:
    """Puts one more geom into an abstract scene that has room for it.

    Args:
        scene: the scene that MuJoCo draws.
        kind: shape of the geom.
        size: shape (3,), as the kind takes it [m].
        position: shape (3,), in world coordinates [m].
        frame: shape (3, 3), its axes are the columns.
        color: red, green, blue, opacity, 0 to 1.
        emission: how much of the colour stays in the shade, 0 to 1.
    """
    if scene.ngeom >= scene.maxgeom:
        return
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(
        geom,
        int(kind),
        np.asarray(size, np.float64),
        np.asarray(position, np.float64),
        np.asarray(frame, np.float64).reshape(9),
        np.asarray(color, np.float32),
    )
    geom.emission = emission
    geom.specular = 0.0
    scene.ngeom += 1


def add_triangles(
    scene: mujoco.MjvScene,
    triangles: tuple[np.ndarray, np.ndarray],
    color: tuple[float, ...],
    emission: float,
) -> None:
    """Puts triangles into an abstract scene, as far as there is room. MuJoCo 2.2 has none.

    Args:
        scene: the scene that MuJoCo draws.
        triangles: points [m], shape (n, 3), and their indices, shape (m, 3).
        color: red, green, blue, opacity, 0 to 1.
        emission: how much of the colour stays in the shade, 0 to 1.
    """
    points, faces = triangles
    for a, b, c in points[faces]:
        sides = np.column_stack([b - a, c - a])
        lengths = np.linalg.norm(sides, axis=0)
        normal = np.cross(sides[:, 0], sides[:, 1])
        size = np.linalg.norm(normal)
        if size == 0.0:
            continue
        # The frame of a triangle is skew: its sides are the first two axes.
        frame = np.column_stack([sides / lengths, normal / size])
        kind = mujoco.mjtGeom.mjGEOM_TRIANGLE
        add_geom(scene, kind, np.array([*lengths, 0.0]), a, frame, color, emission)


def camera_id(model: mujoco.MjModel, name: str) -> int:
    """The index of a camera.

    Raises:
        ValueError: the scene has no camera of that name; the message lists those it has.
    """
    kind = int(mujoco.mjtObj.mjOBJ_CAMERA)
    index = int(mujoco.mj_name2id(model, kind, name))
    if index < 0:
        names = [mujoco.mj_id2name(model, kind, i) or f"camera {i}" for i in range(model.ncam)]
        raise ValueError(f"no camera {name!r} in the scene; it has: {', '.join(names) or 'none'}")
    return index


def default_view(model: mujoco.MjModel) -> View:
    """A view of the whole scene, the same on every MuJoCo release."""
    x, y, z = (float(c) for c in dense(model.stat.center))
    return View(lookat=(x, y, z), distance=1.5 * float(model.stat.extent))


def _drawable(model: mujoco.MjModel, width: int, height: int) -> mujoco.MjModel:
    """A copy with an off-screen buffer of the right size and shadows that a CPU draws quickly."""
    model = copy.copy(model)
    model.vis.global_.offwidth = max(width, model.vis.global_.offwidth)
    model.vis.global_.offheight = max(height, model.vis.global_.offheight)
    model.vis.quality.shadowsize = min(_SHADOW_SIZE, model.vis.quality.shadowsize)
    light_up(model)
    return model


def light_up(model: mujoco.MjModel) -> None:
    """Gives a scene without a light a bright one at the camera; others stay as they are."""
    if model.nlight > 0:
        return
    model.vis.headlight.active = 1
    for name, strength in _HEADLIGHT.items():
        dense(getattr(model.vis.headlight, name))[:] = strength


def _background(shape: tuple[int, int]) -> np.ndarray:
    """What is seen where there is nothing, bottom row first: a pale vertical gradient."""
    bottom, top = np.array(_HORIZON), np.array(_ZENITH)
    blend = np.linspace(0.0, 1.0, shape[0])[:, None, None]
    rows = (1.0 - blend) * bottom + blend * top
    return np.broadcast_to(rows.astype(np.uint8), (*shape, 3))


def frame_along(direction: np.ndarray) -> np.ndarray:
    """A rotation matrix whose third column is along `direction`, shape (3, 3)."""
    z = direction / np.linalg.norm(direction)
    helper = np.eye(3)[np.argmin(np.abs(z))]
    x = np.cross(helper, z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def _gl_context(width: int, height: int) -> mujoco.GLContext:
    """An OpenGL context from EGL, or from what MUJOCO_GL asks for."""
    try:
        if os.environ.get("MUJOCO_GL", "").lower() in ("glfw", "osmesa"):
            return mujoco.GLContext(width, height)
        from mujoco.egl import GLContext

        return GLContext(width, height)
    except Exception as error:  # the bindings raise anything from OSError to AttributeError here
        raise _no_gl(error) from error


def _no_gl(error: BaseException) -> RenderError:
    reason = (str(error).strip().splitlines() or [type(error).__name__])[0]
    return RenderError(
        f"no headless OpenGL on this machine ({reason}); "
        f"install it with: apt-get install {_PACKAGES}"
    )


_open_renderers: weakref.WeakSet[Renderer] = weakref.WeakSet()


@functools.cache
def _close_all_at_exit() -> None:
    """Frees forgotten contexts before EGL itself shuts down, which prints errors otherwise.

    Exit functions run last in, first out, so this must be registered after EGL's own.
    """

    def close_all() -> None:
        for renderer in list(_open_renderers):
            renderer.close()

    atexit.register(close_all)
