# SPDX-License-Identifier: Apache-2.0
"""What volcontact understood of a scene, as tables for the terminal and the report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from volcontact.report.units import FIELD_UNITS

Record = Mapping[str, Any]

_PREFIXES = ("volcontact/material/", "volcontact/pair/", "volcontact/solid/")
_LISTED = 3  # so many entries of a long list are named
# What only programs want to know, and what another column says already.
_HIDDEN = frozenset({"explicit_step", "id", "id_a", "id_b", "key", "pair"})
_FIRST = ("name", "pairs", "geom", "geoms", "engine", "shape", "body", "material", "normal_law")
_LAST = ("sources",)
_WHO = frozenset({"name", "pairs", "geom", "geoms"})


@dataclass(frozen=True)
class Table:
    """Rows of text.

    Attributes:
        title: above the table.
        columns: their headings.
        rows: one entry per column each.
        note: what holds for every row; may be empty.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


def tables(description: Record, *, sources: bool = True) -> list[Table]:
    """One table per part of a description; its warnings and single values are not among them.

    Args:
        description: as `Contact.description` gives it.
        sources: say where the values come from.
    """
    made = []
    for name, content in description.items():
        records = _records(content)
        if name == "warnings" or not records:
            if isinstance(content, Mapping) and content:
                made.append(_table_of_values(name, content))
            continue
        if name == "pairs":
            records = _alike(records)
        made.append(_table(name, records, sources=sources))
    return made


def _table_of_values(name: str, values: Record) -> Table:
    rows = tuple((_heading(key, unit=False), text(v), _unit(key)) for key, v in values.items())
    return Table(_title(name), ("name", "value", "unit"), rows)


def _in_force(record: Record) -> Record:
    """A record without the values that another field of its law has put out of force."""
    sources = record.get("sources")
    if isinstance(sources, Mapping):
        out = {key for key in record if str(sources.get(key, "")).startswith("none:")}
    else:  # the default material alone has both, and damping holds
        out = {"restitution"} if {"damping", "restitution"} <= record.keys() else set()
    if "restitution" in out:
        out.add("restitution_speed_floor")
    return {key: None if key in out else value for key, value in record.items()}


def _table(name: str, records: list[Record], *, sources: bool) -> Table:
    records = [_in_force(record) for record in records]
    keys = sorted(dict.fromkeys(key for record in records for key in record), key=_rank)
    keys = [key for key in keys if key not in _HIDDEN and (sources or key not in _LAST)]
    keys = [key for key in keys if any(text(record.get(key)) for record in records)]
    note = ""
    if len(records) > 1:
        shared = [
            key
            for key in keys
            if key not in _WHO and len({text(record.get(key)) for record in records}) == 1
        ]
        keys = [key for key in keys if key not in shared]
        note = ", ".join(f"{_heading(k, unit=False)} {_with_unit(records[0], k)}" for k in shared)
    return Table(
        _title(name),
        tuple(_heading(key) for key in keys),
        tuple(tuple(text(record.get(key)) for key in keys) for record in records),
        f"all: {note}" if note else "",
    )


def _records(content: object) -> list[Record]:
    """The rows of a list of mappings, or of a mapping from names to mappings; else none."""
    if isinstance(content, Mapping):
        if all(isinstance(value, Mapping) for value in content.values()):
            return [{"name": name, **value} for name, value in content.items()]
    elif isinstance(content, Sequence) and not isinstance(content, str):
        return [item for item in content if isinstance(item, Mapping)]
    return []


def _alike(pairs: list[Record]) -> list[Record]:
    """One record for all pairs that differ in their geoms only."""
    groups: dict[str, list[Record]] = {}
    own = _HIDDEN | {"geom_a", "geom_b"}
    for pair in pairs:
        rest = {key: value for key, value in pair.items() if key not in own}
        groups.setdefault(repr(rest), []).append(pair)
    return [
        {
            "pairs": len(group),
            "geoms": [f"{pair.get('geom_a')} with {pair.get('geom_b')}" for pair in group],
            **{key: value for key, value in group[0].items() if key not in own},
        }
        for group in groups.values()
    ]


def _rank(key: str) -> tuple[int, int]:
    if key in _FIRST:
        return 0, _FIRST.index(key)
    return (2, 0) if key in _LAST else (1, 0)


def _title(name: str) -> str:
    return name.replace("_", " ").capitalize()


def _unit(key: str) -> str:
    return FIELD_UNITS.get(key, "")


def _heading(key: str, *, unit: bool = True) -> str:
    label = key.replace("_", " ")
    return f"{label} [{_unit(key)}]" if unit and _unit(key) else label


def _with_unit(record: Record, key: str) -> str:
    unit = _unit(key)
    return f"{text(record.get(key))}{f' {unit}' if unit not in ('', '-') else ''}"


def text(value: object) -> str:
    """A value as people write it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (int, float)):
        return f"{value:.6g}"
    if isinstance(value, Mapping):
        return "; ".join(f"{_heading(key, unit=False)} {text(v)}" for key, v in value.items())
    if isinstance(value, Sequence) and not isinstance(value, str):
        more = len(value) - _LISTED
        named = [text(item) for item in (value if more <= 1 else value[:_LISTED])]
        return ", ".join(named) + (f" and {more} more" if more > 1 else "")
    word = str(value)
    for prefix in _PREFIXES:
        word = word.replace(prefix, "")
    return word
