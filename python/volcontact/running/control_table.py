# SPDX-License-Identifier: Apache-2.0
"""Controls over time: a table in a file, CSV or Parquet."""

from __future__ import annotations

import csv
import math
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

_TIME = "time"


@dataclass(frozen=True)
class ControlTable:
    """Controls at some times, linear in between.

    Attributes:
        time: [s], rising, shape (n,).
        columns: by name of the actuator, in the unit of its control, each of shape (n,).
        source: what messages call it.

    Raises:
        ValueError: times that do not rise, a number that is none, no row or columns of another
            length.
    """

    time: np.ndarray
    columns: dict[str, np.ndarray]
    source: str = "controls"

    def __post_init__(self) -> None:
        count = len(self.time)
        if count == 0:
            raise ValueError(f"{self.source}: has no rows: give at least one time and its controls")
        if not self.columns:
            raise ValueError(
                f"{self.source}: has no column besides {_TIME!r}: name one after each actuator "
                "that is driven"
            )
        for name, values in {_TIME: self.time, **self.columns}.items():
            if values.shape != (count,):
                raise ValueError(
                    f"{self.source}: column {name!r} has shape {values.shape}, the times have "
                    f"({count},)"
                )
            bad = np.flatnonzero(~np.isfinite(values))
            if len(bad):
                raise ValueError(
                    f"{self.source}: row {bad[0] + 1} of column {name!r} is {values[bad[0]]:g}: "
                    "every cell must be a finite number"
                )
        late = np.flatnonzero(np.diff(self.time) <= 0.0)
        if len(late):
            row = int(late[0]) + 1
            raise ValueError(
                f"{self.source}: row {row + 1}: time {self.time[row]:g} s comes after "
                f"{self.time[row - 1]:g} s: times must rise from row to row"
            )


def read_controls(path: str | os.PathLike[str]) -> ControlTable:
    """Reads a table of controls: the column `time` [s] and one for each actuator that is driven.

    Args:
        path: of a file that ends in `.csv` or `.parquet`. The first line of a CSV file has the
            names of its columns.

    Raises:
        FileNotFoundError: there is no such file.
        ValueError: it is neither CSV nor Parquet, has no column `time`, a column twice, or a cell
            that is no number.
    """
    file = Path(path)
    if not file.is_file():
        raise FileNotFoundError(f"no such file of controls: {file}")
    kind = file.suffix.lower()
    if kind not in (".csv", ".parquet"):
        raise ValueError(f"{file}: is neither .csv nor .parquet")
    columns = _of_csv(file) if kind == ".csv" else _of_parquet(file)
    if _TIME not in columns:
        raise ValueError(
            f"{file}: has no column {_TIME!r}, but {', '.join(columns) or 'none'}: the first row "
            f"names the columns, {_TIME!r} and one for each actuator"
        )
    return ControlTable(columns.pop(_TIME), columns, str(file))


def _of_csv(file: Path) -> dict[str, np.ndarray]:
    with file.open(encoding="utf-8-sig", newline="") as lines:
        rows = [(number, row) for number, row in enumerate(csv.reader(lines), 1) if any(row)]
    if not rows:
        return {}
    heads = [head.strip() for head in rows[0][1]]
    _require_different(file, heads)
    numbers = np.empty((len(rows) - 1, len(heads)))
    for i, (line, row) in enumerate(rows[1:]):
        if len(row) != len(heads):
            raise ValueError(f"{file}:{line}: has {len(row)} cells for {len(heads)} columns")
        for j, cell in enumerate(row):
            numbers[i, j] = _number(cell)
            if math.isnan(numbers[i, j]):
                raise ValueError(
                    f"{file}:{line}: {cell.strip()!r} in column {heads[j]!r}: "
                    "every cell must be a finite number"
                )
    return dict(zip(heads, numbers.T.copy(), strict=True))


def _number(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return math.nan


def _of_parquet(file: Path) -> dict[str, np.ndarray]:
    import pyarrow
    import pyarrow.parquet

    try:
        table = pyarrow.parquet.read_table(file)
    except pyarrow.ArrowInvalid as error:
        raise ValueError(f"{file}: is no Parquet file ({str(error).splitlines()[0]})") from error
    _require_different(file, table.column_names)
    for field in table.schema:
        if not (pyarrow.types.is_floating(field.type) or pyarrow.types.is_integer(field.type)):
            raise ValueError(f"{file}: column {field.name!r} has no numbers, but {field.type}")
    return {name: np.array(table[name].to_pylist(), np.float64) for name in table.column_names}


def _require_different(file: Path, heads: list[str]) -> None:
    for head in heads:
        if heads.count(head) > 1:
            raise ValueError(f"{file}: has {heads.count(head)} columns named {head!r}")
