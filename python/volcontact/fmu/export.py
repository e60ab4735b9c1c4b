# SPDX-License-Identifier: Apache-2.0
"""Writes a unit: description, binaries, resources, documentation, icon."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import volcontact
from volcontact import _volcontact
from volcontact.fmu import container as containers
from volcontact.fmu.container import Container
from volcontact.fmu.description import About, description
from volcontact.fmu.drawing import documentation
from volcontact.fmu.packing import common_files, identifier_of, now, token_of, write_zip
from volcontact.fmu.sources import build_description, source_files
from volcontact.fmu.variables import Group, group_line, scalar_line, variables

if TYPE_CHECKING:
    from volcontact.given_keys import Values

_CHOICES: dict[str, tuple[object, ...]] = {
    "fmi": (2, 3),
    "kind": ("me", "cs", "both"),
    "orientation": ("quaternion", "matrix"),
    "frame": ("world", "body"),
}
_MOST_SLOTS = 64


def check_choices(function: str, **given: object) -> None:
    """Raises where an argument is none of the words it may be.

    Raises:
        ValueError: naming the words.
    """
    for name, value in given.items():
        if value not in _CHOICES[name]:
            known = ", ".join(map(str, _CHOICES[name]))
            raise ValueError(f"{function}: {name} = {value!r} is none of {known}")


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
    arrays: bool = True,
    sources: bool = False,
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
        arrays: of FMI 3: False gives the scalars of FMI 2, for masters that know no arrays.
        sources: whether the sources are inside, for masters that compile them.
        material: as of `attach`.
        options: as of `attach`.

    Returns:
        The path written.

    Raises:
        ValueError: a body is not there, or named twice, or no two can touch; a choice is unknown.
        RuntimeError: the package has no binary for this version of the standard, or no sources.
    """
    check_choices("export_fmu", fmi=fmi, kind=kind, orientation=orientation, frame=frame)
    if not 1 <= slots <= _MOST_SLOTS:
        raise ValueError(f"export_fmu: slots = {slots} must be 1 to {_MOST_SLOTS}")
    if isinstance(scene, _volcontact.ContactModel):
        container = containers.of_model(scene, bodies)
    else:
        container = containers.of_scene(scene, bodies, material=material, options=options)
    groups = variables(container, kind=kind, orientation=orientation, frame=frame, slots=slots)
    out = Path(path)
    container.name = out.stem
    files = _files(
        container, groups, fmi=fmi, kind=kind, frame=frame, slots=slots, sources=sources,
        arrays=arrays,
    )  # fmt: skip
    write_zip(out, files)
    return out


def _files(
    container: Container,
    groups: list[Group],
    *,
    fmi: int,
    kind: str,
    frame: str,
    slots: int,
    sources: bool,
    arrays: bool,
) -> dict[str, bytes]:
    identifier = identifier_of(container.name)
    models = {f"model_{m}.txt": model.text for m, model in enumerate(container.models)}
    body = _unit(container, groups, frame, slots) + scalar_line(fmi, arrays=arrays)
    token = token_of(f"{fmi} {kind} {container.name}", body, *models.values())
    inside, to_compile = source_files(fmi) if sources else ({}, [])
    if sources and fmi == 3:
        inside["buildDescription.xml"] = build_description(identifier, to_compile).encode()
    about = About(
        container.name, text_of(container), identifier, token, kind,
        volcontact.__version__, now(), container=container, sources=tuple(to_compile),
    )  # fmt: skip
    texts = {
        "modelDescription.xml": description(fmi, about, groups, arrays=arrays),
        "documentation/index.html": documentation(about, groups, fmi),
        "resources/unit.txt": f"volcontact_unit 1\ntoken {token}\n{body}",
        **{f"resources/{name}": text for name, text in models.items()},
    }
    files = common_files(fmi, identifier) | {name: text.encode() for name, text in texts.items()}
    return files | {f"sources/{name}": content for name, content in inside.items()}


def text_of(container: Container) -> str:
    """One sentence on a unit."""
    bodies = ", ".join(body.name for body in container.bodies)
    return f"Volumetric contact between {bodies}, from {container.source}"


def _unit(container: Container, groups: list[Group], frame: str, slots: int) -> str:
    """What the binary reads of a unit, plugin/fmu/unit_file.h."""
    lines = [f"slots {slots}", f"frame {frame}"]
    lines += [f"body {'free' if body.is_free else 'fixed'}" for body in container.bodies]
    lines += [f"model {model.body_a} {model.body_b}" for model in container.models]
    lines += map(group_line, groups)
    return "\n".join(lines) + "\n"
