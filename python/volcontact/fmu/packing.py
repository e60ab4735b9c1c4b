# SPDX-License-Identifier: Apache-2.0
"""What all units have in common: names, token, icon, binaries, the archive."""

from __future__ import annotations

import datetime
import hashlib
import platform
import re
import sys
import zipfile
from pathlib import Path
from typing import Any

from volcontact._files import appearing
from volcontact.fmu.container import library_folder
from volcontact.fmu.drawing import icon
from volcontact.fmu.private_names import is_elf, needed, renamed

_EPOCH = (2020, 1, 1, 0, 0, 0)  # of all files: the same unit gives the same bytes
_UUID = ((0, 8), (8, 12), (12, 16), (16, 20), (20, 32))
SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
_ICONS = """<?xml version="1.0" encoding="UTF-8"?>
<fmiTerminalsAndIcons fmiVersion="3.0">
<GraphicalRepresentation>
<CoordinateSystem x1="-100" y1="-100" x2="100" y2="100" suggestedScalingFactorTo_mm="0.1"/>
<Icon x1="-100" y1="-100" x2="100" y2="100"/>
</GraphicalRepresentation>
</fmiTerminalsAndIcons>
"""


def identifier_of(name: str) -> str:
    """The name as a word of C."""
    identifier = re.sub(r"[^A-Za-z0-9_]", "_", name)
    return identifier if re.match(r"[A-Za-z_]", identifier) else "_" + identifier


def token_of(*parts: str | bytes) -> str:
    """A token for a unit of these parts."""
    digest = hashlib.sha256()
    for part in parts:
        digest.update(part.encode() if isinstance(part, str) else part)
        digest.update(b"\n")
    text = digest.hexdigest()
    return "{" + "-".join(text[a:b] for a, b in _UUID) + "}"


def now() -> str:
    """As modelDescription.xml writes a time."""
    return datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


def common_files(fmi: int, identifier: str) -> dict[str, bytes]:
    """Icon and binary of a unit, by their paths in it."""
    folder = f"binaries/{platform_folder(fmi)}"
    library = binary(fmi)
    files = {
        "model.png" if fmi == 2 else "terminalsAndIcons/icon.png": icon(),
        f"{folder}/{identifier}{SUFFIX}": beside(library),
    }
    files |= {f"{folder}/{name}": content for name, content in brought(library).items()}
    if fmi == 3:
        files["terminalsAndIcons/terminalsAndIcons.xml"] = _ICONS.encode()
    return files


def platform_folder(fmi: int) -> str:
    """The folder of binaries for this machine, as the standards name it."""
    system = {"win32": "windows", "darwin": "darwin"}.get(sys.platform, "linux")
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(
        platform.machine().lower(), platform.machine().lower()
    )
    if fmi == 3:
        return f"{machine}-{system}"
    short = {"windows": "win", "darwin": "darwin", "linux": "linux"}[system]
    return f"{short}64" if machine == "x86_64" else f"{machine}-{system}"


def beside(library: bytes) -> bytes:
    """A library that looks for what it needs in its own folder."""
    return renamed(library, {}) if is_elf(library) else library


def brought(library: bytes) -> dict[str, bytes]:
    """What a library needs of what a wheel brought along, such as that of OpenMP, by name."""
    folder = library_folder().parent / "volcontact.libs"  # as auditwheel names it
    found: dict[str, bytes] = {}
    waiting = [library] if is_elf(library) and folder.is_dir() else []
    while waiting:
        for name in needed(waiting.pop()):
            if name not in found and (folder / name).is_file():
                content = (folder / name).read_bytes()
                found[name] = beside(content)
                waiting.append(content)
    return found


def binary(fmi: int) -> bytes:
    """The library of a version of the standard."""
    path = library_folder() / f"volcontact_fmi{fmi}{SUFFIX}"
    if not path.is_file():
        raise RuntimeError(f"the package has no {path.name}; build it again")
    return path.read_bytes()


def write_zip(path: Path, files: dict[str, Any]) -> None:
    """Writes an FMU; the file appears whole or not at all."""
    with (
        appearing(path) as part,
        zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as out,
    ):
        for name in sorted(files, key=lambda name: (name != "modelDescription.xml", name)):
            info = zipfile.ZipInfo(name, _EPOCH)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            out.writestr(info, files[name])
