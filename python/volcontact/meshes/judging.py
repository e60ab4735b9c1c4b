# SPDX-License-Identifier: Apache-2.0
"""Whether triangles bound a volume, and if not, why and where."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from volcontact.meshes import cgal
from volcontact.meshes.moments import Moments, moments_of
from volcontact.meshes.topology import Edges, edges_of, loops_of, parts_of, pinched_vertices, weld
from volcontact.meshes.triangles import Triangles, counted

__all__ = ["Finding", "Judgement", "judge"]

_SHOWN = 5  # places of each kind
_FLAT = 1e-14  # twice the area over the square of the longest edge: rounding of a line


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong: how many, where, and what to do.

    Attributes:
        kind: such as "open_edges".
        count: of faces, edges or pairs.
        text: for people.
        places: some of them, as points [length] or names of faces.
        serious: the triangles bound no volume because of it.
        more: there are more places than these.
    """

    kind: str
    count: int
    text: str
    places: tuple[str, ...]
    serious: bool = True
    more: bool = False


@dataclass(frozen=True)
class Judgement:
    """What triangles are.

    Attributes:
        mesh: the triangles.
        welded_vertices: different points.
        parts: pieces that hang together across edges.
        closed: every edge has two faces or, where parts touch, an even number.
        oriented: faces side by side are turned alike.
        outward: the volume is positive; None if it is not closed and oriented.
        crossings: pairs of faces that cross or touch, None if that was not examined.
        bounds_volume: all of this; None if only the crossings are unknown.
        moments: of closed and oriented triangles, as they are turned.
        size: of the box around the points [length], shape (3,).
        findings: all that is wrong.
    """

    mesh: Triangles
    welded_vertices: int
    parts: int
    closed: bool
    oriented: bool
    outward: bool | None
    crossings: int | None
    bounds_volume: bool | None
    moments: Moments | None
    size: NDArray[np.float64]
    findings: tuple[Finding, ...]

    def as_json(self) -> dict[str, Any]:
        """The judgement for machines."""
        moments = self.moments
        return {
            "file": self.mesh.path,
            "format": self.mesh.format,
            "faces": len(self.mesh.faces),
            "vertices": len(self.mesh.vertices),
            "welded_vertices": self.welded_vertices,
            "parts": self.parts,
            "bounds_volume": self.bounds_volume,
            "closed": self.closed,
            "oriented": self.oriented,
            "outward": self.outward,
            "crossings": self.crossings,
            "size": self.size.tolist(),
            "volume": None if moments is None else moments.volume,
            "centroid": None if moments is None else moments.centroid.tolist(),
            "inertia": None if moments is None else moments.inertia.tolist(),
            "findings": [
                {"kind": f.kind, "count": f.count, "text": f.text, "places": list(f.places)}
                for f in self.findings
            ],
        }


def judge(mesh: Triangles, *, crossings: bool = True) -> Judgement:
    """Judges triangles.

    Args:
        mesh: the triangles of a file.
        crossings: look for faces that cross, where the program volcontact-cgal is installed.

    Returns:
        The judgement. Its findings say what keeps the triangles from bounding a volume.
    """
    points, faces = weld(mesh.vertices, mesh.faces)
    folded = (faces == np.roll(faces, 1, axis=1)).any(axis=1)
    whole = np.flatnonzero(~folded)
    edges = edges_of(faces[whole])
    part = parts_of(len(whole), edges.neighbours)
    findings = [*_faces_without_area(mesh, points, faces, folded), *_twice(mesh, faces, whole)]
    balanced = not len(edges.open) and _balanced(faces[whole])
    findings += _edge_findings(mesh, points, edges, whole, balanced=balanced)
    if balanced:
        findings += _pinched(points, faces[whole], edges)
    closed = not len(edges.open) and len(whole) > 0
    moments = moments_of(points, faces[whole]) if balanced and closed else None
    outward = None
    if moments is not None:
        outward = moments.volume > 0.0
        findings += _orientation(mesh, moments, points, faces[whole], part)
    count = None
    if crossings and cgal.program() is not None:
        examined = cgal.check(points, faces[whole])
        count = int(examined["crossings"])
        findings += _crossing_findings(mesh, examined, whole)
        if not any(finding.serious for finding in findings):
            findings += _nesting(examined)
    bounds: bool | None = not any(finding.serious for finding in findings)
    if bounds and count is None:
        bounds = None
    return Judgement(
        mesh=mesh,
        welded_vertices=len(points),
        parts=int(part.max()) + 1 if len(part) else 0,
        closed=closed,
        oriented=balanced if closed else not len(edges.flipped),
        outward=outward,
        crossings=count,
        bounds_volume=bounds,
        moments=moments,
        size=points.max(axis=0) - points.min(axis=0),
        findings=tuple(findings),
    )


def _balanced(faces: NDArray[np.int64]) -> bool:
    """Whether every edge is run along as often in one direction as in the other."""
    start, end = faces.reshape(-1), np.roll(faces, -1, axis=1).reshape(-1)
    there = start * (int(faces.max()) + 1) + end if len(faces) else start
    back = end * (int(faces.max()) + 1) + start if len(faces) else end
    return bool((np.sort(there) == np.sort(back)).all())


def _names(mesh: Triangles, faces: NDArray[np.int64]) -> tuple[str, ...]:
    return tuple(mesh.face_name(int(face)) for face in faces[:_SHOWN])


def _point(point: NDArray[np.float64]) -> str:
    return "(" + ", ".join(f"{x:.6g}" for x in point) + ")"


def _faces_without_area(
    mesh: Triangles,
    points: NDArray[np.float64],
    faces: NDArray[np.int64],
    folded: NDArray[np.bool_],
) -> list[Finding]:
    corners = points[faces]
    sides = np.roll(corners, -1, axis=1) - corners
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    longest = (sides**2).sum(axis=2).max(axis=1)
    flat = np.flatnonzero(folded | (area <= _FLAT * longest))
    if not len(flat):
        return []
    nothing_else = len(flat) == len(faces)
    text = f"{counted(len(flat), 'face')} without area" + (
        ": there is no surface" if nothing_else else ""
    )
    more = len(flat) > _SHOWN
    return [Finding("faces_without_area", len(flat), text, _names(mesh, flat), nothing_else, more)]


def _twice(mesh: Triangles, faces: NDArray[np.int64], whole: NDArray[np.int64]) -> list[Finding]:
    ordered = np.sort(faces[whole], axis=1)
    order = np.lexsort(ordered.T)
    again = np.zeros(len(ordered), dtype=bool)
    if len(ordered):
        again[order[1:]] = (ordered[order[1:]] == ordered[order[:-1]]).all(axis=1)
    twice = np.sort(whole[again])
    if not len(twice):
        return []
    text = (
        f"{counted(len(twice), 'face')} that stand there twice; `volcontact mesh repair` mends it"
    )
    more = len(twice) > _SHOWN
    return [Finding("faces_twice", len(twice), text, _names(mesh, twice), more=more)]


def _edge_findings(
    mesh: Triangles,
    points: NDArray[np.float64],
    edges: Edges,
    whole: NDArray[np.int64],
    *,
    balanced: bool,
) -> list[Finding]:
    findings = []
    if len(edges.open):
        loops = loops_of(edges.open)
        places = []
        for loop in loops[:_SHOWN]:
            ring = points[np.unique(loop)]
            low, high = ring.min(axis=0), ring.max(axis=0)
            places.append(
                f"{counted(len(loop), 'edge')} around {_point(0.5 * (low + high))}, "
                f"{np.linalg.norm(high - low):.3g} across"
            )
        first = mesh.face_name(int(whole[edges.open_faces[0]]))
        text = (
            f"open: {counted(len(edges.open), 'boundary edge')} in "
            f"{counted(len(loops), 'hole')}, the first at {first}; "
            "`volcontact mesh repair` fills holes"
        )
        more = len(loops) > _SHOWN
        findings.append(Finding("open_edges", len(edges.open), text, tuple(places), more=more))
    for kind, pairs, beside, text in (
        (
            "crowded_edges",
            edges.crowded,
            edges.crowded_faces,
            "with more than two faces" + (": parts touch there" if balanced else ""),
        ),
        (
            "flipped_edges",
            edges.flipped,
            edges.flipped_faces,
            "between faces turned against each other; `volcontact mesh repair` turns them",
        ),
    ):
        if len(pairs):
            middles = points[pairs[:_SHOWN]].mean(axis=1)
            places = [
                f"{mesh.face_name(int(whole[face]))} at {_point(middle)}"
                for face, middle in zip(beside, middles, strict=False)
            ]
            sentence = f"{counted(len(pairs), 'edge')} {text}"
            more = len(pairs) > _SHOWN
            findings.append(
                Finding(kind, len(pairs), sentence, tuple(places), not balanced, more=more)
            )
    return findings


def _orientation(
    mesh: Triangles,
    moments: Moments,
    points: NDArray[np.float64],
    faces: NDArray[np.int64],
    part: NDArray[np.int64],
) -> list[Finding]:
    if moments.volume == 0.0:
        return [Finding("no_volume", len(faces), "the faces enclose no volume", ())]
    if moments.volume < 0.0:
        text = "inside out: the faces show inwards; `volcontact mesh repair` turns them"
        return [Finding("inside_out", len(faces), text, ())]
    hollow = []
    for one in range(int(part.max()) + 1):
        chosen = np.flatnonzero(part == one)
        if moments_of(points, faces[chosen]).volume < 0.0:
            middle = points[np.unique(faces[chosen])].mean(axis=0)
            hollow.append(f"{counted(len(chosen), 'face')} around {_point(middle)}")
    if not hollow:
        return []
    text = f"{counted(len(hollow), 'part')} turned inwards: hollow, or inside out"
    shown, more = tuple(hollow[:_SHOWN]), len(hollow) > _SHOWN
    return [Finding("parts_inwards", len(hollow), text, shown, serious=False, more=more)]


def _crossing_findings(
    mesh: Triangles, examined: dict[str, Any], whole: NDArray[np.int64]
) -> list[Finding]:
    count = int(examined["crossings"])
    if not count:
        return []
    places = [
        f"{mesh.face_name(int(whole[shown['faces'][0]]))} and "
        f"{mesh.face_name(int(whole[shown['faces'][1]]))} at {_point(np.array(shown['place']))}"
        for shown in examined["shown"][:_SHOWN]
    ]
    text = (
        f"{counted(count, 'pair')} of faces that cross or touch; join the parts where the mesh "
        "was made, or try `volcontact mesh repair --wrap`"
    )
    return [Finding("crossings", count, text, tuple(places), more=count > len(places))]


def _nesting(examined: dict[str, Any]) -> list[Finding]:
    # Of parts that touch CGAL cannot tell which is inside which.
    if examined["bounds_volume"] or not (examined["is_surface"] and examined["closed"]):
        return []
    text = (
        "parts inside others are not turned inwards as hollows; `volcontact mesh repair` turns "
        "them, or join the parts where the mesh was made"
    )
    return [Finding("nesting", 1, text, ())]


def _pinched(points: NDArray[np.float64], faces: NDArray[np.int64], edges: Edges) -> list[Finding]:
    # The corners of an edge with more than two faces are no news.
    found = np.setdiff1d(pinched_vertices(faces, edges), edges.crowded)
    if not len(found):
        return []
    text = f"{counted(len(found), 'corner')} in which parts of the surface touch"
    places = tuple(_point(points[vertex]) for vertex in found[:_SHOWN])
    return [Finding("pinched", len(found), text, places, serious=False, more=len(found) > _SHOWN)]
