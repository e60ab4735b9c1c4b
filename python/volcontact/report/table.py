# SPDX-License-Identifier: Apache-2.0
"""All recorded numbers of the runs, as Parquet and as CSV."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as csv
import pyarrow.parquet as pq

from volcontact.messages.printable import cell
from volcontact.report import files
from volcontact.running.outside_work import CHANNELS as OUTSIDE
from volcontact.running.recording import CHANNELS, Recording

_UNITS = {
    "time": "s",
    "kinetic": "J",
    "potential": "J",
    "elastic": "J",
    "contact_force": "N",
    "largest_site_force": "N",
    "site_count": "1",
    "penetration": "m",
    "step_microseconds": "us",
    **{f"dissipated_{channel}": "J" for channel in CHANNELS},
    "work": "J",
    "numerical": "J",
    **{f"work_of_{channel}": "J" for channel in OUTSIDE},
}
_POSE = (("x", "m"), ("y", "m"), ("z", "m"), ("qw", "1"), ("qx", "1"), ("qy", "1"), ("qz", "1"))
_WRENCH = (
    *((f"force_{axis}", "N") for axis in "xyz"),
    *((f"torque_{axis}", "N m") for axis in "xyz"),
)
_SITE_UNITS = {
    "position": "m",
    "normal": "1",
    "force": "N",
    "torque": "N m",
    "area": "m^2",
    "depth": "m",
    "volume": "m^3",
}


def write_table(runs: tuple[Recording, ...], path: Path) -> None:
    """Writes one row per run and instant; the column `contact` tells the runs apart.

    Every column carries its unit in the field metadata. `qpos` and `qvel` are list columns. Beside
    it comes the same as CSV, with a column a component and units in the heads, and for both the
    contact sites, as `sites.parquet` and `sites.csv`: one row per run, instant and site. The
    metadata of the Parquet file names the scene, for `volcontact view`.

    Args:
        runs: whose bodies are the same.
        path: of the Parquet file of the instants.
    """
    instants = pa.concat_tables([_table(run) for run in runs])
    sites = pa.concat_tables([_site_table(run) for run in runs])
    for table, file in ((instants, path), (sites, path.with_name(files.SITES))):
        pq.write_table(table, file, compression="zstd")
        csv.write_csv(_flat(table), file.with_suffix(".csv"))


def _site_table(run: Recording) -> pa.Table:
    sites, names = run.sites, np.array([*run.geoms, ""], dtype=object)
    columns: dict[str, tuple[pa.Array, str]] = {
        "contact": (pa.array([run.contact] * len(sites), pa.string()), "1"),
        "time": (pa.array(run.time[sites["row"]]), "s"),
        "geom_a": (pa.array(names[sites["geom_a"]], pa.string()), "1"),
        "geom_b": (pa.array(names[sites["geom_b"]], pa.string()), "1"),
    }
    for name, unit in _SITE_UNITS.items():
        values = sites[name]
        if values.ndim == 1:
            columns[name] = pa.array(np.ascontiguousarray(values)), unit
        else:
            for i, axis in enumerate("xyz"):
                columns[f"{name}_{axis}"] = pa.array(np.ascontiguousarray(values[:, i])), unit
    return _with_units(columns)


def _with_units(columns: dict[str, tuple[pa.Array, str]]) -> pa.Table:
    fields = [
        pa.field(name, array.type, metadata={"unit": unit})
        for name, (array, unit) in columns.items()
    ]
    return pa.table([array for array, _ in columns.values()], schema=pa.schema(fields))


def _flat(table: pa.Table) -> pa.Table:
    """A column a component, heads with units: what CSV can hold."""
    arrays, names = [], []
    for field, column in zip(table.schema, table.columns, strict=True):
        unit = field.metadata[b"unit"].decode()
        head = f" [{unit}]" if unit != "1" else ""
        if pa.types.is_fixed_size_list(field.type):
            rows = np.array(column.to_pylist()).reshape(len(column), field.type.list_size)
            arrays += [pa.array(rows[:, i]) for i in range(rows.shape[1])]
            names += [f"{field.name}_{i}{head}" for i in range(rows.shape[1])]
        else:
            text = pa.types.is_dictionary(field.type)
            arrays.append(column.cast(pa.string()) if text else column)
            names.append(field.name + head)
    arrays = [_cells(array) if pa.types.is_string(array.type) else array for array in arrays]
    names = [cell(name) for name in names]
    return pa.table(arrays, names=names)


def _cells(column: pa.ChunkedArray) -> pa.Array:
    return pa.array([cell(text) for text in column.to_pylist()], pa.string())


def columns_of(run: Recording) -> dict[str, tuple[np.ndarray, str]]:
    """All numbers of a run that have one value an instant: values, shape (n,), and unit by name."""
    columns = {name: (_column(run, name), unit) for name, unit in _UNITS.items()}
    for i, body in enumerate(run.bodies):
        pose = np.hstack([run.position[:, i], run.quaternion[:, i]])
        for j, (name, unit) in enumerate(_POSE):
            columns[f"{body}.{name}"] = (pose[:, j], unit)
        columns[f"{body}.speed"] = (run.speed[:, i], "m/s")
        columns[f"{body}.spin"] = (run.spin[:, i], "rad/s")
    for body, wrench in run.wrench_on.items():
        for i, (name, unit) in enumerate(_WRENCH):
            columns[f"{body}.{name}"] = (wrench[:, i], unit)
    columns |= {name: (signal.values, signal.unit) for name, signal in run.signals.items()}
    return columns


def _table(run: Recording) -> pa.Table:
    kind = pa.array([run.contact] * len(run.time)).dictionary_encode()
    columns: dict[str, tuple[pa.Array, str]] = {"contact": (kind, "1")}
    for name, (values, unit) in columns_of(run).items():
        columns[name] = (pa.array(np.ascontiguousarray(values)), unit)
    for name, rows, unit in (("qpos", run.qpos, "m, rad"), ("qvel", run.qvel, "m/s, rad/s")):
        if rows.shape[1] > 0:
            columns[name] = (_lists(rows), unit)
    schema = pa.schema(
        [
            pa.field(name, array.type, metadata={"unit": unit})
            for name, (array, unit) in columns.items()
        ],
        metadata={
            "bodies": json.dumps(run.bodies),
            "origin": json.dumps(asdict(run.origin), default=lambda v: np.asarray(v).tolist()),
        },
    )
    return pa.table([array for array, _ in columns.values()], schema=schema)


def _column(run: Recording, name: str) -> np.ndarray:
    if name.startswith("dissipated_"):
        return run.dissipated[:, CHANNELS.index(name.removeprefix("dissipated_"))]
    if name.startswith("work_of_"):
        return run.outside_work[:, OUTSIDE.index(name.removeprefix("work_of_"))]
    if name == "step_microseconds":  # the last row is a state after which no step was taken
        return np.append(run.step_microseconds, np.nan)
    return np.asarray(getattr(run, name))


def _lists(rows: np.ndarray) -> pa.Array:
    flat = pa.array(np.ascontiguousarray(rows).ravel())
    return pa.FixedSizeListArray.from_arrays(flat, rows.shape[1])
