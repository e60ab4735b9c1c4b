# SPDX-License-Identifier: Apache-2.0
"""From points of the unit cube to values of the inputs, by the distributions of a study."""

from __future__ import annotations

import csv
import functools
import inspect
import math
from pathlib import Path
from typing import Any

import numpy as np

from volcontact.messages.spelling import nearest
from volcontact.study.file.settings import Input, Settings, StudyError

CORRELATED = ("distribution",)
_INSIDE = 1e-16  # distance that quantiles keep from 0 and 1


@functools.cache
def distribution_names() -> tuple[str, ...]:
    """Distributions that a study may name: those of scipy.stats with quantiles, and rotation."""
    from scipy import stats

    kinds = (stats.rv_continuous, stats.rv_discrete)
    names = [name for name in dir(stats) if isinstance(getattr(stats, name), kinds)]
    return (*names, "rotation")


def check_input(given: Input, where: str) -> None:
    """Checks what the reader of the file cannot see.

    Raises:
        StudyError: a parameter is missing, unknown or out of range; a table has no such column.
    """
    if given.kind == "distribution":
        _frozen_checked(given, where)
    elif given.kind == "rotation" and given.arguments:
        raise StudyError(f"{where}: a rotation takes no {given.arguments[0][0]}")
    elif given.kind == "rotation" and given.mode != "set":
        raise StudyError(f"{where} mode = {given.mode!r}: a rotation is set")
    elif given.kind == "table":
        assert given.table is not None
        table_column(given.table, given.column, where)
    if given.is_text and given.mode != "set":
        raise StudyError(f"{where} mode = {given.mode!r}: texts can only be set")


def _ours(given: Input) -> dict[str, float]:
    """Arguments for scipy.stats: uniform also takes low and high, norm mean and std."""
    found = dict(given.arguments)
    if given.distribution == "uniform" and {"low", "high"} <= set(found):
        low, high = found.pop("low"), found.pop("high")
        found |= {"loc": low, "scale": high - low}
    if given.distribution == "norm":
        for word, theirs in (("mean", "loc"), ("std", "scale")):
            if word in found:
                found[theirs] = found.pop(word)
    return found


def _frozen_checked(given: Input, where: str) -> None:
    from scipy import stats

    kind = getattr(stats, given.distribution)
    shapes = [] if kind.shapes is None else [s.strip() for s in kind.shapes.split(",")]
    takes = [*shapes, "loc"] + (["scale"] if isinstance(kind, stats.rv_continuous) else [])
    found = _ours(given)
    words = {"uniform": ["low", "high"], "norm": ["mean", "std"]}.get(given.distribution, [])
    for key in found:
        if key not in takes:
            raise StudyError(f"{where} {key}: is unknown{nearest(key, [*takes, *words])}")
    for key in shapes:
        if key not in found:
            raise StudyError(f"{where}: {given.distribution} needs {key}")
    if given.distribution == "uniform" and not found.get("scale", 1.0) > 0.0:
        raise StudyError(f"{where}: high must be above low")
    middle = kind(**found).ppf(0.5)
    if not np.isfinite(middle):
        shown = ", ".join(f"{key} = {value:g}" for key, value in given.arguments)
        raise StudyError(f"{where}: {given.distribution} is not defined for {shown}")


@functools.lru_cache(maxsize=64)
def table_column(path: Path, column: str, where: str = "") -> np.ndarray:
    """The numbers of a column of a CSV file with a header."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    if not rows:
        raise StudyError(f"{where} table = {path.name!r}: has no rows below its header")
    if column not in rows[0]:
        raise StudyError(f"{where} column = {column!r}: is unknown{nearest(column, rows[0])}")
    values = []
    for number, row in enumerate(rows, 2):
        try:
            values.append(float(row[column]))
        except (TypeError, ValueError) as error:
            raise StudyError(
                f"{where} table = {path.name!r}: line {number}, column {column!r}: "
                f"{row[column]!r} is no number"
            ) from error
        if not math.isfinite(values[-1]):
            raise StudyError(f"{where} table = {path.name!r}: line {number} is not finite")
    return np.array(values)


class Quantiles:
    """Turns rows of the unit cube into values; one column or more of the cube an input.

    Args:
        settings: of the study.
    """

    def __init__(self, settings: Settings) -> None:
        self._inputs = settings.inputs
        self.columns = settings.columns
        self._tables: dict[Path, int] = {}
        self._places: list[int] = []
        self.dimension = 0
        for each in self._inputs:
            if each.table is not None and each.table in self._tables:
                self._places.append(self._tables[each.table])
                continue
            self._places.append(self.dimension)
            if each.table is not None:
                self._tables[each.table] = self.dimension
            self.dimension += 3 if each.kind == "rotation" else 1
        self._factors = [
            (
                [self._places[self._index(name)] for name in correlation.inputs],
                np.linalg.cholesky(np.array(correlation.matrix)),
            )
            for correlation in settings.correlations
        ]
        self._frozen = [_frozen(each) for each in self._inputs]

    def values(self, cube: np.ndarray) -> dict[str, np.ndarray]:
        """Values by column for rows of the cube, shape (n, dimension)."""
        if self._factors:
            cube = self._correlated(cube)
        found: dict[str, np.ndarray] = {}
        for each, place, frozen in zip(self._inputs, self._places, self._frozen, strict=True):
            if each.kind == "rotation":
                turned = rotations(cube[:, place : place + 3])
                for axis, column in enumerate(each.columns):
                    found[column] = turned[:, axis]
            else:
                found[each.name] = _values(each, cube[:, place], frozen)
        return found

    def normal_values(self, scores: np.ndarray) -> dict[str, np.ndarray]:
        """Values for independent standard normal scores, shape (n, dimension)."""
        from scipy.special import ndtr

        return self.values(ndtr(scores))

    def _index(self, name: str) -> int:
        return [each.name for each in self._inputs].index(name)

    def _correlated(self, cube: np.ndarray) -> np.ndarray:
        from scipy.special import ndtr, ndtri

        cube = cube.copy()
        for places, factor in self._factors:
            scores = ndtri(np.clip(cube[:, places], _INSIDE, 1.0 - _INSIDE))
            # Term by term: a matrix product may round by the number of rows.
            mixed = np.zeros_like(scores)
            for row in range(len(places)):
                for column in range(row + 1):
                    mixed[:, row] += factor[row, column] * scores[:, column]
            cube[:, places] = ndtr(mixed)
        return cube


def _frozen(given: Input) -> Any:
    if given.kind != "distribution":
        return None
    from scipy import stats

    return getattr(stats, given.distribution)(**_ours(given))


def _values(given: Input, unit: np.ndarray, frozen: Any) -> np.ndarray:
    if given.kind == "choice":
        edges = np.cumsum(given.weights)[:-1]
        found: np.ndarray = np.array(given.choices)[np.searchsorted(edges, unit, side="right")]
        return found
    if given.kind == "table":
        assert given.table is not None
        numbers = table_column(given.table, given.column)
        row = np.minimum((unit * len(numbers)).astype(int), len(numbers) - 1)
        picked: np.ndarray = numbers[row]
        return picked
    if given.distribution == "uniform":  # without the rounding of scipy's general way
        arguments = _ours(given)
        return np.asarray(arguments.get("loc", 0.0) + arguments.get("scale", 1.0) * unit)
    return np.asarray(frozen.ppf(np.clip(unit, _INSIDE, 1.0 - _INSIDE)), float)


def rotations(cube: np.ndarray) -> np.ndarray:
    """Uniform rotations as quaternions w x y z, shape (n, 4), of points of the cube, (n, 3).

    Two pairs of coordinates on circles whose radii share the unit sphere: [Shoemake1992].
    """
    inner, outer = np.sqrt(1.0 - cube[:, 0]), np.sqrt(cube[:, 0])
    first, second = 2.0 * np.pi * cube[:, 1], 2.0 * np.pi * cube[:, 2]
    return np.stack(
        [
            outer * np.cos(second),
            inner * np.sin(first),
            inner * np.cos(first),
            outer * np.sin(second),
        ],
        axis=1,
    )


def signature_takes(function: Any, name: str) -> bool:
    """Whether a function of a library has such an argument: they were renamed over the years."""
    return name in inspect.signature(function).parameters
