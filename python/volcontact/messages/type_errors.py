# SPDX-License-Identifier: Apache-2.0
"""What is wrong with the arguments of a call of the compiled core, in one line."""

from __future__ import annotations

import numbers
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from volcontact.messages.spelling import nearest

_SIGNATURE = re.compile(r"^\s*\d+\. (\w+)\((.*)\) -> ", re.MULTILINE)
_SHAPE = re.compile(r"shape=\(([^)]*)\)")
_OPEN, _CLOSED = "([{", ")]}"


@dataclass(frozen=True)
class _Parameter:
    name: str
    takes: str  # its type, as nanobind writes it
    is_needed: bool
    by_name_only: bool


def explained(
    callable_: Any, args: Sequence[Any], kwargs: Mapping[str, Any], error: BaseException
) -> str:
    """A line in the place of the message of nanobind.

    Args:
        callable_: class or function that was called.
        args: its positional arguments; of a method the first is the object.
        kwargs: its keyword arguments.
        error: what nanobind raised.
    """
    signatures = _SIGNATURE.findall(str(error))
    if "no constructor defined" in str(error):
        return f"{callable_.__name__} is not called to make one{_how_it_is_made(callable_)}"
    if not signatures:
        return str(error)
    name = callable_.__name__
    lines = []
    for _, text in signatures:
        parameters = list(_parameters(text))
        of_method = bool(parameters) and parameters[0].name == "self"
        given = list(args)
        if of_method:
            parameters = parameters[1:]
            given = given if isinstance(callable_, type) else given[1:]
        lines.append(_fault(name, parameters, given, kwargs))
    return lines[0] if len(lines) == 1 else f"{name}: no form takes this; {'; or '.join(lines)}"


def _how_it_is_made(made: Any) -> str:
    """What the docstring of a class says of it, as the end of a sentence."""
    found = re.search(r"^Made by (.*?)(?:\n *\n|\Z)", made.__doc__ or "", re.DOTALL | re.MULTILINE)
    return f": it is made by {' '.join(found[1].split()).rstrip(':.')}" if found else ""


def _parameters(text: str) -> Iterator[_Parameter]:
    by_name_only = False
    for part in _split(text):
        if part == "*":
            by_name_only = True
            continue
        name, _, rest = part.partition(":")
        takes, equals, _ = rest.partition(" = ")
        yield _Parameter(name.strip(), takes.strip(), not equals, by_name_only)


def _split(text: str) -> Iterator[str]:
    """The parts between commas that no bracket encloses."""
    depth, start = 0, 0
    for i, letter in enumerate(text):
        depth += (letter in _OPEN) - (letter in _CLOSED)
        if letter == "," and depth == 0:
            yield text[start:i].strip()
            start = i + 1
    if text[start:].strip():
        yield text[start:].strip()


def _fault(
    name: str, parameters: list[_Parameter], args: list[Any], kwargs: Mapping[str, Any]
) -> str:
    known = [parameter.name for parameter in parameters]
    by_place = [parameter for parameter in parameters if not parameter.by_name_only]
    for word in kwargs:
        if word not in known:
            return f"{name} has no argument {word!r}{nearest(word, known)}"
    if len(args) > len(by_place):
        if not by_place:
            names = ", ".join(f"{parameter.name}=..." for parameter in parameters[:3])
            return f"{name} takes its arguments by name: {names}"
        return (
            f"{name} takes at most {len(by_place)} arguments without a name "
            f"({', '.join(parameter.name for parameter in by_place)}), got {len(args)}"
        )
    values = dict(zip((parameter.name for parameter in by_place), args, strict=False))
    for word in kwargs:
        if word in values:
            return f"{name} got {word!r} twice: by its place and by its name"
    values.update(kwargs)
    for parameter in parameters:
        if parameter.is_needed and parameter.name not in values:
            return f"{name} needs {parameter.name}: {_what(parameter)}"
    for parameter in parameters:
        if parameter.name in values and not _fits(parameter, values[parameter.name]):
            got = _told(values[parameter.name])
            return f"{name}: {parameter.name} takes {_what(parameter)}, got {got}"
    return f"{name}: takes {', '.join(f'{p.name} ({_what(p)})' for p in parameters)}"


def _what(parameter: _Parameter) -> str:
    """What an argument takes, in words."""
    takes = parameter.takes
    if "ndarray" in takes or "NDArray" in takes:
        found = _SHAPE.search(takes)
        shape = f"({found[1].replace('*', 'n').replace('None', 'n')})" if found else ""
        shape = shape.replace("(6)", "(6,)").replace("(3)", "(3,)")
        kind = "whole numbers" if "int32" in takes else "numbers"
        if shape == "(4, 4)":
            return "a pose, numpy.array of shape (4, 4)"
        return f"numpy.array of {kind}" + (f", shape {shape}" if shape else "")
    words = [word.strip().rpartition(".")[2] for word in takes.split("|")]
    if "HalfSpace" in words:
        return "a solid, such as Sphere(radius=0.05)"
    if "Sequence[float]" in takes:
        return "3 numbers, (x, y, z)"
    inner = re.search(r"Sequence\[(?:[\w.]+\.)?(\w+)\]", takes)
    if inner:
        return f"a list of {inner[1]}"
    simple = {
        "float": "a number",
        "int": "a whole number",
        "bool": "True or False",
        "str": "a word in quotes",
        "None": "None",
    }
    named = {"NormalForce": "a normal law, such as HuntCrossley(stiffness=1e9)"}
    named["Friction"] = "a friction law, such as ElasticCoulomb(friction=0.3)"
    return " or ".join(simple.get(word) or named.get(word) or f"a {word}" for word in words)


def _fits(parameter: _Parameter, value: Any) -> bool:
    """Whether a value is of the type, as far as that can be told from its name."""
    takes = parameter.takes
    if value is None:
        return takes.endswith("None")
    if "ndarray" in takes or "NDArray" in takes:
        if not isinstance(value, np.ndarray) or value.dtype.kind not in "fiu":
            return False
        found = _SHAPE.search(takes)
        sizes = [size.strip() for size in found[1].split(",") if size.strip()] if found else []
        return len(sizes) == value.ndim and all(
            size in ("*", "None") or int(size) == have
            for size, have in zip(sizes, value.shape, strict=True)
        )
    words = [word.strip().rpartition(".")[2] for word in takes.split("|")]
    if "Sequence[float]" in takes:
        good = isinstance(value, (list, tuple, np.ndarray)) and len(value) == 3
        return good and all(isinstance(number, numbers.Real) for number in value)
    if "Sequence[" in takes:
        inner = re.search(r"Sequence\[(?:[\w.]+\.)?(\w+)\]", takes)
        return isinstance(value, (list, tuple)) and all(
            inner is not None and inner[1] in _types(each) for each in value
        )
    if "float" in words and isinstance(value, numbers.Real) and not isinstance(value, bool):
        return True
    if "int" in words and isinstance(value, numbers.Integral) and not isinstance(value, bool):
        return True
    return bool(set(words) & set(_types(value)))


def _types(value: Any) -> list[str]:
    return [each.__name__ for each in type(value).__mro__]


def _told(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"an array of {value.dtype} of shape {value.shape}"
    text = repr(value)
    return f"{type(value).__name__} {text}" if len(text) <= 40 else type(value).__name__
