# SPDX-License-Identifier: Apache-2.0
"""The program volcontact-cgal: exact overlaps against closed forms and manifold3d, judgements."""

from __future__ import annotations

import numpy as np
import pytest

from volcontact.meshes import cgal

trimesh = pytest.importorskip("trimesh")
manifold3d = pytest.importorskip("manifold3d")

pytestmark = pytest.mark.skipif(cgal.program() is None, reason=cgal.MISSING)

EXACT = 4e-16  # of the size: the result is rounded once
BOX = trimesh.creation.box((1.0, 1.0, 1.0))


def arrays(mesh, move=(0, 0, 0)):
    return np.asarray(mesh.vertices) + move, np.asarray(mesh.faces, dtype=np.int64)


def overlap(a, b):
    return cgal.overlap(*a, *b)


@pytest.mark.parametrize("move", [(0.5, 0.25, 0.0), (0.75, 0.0, 0.0), (0.5, 0.5, -0.5), (0, 0, 0)])
def test_boxes_overlap_in_a_box_also_with_faces_in_one_plane(move):
    sides = 1.0 - np.abs(move)
    result = overlap(arrays(BOX), arrays(BOX, move))
    volume = sides.prod()
    assert abs(result["volume"] - volume) <= EXACT
    assert np.abs(np.array(result["centroid"]) - 0.5 * np.array(move)).max() <= EXACT
    inertia = volume / 12.0 * ((sides**2).sum() - sides**2)
    assert np.abs(np.array(result["inertia"]) - np.diag(inertia)).max() <= EXACT


@pytest.mark.parametrize("move", [(1, 0, 0), (1, 1, 0), (1, 1, 1), (3, 0, 0)])
def test_solids_that_touch_have_no_overlap(move):
    assert overlap(arrays(BOX), arrays(BOX, move))["volume"] == 0.0


def test_a_solid_inside_another_is_the_overlap():
    small = trimesh.creation.icosphere(subdivisions=2, radius=0.2)
    result = overlap(arrays(BOX), arrays(small))
    assert np.isclose(result["volume"], small.volume, rtol=1e-13)


def test_two_prongs_in_a_slab_are_two_parts():
    prongs = trimesh.util.concatenate(
        [trimesh.creation.box((0.1, 0.1, 2.0)).apply_translation([x, 0, 0]) for x in (-0.3, 0.3)]
    )
    slab = trimesh.creation.box((1.0, 1.0, 0.5))
    result = overlap(arrays(prongs), arrays(slab))
    assert result["parts"] == 2
    assert np.isclose(result["volume"], 2 * 0.1 * 0.1 * 0.5, rtol=1e-14)


def bumpy(subdivisions):
    ball = trimesh.creation.icosphere(subdivisions=subdivisions, radius=1.0)
    x, y, z = ball.vertices.T
    ball.vertices *= (1.0 + 0.03 * np.sin(5.0 * x) * np.sin(6.0 * y) * np.cos(4.0 * z))[:, None]
    return ball


@pytest.mark.parametrize("depth", [0.02, 0.4])
@pytest.mark.parametrize("subdivisions", [2, 3])
def test_bumpy_balls_agree_with_manifold3d(subdivisions, depth):
    ball = bumpy(subdivisions)
    a, b = arrays(ball), arrays(ball, (0.61 * (2.0 - depth), 0.44, 0.65 * (2.0 - depth)))
    result = overlap(a, b)
    common = (manifold(*a) ^ manifold(*b)).to_mesh64()
    mesh = trimesh.Trimesh(common.vert_properties[:, :3], common.tri_verts, process=False)
    mesh.apply_translation(-np.array(result["centroid"]))  # trimesh cancels digits far away
    assert result["volume"] > 0.0
    assert np.isclose(result["volume"], mesh.volume, rtol=1e-10)
    scale = np.cbrt(result["volume"])
    assert np.abs(mesh.center_mass).max() <= 1e-10 * scale
    assert np.allclose(result["inertia"], mesh.moment_inertia, atol=1e-10 * scale**5)


def manifold(vertices, faces):
    mesh = manifold3d.Mesh64(vertices, faces.astype(np.uint64))
    return manifold3d.Manifold(mesh)


def test_overlap_wants_closed_meshes():
    vertices, faces = arrays(BOX)
    with pytest.raises(RuntimeError, match="the second mesh is open"):
        overlap((vertices, faces), (vertices, faces[1:]))
    with pytest.raises(RuntimeError, match="the first mesh is no surface"):
        overlap((vertices, np.concatenate([faces, [[0, 1, 7]]])), (vertices, faces))


def test_moments_of_a_mesh_far_away_keep_their_digits():
    result = cgal.check(*arrays(BOX, (1e6, 1e6, 1e6)))
    assert result["bounds_volume"]
    assert np.isclose(result["volume"], 1.0, rtol=1e-15)
    assert np.allclose(result["inertia"], np.eye(3) / 6.0, atol=1e-15)


def test_a_crossing_is_named_with_its_faces_and_place():
    """Two needles through one triangle of the box's top, at known points."""
    needle = trimesh.creation.cone(radius=0.01, height=0.4, sections=3)
    needle.apply_translation([0.2, -0.1, 0.4])
    vertices, faces = arrays(trimesh.util.concatenate([BOX, needle]))
    result = cgal.check(vertices, faces)
    assert result["crossings"] == 3  # the three sides of the needle
    for crossing in result["shown"]:
        assert np.allclose(crossing["place"], [0.2, -0.1, 0.5], atol=0.01)
        top = vertices[faces[crossing["faces"][0]]]
        assert np.allclose(top[:, 2], 0.5)


def test_a_program_that_fails_is_named(monkeypatch, tmp_path):
    fake = tmp_path / "volcontact-cgal"
    for script, message in {
        "kill -SEGV $$": "crashed with signal 11",
        "echo out of luck >&2; exit 1": "volcontact-cgal: out of luck",
    }.items():
        fake.write_text(f"#!/bin/sh\n{script}\n")
        fake.chmod(0o755)
        monkeypatch.setenv("VOLCONTACT_CGAL", str(fake))
        with pytest.raises(RuntimeError, match=message):
            cgal.check(*arrays(BOX))
    monkeypatch.setenv("VOLCONTACT_CGAL", str(tmp_path / "nowhere"))
    with pytest.raises(RuntimeError, match="does not start"):
        cgal.check(*arrays(BOX))
