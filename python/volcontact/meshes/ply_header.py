# SPDX-License-Identifier: Apache-2.0
"""The header of a PLY file: which elements follow, and of which numbers each is made."""

from __future__ import annotations

from dataclasses import dataclass, field

from volcontact.meshes.text_lines import count_of
from volcontact.meshes.triangles import fail

__all__ = ["Element", "Header", "Property", "read_header"]

_NAMES = {
    "i1": "char int8",
    "u1": "uchar uint8",
    "i2": "short int16",
    "u2": "ushort uint16",
    "i4": "int int32",
    "u4": "uint uint32",
    "f4": "float float32",
    "f8": "double float64",
}
_CODES = {name: code for code, names in _NAMES.items() for name in names.split()}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True)
class Property:
    """One property of an element: a number, or a list of numbers with its length before it."""

    name: str
    code: str  # of numpy, such as "f4"
    count_code: str = ""  # of a list


@dataclass
class Element:
    """A kind of rows: how many and of what."""

    name: str
    count: int
    line: int
    properties: list[Property] = field(default_factory=list)

    def index(self, *names: str) -> int | None:
        """The place of the first property with one of the names."""
        for place, one in enumerate(self.properties):
            if one.name in names:
                return place
        return None


@dataclass(frozen=True)
class Header:
    """What a header says, and where the data begin."""

    order: str  # "" for ASCII, else of numpy: "<" or ">"
    elements: list[Element]
    size: int  # [byte]
    lines: int


def read_header(path: str, content: bytes) -> Header:
    """Reads everything up to end_header."""
    order: str | None = None
    elements: list[Element] = []
    at = number = 0
    while True:
        end = content.find(b"\n", at)
        if end < 0 or number > 10_000:
            fail(path, f"line {number + 1}", "the header has no end_header: the file was cut off")
        number += 1
        words = content[at:end].decode("latin-1").split()
        at = end + 1
        place = f"line {number}"
        keyword = words[0] if words else ""
        if number == 1:
            if words != ["ply"]:
                fail(path, place, "a PLY file begins with ply", "Check what kind of file it is")
        elif keyword in ("comment", "obj_info"):
            continue
        elif keyword == "format" and len(words) == 3 and words[1] in _ORDERS:
            order = _ORDERS[words[1]]
        elif keyword == "element" and len(words) == 3:
            count = count_of(path, number, words[2], f"rows of {words[1]}", len(content))
            elements.append(Element(words[1], count, number))
        elif keyword == "property" and elements:
            elements[-1].properties.append(_property(path, place, words))
        elif keyword == "end_header":
            break
        else:
            shown = "".join(letter if letter.isprintable() else "?" for letter in " ".join(words))
            fail(path, place, f"'{shown[:30]}' is no line of a PLY header")
    if order is None:
        fail(path, "line 2", "the header does not name the format of the numbers")
    return Header(order, elements, at, number)


def _property(path: str, place: str, words: list[str]) -> Property:
    types = words[2:4] if words[1:2] == ["list"] else words[1:2]
    if len(words) != (5 if len(types) == 2 else 3) or any(name not in _CODES for name in types):
        fail(path, place, "a property needs known types and a name")
    codes = [_CODES[name] for name in types]
    if len(codes) == 2:
        if codes[0].startswith("f"):
            fail(path, place, "the length of a list is a whole number")
        return Property(words[4], codes[1], codes[0])
    return Property(words[2], codes[0])
