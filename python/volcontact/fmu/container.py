# SPDX-License-Identifier: Apache-2.0
"""What goes into a unit: bodies and the contact models between them."""

from __future__ import annotations

import ctypes
import difflib
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from volcontact import _volcontact
from volcontact.scene import attach, load

if TYPE_CHECKING:
    from volcontact.given_keys import Values


@dataclass(frozen=True)
class Body:
    """A body of a unit, with where it starts: its frame in the world.

    Attributes:
        is_free: whether its motion is an input. What is fixed has none, and the world's frame.
    """

    name: str
    is_free: bool = True
    position: tuple[float, ...] = (0.0, 0.0, 0.0)
    quaternion: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0)
    twist: tuple[float, ...] = (0.0,) * 6


@dataclass(frozen=True)
class Parameter:
    """A number of a contact model, as the C container lists it."""

    name: str
    unit: str
    range: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class State:
    """What a law keeps of a site."""

    name: str
    unit: str
    count: int


@dataclass
class Model:
    """A contact model between two bodies, as text of the C container."""

    body_a: int
    body_b: int
    text: str
    parameters: list[Parameter] = field(default_factory=list)
    states: list[State] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.parameters, self.states = _tables(self.text)


@dataclass
class Container:
    """Bodies and models of a unit."""

    name: str
    bodies: list[Body]
    models: list[Model]
    source: str


def of_model(model: _volcontact.ContactModel, names: Sequence[str]) -> Container:
    """Of a contact model of Python: the bodies A and B, both free."""
    bodies = list(names) if names else ["A", "B"]
    if len(bodies) != 2 or bodies[0] == bodies[1]:
        raise ValueError(f"a ContactModel is between two bodies: give two names, not {bodies}")
    return Container(
        "contact",
        [Body(name) for name in bodies],
        [Model(0, 1, model.text)],
        "a contact model of Python",
    )


def of_scene(
    scene: str | os.PathLike[str],
    names: Sequence[str],
    *,
    material: Values | None = None,
    options: Values | None = None,
) -> Container:
    """The geoms, solids and materials of the named bodies of a scene.

    Raises:
        ValueError: a body is not there or named twice, or no two of them can touch.
    """
    from volcontact.running.simulation import to_start

    model = load(scene, material=material, options=options)
    data = mujoco.MjData(model)
    to_start(model, data)
    mujoco.mj_forward(model, data)
    ids = _ids(model, names)
    with attach(model, material=material, options=options) as contact:
        description = contact.description
        texts = [contact._pair_text(pair["pair"]) for pair in description["pairs"]]
    models: dict[tuple[int, int, str], list[str]] = {}
    for pair, text in zip(description["pairs"], texts, strict=True):
        sides = [_side(model, int(pair[key]), ids) for key in ("id_a", "id_b")]
        if sides[0] == sides[1] or not set(sides) <= set(ids):
            continue
        laws, solids = _in_bodies(model, data, text, [pair["id_a"], pair["id_b"]])
        models.setdefault((ids.index(sides[0]), ids.index(sides[1]), laws), []).append(solids)
    if not models:
        raise ValueError(
            f"no two of the bodies {', '.join(names)} can touch; `volcontact check` lists the "
            "pairs of the scene"
        )
    return Container(
        "scene",
        [_body(model, data, i) for i in ids],
        [Model(a, b, laws + "".join(pairs)) for (a, b, laws), pairs in models.items()],
        source_of(scene),
    )


def source_of(scene: str | os.PathLike[str]) -> str:
    """What a scene came from, for a sentence on a unit."""
    text = os.fspath(scene)
    if text.lstrip().startswith("<"):
        return "a scene given as text"
    return f"the scene {Path(text).name}"


def _ids(model: mujoco.MjModel, names: Sequence[str]) -> list[int]:
    known = [of_kind(model, "body", i) for i in range(model.nbody)]
    for name in names:
        if name not in known:
            near = difflib.get_close_matches(name, known, n=1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise ValueError(f"the scene has no body {name!r}; it has {', '.join(known)}{hint}")
        if list(names).count(name) > 1:
            raise ValueError(f"body {name!r} is named twice; a unit is between different bodies")
    if len(names) < 2:
        raise ValueError("name two bodies or more; 'world' is one")
    return [known.index(name) for name in names]


def _is_fixed(model: mujoco.MjModel, body: int) -> bool:
    return bool(model.body_weldid[body] == 0)


def _side(model: mujoco.MjModel, geom: int, ids: list[int]) -> int:
    """The body of a geom; what is fixed and not named itself is of the world."""
    body = int(model.geom_bodyid[geom])
    return 0 if body not in ids and _is_fixed(model, body) else body


def of_kind(model: mujoco.MjModel, kind: str, i: int) -> str:
    """The name of a body, geom, joint, ...; `body_3` where it has none."""
    number = int(getattr(mujoco.mjtObj, f"mjOBJ_{kind.upper()}"))
    return mujoco.mj_id2name(model, number, i) or f"{kind}_{i}"


def _body(model: mujoco.MjModel, data: mujoco.MjData, body: int) -> Body:
    if _is_fixed(model, body):
        return Body(of_kind(model, "body", body), is_free=False)
    twist = np.zeros(6)
    mujoco.mj_objectVelocity(model, data, int(mujoco.mjtObj.mjOBJ_XBODY), body, twist, 0)
    return Body(
        of_kind(model, "body", body),
        True,
        tuple(map(float, data.xpos[body])),
        tuple(map(float, data.xquat[body])),
        tuple(map(float, twist)),
    )


def _in_bodies(
    model: mujoco.MjModel, data: mujoco.MjData, text: str, geoms: list[int]
) -> tuple[str, str]:
    """The lines of the laws, and those of the pair with its solids posed in the bodies.

    What is fixed is posed in the world.
    """
    laws, _, solids = text.partition("pair\n")
    lines = ["pair"]
    for line in solids.splitlines():
        if line.startswith("at "):
            geom = geoms[len([one for one in lines if one.startswith("at ")])]
            pose = np.eye(4)
            turned = np.zeros(9)
            if _is_fixed(model, int(model.geom_bodyid[geom])):
                turned[:], pose[:3, 3] = data.geom_xmat[geom], data.geom_xpos[geom]
            else:
                mujoco.mju_quat2Mat(turned, model.geom_quat[geom])
                pose[:3, 3] = model.geom_pos[geom]
            pose[:3, :3] = turned.reshape(3, 3)
            inner = np.array([float(number) for number in line.split()[1:]]).reshape(4, 4)
            line = "at " + " ".join(repr(float(number)) for number in (pose @ inner).ravel())
        lines.append(line)
    return laws, "\n".join(lines) + "\n"


# ---- The C container, which knows names, units and ranges ----------------------------------------


def library_folder() -> Path:
    """Where the compiled parts of the package are."""
    return Path(_volcontact.__file__).resolve().parent


def _tables(text: str) -> tuple[list[Parameter], list[State]]:
    library = ctypes.CDLL(str(library_folder() / "libvolcontact.so"))
    library.vc_error.restype = ctypes.c_char_p
    model = ctypes.c_void_p()
    if library.vc_model_create_text(text.encode(), ctypes.byref(model)) != 0:
        raise ValueError(library.vc_error().decode())
    try:
        parameters = _read(library.vc_model_parameters, model)
        states = _read(library.vc_model_states, model)
    finally:
        library.vc_model_free(model)
    return (
        [
            Parameter(name, unit, allowed, tuple(float(number) for number in value.split()))
            for name, unit, allowed, value in parameters
            if unit != "word" and not name.startswith("pair/") and name != "threads"
        ],
        [State(name, unit, int(count)) for name, unit, _, count in states],
    )


def _read(function: Any, model: ctypes.c_void_p) -> list[list[str]]:
    buffer = ctypes.create_string_buffer(function(model, None, 0) + 1)
    function(model, buffer, len(buffer))
    return [line.split("\t") for line in buffer.value.decode().splitlines()]
