# SPDX-License-Identifier: Apache-2.0
"""Reads tables of a study file, strictly: what is not understood is an error that says where."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from volcontact.messages.spelling import nearest
from volcontact.study.file.settings import Condition, StudyError

_REQUIRED = object()


class Table:
    """One table of the file.

    Args:
        content: as TOML gave it.
        where: its name for messages, such as `study.toml [end]`.
    """

    def __init__(self, content: Any, where: str) -> None:
        if not isinstance(content, dict):
            raise StudyError(f"{where}: must be a table, as [name] with lines key = value")
        self._content = dict(content)
        self._known: list[str] = []
        self.where = where

    def error(self, key: str, value: Any, reason: str) -> StudyError:
        """An error of one entry."""
        return StudyError(f"{self.where} {key} = {value!r}: {reason}")

    def has(self, key: str) -> bool:
        """Whether the entry is there and was not taken yet."""
        return key in self._content

    def take(self, key: str, default: Any = _REQUIRED) -> Any:
        """Any entry."""
        self._known.append(key)
        if key in self._content:
            return self._content.pop(key)
        if default is _REQUIRED:
            raise StudyError(f"{self.where}: {key} is missing")
        return default

    def number(
        self,
        key: str,
        default: Any = _REQUIRED,
        *,
        low: float = -math.inf,
        high: float = math.inf,
        above: float = -math.inf,
    ) -> float:
        """A number from low to high, and above a bound."""
        value = self.take(key, default)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or math.isnan(value):
            raise self.error(key, value, "must be a number")
        if not (low <= value <= high and value > above):
            least = f"above {above:g}" if above > -math.inf else f"at least {low:g}"
            most = f" and at most {high:g}" if high < math.inf else ""
            raise self.error(key, value, f"must be {least}{most}")
        return float(value)

    def whole(self, key: str, default: Any = _REQUIRED, *, low: int, high: int) -> int:
        """A whole number from low to high."""
        value = self.take(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise self.error(key, value, f"must be a whole number from {low} to {high}")
        return value

    def word(self, key: str, default: Any = _REQUIRED, *, among: Iterable[str] = ()) -> str:
        """A text, one of `among` where these are given."""
        value = self.take(key, default)
        if not isinstance(value, str):
            raise self.error(key, value, "must be a text in quotes")
        words = list(among)
        if words and value not in words:
            raise self.error(key, value, f"is unknown{nearest(value, words)}")
        return value

    def words(self, key: str, default: Any = ()) -> tuple[str, ...]:
        """A list of texts."""
        value = self.take(key, default)
        if isinstance(value, str):
            return (value,)
        if not isinstance(value, (list, tuple)) or not all(isinstance(w, str) for w in value):
            raise self.error(key, value, "must be a list of texts")
        return tuple(value)

    def numbers(self, key: str, default: Any = ()) -> tuple[float, ...]:
        """A list of numbers."""
        value = self.take(key, default)
        if not isinstance(value, (list, tuple)) or not all(
            isinstance(v, (int, float)) and not isinstance(v, bool) for v in value
        ):
            raise self.error(key, value, "must be a list of numbers")
        return tuple(float(v) for v in value)

    def pairs(self, key: str) -> tuple[tuple[str, Any], ...]:
        """A table in it, as pairs."""
        value = self.take(key, {})
        if not isinstance(value, dict):
            raise self.error(key, value, "must be a table { name = value }")
        return tuple(value.items())

    def conditions(self) -> tuple[Condition, ...]:
        """What is left, as conditions `"quantity" = [low, high]`."""
        found = []
        for key in list(self._content):
            value = self._content.pop(key)
            found.append(condition(key, value, self.where))
        return tuple(found)

    def finish(self) -> None:
        """Nothing may be left."""
        for key in self._content:
            raise StudyError(f"{self.where} {key}: is unknown{nearest(key, self._known)}")


def condition(quantity: str, value: Any, where: str) -> Condition:
    """The condition that a quantity lies in [low, high]."""
    good = isinstance(value, (list, tuple)) and len(value) == 2
    if not good or not all(
        isinstance(v, (int, float)) and not isinstance(v, bool) and not math.isnan(v) for v in value
    ):
        raise StudyError(f'{where} "{quantity}" = {value!r}: must be [low, high]; inf is allowed')
    low, high = map(float, value)
    if low > high:
        raise StudyError(f'{where} "{quantity}" = {value!r}: low must not be above high')
    return Condition(quantity, low, high)
