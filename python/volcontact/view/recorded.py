# SPDX-License-Identifier: Apache-2.0
"""What `volcontact run` or `compare` wrote into a folder, shown again without stepping anything."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from volcontact.messages.names import name_of
from volcontact.report import files
from volcontact.running.driving import to_keyframe
from volcontact.running.probes import recorded_sites
from volcontact.running.recording import SITE, ContactKind
from volcontact.scene import Contact, attach, load
from volcontact.surface import SiteSurface
from volcontact.view.history import Snapshot
from volcontact.view.playback import Playback, stride

_VECTORS = ("position", "normal", "force", "torque")
_NUMBERS = ("area", "depth", "volume")


def open_recorded(
    folder: str | os.PathLike[str],
    *,
    contact: ContactKind | None = None,
    scene: str | os.PathLike[str] | None = None,
) -> RecordedRun:
    """Opens the run in a folder.

    Args:
        folder: of `--out` of `run` or `compare`, or of `report.write_report`.
        contact: which of two runs; None takes the volumetric one where there is one.
        scene: the scene it was made from; None takes the file that the recording names.

    Raises:
        FileNotFoundError: there is no recording in the folder, or its scene is not there.
        ValueError: it holds no run of that kind, or the scene is another one by now.
    """
    import pyarrow.compute as pc
    import pyarrow.parquet as pq

    if not Path(folder, files.TRAJECTORY).is_file():
        raise FileNotFoundError(
            f"{folder} holds no {files.TRAJECTORY}: `volcontact run SCENE --out {folder}` makes one"
        )
    states = pq.read_table(Path(folder, files.TRAJECTORY))
    origin = json.loads((states.schema.metadata or {}).get(b"origin", b"{}"))
    kinds = pc.unique(states["contact"]).to_pylist()
    kind: ContactKind = contact or ("volumetric" if "volumetric" in kinds else "native")
    if kind not in kinds:
        raise ValueError(f"{folder} holds no run under {kind} contact, but one under {kinds[0]}")
    states = states.filter(pc.equal(states["contact"], kind))
    sites = pq.read_table(Path(folder, files.SITES))
    sites = sites.filter(pc.equal(sites["contact"], kind))
    keys: dict[str, Any] = {name: origin.get(name) for name in ("material", "options")}
    model = load(_scene_of(folder, scene, origin), **keys)
    time, qpos, qvel = _states(states, model, folder)
    attached = attach(model, **keys) if kind == "volumetric" else None
    try:
        start = mujoco.MjData(model)  # mocap bodies stay where the keyframe has them
        to_keyframe(model, start, origin.get("keyframe"))
        rows = _rows_to_show(time)
        return RecordedRun(
            model,
            attached,
            [_snapshot(start, time[row], qpos[row], qvel[row]) for row in rows],
            _sites_by_time(sites, model, folder),
        )
    except BaseException:
        if attached is not None:
            attached.close()
        raise


class RecordedRun(Playback):
    """A run from a folder: forces are those that were recorded, shapes follow from the poses.

    Args:
        model: of the run.
        contact: of the model, attached; None under native contact. `close` detaches it.
        snapshots: in the order of their times, at least one.
        sites: that were recorded, by time: arrays of `volcontact.running.recording.SITE`.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        contact: Contact | None,
        snapshots: Sequence[Snapshot],
        sites: dict[float, np.ndarray],
    ) -> None:
        self._recorded = sites
        super().__init__(model, contact, snapshots)

    def contacts_of(
        self, data: mujoco.MjData, *, resolution: int = 16
    ) -> tuple[np.ndarray, Sequence[SiteSurface | None]]:
        """The recorded contacts at the time of the data, and their shapes at its pose."""
        recorded = self._recorded.get(float(data.time), np.zeros(0, SITE))
        if self._contact is None:
            return recorded, ()
        found = recorded_sites(self._contact.sites(data))
        places = [_place_of(site, found) for site in recorded]
        return recorded, [
            None if i is None else self._contact.surface(data, i, resolution=resolution)
            for i in places
        ]


def _scene_of(
    folder: str | os.PathLike[str], scene: str | os.PathLike[str] | None, origin: dict[str, Any]
) -> str:
    if scene is not None:
        return os.fspath(scene)
    path = origin.get("scene")
    if path is None:
        raise FileNotFoundError(
            f"{folder} does not say which file its scene is in: name it by --scene FILE"
        )
    if not Path(path).is_file():
        raise FileNotFoundError(
            f"the scene of {folder} is no longer at {path}: name it by --scene FILE"
        )
    return str(path)


def _states(
    table: Any, model: mujoco.MjModel, folder: str | os.PathLike[str]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    found = []
    for name, size in (("qpos", model.nq), ("qvel", model.nv)):
        width = table.schema.field(name).type.list_size if name in table.column_names else 0
        if width != size:
            raise ValueError(
                f"the scene does not fit {folder}: {width} numbers of {name} were recorded, "
                f"the scene has {size}"
            )
        chunks = table[name].chunks if width else []
        rows = [np.asarray(chunk.flatten()).reshape(-1, width) for chunk in chunks]
        found.append(np.concatenate(rows) if rows else np.zeros((len(table), 0)))
    return np.asarray(table["time"]), found[0], found[1]


def _rows_to_show(time: np.ndarray) -> list[int]:
    steps = len(time) - 1
    every = stride(steps, float(time[-1] - time[0]) / steps) if steps > 0 else 1
    return sorted({*range(0, len(time), every), steps})


def _snapshot(start: mujoco.MjData, time: float, qpos: np.ndarray, qvel: np.ndarray) -> Snapshot:
    start.time, start.qpos[:], start.qvel[:] = time, qpos, qvel
    return Snapshot(start)


def _sites_by_time(
    table: Any, model: mujoco.MjModel, folder: str | os.PathLike[str]
) -> dict[float, np.ndarray]:
    geoms = {name_of(model, "geom", i): i for i in range(model.ngeom)}
    sites = np.zeros(len(table), SITE)
    for side in ("geom_a", "geom_b"):
        names = table[side].to_pylist()
        unknown = set(names) - geoms.keys()
        if unknown:
            raise ValueError(
                f"the scene does not fit {folder}: it has no geom {sorted(unknown)[0]!r}"
            )
        sites[side] = [geoms[name] for name in names]
    for name in _VECTORS:
        sites[name] = np.column_stack([np.asarray(table[f"{name}_{axis}"]) for axis in "xyz"])
    for name in _NUMBERS:
        sites[name] = np.asarray(table[name])
    time = np.asarray(table["time"])
    starts = np.flatnonzero(np.diff(time, prepend=-np.inf))
    parts = np.split(sites, starts)[1:]
    return {float(time[i]): part for i, part in zip(starts, parts, strict=True)}


def _place_of(site: np.void, found: np.ndarray) -> int | None:
    """Of the sites at a pose the one that was recorded: of its geoms, and the nearest of these."""
    same = (found["geom_a"] == site["geom_a"]) & (found["geom_b"] == site["geom_b"])
    places = np.flatnonzero(same)
    if len(places) == 0:
        return None
    distance = np.linalg.norm(found["position"][places] - site["position"], axis=1)
    return int(places[np.argmin(distance)])
