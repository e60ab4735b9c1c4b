# SPDX-License-Identifier: Apache-2.0
"""Repairing a mesh file: what was done, what came out, and whether it is a solid."""

from __future__ import annotations

import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from volcontact.meshes import cgal
from volcontact.meshes.judging import Judgement, judge
from volcontact.meshes.reading import read_mesh, write_mesh
from volcontact.meshes.triangles import MeshFileError, counted

__all__ = ["Repair", "repair"]


@dataclass(frozen=True)
class Repair:
    """A repair of a mesh file.

    Attributes:
        before: the judgement of the file.
        after: the judgement of the triangles as they are, or would be, in the new file.
        steps: what was done, one sentence each.
        written: whether there is a new file.
    """

    before: Judgement
    after: Judgement
    steps: tuple[str, ...]
    written: bool

    @property
    def volume_change(self) -> float | None:
        """Of the volume, relative; None if there was none before or is none after."""
        before, after = self.before.moments, self.after.moments
        if before is None or after is None or before.volume == 0.0:
            return None
        return after.volume / abs(before.volume) - 1.0

    def as_json(self) -> dict[str, Any]:
        """The repair for machines."""
        return {
            "before": self.before.as_json(),
            "after": self.after.as_json(),
            "steps": list(self.steps),
            "volume_change": self.volume_change,
            "written": self.written,
        }


def repair(
    source: str | os.PathLike[str],
    target: str | os.PathLike[str],
    *,
    weld: float = 0.0,
    fill: bool = True,
    wrap: float | None = None,
    offset: float | None = None,
    overwrite: bool = False,
    anyway: bool = False,
) -> Repair:
    """Repairs a mesh file: welds, orients, stitches and fills, and wraps if that is asked for.

    Args:
        source: the file to repair.
        target: the file to write; its suffix names the format.
        weld: points nearer than this along each axis become one [length].
        fill: close holes with triangles.
        wrap: if the result bounds no volume, wrap a surface around it that enters no opening
            narrower than this [length].
        offset: distance of the wrap [length]; a thirtieth of `wrap` if left out.
        overwrite: write over a file that exists.
        anyway: write a result that bounds no volume.

    Returns:
        What was done. The file is written if it bounds a volume, or `anyway`.

    Raises:
        MeshFileError: the source is no mesh, or the target cannot be written.
        RuntimeError: the program volcontact-cgal is missing, or failed.
    """
    name = os.fspath(target)
    if Path(name).exists() and not overwrite:
        raise MeshFileError(f"{name}: it exists. Choose another name, or say --overwrite.")
    if cgal.program() is None:
        raise RuntimeError(f"{os.fspath(source)}: a repair needs CGAL, and {cgal.MISSING}")
    mesh = read_mesh(source)
    before = judge(mesh)
    report, result = cgal.repair(mesh.vertices, mesh.faces, weld=weld, fill=fill)
    steps = _steps(report, before)
    if not len(result.faces):
        raise MeshFileError(f"{mesh.path}: no face with an area is left. Export the mesh again.")
    after = _as_written(name, result.vertices, result.faces)
    if wrap is not None and not after.bounds_volume:
        offset = wrap / 30.0 if offset is None else offset
        result = cgal.wrap(result.vertices, result.faces, alpha=wrap, offset=offset)
        steps.append(f"wrapped at a distance of {offset:.3g}, which grows it by as much")
        after = _as_written(name, result.vertices, result.faces)
    written = bool(after.bounds_volume) or anyway
    if written:
        write_mesh(name, result.vertices, result.faces)
    return Repair(before, after, tuple(steps), written)


def _as_written(name: str, vertices: np.ndarray, faces: np.ndarray) -> Judgement:
    """The judgement of the triangles as the file will have them: STL rounds them."""
    with tempfile.TemporaryDirectory(prefix="volcontact-") as folder:
        trial = Path(folder) / f"result{Path(name).suffix}"
        write_mesh(trial, vertices, faces)
        return judge(read_mesh(trial))


def _steps(report: dict[str, Any], before: Judgement) -> list[str]:
    indexed = not before.mesh.format.startswith("STL")  # whose corners are all apart
    counts = (
        ("points_welded" if indexed else "", "point", "welded to an equal or near one"),
        ("faces_folded", "face", "with a corner twice taken out"),
        ("faces_twice", "face", "that stood there twice taken out"),
        ("points_doubled", "point", "doubled where the faces are no surface"),
        ("faces_turned", "face", "turned to agree with its neighbours"),
        ("edges_stitched", "pair", "of open edges stitched"),
    )
    steps = [
        f"{counted(report[key], thing)} {done}" for key, thing, done in counts if report.get(key)
    ]
    for hole in report["holes"]:
        low, high = np.array(hole["low"]), np.array(hole["high"])
        middle = ", ".join(f"{x:.4g}" for x in 0.5 * (low + high))
        done = "filled" if hole["filled"] else "left open"
        steps.append(
            f"a hole of {counted(hole['edges'], 'edge')} around ({middle}), "
            f"{np.linalg.norm(high - low):.3g} across, {done}"
        )
    if report["turned"]:
        steps.append("all faces of a part turned so that it bounds a volume")
    return steps
