# SPDX-License-Identifier: Apache-2.0
"""Force laws of your own, in Python: for trying out, since they are slow.

A law in Python costs some microseconds and the interpreter lock at every contact site, and serves
`ContactModel` only, not MuJoCo scenes: there a law is a C++ header of ten lines. docs/own_laws.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

from volcontact._volcontact import PythonFriction, PythonNormal


@dataclass(frozen=True)
class LawField:
    """A parameter of a law.

    Attributes:
        unit: SI, "-" for none.
        default: its value where none is given.
        minimum, maximum: the least and the largest value allowed.
        meaning: in a few words.
    """

    unit: str
    default: float
    minimum: float = -math.inf
    maximum: float = math.inf
    meaning: str = ""


@dataclass(frozen=True)
class LawState:
    """A number, or a vector in the contact plane, that a law keeps for each contact site.

    Attributes:
        unit: SI, "-" for none.
        keeping: how it follows sites that split and merge: an "amount" is shared and summed, a
            "value" is the same for all and averaged, a "vector" is an amount of three numbers that
            turns with the contact plane, a "vector_value" turns likewise and is averaged.
        meaning: in a few words.
    """

    unit: str
    keeping: Literal["vector", "amount", "value", "vector_value"] = "value"
    meaning: str = ""


class _OwnLaw:
    """Parameters by name, checked against the table `fields`."""

    name: ClassVar[str]
    fields: ClassVar[dict[str, LawField]] = {}
    states: ClassVar[dict[str, LawState]] = {}

    def __init__(self, **parameters: float) -> None:
        for name in parameters:
            if name not in self.fields:
                known = ", ".join(self.fields) or "none"
                message = f"{self.name} has no field '{name}'; it has {known}"
                raise TypeError(message)
        rows = [(name, state.unit, state.keeping) for name, state in self.states.items()]
        super().__init__(self.name, rows)  # type: ignore[call-arg]
        for name, field in self.fields.items():
            value = float(parameters.get(name, field.default))
            if not (math.isfinite(value) and field.minimum <= value <= field.maximum):
                message = (
                    f"{self.name}: {name} = {value:g} [{field.unit}] is out of range: must be from "
                    f"{field.minimum:g} to {field.maximum:g}"
                )
                raise ValueError(message)
            setattr(self, name, value)


class NormalLaw(_OwnLaw, PythonNormal):
    """Base of a normal law in Python.

    A law sets `name`, `fields` and, where it keeps something, `states`, and defines

        def evaluate(self, contact: NormalInput, state: dict, elapsed: float) -> NormalOutput

    `state` has the values of the last accepted time, `elapsed` seconds ago, zeros for a new site.
    The law writes those of now into it. It may be called more than once for one step.
    """


class FrictionLaw(_OwnLaw, PythonFriction):
    """Base of a friction law in Python: as `NormalLaw`, with FrictionInput and FrictionOutput."""
