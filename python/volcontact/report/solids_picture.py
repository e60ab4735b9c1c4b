# SPDX-License-Identifier: Apache-2.0
"""A picture of the solids that volcontact understands, holes open, materials by colour."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from volcontact._mujoco_views import dense
from volcontact.messages.names import name_of
from volcontact.render import Renderer, SiteStyle
from volcontact.report.palette import MATERIALS, OTHER_MATERIALS, VOLUMETRIC, rgb
from volcontact.report.solids_drawing import solids_of, surface
from volcontact.scene import Contact

_LINE = 20  # of the legend [pixel]
_MOST_LINES = 12
# From above, so that what lies flat is brighter than what stands.
_LIGHT = (
    '<light directional="true" castshadow="false" dir="-0.25 0.35 -1" ambient="0 0 0" '
    'diffuse="0.35 0.35 0.35" specular="0 0 0"/>'
)
_HEADLIGHT = '<headlight ambient="0.4 0.4 0.4" diffuse="0.2 0.2 0.2" specular="0 0 0"/>'


def draw_solids(
    contact: Contact,
    data: mujoco.MjData,
    sites: np.ndarray,
    *,
    width: int,
    height: int,
    camera: str | None = None,
) -> np.ndarray:
    """Draws the solids of all pairs that can touch, at the state of the last evaluation.

    Args:
        contact: of the scene.
        data: evaluated.
        sites: of type `volcontact.running.recording.SITE`; with any, what moves is translucent.
        width: of the picture [pixel].
        height: of the picture [pixel].
        camera: of the scene; None takes its first, or a view of all.

    Returns:
        Picture, shape (height, width, 3), uint8.
    """
    model, description = contact.model, contact.description
    steps = _steps_of_geoms(contact, description)
    materials = {
        int(solid["id"]): str(solid["material"]) for solid in description["solids"] if "id" in solid
    }
    colors = _colors(materials)
    drawn = sorted(steps)
    text = _scene(model, data, [(g, steps[g], colors[materials.get(g, "")]) for g in drawn])
    picture_model = mujoco.MjModel.from_xml_string(text)
    # In the order in which they were written, which is that of the bodies.
    places = {geom: i for i, geom in enumerate(drawn)}
    shown = np.array([row for row in sites if _touch(row) <= places.keys()], sites.dtype)
    for key in ("geom_a", "geom_b"):
        shown[key] = [places[int(geom)] for geom in shown[key]]
    forces = np.linalg.norm(shown["force"], axis=1) if len(shown) else np.zeros(1)
    style = SiteStyle(rgb(VOLUMETRIC), reference_force=float(forces.max()) or 1.0)
    with Renderer(picture_model, width=width, height=height) as renderer:
        picture = renderer.draw(
            picture_model.qpos0,
            sites=shown if len(shown) else None,
            style=style,
            view=camera,
        )
    return _with_legend(picture, {name: colors[name] for name in colors if name})


def _touch(site: np.void) -> set[int]:
    return {int(site["geom_a"]), int(site["geom_b"])}


def _steps_of_geoms(contact: Contact, description: Mapping[str, Any]) -> dict[int, Any]:
    """What each geom that can touch is for volcontact: its pose and steps."""
    found: dict[int, Any] = {}
    for pair in description["pairs"]:
        ids = [int(pair.get(key, -1)) for key in ("id_a", "id_b")]
        if all(geom in found or geom < 0 for geom in ids):
            continue
        for geom, solid in zip(ids, solids_of(contact._pair_text(int(pair["pair"]))), strict=True):
            if geom >= 0:
                found.setdefault(geom, solid)
    return found


def _colors(materials: Mapping[int, str]) -> dict[str, str]:
    names = list(dict.fromkeys(name for name in materials.values() if name != "default"))
    colors = {
        name: MATERIALS[i] if i < len(MATERIALS) else OTHER_MATERIALS
        for i, name in enumerate(names)
    }
    if "default" in materials.values():
        colors["default"] = OTHER_MATERIALS
    return {**colors, "": OTHER_MATERIALS}


def _scene(model: mujoco.MjModel, data: mujoco.MjData, solids: list[Any]) -> str:
    """MJCF of the solids alone: a body for each, free where it can move."""
    assets, bodies = [], []
    corners: list[np.ndarray] = []  # of what has an end, in the world
    for i, (geom, (inner, steps), color) in enumerate(solids):
        found = surface(steps)
        place = np.eye(4)
        place[:3, :3], place[:3, 3] = data.geom_xmat[geom].reshape(3, 3), data.geom_xpos[geom]
        place = place @ inner
        shown = f'rgba="{" ".join(f"{x:.3g}" for x in rgb(color))} 1"'
        if found is None:
            size = 0.5 * float(model.stat.extent)
            body = f'<geom type="plane" size="{size:.6g} {size:.6g} 0.1" {shown}/>'
        else:
            points, faces = found
            corners.append(points @ place[:3, :3].T + place[:3, 3])
            of_faces = f' face="{_words(faces)}"' if len(faces) else ""
            assets.append(f'<mesh name="s{i}" vertex="{_words(points)}"{of_faces}/>')
            body = (
                '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
                f'<geom type="mesh" mesh="s{i}" contype="0" conaffinity="0" {shown}/>'
            )
        moves = found is not None and model.body_weldid[model.geom_bodyid[geom]] != 0
        axes = f"{_words(place[:3, 0])} {_words(place[:3, 1])}"
        joint = "<freejoint/>" if moves else ""
        bodies.append(f'<body pos="{_words(place[:3, 3])}" xyaxes="{axes}">{joint}{body}</body>')
    cameras = [
        f'<camera name="{_escaped(name_of(model, "camera", c))}" pos="{_words(data.cam_xpos[c])}" '
        f'xyaxes="{_words(data.cam_xmat[c].reshape(3, 3).T[:2])}" fovy="{model.cam_fovy[c]:.6g}"/>'
        for c in range(model.ncam)
    ]
    center, extent = np.array(dense(model.stat.center)), float(model.stat.extent)
    near, far = (float(x) * extent for x in (model.vis.map.znear, model.vis.map.zfar))
    if corners:
        every = np.concatenate(corners)
        low, high = every.min(axis=0), every.max(axis=0)
        center, extent = 0.5 * (low + high), float(np.linalg.norm(high - low))
    # MuJoCo measures both in extents.
    return (
        f'<mujoco><statistic center="{_words(center)}" extent="{extent:.6g}"/>'
        f'<visual>{_HEADLIGHT}<map znear="{near / extent:.6g}" zfar="{far / extent:.6g}"/></visual>'
        f"<asset>{''.join(assets)}</asset>"
        f"<worldbody>{_LIGHT}{''.join(cameras)}{''.join(bodies)}</worldbody></mujoco>"
    )


def _words(numbers: np.ndarray) -> str:
    digits = "d" if numbers.dtype.kind == "i" else ".9g"
    return " ".join(format(x, digits) for x in numbers.ravel().tolist())


def _escaped(name: str) -> str:
    return name.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")


def _with_legend(picture: np.ndarray, colors: Mapping[str, str]) -> np.ndarray:
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default()
    for i, (name, color) in enumerate(list(colors.items())[:_MOST_LINES]):
        top = 8 + _LINE * i
        draw.rectangle([8, top, 20, top + 12], fill=color, outline="#333333")
        text = name.encode("ascii", "replace").decode("ascii")
        draw.text((28, top + 1), text, fill="#222222", font=font)
    drawn: np.ndarray = np.asarray(image)
    return drawn
