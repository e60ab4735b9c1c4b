# SPDX-License-Identifier: Apache-2.0
"""Where the value of an input goes: into numbers of the model, its text, the start, a controller.

A target is written as `volcontact/material/steel/friction`, `geom/peg/size/0`, `option/gravity/2`,
`qpos/JOINT/0`, `qvel/JOINT`, `act/ACTUATOR` or `control/GAIN`; with a minus in front the value is
added the other way. Numbers that MuJoCo's compiler uses for nothing else are changed in the
compiled model; for all others the model is compiled anew.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from volcontact.messages.spelling import nearest
from volcontact.study.file.settings import Input, StudyError
from volcontact.study.mjcf import Document, missing, with_value

_STATES = ("qpos", "qvel", "act")
# Attribute of an element -> array of the model. Nothing else is computed from these.
_LIVE = {
    ("geom", "friction"): "geom_friction",
    ("actuator", "gainprm"): "actuator_gainprm",
    ("actuator", "biasprm"): "actuator_biasprm",
    ("actuator", "ctrlrange"): "actuator_ctrlrange",
    ("actuator", "forcerange"): "actuator_forcerange",
    ("option", "gravity"): "gravity",
    ("option", "wind"): "wind",
    ("option", "timestep"): "timestep",
}
_ACTUATORS = ("general", "motor", "position", "velocity")


@dataclass(frozen=True)
class Target:
    """One place a value goes.

    Attributes:
        text: as the study writes it.
        column: of the value.
        where: `numeric`, `attribute`, `option`, `qpos`, `qvel`, `act` or `control`.
        tag, name, key, index: of an attribute; name and index of the others.
        mode: `set`, `add` or `scale`.
        live: whether the model need not be compiled anew.
        sign: -1 where a target to add to begins with a minus.
    """

    text: str
    column: str
    where: str
    tag: str
    name: str
    key: str
    index: int | None
    mode: str
    live: bool
    sign: float = 1.0

    def value(self, values: dict[str, Any]) -> Any:
        """The value of its column, with the sign of the target."""
        value = values[self.column]
        return value if isinstance(value, str) else self.sign * float(value)


def targets_of(given: Input, document: Document | None) -> list[Target]:
    """The targets of an input, checked against the scene as text.

    Raises:
        StudyError: the scene has no such thing.
    """
    found = []
    for text in given.targets:
        minus = text.startswith("-")
        if minus and given.mode != "add":
            raise StudyError(f"target {text!r}: a minus needs mode = 'add'")
        for axis, column in enumerate(given.columns):
            target = _parse(text.removeprefix("-"), column, given.mode, document)
            if minus:
                target = dataclasses.replace(target, sign=-1.0)
            if given.kind == "rotation":
                if target.where != "qpos":
                    raise StudyError(f"target {text!r}: a rotation goes to qpos/JOINT of a joint")
                target = dataclasses.replace(target, index=_first(target) + axis)
            found.append(target)
    return found


def _first(target: Target) -> int:
    return 3 if target.index is None else target.index  # behind the position of a free joint


def _parse(text: str, column: str, mode: str, document: Document | None) -> Target:
    def made(where: str, tag: str, name: str, key: str, index: int | None, live: bool) -> Target:
        return Target(text, column, where, tag, name, key, index, mode, live)

    parts = text.split("/")
    index = int(parts[-1]) if parts[-1].isdecimal() else None
    words = parts[:-1] if index is not None else parts
    if words[0] == "control":
        if len(words) != 2:
            raise StudyError(f"target {text!r}: must be control/GAIN")
        return made("control", "", words[1], "", None, True)
    if document is None:
        raise StudyError(f"target {text!r}: a function study has no scene; leave target away")
    if words[0] == "volcontact":
        return _numeric(text, document, made)
    if words[0] in _STATES:
        if len(words) != 2:
            raise StudyError(f"target {text!r}: must be {words[0]}/NAME or {words[0]}/NAME/INDEX")
        _check_state(text, words[0], words[1], document)
        return made(words[0], "", words[1], "", index, True)
    if words[0] == "option" and len(words) == 2:
        live = ("option", words[1]) in _LIVE
        return made("option", "option", "", words[1], index, live)
    if len(words) != 3:
        raise StudyError(
            f"target {text!r}: must be volcontact/..., ELEMENT/NAME/ATTRIBUTE, option/NAME, "
            "qpos/JOINT, qvel/JOINT, act/ACTUATOR or control/GAIN, with /INDEX where one is meant"
        )
    tag, name, key = words
    element = document.find(tag, name)
    if element is None:
        raise missing(document, tag, name, text)
    kind = "actuator" if tag in _ACTUATORS else tag
    live = (kind, key) in _LIVE and index is not None
    if not live:
        with_value(document.attribute(element, key), index, 1.0, mode, text)
    return made("attribute", tag, name, key, index, live)


def _numeric(text: str, document: Document, made: Callable[..., Target]) -> Target:
    names = document.names("numeric")
    if text in names:
        return made("numeric", "numeric", text, "data", None, True)
    stem, _, last = text.rpartition("/")
    if last.isdecimal() and stem in names:
        return made("numeric", "numeric", stem, "data", int(last), True)
    ours = [name for name in names if name.startswith("volcontact/")]
    raise StudyError(f"target {text!r}: the scene has no such number{nearest(text, ours)}")


def _check_state(text: str, kind: str, name: str, document: Document) -> None:
    if kind == "act":
        known = [n for tag in _ACTUATORS for n in document.names(tag)]
    else:
        known = [*document.names("joint"), *document.names("freejoint")]
        # A free joint mostly has no name: that of its body then stands for it.
        for body in document.root.iter("body"):
            joints = [*body.findall("freejoint"), *body.findall("joint")]
            if len(joints) == 1 and not joints[0].get("name") and body.get("name"):
                known.append(body.get("name", ""))
    if name not in known:
        thing = "actuator" if kind == "act" else "joint"
        raise StudyError(
            f"target {text!r}: the scene has no {thing} {name!r}{nearest(name, known)}"
        )


def changed_text(document: Document, targets: list[Target], values: dict[str, Any]) -> str:
    """The scene as text with the values of the targets that are not live."""
    changed = document.copy()
    for target in targets:
        if target.live or target.where not in ("attribute", "option"):
            continue
        if target.where == "option":
            element = changed.root.find("option")
            if element is None:
                raise StudyError(f"target {target.text!r}: the scene has no element option")
        else:
            found = changed.find(target.tag, target.name)
            assert found is not None
            element = found
        nominal = changed.attribute(element, target.key)
        value = target.value(values)
        element.set(target.key, with_value(nominal, target.index, value, target.mode, target.text))
    return changed.text()


class LiveNumbers:
    """Writes the live targets of a compiled model, and its start.

    Args:
        model: compiled; its numbers are the nominal ones.
        targets: all targets of the study.
    """

    def __init__(self, model: mujoco.MjModel, targets: list[Target]) -> None:
        self._model = model
        self._arrays: list[tuple[Target, np.ndarray, Any, np.ndarray]] = []
        self._states: list[tuple[Target, int | slice]] = []
        for target in targets:
            if target.where in _STATES:
                self._states.append((target, _state_place(model, target)))
            elif target.live and target.where != "control":
                array, place = _live_place(model, target)
                self._arrays.append((target, array, place, np.array(array[place])))

    def write(self, values: dict[str, Any]) -> None:
        """Puts the values of a trial into the model, from the nominal ones."""
        for _, array, place, nominal in self._arrays:
            array[place] = nominal
        for target, array, place, _ in self._arrays:
            _put(array, place, target.value(values), target.mode)

    def start(self, data: mujoco.MjData, values: dict[str, Any]) -> None:
        """Puts the values of a trial into the state."""
        for target, place in self._states:
            array = getattr(data, target.where)
            _put(array, place, target.value(values), target.mode)


def _put(array: np.ndarray, place: Any, value: float, mode: str) -> None:
    if mode == "set":
        array[place] = value
    elif mode == "add":
        array[place] += value
    else:
        array[place] *= value


class _Timestep:
    """The timestep, which MuJoCo has as a plain number, written like an array."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._option = model.opt

    def __getitem__(self, place: Any) -> float:
        return float(self._option.timestep)

    def __setitem__(self, place: Any, value: Any) -> None:
        self._option.timestep = float(value)


def _live_place(model: mujoco.MjModel, target: Target) -> tuple[Any, Any]:
    if target.where == "numeric":
        number = _id(model, "NUMERIC", target.name)
        size = int(model.numeric_size[number])
        index = target.index or 0
        if index >= size:
            raise StudyError(f"target {target.text!r}: index must be from 0 to {size - 1}")
        return model.numeric_data, int(model.numeric_adr[number]) + index
    if target.where == "option":
        if target.key == "timestep":
            return _Timestep(model), 0
        return getattr(model.opt, target.key), slice(None) if target.index is None else target.index
    kind = "actuator" if target.tag in _ACTUATORS else target.tag
    array = getattr(model, _LIVE[kind, target.key])
    row = _id(model, kind.upper(), target.name)
    if target.index is not None and target.index >= array.shape[1]:
        raise StudyError(f"target {target.text!r}: index must be from 0 to {array.shape[1] - 1}")
    return array, (row, target.index)


def _state_place(model: mujoco.MjModel, target: Target) -> int | slice:
    if target.where == "act":
        number = _id(model, "ACTUATOR", target.name)
        first = int(model.actuator_actadr[number]) if hasattr(model, "actuator_actadr") else -1
        if not hasattr(model, "actuator_actadr"):  # MuJoCo 2.2: those with states come last
            first = number - (model.nu - model.na)
        if first < 0:
            raise StudyError(f"target {target.text!r}: this actuator has no activation")
        return first + (target.index or 0)
    first, size = joint_place(model, target.name, target.where)
    index = target.index or 0
    if index >= size:
        raise StudyError(f"target {target.text!r}: index must be from 0 to {size - 1}")
    return first + index


def joint_place(model: mujoco.MjModel, name: str, where: str) -> tuple[int, int]:
    """First place and length in qpos or qvel of a joint, or of the only joint of a body."""
    joint = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_JOINT), name)
    if joint < 0:
        body = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_BODY), name)
        if body < 0 or model.body_jntnum[body] != 1:
            raise StudyError(f"{where}/{name}: the scene has no joint {name!r}")
        joint = int(model.body_jntadr[body])
    kind = int(model.jnt_type[joint])
    lengths = {0: (7, 6), 1: (4, 3)}.get(kind, (1, 1))
    if where == "qpos":
        return int(model.jnt_qposadr[joint]), lengths[0]
    return int(model.jnt_dofadr[joint]), lengths[1]


def _id(model: mujoco.MjModel, kind: str, name: str) -> int:
    number = mujoco.mj_name2id(model, int(getattr(mujoco.mjtObj, f"mjOBJ_{kind}")), name)
    if number < 0:
        raise StudyError(f"the scene has no {kind.lower()} {name!r}")
    return int(number)
