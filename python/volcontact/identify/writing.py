# SPDX-License-Identifier: Apache-2.0
"""The scene with the values that were found, as MJCF that loads as it is."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from volcontact._files import appearing
from volcontact.identify.bench import Values, written
from volcontact.identify.settings import Settings
from volcontact.study.mjcf import Document, with_value
from volcontact.study.targets import targets_of

_FILES = {"mesh": "meshdir", "texture": "texturedir", "hfield": "meshdir", "skin": "meshdir"}
_KEYS = ("file", "fileright", "fileleft", "fileup", "filedown", "filefront", "fileback")


def write_scene(settings: Settings, values: Values, file: Path, note: str) -> None:
    """Writes the scene of a study with values, and a comment at its top.

    Raises:
        StudyError: a target does not fit the scene.
        OSError: the file cannot be written.
    """
    document = Document(settings.scene)
    given = written(settings, values)
    for each in settings.parameters:
        for target in targets_of(each.as_input(), document):
            if target.where not in ("numeric", "attribute", "option"):
                continue
            element = document.root.find("option")
            if target.where != "option":
                element = document.find(target.tag, target.name)
            assert element is not None
            nominal = document.attribute(element, target.key)
            value = target.sign * given[target.column]
            index = target.index
            if target.where == "numeric":
                index = index or 0
            element.set(target.key, with_value(nominal, index, value, target.mode, target.text))
    if settings.timestep is not None:
        option = document.root.find("option")
        if option is None:
            option = ElementTree.SubElement(document.root, "option")
        option.set("timestep", repr(settings.timestep))
    _keys(document, settings)
    _near_files(document, file.resolve().parent)
    ElementTree.indent(document.root)
    with appearing(file) as made:
        safe = note.replace("--", "- -")
        text = document.text().replace(" />", "/>")
        made.write_text(f"<!-- {safe} -->\n{text}\n", encoding="utf-8")


def _keys(document: Document, settings: Settings) -> None:
    """Options of the study; a material of the study has no name that could be written."""
    if not settings.options:
        return
    custom = document.root.find("custom")
    if custom is None:
        custom = ElementTree.SubElement(document.root, "custom")
    for key, value in settings.options.items():
        word = isinstance(value, str)
        name = f"volcontact/option/{key}/{value}" if word else f"volcontact/option/{key}"
        if document.find("numeric", name) is None:
            data = "1" if word else repr(float(value))
            ElementTree.SubElement(custom, "numeric", {"name": name, "data": data})


def _near_files(document: Document, folder: Path) -> None:
    """Paths of meshes and textures from the folder of the new file."""
    whole = document.root.findall("compiler")[-1]  # which `Document` added
    used = {
        _FILES[element.tag]
        for element in document.root.iter()
        if element.tag in _FILES and any(key in element.attrib for key in _KEYS)
    }
    for key in ("meshdir", "texturedir"):
        place = whole.attrib.pop(key)
        if key in used:
            whole.set(key, os.path.relpath(place, folder))
            for other in document.root.findall("compiler")[:-1]:
                other.attrib.pop("assetdir", None)
                other.attrib.pop(key, None)
    if not whole.attrib:
        document.root.remove(whole)
