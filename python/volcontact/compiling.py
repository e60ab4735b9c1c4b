# SPDX-License-Identifier: Apache-2.0
"""Compiles scenes, and says what MuJoCo's message leaves open."""

from __future__ import annotations

import difflib
import os
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import mujoco

_MESHES = {".stl", ".obj", ".ply", ".off", ".msh", ".step", ".stp", ".iges", ".glb", ".dae"}


def compile_scene(path_or_text: str) -> mujoco.MjModel:
    """The model of a file, or of MJCF text.

    Raises:
        FileNotFoundError: there is no such file.
        ValueError: MuJoCo cannot compile it; a misspelt name in a tuple of ours is matched with
            the nearest one.
    """
    is_text = path_or_text.lstrip().startswith("<")
    if not is_text:
        require_scene(path_or_text)
    try:
        if is_text:
            return mujoco.MjModel.from_xml_string(path_or_text)
        if path_or_text.endswith(".mjb"):
            return mujoco.MjModel.from_binary_path(path_or_text)
        return mujoco.MjModel.from_xml_path(path_or_text)
    except ValueError as error:
        hint = _misspelt_reference(path_or_text, is_text=is_text)
        if hint is None:
            raise
        raise ValueError(hint) from error


def require_scene(path: str) -> None:
    """Raises what is wrong with a path before MuJoCo reads it.

    Raises:
        FileNotFoundError: there is no such file.
        ValueError: it is a mesh.
    """
    if not Path(path).is_file():
        raise FileNotFoundError(f"no such scene: {path}")
    if Path(path).suffix.lower() in _MESHES:
        raise ValueError(
            f"{path}: is a mesh, not a scene: name it in <asset><mesh file=.../> of a scene "
            "(`volcontact new NAME --template mesh_in_hole` writes one); "
            "`volcontact mesh check` looks at the mesh"
        )


def _misspelt_reference(path_or_text: str, *, is_text: bool) -> str | None:
    """MuJoCo refuses a tuple that names what is not there; says which name was meant."""
    try:
        roots = _roots(path_or_text, is_text=is_text)
    except (ElementTree.ParseError, OSError):
        return None
    bodies = [element for root in roots for element in root.iter()]
    for kind in ("geom", "body"):
        names = [e.get("name", "") for e in bodies if e.tag == kind and e.get("name")]
        for element in bodies:
            wanted = element.get("objname")
            if element.tag != "tuple" or "volcontact/" not in element.get("name", ""):
                continue
            for member in element.iter("element"):
                wanted = member.get("objname", "")
                if member.get("objtype") != kind or wanted in names:
                    continue
                near = difflib.get_close_matches(wanted, names, n=1)
                meant = f" (did you mean {near[0]!r}?)" if near else ""
                return f"{element.get('name')}: there is no {kind} {wanted!r}{meant}"
    return None


def _roots(path_or_text: str, *, is_text: bool) -> list[ElementTree.Element]:
    """The document and all it includes, each file once: files may include each other in a ring."""
    if is_text:
        return [ElementTree.fromstring(path_or_text)]
    top = Path(path_or_text)
    roots, waiting, seen = [], [top], {os.path.realpath(top)}
    while waiting:
        root = ElementTree.parse(waiting.pop()).getroot()
        roots.append(root)
        for include in root.iter("include"):
            file = top.parent / include.get("file", "")
            place = os.path.realpath(file)
            if place not in seen:
                seen.add(place)
                waiting.append(file)
    return roots
