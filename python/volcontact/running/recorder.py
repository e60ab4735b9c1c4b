# SPDX-License-Identifier: Apache-2.0
"""Records states, energies and contact sites of a simulation that somebody else steps."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from volcontact._adaptor import SITE_DTYPE
from volcontact._files import appearing_in
from volcontact.running.audit import Audit, worst_step
from volcontact.scene import Channels, Contact

SITE_UNITS = {
    "time": "s",
    "pair": "1",
    "geom_a": "1",
    "geom_b": "1",
    "status": "1",
    "volume": "m^3",
    "centroid": "m",
    "normal": "1",
    "area": "m^2",
    "depth": "m",
    "force": "N",
    "torque": "N m",
    "normal_force": "N",
    "slip": "m/s",
    "spin": "rad/s",
    "elastic_energy": "J",
    "flatness": "1",
    "volume_error": "m^3",
}
_RECORDED_SITE = np.dtype([("time", "f8"), *((n, SITE_DTYPE[n]) for n in SITE_DTYPE.names or ())])


class Variable(NamedTuple):
    """One recorded quantity, as `xarray.Dataset` takes it.

    Attributes:
        dims: names of its axes.
        values: the numbers.
        attributes: `units`.
    """

    dims: tuple[str, ...]
    values: np.ndarray
    attributes: dict[str, str]


class Recorder:
    """Keeps the state, the energies and all contact sites of every instant it is shown.

    Shown every step of a run, and written::

        with vc.attach(model) as contact:
            recorder = vc.Recorder(contact)
            for _ in range(500):
                mujoco.mj_step(model, data)
                recorder.record(data)
        recorder.write("results")

    Args:
        contact: what `attach` returned.
    """

    def __init__(self, contact: Contact) -> None:
        self._contact = contact
        self._rows: list[tuple[float, ...]] = []
        self._qpos: list[np.ndarray] = []
        self._qvel: list[np.ndarray] = []
        self._sites: list[np.ndarray] = []
        self._made: list[tuple[float, float]] = []  # in a step, and the energy at its end [J]

    def __len__(self) -> int:
        """How many instants were recorded."""
        return len(self._rows)

    def record(self, data: mujoco.MjData) -> None:
        """Keeps the present instant.

        Calls `mj_forward`, so that sites and energies belong to the state beside them; `mj_step`
        alone leaves those of the state it began with.
        """
        mujoco.mj_forward(self._contact.model, data)
        sites, energy = self._contact.sites(data), self._contact.energy(data)
        total = float(np.linalg.norm(sites["force"], axis=1).sum())
        self._rows.append(
            (float(data.time), energy.elastic, *energy.by_channel, total, float(len(sites)))
        )
        self._made.append((energy.made, self._kinetic(data) + energy.elastic))
        self._qpos.append(data.qpos.copy())
        self._qvel.append(data.qvel.copy())
        rows = np.zeros(len(sites), _RECORDED_SITE)
        rows["time"] = data.time
        for name in SITE_DTYPE.names or ():
            rows[name] = sites[name]
        self._sites.append(rows)

    def audit(self) -> Audit:
        """The step in which contact made most energy, of those that end at a recorded instant."""
        model = self._contact.model
        made, energy = np.array(self._made, np.float64).reshape(len(self), 2).T

        def name_of(geom: int) -> str:
            kind = int(mujoco.mjtObj.mjOBJ_GEOM)
            return mujoco.mj_id2name(model, kind, geom) or f"geom {geom}"

        time = np.array([row[0] for row in self._rows])
        return worst_step(time, made, energy, self._sites.__getitem__, name_of)

    def _kinetic(self, data: mujoco.MjData) -> float:
        momentum = np.zeros(self._contact.model.nv)
        mujoco.mj_mulM(self._contact.model, data, momentum, data.qvel)
        return 0.5 * float(momentum @ data.qvel)

    @property
    def sites(self) -> np.ndarray:
        """All contact sites: a structured array as of `Contact.sites`, with `time` [s] in front."""
        return np.concatenate([np.zeros(0, _RECORDED_SITE), *self._sites])

    def variables(self) -> dict[str, Variable]:
        """All that has one value an instant: `xarray.Dataset(recorder.variables())` takes it.

        Returns:
            `time` [s], `elastic` [J] and `dissipated` [J] (by channel, since the start of the
            simulation), `contact_force` [N] (sum of the magnitudes), `site_count`, `qpos`, `qvel`.
        """
        model = self._contact.model
        rows = np.array(self._rows, np.float64).reshape(len(self), 4 + len(Channels._fields))
        time, elastic, *_, force, count = rows.T

        def one(values: np.ndarray, unit: str) -> Variable:
            return Variable(("time",), values.copy(), {"units": unit})

        def many(dim: str, rows: np.ndarray, unit: str) -> Variable:
            return Variable(("time", dim), rows, {"units": unit})

        qpos = np.array(self._qpos, np.float64).reshape(len(self), model.nq)
        qvel = np.array(self._qvel, np.float64).reshape(len(self), model.nv)
        return {
            "time": one(time, "s"),
            "channel": Variable(("channel",), np.array(Channels._fields), {}),
            "elastic": one(elastic, "J"),
            "dissipated": many("channel", rows[:, 2:-2].copy(), "J"),
            "contact_force": one(force, "N"),
            "site_count": one(count.astype(np.int64), "1"),
            "qpos": many("qpos_index", qpos, "m, rad"),
            "qvel": many("qvel_index", qvel, "m/s, rad/s"),
        }

    def write(self, folder: str | os.PathLike[str]) -> tuple[Path, Path]:
        """Writes `states.parquet` and `sites.parquet`, one row an instant and one a site.

        Vectors have a column a component (`qpos_0`, `dissipated_slide`, `force_x`); every column
        has its unit in the metadata of its field. Both files appear whole, or neither does.

        Returns:
            The two files.
        """
        states: dict[str, tuple[np.ndarray, str]] = {}
        for name, (dims, values, attributes) in self.variables().items():
            if dims[0] != "time":
                continue
            parts: Iterable[object] = range(values.shape[-1])
            if "channel" in dims:
                parts = Channels._fields
            _add_columns(states, name, values, parts, attributes["units"])
        sites: dict[str, tuple[np.ndarray, str]] = {}
        recorded = self.sites
        for name, unit in SITE_UNITS.items():
            _add_columns(sites, name, recorded[name], "xyz", unit)
        names = "states.parquet", "sites.parquet"
        with appearing_in(folder) as new:
            for name, columns in zip(names, (states, sites), strict=True):
                _write(new / name, columns)
        return Path(folder) / names[0], Path(folder) / names[1]


def _add_columns(
    columns: dict[str, tuple[np.ndarray, str]],
    name: str,
    values: np.ndarray,
    parts: Iterable[object],
    unit: str,
) -> None:
    if values.ndim == 1:
        columns[name] = values, unit
        return
    for i, part in zip(range(values.shape[1]), parts, strict=True):
        columns[f"{name}_{part}"] = values[:, i], unit


def _write(file: Path, columns: dict[str, tuple[np.ndarray, str]]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    arrays = {name: pa.array(np.ascontiguousarray(values)) for name, (values, _) in columns.items()}
    fields = [
        pa.field(name, array.type, metadata={"unit": columns[name][1]})
        for name, array in arrays.items()
    ]
    pq.write_table(pa.table(list(arrays.values()), schema=pa.schema(fields)), file)
