# SPDX-License-Identifier: Apache-2.0
"""An MJCF document as one tree whose attributes can be changed, on every MuJoCo release."""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from volcontact.messages.spelling import nearest
from volcontact.study.file.settings import StudyError


class Document:
    """A scene with everything that it includes.

    Args:
        path: of the MJCF file.

    Raises:
        StudyError: it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self._folder = path.parent
        try:
            self.root = self._expanded(ElementTree.parse(path).getroot(), {path.resolve()})
        except (ElementTree.ParseError, OSError) as error:
            raise StudyError(f"{path.name}: {error}") from error
        self._name_folders()
        self._parents = {child: parent for parent in self.root.iter() for child in parent}

    def _expanded(self, root: ElementTree.Element, seen: set[Path]) -> ElementTree.Element:
        children: list[ElementTree.Element] = []
        for child in root:
            if child.tag == "include":
                file = (self._folder / child.get("file", "")).resolve()
                if file in seen:
                    continue
                seen.add(file)
                children.extend(self._expanded(ElementTree.parse(file).getroot(), seen))
            else:
                children.append(self._expanded(child, seen))
        root[:] = children
        return root

    def _name_folders(self) -> None:
        """Text has no folder of its own, so that meshes and textures need whole paths."""
        said: dict[str, str] = {}
        for compiler in self.root.iter("compiler"):
            said.update(compiler.attrib)
        top = ElementTree.SubElement(self.root, "compiler")
        for kind in ("meshdir", "texturedir"):
            folder = said.get(kind, said.get("assetdir", ""))
            top.set(kind, str((self._folder / folder).resolve()))

    def text(self) -> str:
        """The document."""
        return ElementTree.tostring(self.root, encoding="unicode")

    def copy(self) -> Document:
        """Another one to change."""
        made = Document.__new__(Document)
        made._folder = self._folder
        made.root = copy.deepcopy(self.root)
        made._parents = {child: parent for parent in made.root.iter() for child in parent}
        return made

    def names(self, tag: str) -> list[str]:
        """Names of all elements of a kind, in worldbody, assets, actuators and so on."""
        return [name for name in map(self._name, self._elements(tag)) if name]

    def tags(self) -> set[str]:
        """All kinds of elements."""
        return {element.tag for element in self.root.iter()}

    def find(self, tag: str, name: str) -> ElementTree.Element | None:
        """The element of that kind and name; an `inertial` goes by the name of its body."""
        for element in self._elements(tag):
            if self._name(element) == name:
                return element
        return None

    def _name(self, element: ElementTree.Element) -> str:
        named = self._parents[element] if element.tag == "inertial" else element
        return named.get("name", "")

    def _elements(self, tag: str) -> list[ElementTree.Element]:
        found = []
        for top in self.root:
            if top.tag != "default":
                found += list(top.iter(tag))
        return found

    def attribute(self, element: ElementTree.Element, key: str) -> str | None:
        """What an element says, itself or by its default class; None when neither does."""
        if key in element.attrib:
            return element.attrib[key]
        name = element.get("class") or self._childclass(element)
        for default in self._default_chain(name):
            for entry in default.findall(element.tag):
                if key in entry.attrib:
                    return entry.attrib[key]
        return None

    def _childclass(self, element: ElementTree.Element) -> str | None:
        parent = self._parents.get(element)
        while parent is not None:
            if parent.get("childclass"):
                return parent.get("childclass")
            parent = self._parents.get(parent)
        return None

    def _default_chain(self, name: str | None) -> list[ElementTree.Element]:
        """Defaults of a class, the innermost first, up to the unnamed ones at the top."""
        chain: list[ElementTree.Element] = []
        if name is not None:
            for default in self.root.iter("default"):
                if default.get("class") == name:
                    here: ElementTree.Element | None = default
                    while here is not None and here.tag == "default":
                        chain.append(here)
                        here = self._parents.get(here)
                    break
        tops = [d for d in self.root.findall("default") if d not in chain]
        return chain + [d for d in tops if d.get("class") in (None, "main")]


def with_value(
    nominal: str | None, index: int | None, value: float | str, mode: str, what: str
) -> str:
    """The text of an attribute after a value was set, added or multiplied.

    Args:
        nominal: what the scene says.
        index: of the number that changes; None for all of it.
        value: of the input.
        mode: `set`, `add` or `scale`.
        what: the target, for messages.

    Raises:
        StudyError: the scene says nothing to add to, or has no number of that index.
    """
    if isinstance(value, str) or (mode == "set" and index is None):
        return value if isinstance(value, str) else repr(float(value))
    if nominal is None:
        raise StudyError(
            f"target {what!r}: the scene gives no such attribute; write it there, or take "
            "mode = 'set' and no index"
        )
    numbers = [float(word) for word in nominal.split()]
    if index is not None and not 0 <= index < len(numbers):
        raise StudyError(f"target {what!r}: index must be from 0 to {len(numbers) - 1}")
    for place in range(len(numbers)) if index is None else (index,):
        if mode == "set":
            numbers[place] = float(value)
        elif mode == "add":
            numbers[place] += float(value)
        else:
            numbers[place] *= float(value)
    return " ".join(map(repr, numbers))


def missing(document: Document, tag: str, name: str, what: str) -> StudyError:
    """Why a target is not there."""
    if tag not in document.tags():
        hint = nearest(tag, document.tags())
        return StudyError(f"target {what!r}: the scene has no element {tag!r}{hint}")
    return StudyError(
        f"target {what!r}: the scene has no {tag} {name!r}{nearest(name, document.names(tag))}"
    )
