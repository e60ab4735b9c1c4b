# SPDX-License-Identifier: Apache-2.0
"""Keys that a program gives beside those of the file: a material and options."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np

import volcontact._volcontact as core
from volcontact._adaptor import GIVEN_MATERIAL, Key, adaptor
from volcontact.messages.spelling import nearest

Value = float | str | Sequence[float]
Values = Mapping[str, Value]

_OPTION = "volcontact/option/"
# Keys whose value is a number, of a material and of the options.
NUMBERS = {*core.units_of_law_fields(), "tolerance", "threads", "exit_speed"}
_OF_OPTIONS = (
    "tolerance", "threads", "engine", "target", "implicit", "mesh", "pairs", "formulation",
)  # fmt: skip


def refuse(call: str, values: Mapping[str, object]) -> None:
    """Answers arguments that a function has not, beside `material` and `options`.

    Raises:
        TypeError: there are any; it tells where the first belongs.
    """
    for word, value in values.items():
        line = f"{call} has no argument {word!r}"
        if word in _OF_OPTIONS:
            raise TypeError(f"{line}: it is an option, options={{{word!r}: {value!r}}}")
        if word in NUMBERS or word in {"normal_law", "friction_law"}:
            raise TypeError(f"{line}: it is of the material, material={{{word!r}: {value!r}}}")
        raise TypeError(line + nearest(word, ("material", "options")))


class GivenKeys:
    """`material` and `options` as MJCF keys: `arguments` are those of the functions `..._with`.

    Raises:
        TypeError: not a mapping from names to numbers and words.
    """

    def __init__(self, material: Values | None, options: Values | None) -> None:
        self.material = material
        self.options = options
        self._alive: list[object] = []  # what the records point to
        records = [
            self._record(name, numbers)
            for what, stem, values in (
                ("material", GIVEN_MATERIAL, material),
                ("options", _OPTION, options),
            )
            for name, numbers in _keys(what, stem, values or {})
        ]
        self._records = (Key * len(records))(*records)

    @property
    def arguments(self) -> tuple[ctypes.Array[Key], int]:
        """The array and its length."""
        return self._records, len(self._records)

    def items(self) -> list[tuple[str, list[float]]]:
        """Name and numbers of each key."""
        return [(key.name.decode(), list(key.numbers[: key.count])) for key in self._records]

    def make_room(self, model: mujoco.MjModel) -> None:
        """Adds room in userdata where it lacks; no data of the model may exist yet."""
        library = adaptor()
        needed = library.call("userdata_size_with", model._address, *self.arguments)
        if model.nuserdata < needed:
            library.call("reserve_with", model._address, *self.arguments)

    def _record(self, name: str, numbers: list[float]) -> Key:
        array = (ctypes.c_double * len(numbers))(*numbers)
        self._alive.append(array)
        return Key(name.encode(), array, len(numbers))


def _require_word(place: str, text: str, *, is_number: bool) -> None:
    try:
        float(text)
    except ValueError:
        if is_number:
            raise TypeError(f"{place} takes a number, got the text {text!r}") from None
        return
    raise TypeError(f"{place} takes a number, got the text {text!r}: leave the quotes out")


def _keys(what: str, stem: str, values: Values) -> list[tuple[str, list[float]]]:
    """Name and numbers of each key: a choice is spelled in the name."""
    if not isinstance(values, Mapping):
        raise TypeError(f"{what} takes a dict of names and values, got {type(values).__name__}")
    keys = []
    for name, value in values.items():
        if isinstance(value, str):
            _require_word(f"{what}[{name!r}]", value, is_number=name in NUMBERS)
            keys.append((f"{stem}{name}/{value}", [1.0]))
            continue
        numbers = np.atleast_1d(value)
        if numbers.dtype.kind not in "iuf":
            raise TypeError(f"{what}[{name!r}] takes a number or a word, got {value!r}")
        keys.append((f"{stem}{name}", numbers.astype(float).tolist()))
    return keys
