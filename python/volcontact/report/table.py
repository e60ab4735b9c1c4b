# SPDX-License-Identifier: Apache-2.0
"""All recorded numbers of the runs as one Parquet file."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from volcontact.recording import CHANNELS, Recording

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
}
_POSE = (("x", "m"), ("y", "m"), ("z", "m"), ("qw", "1"), ("qx", "1"), ("qy", "1"), ("qz", "1"))


def write_table(runs: tuple[Recording, ...], path: Path) -> None:
    """Writes one row per run and instant; the column `contact` tells the runs apart.

    Every column carries its unit in the field metadata. `qpos` and `qvel` are list columns.
    """
    tables = [_table(run) for run in runs]
    pq.write_table(pa.concat_tables(tables), path, compression="zstd")


def _table(run: Recording) -> pa.Table:
    columns: dict[str, tuple[pa.Array, str]] = {
        "contact": (pa.array([run.contact] * len(run.time)).dictionary_encode(), "1")
    }
    for name, unit in _UNITS.items():
        columns[name] = (pa.array(_column(run, name)), unit)
    for i, body in enumerate(run.bodies):
        pose = np.hstack([run.position[:, i], run.quaternion[:, i]])
        for j, (name, unit) in enumerate(_POSE):
            columns[f"{body}.{name}"] = (pa.array(pose[:, j]), unit)
        columns[f"{body}.speed"] = (pa.array(run.speed[:, i]), "m/s")
        columns[f"{body}.spin"] = (pa.array(run.spin[:, i]), "rad/s")
    for name, rows, unit in (("qpos", run.qpos, "m, rad"), ("qvel", run.qvel, "m/s, rad/s")):
        if rows.shape[1] > 0:
            columns[name] = (_lists(rows), unit)
    schema = pa.schema(
        [
            pa.field(name, array.type, metadata={"unit": unit})
            for name, (array, unit) in columns.items()
        ],
        metadata={"bodies": json.dumps(run.bodies)},
    )
    return pa.table([array for array, _ in columns.values()], schema=schema)


def _column(run: Recording, name: str) -> np.ndarray:
    if name.startswith("dissipated_"):
        return run.dissipated[:, CHANNELS.index(name.removeprefix("dissipated_"))]
    if name == "step_microseconds":  # the last row is a state after which no step was taken
        return np.append(run.step_microseconds, np.nan)
    return np.asarray(getattr(run, name))


def _lists(rows: np.ndarray) -> pa.Array:
    flat = pa.array(np.ascontiguousarray(rows).ravel())
    return pa.FixedSizeListArray.from_arrays(flat, rows.shape[1])
