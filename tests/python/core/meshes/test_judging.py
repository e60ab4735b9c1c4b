# SPDX-License-Identifier: Apache-2.0
"""What is said of triangles, against closed forms and against trimesh."""

from __future__ import annotations

import numpy as np
import pytest

from volcontact.meshes import cgal
from volcontact.meshes.judging import judge
from volcontact.meshes.moments import moments_of
from volcontact.meshes.topology import edges_of, loops_of, parts_of
from volcontact.meshes.triangles import Triangles

trimesh = pytest.importorskip("trimesh")
ROUNDING = 1e-13  # relative, of sums over a few thousand faces


def triangles(mesh) -> Triangles:
    faces = np.asarray(mesh.faces, dtype=np.int64)
    places = np.arange(len(faces), dtype=np.int64)
    return Triangles(np.asarray(mesh.vertices), faces, "part.obj", "OBJ", places, "line")


def joined(*meshes) -> Triangles:
    return triangles(trimesh.util.concatenate(meshes))


def box(sizes, centre=(0, 0, 0)):
    mesh = trimesh.creation.box(sizes)
    mesh.apply_translation(centre)
    return mesh


def kinds(judgement) -> set[str]:
    return {finding.kind for finding in judgement.findings}


def test_box_has_its_closed_form():
    moments = moments_of(*_arrays(box((1.0, 2.0, 3.0), (4.0, -5.0, 6.0))))
    assert np.isclose(moments.volume, 6.0, rtol=ROUNDING)
    assert np.allclose(moments.centroid, [4.0, -5.0, 6.0], rtol=ROUNDING)
    diagonal = np.array([4.0 + 9.0, 1.0 + 9.0, 1.0 + 4.0]) * 6.0 / 12.0
    assert np.allclose(moments.inertia, np.diag(diagonal), atol=ROUNDING * diagonal.max())


def test_moments_of_a_ring_are_those_of_trimesh():
    mesh = trimesh.creation.torus(major_radius=0.2, minor_radius=0.05)
    mesh.apply_transform(trimesh.transformations.random_rotation_matrix(np.array([0.1, 0.4, 0.8])))
    mesh.apply_translation([1.0, 2.0, 3.0])
    moments = moments_of(*_arrays(mesh))
    assert np.isclose(moments.volume, mesh.volume, rtol=1e-10)
    assert np.allclose(moments.centroid, mesh.center_mass, rtol=1e-10)
    # trimesh sums about the origin, where digits cancel
    assert np.allclose(moments.inertia, mesh.moment_inertia, atol=1e-9)


def _arrays(mesh):
    return np.asarray(mesh.vertices), np.asarray(mesh.faces, dtype=np.int64)


@pytest.mark.parametrize(
    "mesh",
    [trimesh.creation.icosphere(4), trimesh.creation.torus(1.0, 0.3), box((1, 1, 1))],
    ids=["ball", "ring", "box"],
)
def test_solids_are_solids(mesh):
    judgement = judge(triangles(mesh))
    assert judgement.bounds_volume is (True if cgal.program() else None)
    assert (judgement.closed, judgement.oriented, judgement.outward) == (True, True, True)
    assert (judgement.parts, judgement.findings) == (1, ())


def test_a_hollow_is_said_and_allowed():
    hole = box((1, 1, 1))
    hole.invert()
    judgement = judge(joined(box((2, 2, 2)), hole))
    assert judgement.bounds_volume is not False
    assert kinds(judgement) == {"parts_inwards"}
    assert np.isclose(judgement.moments.volume, 7.0, rtol=ROUNDING)


@pytest.mark.parametrize(("centre", "kind"), [((1, 1, 0), "crowded_edges"), ((1, 1, 1), "pinched")])
def test_parts_may_touch_in_an_edge_or_a_corner(centre, kind):
    judgement = judge(joined(box((1, 1, 1)), box((1, 1, 1), centre)))
    assert judgement.bounds_volume is not False
    assert kinds(judgement) == {kind}
    assert np.isclose(judgement.moments.volume, 2.0, rtol=ROUNDING)


def test_open_edges_are_grouped_to_holes_with_their_place():
    mesh = trimesh.creation.cylinder(radius=1.0, height=4.0, sections=32)
    flat = np.abs(mesh.face_normals[:, 2]) > 0.5
    mesh.update_faces(~flat)
    judgement = judge(triangles(mesh))
    (finding,) = judgement.findings
    assert (finding.kind, finding.count, len(finding.places)) == ("open_edges", 64, 2)
    assert {place.split(", ")[2].rstrip(")") for place in finding.places} == {"2", "-2"}
    assert judgement.moments is None


def test_flat_faces_between_others_are_said_and_allowed():
    """A point in the middle of an edge: a face of three points in a line closes the gap."""
    vertices = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 0, 0]], dtype=float)
    faces = np.array([[0, 2, 1], [0, 1, 4], [0, 4, 3], [4, 1, 3], [0, 3, 2], [1, 2, 3]])
    soup = Triangles(vertices, faces, "part.obj", "OBJ", np.arange(6), "line")
    judgement = judge(soup, crossings=False)
    assert judgement.closed and judgement.oriented
    assert kinds(judgement) == {"faces_without_area"}
    assert np.isclose(judgement.moments.volume, 8.0 / 6.0, rtol=ROUNDING)


def test_edges_are_sorted_by_kind():
    faces = np.array([[0, 1, 2], [0, 1, 3], [4, 5, 6], [5, 4, 7], [5, 4, 8]])
    edges = edges_of(faces)
    assert edges.flipped.tolist() == [[0, 1]]
    assert edges.crowded.tolist() == [[4, 5]]
    assert len(edges.open) == 4 + 6
    assert sorted(map(len, loops_of(edges.open))) == [4, 6]


def test_parts_of_a_long_chain():
    chain = np.stack([np.arange(5000), np.arange(1, 5001)], axis=1)[::-1]
    assert (parts_of(5002, chain) == [0] * 5001 + [1]).all()


def test_crossings_need_the_program(monkeypatch):
    monkeypatch.setenv("VOLCONTACT_CGAL", "")
    crossing = joined(box((1, 1, 1)), box((1, 1, 1), (0.5, 0.5, 0.5)))
    judgement = judge(crossing)
    assert (judgement.crossings, judgement.bounds_volume) == (None, None)
