# SPDX-License-Identifier: Apache-2.0
"""Gives shared libraries names of their own, so that another copy may be in the same process.

The dynamic linker takes a library that is loaded already for one of the same name. The names stand
in the string table of the file (ELF, "Dynamic Section"); new ones of the same length need no other
change.
"""

from __future__ import annotations

import hashlib
import re
import struct
from collections.abc import Mapping, Sequence

_LOAD, _DYNAMIC = 1, 2
_NEEDED, _STRINGS, _NAME, _RPATH, _RUNPATH = 1, 5, 14, 15, 29
_BESIDE = b"$ORIGIN"


def is_elf(library: bytes) -> bool:
    """Whether it is a 64-bit library of Linux."""
    return library[:6] == b"\x7fELF\x02\x01"


def private_names(libraries: Sequence[tuple[str, bytes]]) -> dict[str, str]:
    """New names of the same length, which tell the content of all.

    Args:
        libraries: name and content of each; names as `lib<word>...`.
    """
    digest = hashlib.sha256(b"".join(content for _, content in libraries)).hexdigest()
    return {
        name: re.sub(r"(?<=^lib)[A-Za-z0-9]+", lambda word: digest[: len(word[0])], name)
        for name, _ in libraries
    }


def renamed(library: bytes, names: Mapping[str, str]) -> bytes:
    """A library with other names for itself and for those that it needs, which lie beside it.

    Raises:
        ValueError: it is no 64-bit ELF library, or a new name has another length.
    """
    if not is_elf(library):
        raise ValueError("private names are for 64-bit ELF libraries, those of Linux")
    out = bytearray(library)
    entries, strings = _dynamic(library)
    for tag, value in entries:
        at = strings + value
        if tag not in (_NEEDED, _NAME, _RPATH, _RUNPATH):
            continue
        text = library[at : library.index(b"\0", at)]
        if tag in (_RPATH, _RUNPATH):
            if len(text) >= len(_BESIDE):
                out[at : at + len(text)] = _BESIDE.ljust(len(text), b"\0")
            continue
        new = names.get(text.decode())
        if new is None:
            continue
        if len(new) != len(text):
            raise ValueError(f"the name {new!r} is not as long as {text.decode()!r}")
        out[at : at + len(text)] = new.encode()
    return bytes(out)


def name_of(library: bytes) -> str | None:
    """The name that a library gives itself."""
    return next(iter(_strings(library, _NAME)), None)


def needed(library: bytes) -> list[str]:
    """The names of the libraries that a library needs."""
    return _strings(library, _NEEDED)


def _strings(library: bytes, wanted: int) -> list[str]:
    entries, strings = _dynamic(library)
    starts = [strings + value for tag, value in entries if tag == wanted]
    return [library[at : library.index(b"\0", at)].decode() for at in starts]


def _dynamic(library: bytes) -> tuple[list[tuple[int, int]], int]:
    """Entries of the dynamic section, and where in the file its strings begin."""
    (first,) = struct.unpack_from("<Q", library, 0x20)
    size, count = struct.unpack_from("<HH", library, 0x36)
    heads = [struct.unpack_from("<IIQQQQQQ", library, first + i * size) for i in range(count)]
    entries: list[tuple[int, int]] = []
    for kind, _, offset, _, _, length, _, _ in heads:
        if kind == _DYNAMIC:
            for at in range(offset, offset + length, 16):
                tag, value = struct.unpack_from("<QQ", library, at)
                if tag == 0:
                    break
                entries.append((tag, value))
    address = next((value for tag, value in entries if tag == _STRINGS), None)
    if address is None:
        raise ValueError("the library has no dynamic section")
    for kind, _, offset, start, _, length, _, _ in heads:
        if kind == _LOAD and start <= address < start + length:
            return entries, offset + address - start
    raise ValueError("the library's string table is nowhere in the file")
