# SPDX-License-Identifier: Apache-2.0
"""The live viewer in the browser, by viser, on every MuJoCo release and without a display."""

from __future__ import annotations

import contextlib
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from volcontact._closing import Closing
from volcontact.messages.extras import advice
from volcontact.render import View, default_view
from volcontact.report.palette import NATIVE, VOLUMETRIC, rgb
from volcontact.view.controls import Controls
from volcontact.view.drawing import SiteDrawing, Triangles
from volcontact.view.geoms import geom_triangles
from volcontact.view.guard import Guard, guarded
from volcontact.view.stage import Stage

_PERIOD = 1.0 / 30.0  # of moving bodies [s]
_OVERLAY_PERIOD = 1.0 / 8.0  # of patches and forces, of which all are sent anew [s]
_FRICTION = (255, 166, 26)
_HAND = (30, 140, 60)
_SEEN_THROUGH = 0.15  # opacity of moving bodies, so that the sites inside are seen
_POINT = 0.012  # of a contact without an area, in scene extents


class Page(Closing):
    """A page that shows a stage and steers it. Use as a context manager, or call `close`.

    Args:
        stage: what to show.
        host: from which machines it may be opened; "127.0.0.1" is this one alone. Any other takes
            the token that `address` ends in.
        port: to listen at; the next free one where it is taken.

    Attributes:
        address: to open in the browser.

    Raises:
        ModuleNotFoundError: viser is not installed.
        RuntimeError: its server cannot be guarded.
    """

    def __init__(self, stage: Stage, *, host: str = "127.0.0.1", port: int = 8080) -> None:
        import viser

        self._stage = stage
        guard = Guard(host)
        with guarded(guard) as started:
            self._server = viser.ViserServer(
                host=host, port=port, label="volcontact", verbose=False
            )
        if not started.is_set():  # the page would be open to every web site
            self.close()
            raise RuntimeError(
                f"viser {viser.__version__} starts its server in a way that volcontact cannot guard"
            )
        shown = "localhost" if host in ("127.0.0.1", "0.0.0.0") else host
        self.address = f"http://{shown}:{self._server.get_port()}{guard.query}"
        self._bodies = list(self._add_geoms())
        self._labels: list[Any] = []
        self._things: dict[str, Any] = {}
        self._shown: tuple[object, ...] = ()
        self._look()
        self._wanted = Controls(self._server.gui, stage)
        self._move_bodies()
        self._draw()

    def run(self, *, seconds: float | None = None) -> None:
        """Steps and draws until interrupted, or for so many seconds of real time."""
        begin = last = drawn = time.monotonic()
        while seconds is None or last - begin < seconds:
            now = time.monotonic()
            self._stage.advance(now - last)
            last = now
            if self._wanted.clip_for is not None:
                self._send_clip()
                last = time.monotonic()
            seen = self._seen()
            if seen == self._shown:
                time.sleep(_PERIOD)
                continue
            self._move_bodies()
            if now - drawn > _OVERLAY_PERIOD:
                self._wanted.follow()
                self._draw()
                self._shown = seen
                # Where drawing takes long, half of the time is left for stepping.
                drawn = time.monotonic() + (time.monotonic() - now) - _OVERLAY_PERIOD / 2
            time.sleep(max(0.0, _PERIOD - (time.monotonic() - now)))

    def close(self) -> None:
        """Ends the server. May be called twice."""
        with contextlib.suppress(RuntimeError):
            self._server.stop()

    def _seen(self) -> tuple[object, ...]:
        """All that the page depends on: while it stays, nothing is sent."""
        stage = self._stage
        with stage.lock:
            state = (stage.contact, stage.paused, stage.data.time, stage.data.qpos.tobytes())
        held = stage.hand.grip
        return (*state, None if held is None else held.target.tobytes(), *self._wanted.drawn)

    # ---- Bodies ----------------------------------------------------------------------------------

    def _add_geoms(self) -> Iterator[tuple[int, Any]]:
        model = self._stage.model
        for geom in range(model.ngeom):
            triangles = geom_triangles(model, geom)
            color = model.geom_rgba[geom].copy()
            material = model.geom_matid[geom]
            if material >= 0 and np.array_equal(color, [0.5, 0.5, 0.5, 1.0]):
                color = model.mat_rgba[material].copy()
            if triangles is None or color[3] == 0.0 or model.geom_group[geom] > 2:
                continue
            moves = model.body_weldid[model.geom_bodyid[geom]] != 0
            opacity = float(color[3]) * (_SEEN_THROUGH if moves else 1.0)
            mesh = self._server.scene.add_mesh_simple(
                f"/geoms/{geom}",
                triangles[0].astype(np.float32),
                triangles[1].astype(np.uint32),
                color=_bytes(color[:3]),
                opacity=opacity if opacity < 1.0 else None,
                flat_shading=True,
                side="double",
            )
            if moves and self._stage.can_pull:
                self._let_drag(geom, mesh)
            yield geom, mesh

    def _let_drag(self, geom: int, mesh: Any) -> None:
        """The left button pulls at the body; beside it, and on what is fixed, it turns the view."""
        hand = self._stage.hand

        async def drag(event: Any) -> None:  # async: in the order in which they come
            if event.phase == "start":
                # Where the page shows the body, which is where the pointer took hold of it.
                frame = np.zeros(9)
                mujoco.mju_quat2Mat(frame, np.array(mesh.wxyz, float))
                hand.take(geom, frame.reshape(3, 3).T @ (event.start_position - mesh.position))
            if event.phase == "end":
                hand.let_go()
            else:
                hand.move(event.end_position)

        mesh.on_drag("left")(drag)

    def _move_bodies(self) -> None:
        data = self._stage.data
        quaternion = np.zeros(4)
        with self._stage.lock, self._server.atomic():
            for geom, mesh in self._bodies:
                mujoco.mju_mat2Quat(quaternion, data.geom_xmat[geom].reshape(9))
                mesh.position = tuple(data.geom_xpos[geom])
                mesh.wxyz = tuple(quaternion)
            pull = self._stage.hand.ends(data)
            arrow = [] if pull is None else [(pull[0], pull[1] - pull[0])]
            self._put_arrows("/hand", arrow, _HAND)

    def _look(self) -> None:
        view = default_view(self._stage.model)
        azimuth, elevation = np.radians(view.azimuth), np.radians(view.elevation)
        ahead = np.array(
            [
                np.cos(elevation) * np.cos(azimuth),
                np.cos(elevation) * np.sin(azimuth),
                np.sin(elevation),
            ]
        )
        camera = self._server.initial_camera
        camera.look_at = np.array(view.lookat)
        camera.position = np.array(view.lookat) - view.distance * ahead
        # MuJoCo's own field of view; viser's is wider.
        camera.fov = float(np.radians(self._stage.model.vis.global_.fovy))

    # ---- Clip ------------------------------------------------------------------------------------

    def _send_clip(self) -> None:
        """Draws what is recorded, as the one who asked sees it, and sends it for download."""
        client, wanted = self._wanted.clip_for, self._wanted
        try:
            from volcontact.view.clip import write_clip

            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder, "clip.mp4")
                write_clip(
                    self._stage,
                    path,
                    view=_view_of(client.camera),
                    progress=lambda i, n: wanted.say_clip(f"Drawing {i} of {n}"),
                )
                client.send_file_download(path.name, path.read_bytes(), save_immediately=True)
        except (ModuleNotFoundError, OSError, RuntimeError, ValueError) as error:
            client.add_notification("No clip", _reason(error), color="red")
        finally:
            wanted.clip_for = None
            wanted.say_clip("")

    # ---- Contacts --------------------------------------------------------------------------------

    def _draw(self) -> None:
        stage = self._stage
        wanted = self._wanted
        stretch = None if wanted.thick.value else 1.0
        drawings = stage.drawings(stretch=stretch)
        color = _bytes(rgb(VOLUMETRIC if stage.contact == "volumetric" else NATIVE))
        with self._server.atomic():
            patches = [d.patch for d in drawings if d.patch is not None]
            bodies = [d.body for d in drawings if d.body is not None]
            self._put_mesh("/sites/patches", patches if wanted.patches.value else [], color, None)
            self._put_mesh("/sites/bodies", bodies if wanted.bodies.value else [], color, 0.4)
            self._put_points([d.position for d in drawings if d.patch is None], color)
            arrows = drawings if wanted.forces.value else []
            self._put_arrows("/sites/normal", [(d.position, d.normal_arrow) for d in arrows], color)
            self._put_arrows(
                "/sites/friction", [(d.position, d.friction_arrow) for d in arrows], _FRICTION
            )
            self._put_labels(drawings if wanted.numbers.value else [])
            wanted.text.content = self._numbers(drawings)

    def _put_mesh(
        self,
        name: str,
        parts: list[Triangles],
        color: tuple[int, int, int],
        opacity: float | None,
    ) -> None:
        points = [part for part, _ in parts]
        starts = np.cumsum([0, *(len(part) for part in points)])
        faces = [part + start for (_, part), start in zip(parts, starts, strict=False)]
        self._put(
            name,
            self._server.scene.add_mesh_simple,
            {
                "vertices": np.concatenate(points).astype(np.float32),
                "faces": np.concatenate(faces).astype(np.uint32),
                "color": color,
            }
            if parts
            else None,
            opacity=opacity,
            side="double",
            flat_shading=True,
            cast_shadow=False,
        )

    def _put(
        self, name: str, add: Callable[..., Any], changing: dict[str, Any] | None, **fixed: Any
    ) -> None:
        """Adds a thing, changes it, or hides it; what is added anew would flicker."""
        thing = self._things.get(name)
        if changing is None:
            if thing is not None:
                thing.visible = False
        elif thing is None:
            self._things[name] = add(name, **changing, **fixed)
        else:
            for key, value in changing.items():
                setattr(thing, key, value)
            thing.visible = True

    def _put_points(self, positions: list[np.ndarray], color: tuple[int, int, int]) -> None:
        colors = np.full((len(positions), 3), color, np.uint8)
        self._put(
            "/sites/points",
            self._server.scene.add_point_cloud,
            {"points": np.array(positions, np.float32), "colors": colors} if positions else None,
            point_size=_POINT * float(self._stage.model.stat.extent),
            point_shape="circle",
        )

    def _put_arrows(
        self,
        name: str,
        arrows: list[tuple[np.ndarray, np.ndarray]],
        color: tuple[int, int, int],
    ) -> None:
        ends = [(start, start + arrow) for start, arrow in arrows if arrow.any()]
        extent = float(self._stage.model.stat.extent)
        colors = np.full((len(ends), 3), color, np.uint8)
        self._put(
            name,
            self._server.scene.add_arrows,
            {"points": np.array(ends, np.float32), "colors": colors} if ends else None,
            shaft_radius=0.007 * extent,
            head_radius=0.017 * extent,
            head_length=0.03 * extent,
        )

    def _put_labels(self, drawings: list[SiteDrawing]) -> None:
        while len(self._labels) > len(drawings):
            self._labels.pop().remove()
        for i, drawing in enumerate(drawings):
            tip = drawing.position + drawing.normal_arrow
            if i < len(self._labels):
                self._labels[i].text = drawing.label
                self._labels[i].position = tuple(tip)
            else:
                self._labels.append(
                    self._server.scene.add_label(
                        f"/numbers/{i}", drawing.label, position=tuple(tip)
                    )
                )

    def _numbers(self, drawings: list[SiteDrawing]) -> str:
        state = " (paused)" if self._stage.paused else ""
        lines = [f"**t = {self._stage.data.time:.3f} s**{state}", ""]
        if drawings:
            lines += ["| site | force, depth, patch | drawn thicker |", "| --- | --- | --- |"]
        for i, d in enumerate(drawings):
            thicker = f"{d.stretch:.3g} x" if d.stretch > 1.0 else ""
            lines.append(f"| {i} | {d.label} | {thicker} |")
        return "\n".join(lines) if drawings else lines[0] + ", nothing touches"


def _view_of(camera: Any) -> View:
    """The view of a client as a camera of MuJoCo's."""
    ahead = np.asarray(camera.look_at) - np.asarray(camera.position)
    distance = float(np.linalg.norm(ahead))
    x, y, z = (float(part) for part in ahead / distance)
    at_x, at_y, at_z = (float(part) for part in camera.look_at)
    return View(
        lookat=(at_x, at_y, at_z),
        distance=distance,
        azimuth=float(np.degrees(np.arctan2(y, x))),
        elevation=float(np.degrees(np.arcsin(z))),
    )


def _reason(error: Exception) -> str:
    missing = advice(error.name) if isinstance(error, ModuleNotFoundError) else None
    return missing or str(error)


def _bytes(color: np.ndarray | tuple[float, ...]) -> tuple[int, int, int]:
    red, green, blue = (round(255.0 * float(c)) for c in color)
    return red, green, blue
