# SPDX-License-Identifier: Apache-2.0
"""Writes a unit: description, binaries, resources, documentation, icon."""

from __future__ import annotations

import datetime
import hashlib
import os
import platform
import re
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import volcontact
from volcontact import _volcontact
from volcontact._files import appearing
from volcontact.fmu import container as containers
from volcontact.fmu.container import Container
from volcontact.fmu.description import About, description
from volcontact.fmu.drawing import documentation, icon
from volcontact.fmu.variables import Group, variables

if TYPE_CHECKING:
    from volcontact.given_keys import Values

_CHOICES: dict[str, tuple[object, ...]] = {
    "fmi": (2, 3),
    "kind": ("me", "cs", "both"),
    "orientation": ("quaternion", "matrix"),
    "frame": ("world", "body"),
}
_MOST_SLOTS = 64
_EPOCH = (2020, 1, 1, 0, 0, 0)  # of all files: the same unit gives the same bytes


def export_fmu(
    scene: str | os.PathLike[str] | _volcontact.ContactModel,
    path: str | os.PathLike[str],
    *,
    bodies: Sequence[str] = (),
    fmi: int = 2,
    kind: str = "both",
    orientation: str = "quaternion",
    frame: str = "world",
    slots: int = 4,
    material: Values | None = None,
    options: Values | None = None,
) -> Path:
    """Writes the contact of some bodies as a Functional Mock-up Unit. docs/fmu.md.

    Args:
        scene: an MJCF file or text, or a contact model.
        path: of the FMU; its name without the suffix becomes the model's.
        bodies: their names in the scene, `world` for what is fixed; two names for a contact model.
        fmi: the version of the standard, 2 or 3.
        kind: `me` for Model Exchange, `cs` for Co-Simulation, `both`.
        orientation: of the bodies, as a `quaternion` w x y z or as a `matrix` of rotation.
        frame: of twists and wrenches, `world` or `body`.
        slots: contact sites of each contact model that have values of their own, and memory.
        material: as of `attach`.
        options: as of `attach`.

    Returns:
        The path written.

    Raises:
        ValueError: a body is not there, or named twice, or no two can touch; a choice is unknown.
        RuntimeError: the package has no binary for this version of the standard.
    """
    given = {"fmi": fmi, "kind": kind, "orientation": orientation, "frame": frame}
    for name, value in given.items():
        if value not in _CHOICES[name]:
            known = ", ".join(map(str, _CHOICES[name]))
            raise ValueError(f"export_fmu: {name} = {value!r} is none of {known}")
    if not 1 <= slots <= _MOST_SLOTS:
        raise ValueError(f"export_fmu: slots = {slots} must be 1 to {_MOST_SLOTS}")
    if isinstance(scene, _volcontact.ContactModel):
        container = containers.of_model(scene, bodies)
    else:
        container = containers.of_scene(scene, bodies, material=material, options=options)
    groups = variables(container, kind=kind, orientation=orientation, frame=frame, slots=slots)
    out = Path(path)
    container.name = out.stem
    files = _files(container, groups, fmi=fmi, kind=kind, frame=frame, slots=slots)
    write_zip(out, files)
    return out


def _files(
    container: Container, groups: list[Group], *, fmi: int, kind: str, frame: str, slots: int
) -> dict[str, bytes]:
    identifier = re.sub(r"[^A-Za-z0-9_]", "_", container.name)
    if not re.match(r"[A-Za-z_]", identifier):
        identifier = "_" + identifier
    models = {f"model_{m}.txt": model.text for m, model in enumerate(container.models)}
    body = _unit(container, groups, frame, slots)
    key = "\n".join([f"{fmi} {kind} {container.name}", body, *models.values()])
    digest = hashlib.sha256(key.encode()).hexdigest()
    token = "{" + "-".join(digest[a:b] for a, b in _UUID) + "}"
    now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    about = About(container, identifier, token, kind, volcontact.__version__, now)
    texts = {
        "modelDescription.xml": description(fmi, about, groups),
        "documentation/index.html": documentation(about, groups, fmi),
        "resources/unit.txt": f"volcontact_unit 1\ntoken {token}\n{body}",
        **{f"resources/{name}": text for name, text in models.items()},
    }
    files = {name: text.encode() for name, text in texts.items()}
    files["model.png" if fmi == 2 else "terminalsAndIcons/icon.png"] = icon()
    if fmi == 3:
        files["terminalsAndIcons/terminalsAndIcons.xml"] = _ICONS.encode()
    files[f"binaries/{platform_folder(fmi)}/{identifier}{_SUFFIX}"] = _binary(fmi)
    return files


_UUID = ((0, 8), (8, 12), (12, 16), (16, 20), (20, 32))
_SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
_ICONS = """<?xml version="1.0" encoding="UTF-8"?>
<fmiTerminalsAndIcons fmiVersion="3.0">
<GraphicalRepresentation>
<CoordinateSystem x1="-100" y1="-100" x2="100" y2="100" suggestedScalingFactorTo_mm="0.1"/>
<Icon x1="-100" y1="-100" x2="100" y2="100"/>
</GraphicalRepresentation>
</fmiTerminalsAndIcons>
"""


def _unit(container: Container, groups: list[Group], frame: str, slots: int) -> str:
    """What the binary reads of a unit, plugin/fmu/unit_file.h."""
    lines = [f"slots {slots}", f"frame {frame}"]
    lines += [f"body {'free' if body.is_free else 'fixed'}" for body in container.bodies]
    lines += [f"model {model.body_a} {model.body_b}" for model in container.models]
    for group in groups:
        starts = " ".join(repr(float(value)) for value in group.start)
        tunable = int(group.variability == "tunable")
        lines.append(
            f"group {group.role} {group.index} {group.first} {group.count} {tunable} {group.key} "
            f"{starts}"
        )
    return "\n".join(lines) + "\n"


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


def _binary(fmi: int) -> bytes:
    path = containers.library_folder() / f"volcontact_fmi{fmi}{_SUFFIX}"
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
