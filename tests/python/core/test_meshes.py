# SPDX-License-Identifier: Apache-2.0
"""Overlaps of meshes against manifold3d, and what a mesh says of itself."""

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

import volcontact as vc

manifold3d = pytest.importorskip("manifold3d")
Solid = manifold3d.Manifold

Array = NDArray[np.float64]


def arrays(solid: "Solid") -> tuple[Array, NDArray[np.int32]]:
    mesh = solid.to_mesh64()
    return np.array(mesh.vert_properties)[:, :3], np.array(mesh.tri_verts).astype(np.int32)


def solid_of(vertices: Array, faces: NDArray[np.int32]) -> "Solid":
    return Solid(manifold3d.Mesh64(vert_properties=vertices, tri_verts=faces.astype(np.uint64)))


def random_rotation(rng: np.random.Generator) -> Array:
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    q[:, 0] *= np.linalg.det(q)
    return q


def pose(rotation: Array, translation: Array) -> Array:
    X = np.eye(4)
    X[:3, :3], X[:3, 3] = rotation, translation
    return X


SOLIDS = {
    "ring": Solid.cylinder(0.4, 1, 1, 40, True) - Solid.cylinder(2, 0.7, 0.7, 40, True),
    "bored block": Solid.cube((2, 2, 1), True) - Solid.cylinder(3, 0.5, 0.5, 48, True),
    "peg": Solid.cylinder(3, 0.48, 0.48, 48, True),
    "box": Solid.cube((1, 1.2, 0.8), True),
    "hollow ball": Solid.sphere(0.9, 32) - Solid.sphere(0.6, 24),
    "table": Solid.compose(
        [
            Solid.cube((0.2, 0.2, 0.5)).translate((x, y, -0.5))
            for x in (-0.5, 0.5)
            for y in (-0.5, 0.5)
        ]
    )
    + Solid.cube((1.4, 1.4, 0.2)).translate((-0.6, -0.6, -0.1)),
}


def moments(vertices: Array, faces: NDArray[np.int32]) -> tuple[Array, Array]:
    """Centroid and inertia of what a closed mesh holds, from tetrahedra to the origin."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    det = np.einsum("ij,ij->i", a, np.cross(b, c))
    s = a + b + c
    volume = det.sum() / 6
    centroid = (det[:, None] * s).sum(axis=0) / 24 / volume
    second = sum(np.einsum("i,ij,ik->jk", det, p, p) for p in (s, a, b, c)) / 120
    second -= volume * np.outer(centroid, centroid)
    return centroid, np.trace(second) * np.eye(3) - second


def test_any_overlap_of_any_meshes_is_that_of_manifold3d() -> None:
    rng = np.random.default_rng(1)
    names = list(SOLIDS)
    triangles = {name: arrays(solid) for name, solid in SOLIDS.items()}
    meshes = {name: vc.Mesh(*triangles[name]) for name in names}
    touching = 0
    for trial in range(600):
        a, b = rng.choice(names, 2)
        # A fifth of the poses are aligned: flush walls, edges on edges.
        rotation = random_rotation(rng) if rng.random() < 0.8 else np.eye(3)
        X_AB = pose(rotation, rng.normal(size=3) * rng.choice([0.1, 0.5, 1.0]))
        found = vc.interference(meshes[a], meshes[b], X_AB)
        vertices, faces = triangles[b]
        other = solid_of(vertices @ X_AB[:3, :3].T + X_AB[:3, 3], faces)
        expected = solid_of(*triangles[a]) ^ other
        what = f"{a} and {b}, pose {trial}"
        assert found.engine == "columns" and found.status in ("ok", "contained"), what
        assert found.volume == pytest.approx(expected.volume(), rel=1e-10, abs=1e-12), what
        assert sum(site.volume for site in found.sites) == pytest.approx(found.volume, rel=1e-12), (
            what
        )
        if found.volume < 1e-4:
            continue
        touching += 1
        centroid, inertia = moments(*arrays(expected))
        assert np.allclose(found.centroid, centroid, rtol=0, atol=1e-10), what
        assert np.allclose(found.inertia, inertia, rtol=0, atol=1e-10), what
    assert touching > 300


def test_slivers_of_faces_that_are_left_out_are_in_the_bound() -> None:
    # A part of a face, 1e-10 of it, is taken for one that cancels out.
    X_AB = np.eye(4)
    X_AB[:3] = [
        [-0.5256212403418481, 0.21167546937211076, -0.8239634745348813, 0.8205528566203023],
        [-0.12072569006619946, -0.9773073832291783, -0.17405627378458888, 0.9697327510673108],
        [-0.8421090306246201, 0.007985884536631002, 0.5392481860782012, 0.421259402879018],
    ]
    vertices, faces = arrays(SOLIDS["table"])
    found = vc.interference(vc.Mesh(vertices, faces), vc.Mesh(vertices, faces), X_AB)
    other = solid_of(vertices @ X_AB[:3, :3].T + X_AB[:3, 3], faces)
    expected = (SOLIDS["table"] ^ other).volume()
    assert abs(found.volume - expected) <= found.volume_error + 1e-14
    assert found.volume_error <= 1e-8 * expected


def test_mesh_tells_what_it_is() -> None:
    vertices, faces = arrays(SOLIDS["hollow ball"])
    mesh = vc.Mesh(vertices, faces)
    assert mesh.parts == 2 and not mesh.turned
    assert mesh.vertices.shape[1] == 3 and mesh.faces.shape == faces.shape
    assert mesh.own_metrics().volume == pytest.approx(SOLIDS["hollow ball"].volume())
    assert "faces)" in repr(mesh)
    assert vc.Mesh(vertices, faces[:, ::-1]).turned
    low, high = mesh.bounds
    assert np.allclose(high, vertices.max(axis=0)) and np.allclose(low, vertices.min(axis=0))


def test_mesh_takes_arrays_derived_from_those_of_numpy() -> None:
    """As those of trimesh, whose indices are of 64 bits."""
    box = trimesh.creation.box((0.2, 0.2, 0.2))
    assert type(box.faces) is not np.ndarray and box.faces.dtype == np.int64
    assert vc.Mesh(box.vertices, box.faces).own_metrics().volume == pytest.approx(0.008)
    assert vc.Mesh(box.vertices.tolist(), box.faces.tolist()).faces.shape == (12, 3)
    with pytest.raises(TypeError, match=r"mesh: faces must be .* shape \(m, 3\)"):
        vc.Mesh(box.vertices, box.faces[:, :2])
    with pytest.raises(TypeError, match=r"mesh: vertices must be .* shape \(n, 3\)"):
        vc.Mesh(box.vertices[:, :2], box.faces)


@pytest.mark.parametrize("index", [0.5, np.nan, np.inf, 2.0**32, -(2.0**31)])
def test_indices_are_whole_numbers(index: float) -> None:
    vertices, faces = arrays(SOLIDS["box"])
    given = faces.astype(float)
    assert np.array_equal(vc.Mesh(vertices, given).faces, vc.Mesh(vertices, faces).faces)
    given[3, 1] = index
    with pytest.raises(ValueError, match=r"triangle 3 names vertex .*whole numbers from 0 on"):
        vc.Mesh(vertices, given)


def test_surface_that_bounds_no_solid_is_refused() -> None:
    vertices, faces = arrays(SOLIDS["box"])
    with pytest.raises(ValueError, match=r"mesh: 3 boundary edges, the first at \("):
        vc.Mesh(vertices, faces[1:])
    bad = vertices.copy()
    bad[2, 1] = np.nan
    with pytest.raises(ValueError, match="vertex 2 is"):
        vc.Mesh(bad, faces)
    with pytest.raises(ValueError, match="a mesh cannot be composed"):
        vc.Mesh(vertices, faces) - vc.Sphere(0.1)
