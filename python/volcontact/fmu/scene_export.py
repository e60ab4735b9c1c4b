# SPDX-License-Identifier: Apache-2.0
"""Writes a whole scene as a unit: MuJoCo with volumetric contact inside."""

from __future__ import annotations

import difflib
import os
import sys
import tempfile
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import mujoco

import volcontact
from volcontact._adaptor import adaptor
from volcontact.fmu.container import Container, of_kind, of_scene, source_of
from volcontact.fmu.description import About, description
from volcontact.fmu.drawing import documentation
from volcontact.fmu.export import check_choices
from volcontact.fmu.packing import (
    brought,
    common_files,
    identifier_of,
    now,
    platform_folder,
    token_of,
    write_zip,
)
from volcontact.fmu.private_names import name_of, private_names, renamed
from volcontact.fmu.scene_variables import Pair, scene_variables
from volcontact.fmu.variables import Group, group_line, scalar_line
from volcontact.given_keys import GivenKeys
from volcontact.scene import attach, load

if TYPE_CHECKING:
    from volcontact.given_keys import Values


def export_scene_fmu(
    scene: str | os.PathLike[str],
    path: str | os.PathLike[str],
    *,
    fmi: int = 2,
    bodies: Sequence[str] | None = None,
    contacts: Sequence[tuple[str, str]] = (),
    arrays: bool = True,
    material: Values | None = None,
    options: Values | None = None,
) -> Path:
    """Writes a whole scene as a Functional Mock-up Unit for Co-Simulation. docs/fmu.md.

    It has MuJoCo and volumetric contact in it, and steps as `mujoco.mj_step` does, to the bit.

    Args:
        scene: an MJCF file or text.
        path: of the FMU; its name without the suffix becomes the model's.
        fmi: the version of the standard, 2 or 3.
        bodies: those with values of their own; None for all.
        contacts: pairs of bodies or geoms whose contact has values of its own.
        arrays: of FMI 3: False gives the scalars of FMI 2, for masters that know no arrays.
        material: as of `attach`.
        options: likewise.

    Returns:
        The path written.

    Raises:
        FileNotFoundError: there is no such file.
        ValueError: the scene cannot be read or attached, or uses engine plugins; a body or geom is
            not there; both sides of a contact are the same.
        RuntimeError: the package has no binary for this version of the standard, or this is not
            Linux.
    """
    check_choices("export_scene_fmu", fmi=fmi)
    if not sys.platform.startswith("linux"):
        raise RuntimeError("units of whole scenes are made on Linux")
    from volcontact.running.simulation import to_start

    model = load(scene, material=material, options=options)
    if getattr(model, "nplugin", 0) > 0:
        raise ValueError(
            "the scene uses engine plugins, which a unit cannot carry; give volumetric contact by "
            "`volcontact/...` keys"
        )
    data = mujoco.MjData(model)
    to_start(model, data)
    pairs = [_pair(model, names) for names in contacts]
    binary = _binary_model(model)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the scene's author was told
        with attach(model, material=material, options=options):
            pass  # it must be one that can be attached
        drawn = _drawn(scene, model, material, options)
    laws = {law.name: law for one in (drawn.models if drawn else ()) for law in one.parameters}
    groups = scene_variables(
        model, data, bodies=_bodies(model, bodies), pairs=pairs, laws=laws
    )  # fmt: skip
    out = Path(path)
    libraries = _libraries()
    text = _scene_text(groups, pairs, list(libraries), float(model.opt.timestep),
                       GivenKeys(material, options)) + scalar_line(fmi, arrays=arrays)  # fmt: skip
    token = token_of(f"{fmi} {out.stem}", text, binary)
    identifier = identifier_of(out.stem)
    about = About(
        out.stem, f"MuJoCo with volumetric contact, of {source_of(scene)}", identifier, token, "cs",
        volcontact.__version__, now(), step=float(model.opt.timestep),
    )  # fmt: skip
    folder = f"binaries/{platform_folder(fmi)}"
    write_zip(
        out,
        common_files(fmi, identifier)
        | {
            "modelDescription.xml": description(fmi, about, groups, arrays=arrays).encode(),
            "documentation/index.html": documentation(about, groups, fmi, drawn).encode(),
            "resources/scene.txt": f"volcontact_scene 1\ntoken {token}\n{text}".encode(),
            "resources/scene.mjb": binary,
        }
        | {f"{folder}/{name}": content for name, content in libraries.items()},
    )
    return out


def _bodies(model: mujoco.MjModel, names: Sequence[str] | None) -> list[int]:
    known = {of_kind(model, "body", i): i for i in range(1, model.nbody)}
    if names is None:
        return list(known.values())
    for name in names:
        if name not in known:
            raise ValueError(_unknown("body", name, list(known)))
    return [known[name] for name in dict.fromkeys(names)]


def _pair(model: mujoco.MjModel, names: tuple[str, str]) -> Pair:
    a, b = names
    if a == b:
        raise ValueError(f"{a!r} is named twice; a contact is between different things")
    return Pair((a, b), (_geoms(model, a), _geoms(model, b)))


def _geoms(model: mujoco.MjModel, name: str) -> tuple[int, ...]:
    """Of a body, or the geom of that name."""
    bodies = {of_kind(model, "body", i): i for i in range(model.nbody)}
    geoms = {of_kind(model, "geom", i): i for i in range(model.ngeom)}
    if name in bodies:
        first = int(model.body_geomadr[bodies[name]])
        return tuple(range(first, first + int(model.body_geomnum[bodies[name]])))
    if name in geoms:
        return (geoms[name],)
    raise ValueError(_unknown("body and no geom", name, [*bodies, *geoms]))


def _unknown(kind: str, name: str, known: list[str]) -> str:
    near = difflib.get_close_matches(name, known, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    return f"the scene has no {kind} {name!r}; it has {', '.join(known)}{hint}"


def _binary_model(model: mujoco.MjModel) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.mjb"
        mujoco.mj_saveModel(model, str(path), None)
        return path.read_bytes()


def _drawn(
    scene: str | os.PathLike[str],
    model: mujoco.MjModel,
    material: Values | None,
    options: Values | None,
) -> Container | None:
    """The solids of all bodies that can touch, for the documentation; None where there are none."""
    names = [of_kind(model, "body", i) for i in range(model.nbody)]
    if len(set(names)) < max(2, len(names)):
        return None
    try:
        return of_scene(scene, names, material=material, options=options)
    except ValueError:
        return None


def _libraries() -> dict[str, bytes]:
    """The adaptor and MuJoCo under private names, in this order, and what a wheel brought."""
    ours = adaptor().path.read_bytes()
    package = Path(mujoco.__file__).parent
    found = sorted(package.glob("libmujoco.so*"))
    if len(found) != 1:
        raise RuntimeError(f"expected one libmujoco.so in {package}, found {len(found)}")
    theirs = found[0].read_bytes()
    libraries = {
        name_of(ours) or adaptor().path.name: ours,
        name_of(theirs) or found[0].name: theirs,
    }
    names = private_names(list(libraries.items()))
    private = {names[name]: renamed(content, names) for name, content in libraries.items()}
    return private | brought(ours)


def _scene_text(
    groups: list[Group], pairs: list[Pair], libraries: list[str], timestep: float, keys: GivenKeys
) -> str:
    """What the binary reads of a scene, plugin/fmu/scene/scene_file.h."""
    lines = [f"adaptor {libraries[0]}", f"mujoco {libraries[1]}", f"timestep {timestep!r}"]
    lines += [
        f"key {name} {len(numbers)} {' '.join(map(repr, numbers))}"
        for name, numbers in keys.items()
    ]
    for pair in pairs:
        sides = [" ".join(map(str, (len(geoms), *geoms))) for geoms in pair.geoms]
        lines.append(f"pair {sides[0]} {sides[1]}")
    lines += map(group_line, groups)
    return "\n".join(lines) + "\n"
