# SPDX-License-Identifier: Apache-2.0
"""What volcontact understood of a scene, as tables for the terminal and the report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from volcontact.report.units import FIELD_UNITS


@dataclass(frozen=True)
class Table:
    """Rows of text.

    Attributes:
        title: above the table.
        columns: their headings.
        rows: one entry per column each.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def tables(description: Mapping[str, Any]) -> list[Table]:
    """One table per part of a description that has rows; its warnings are not among them."""
    made = [
        _table(str(name), content) for name, content in description.items() if name != "warnings"
    ]
    return [table for table in made if table.rows]


def _table(name: str, content: object) -> Table:
    title = name.replace("_", " ").capitalize()
    records = _records(content)
    if records is None:
        rows = content.items() if isinstance(content, Mapping) else [(name, content)]
        return Table(
            title,
            ("name", "value", "unit"),
            tuple((str(k), text(v), FIELD_UNITS.get(str(k), "")) for k, v in rows),
        )
    keys = list(dict.fromkeys(key for record in records for key in record))
    return Table(
        title,
        tuple(_heading(key) for key in keys),
        tuple(tuple(text(record.get(key)) for key in keys) for record in records),
    )


def _records(content: object) -> list[Mapping[str, Any]] | None:
    """The rows of a list of mappings, or of a mapping from names to mappings."""
    if isinstance(content, Mapping):
        if content and all(isinstance(value, Mapping) for value in content.values()):
            return [{"name": name, **value} for name, value in content.items()]
        return None
    if isinstance(content, Sequence) and not isinstance(content, str):
        return [item if isinstance(item, Mapping) else {"entry": item} for item in content]
    return None


def _heading(key: str) -> str:
    unit = FIELD_UNITS.get(key, "")
    label = key.replace("_", " ")
    return f"{label} [{unit}]" if unit else label


def text(value: object) -> str:
    """A value as people write it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {text(item)}" for key, item in value.items())
    if isinstance(value, Sequence) and not isinstance(value, str):
        return ", ".join(text(item) for item in value)
    return str(value)
