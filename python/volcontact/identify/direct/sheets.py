# SPDX-License-Identifier: Apache-2.0
"""Data sheets of bench tests: CSV with units in its head, and lines of constants before it.

# mass [kg] = 0.5
time [s],speed [mm/s]
0,102.3
"""

from __future__ import annotations

import csv
import difflib
import math
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from volcontact.identify.units import SIGMA_UNITS, UNITS
from volcontact.messages.spelling import nearest

_ANGLE = SIGMA_UNITS["orientation"]
# By kind. The first of each is SI.
KINDS: dict[str, dict[str, float]] = {
    "length": UNITS["position"],
    "angle": _ANGLE,
    "time": UNITS["time"],
    "speed": UNITS["velocity"],
    "angular speed": UNITS["angular_velocity"],
    "acceleration": {"m/s^2": 1.0, "mm/s^2": 1e-3, "g": 9.80665},
    "force": {unit: UNITS["sensor"][unit] for unit in ("N", "mN", "kN", "lbf")},
    "mass": {"kg": 1.0, "g": 1e-3, "lb": 0.45359237},
    "inertia": {"kg m^2": 1.0, "g cm^2": 1e-7, "kg mm^2": 1e-6},
    "stiffness": {"N/m^3": 1.0, "N/mm^3": 1e9},
    "tangential stiffness": {"N/m": 1.0, "N/mm": 1e3, "N/um": 1e6},
    "viscosity": {"N s/m": 1.0, "N s/mm": 1e3},
    "number": {"-": 1.0, "1": 1.0},
}
_HEAD = re.compile(r"^\s*(?P<name>[^\[\]]+?)\s*(?:\[\s*(?P<unit>[^\[\]]*?)\s*\])?\s*$")
_LEAST_ROWS = 2


class SheetError(ValueError):
    """A sheet cannot be read: the message is one line that says what, where and the fix."""


@dataclass(frozen=True)
class Item:
    """A column or a constant of a sheet.

    Attributes:
        name: in words.
        kind: of `KINDS`; "text" for a word.
        unit: that of the template.
        meaning: in a few words.
        needed: whether a sheet must have it.
        above_zero: whether its numbers must be.
    """

    name: str
    kind: str
    unit: str
    meaning: str
    needed: bool = False
    above_zero: bool = False

    def heading(self) -> str:
        """As in the head of a sheet."""
        return self.name if self.kind in ("text", "label") else f"{self.name} [{self.unit}]"


@dataclass(frozen=True)
class Layout:
    """What the sheet of a test has.

    Attributes:
        test: name of the test.
        purpose: what the test gives, one line.
        columns: that may stand in the table; a "label" tells repetitions apart.
        constants: that may stand above it.
        example: rows of the template, by heading of the columns used, with values of constants.
    """

    test: str
    purpose: str
    columns: tuple[Item, ...]
    constants: tuple[Item, ...]
    example: tuple[str, ...]
    example_constants: Mapping[str, str] = field(default_factory=dict)

    def column(self, name: str) -> Item:
        """A column by its name."""
        return next(each for each in self.columns if each.name == name)


@dataclass(frozen=True)
class Sheet:
    """A sheet that was read.

    Attributes:
        test: name of the test.
        source: where it comes from, for messages.
        columns: by name, shape (n,) [SI]; NaN for an empty cell.
        labels: by name of a label column, one text a row.
        constants: by name [SI], or a word.
    """

    test: str
    source: str
    columns: dict[str, np.ndarray]
    labels: dict[str, list[str]] = field(default_factory=dict)
    constants: dict[str, float | str] = field(default_factory=dict)

    def has(self, name: str) -> bool:
        """Whether there is such a column with at least one number."""
        return name in self.columns and bool(np.isfinite(self.columns[name]).any())

    def number(self, name: str, default: float | None = None) -> float:
        """A constant.

        Raises:
            SheetError: it is not there, and has no default.
        """
        return float(self._constant(name, default, f"# {name} [unit] = value"))

    def word(self, name: str, default: str | None = None) -> str:
        """A constant that is a word.

        Raises:
            SheetError: it is not there, and has no default.
        """
        return str(self._constant(name, default, f"# {name} = word"))

    def _constant(self, name: str, default: float | str | None, line: str) -> float | str:
        value = self.constants.get(name, default)
        if value is None:
            raise SheetError(
                f"{self.source}: the constant {name!r} is missing; write a line such as "
                f'"{line}" above the table, or give it with --given'
            )
        return value

    def groups(self, label: str) -> list[tuple[str, np.ndarray]]:
        """Rows of each label, in the order of their first one."""
        rows = len(next(iter(self.columns.values())))
        given = self.labels.get(label, [""] * rows)
        return [(name, np.array([each == name for each in given])) for name in dict.fromkeys(given)]


def read_sheet(
    path: str | os.PathLike[str], layout: Layout, given: Mapping[str, float | str] | None = None
) -> Sheet:
    """Reads a sheet.

    Args:
        path: of the CSV file.
        layout: of the test.
        given: constants in SI that replace those of the file.

    Raises:
        FileNotFoundError: there is no such file.
        SheetError: a column is missing, a unit is not known, a cell holds no number.
    """
    file = Path(path)
    if not file.is_file():
        raise FileNotFoundError(f"no such sheet: {file}")
    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise SheetError(f"{file.name}: is no text in UTF-8: save it as CSV (UTF-8)") from error
    return parse_sheet(text, layout, file.name, given)


def parse_sheet(
    text: str, layout: Layout, source: str, given: Mapping[str, float | str] | None = None
) -> Sheet:
    """The same from text."""
    constants: dict[str, float | str] = {}
    table: list[tuple[int, list[str]]] = []
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("#"):
            _constant(line, layout, f"{source} line {number}", constants)
        elif line.strip(" ,;\t"):
            table.append((number, next(csv.reader([line]))))
    for name, value in (given or {}).items():
        spelt = name.replace("_", " ")
        constants[spelt] = _given(spelt, value, layout)
    if not table:
        raise SheetError(f"{source}: there is no table; {_hint(layout)}")
    head = _head(table[0][1], layout, f"{source} line {table[0][0]}")
    columns, labels = _cells(table[1:], head, source)
    return Sheet(layout.test, source, columns, labels, constants)


def _constant(line: str, layout: Layout, where: str, constants: dict[str, float | str]) -> None:
    """Reads "# name [unit] = value"; other lines are comments."""
    name, equals, value = line.lstrip(" \t#").partition("=")
    found = _HEAD.match(name)
    if not equals or not found:
        return
    known = {each.name: each for each in layout.constants}
    said = found["name"]
    if said not in known:
        if found["unit"] is None and not difflib.get_close_matches(said, known):
            return  # prose with a sign of equality in it
        raise SheetError(
            f"{where}: {said!r} is no constant of the test {layout.test}{nearest(said, known)}"
        )
    item = known[said]
    value = value.strip()
    if not value:
        return  # of the template, not filled in
    if item.kind == "text":
        constants[said] = value
        return
    factor = _factor(item, found["unit"], where)
    constants[said] = factor * _number(value, f"{where}: {said}")
    _check_sign(item, constants[said], where)


def _given(name: str, value: float | str, layout: Layout) -> float | str:
    known = {each.name: each for each in layout.constants}
    if name not in known:
        raise SheetError(f"{name!r} is no constant of the test {layout.test}{nearest(name, known)}")
    if known[name].kind == "text":
        return str(value)
    if isinstance(value, str):
        raise SheetError(
            f"{name} = {value!r}: must be a number [{next(iter(_units(known[name])))}]"
        )
    _check_sign(known[name], float(value), "given")
    return float(value)


def _check_sign(item: Item, value: float | str, where: str) -> None:
    if item.above_zero and not float(value) > 0.0:
        raise SheetError(f"{where}: {item.name} = {value}: must be above 0")


def _units(item: Item) -> dict[str, float]:
    return KINDS[item.kind]


def _factor(item: Item, unit: str | None, where: str) -> float:
    units = _units(item)
    if unit is None:
        if item.kind == "number":
            return 1.0
        raise SheetError(f"{where}: {item.name!r} has no unit; write {item.heading()!r}")
    if unit not in units:
        raise SheetError(
            f"{where}: {unit!r} is no unit of {item.name!r}; it may be in {', '.join(units)}"
        )
    return units[unit]


def _number(text: str, where: str) -> float:
    try:
        value = float(text)
    except ValueError:
        hint = "; write a point, not a comma" if re.fullmatch(r"-?\d+,\d+", text) else ""
        raise SheetError(f"{where} = {text!r}: must be a number{hint}") from None
    if not math.isfinite(value):
        raise SheetError(f"{where} = {text}: leave the cell empty where nothing was measured")
    return value


def _head(cells: list[str], layout: Layout, where: str) -> list[tuple[Item, float]]:
    known = {each.name: each for each in layout.columns}
    head: list[tuple[Item, float]] = []
    for cell in cells:
        found = _HEAD.match(cell)
        name = found["name"] if found else cell.strip()
        if name not in known:
            raise SheetError(
                f"{where}: {name!r} is no column of the test {layout.test}{nearest(name, known)}"
            )
        item = known[name]
        if item in [each for each, _ in head]:
            raise SheetError(f"{where}: the column {name!r} stands there twice; take one out")
        assert found is not None
        unit = found["unit"]
        head.append((item, 1.0 if item.kind == "label" else _factor(item, unit, where)))
    for each in layout.columns:
        if each.needed and each.name not in [item.name for item, _ in head]:
            raise SheetError(
                f"{where}: there is no column {each.name!r}; write {each.heading()!r} into the head"
            )
    return head


def _cells(
    rows: list[tuple[int, list[str]]], head: list[tuple[Item, float]], source: str
) -> tuple[dict[str, np.ndarray], dict[str, list[str]]]:
    values: dict[str, list[float]] = {item.name: [] for item, _ in head if item.kind != "label"}
    labels: dict[str, list[str]] = {item.name: [] for item, _ in head if item.kind == "label"}
    for number, cells in rows:
        if len(cells) > len(head):
            raise SheetError(
                f"{source} line {number}: has {len(cells)} cells and the head {len(head)}: "
                "separate cells by commas and decimals by points"
            )
        for place, (item, factor) in enumerate(head):
            cell = cells[place].strip() if place < len(cells) else ""
            where = f"{source} line {number}: {item.name}"
            if item.kind == "label":
                labels[item.name].append(cell)
            elif not cell:
                if item.needed:
                    raise SheetError(f"{where} is empty: take the row out, or fill it in")
                values[item.name].append(math.nan)
            else:
                value = factor * _number(cell, where)
                if item.above_zero and not value > 0.0:
                    raise SheetError(f"{where} = {cell}: must be above 0")
                values[item.name].append(value)
    if len(rows) < _LEAST_ROWS:
        raise SheetError(f"{source}: has {len(rows)} rows; a test needs at least {_LEAST_ROWS}")
    return {name: np.array(column) for name, column in values.items()}, labels


def _hint(layout: Layout) -> str:
    return f"`volcontact bench {layout.test} --template` prints one to fill in"


def template(layout: Layout) -> str:
    """A sheet to fill in, with an example."""
    lines = [f"# Bench test {layout.test}: {layout.purpose}."]
    lines.append("# Constants; leave empty what is not known:")
    for each in layout.constants:
        value = layout.example_constants.get(each.name, "")
        lines.append(f"# {each.heading()} = {value}".rstrip())
    for each in layout.constants:
        lines.append(f"#   {each.name}: {each.meaning}")
    lines.append("# Columns: a unit may be another one of its kind:")
    for each in layout.columns:
        need = "" if each.needed else " (may be left out)"
        units = "" if each.kind == "label" else f" in {', '.join(_units(each))}"
        lines.append(f"#   {each.name}{units}: {each.meaning}{need}")
    return "\n".join([*lines, *layout.example]) + "\n"
