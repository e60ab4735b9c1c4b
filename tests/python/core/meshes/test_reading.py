# SPDX-License-Identifier: Apache-2.0
"""Mesh files read back what trimesh, another program, wrote; odd but good files are read."""

from __future__ import annotations

import numpy as np
import pytest

from volcontact.meshes.reading import read_mesh, write_mesh
from volcontact.meshes.triangles import MeshFileError

trimesh = pytest.importorskip("trimesh")

WHOLE = 1e-17  # relative; trimesh writes 17 digits behind the point, which is not all of them
SINGLE = 1e-7  # relative, of a number in single precision


def solids():
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.3)
    ring = trimesh.creation.torus(major_radius=0.2, minor_radius=0.05)
    for mesh in (ball, ring):
        mesh.apply_translation([0.1, -2.0 / 3.0, 5.0])
        yield mesh


@pytest.mark.parametrize("solid", list(solids()), ids=["ball", "ring"])
@pytest.mark.parametrize(
    ("kind", "suffix", "options", "error"),
    [
        ("stl", "stl", {}, SINGLE),
        ("stl_ascii", "STL", {}, 1e-8),
        ("obj", "obj", {"digits": 17, "include_normals": True}, WHOLE),
        ("ply", "ply", {"vertex_normal": True}, SINGLE),
        ("ply", "ply", {"encoding": "ascii"}, 1e-7),
        ("off", "off", {"digits": 17}, WHOLE),
    ],
)
def test_reads_what_trimesh_wrote(solid, kind, suffix, options, error, tmp_path):
    content = solid.export(file_type=kind, **options)
    path = tmp_path / f"part.{suffix}"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    mesh = read_mesh(path)
    expected = solid.vertices[solid.faces]
    assert np.abs(mesh.vertices[mesh.faces] - expected).max() <= error * np.abs(expected).max()
    assert len(mesh.places) == len(mesh.faces)


@pytest.mark.parametrize(("suffix", "error"), [("stl", SINGLE), ("obj", 0), ("ply", 0), ("off", 0)])
def test_trimesh_reads_what_was_written(suffix, error, tmp_path):
    solid = next(solids())
    path = tmp_path / f"part.{suffix}"
    write_mesh(path, np.asarray(solid.vertices), np.asarray(solid.faces))
    expected = solid.vertices[solid.faces]
    for triangles in (
        trimesh.load(path, process=False).triangles,
        (mesh := read_mesh(path)).vertices[mesh.faces],
    ):
        assert np.abs(triangles - expected).max() <= error * np.abs(expected).max()
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]  # no trial file is left


SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("quad.obj", SQUARE + "f 1 2 3 4\n"),
        ("windows.obj", (SQUARE + "f 1 2 3 4\n").replace("\n", "\r\n")),
        ("backwards.obj", SQUARE + "f -4 -3 -2 -1\n"),
        ("normals.obj", SQUARE + "vn 0 0 1\nvt 0 0\ng a\ns off\nusemtl b\nf 1/1/1 2//1 3/1 4\n"),
        ("colours.obj", SQUARE.replace(" 0\n", " 0 0.5 0.5 0.5\n") + "f 1 2 3 4"),
        ("continued.obj", SQUARE + "f 1 2 \\\n3 4 # a comment\n"),
        ("encoding.obj", "# f\u00fcr Teile\no Geh\u00e4use\n" + SQUARE + "f 1 2 3 4\n"),
        ("counts.off", "OFF 4 1 0\n# points\n0 0 0\n1 0 0\n\n1 1 0\n0 1 0\n4 0 1 2 3\n"),
        ("colours.off", "COFF\n4 1 0\n0 0 0 9 9 9 9\n1 0 0 9 9 9 9\n1 1 0 9 9 9 9\n"
                        "0 1 0 9 9 9 9\n4 0 1 2 3 255 0 0\n"),
        ("names.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                      "vertex 1 1 0\nendloop\nendfacet\nendsolid a\nSOLID b\nFACET NORMAL 0 0 1\n"
                      "  OUTER LOOP\n VERTEX 0 0 0\n VERTEX 1 1 0\n VERTEX 0 1e0 0\nENDLOOP\n"
                      "ENDFACET\nENDSOLID\n"),
        ("flags.ply", "ply\nformat ascii 1.0\nobj_info x\nelement vertex 4\nproperty uchar red\n"
                      "property double x\nproperty double y\nproperty double z\nelement face 1\n"
                      "property int flags\nproperty list uchar uint vertex_index\n"
                      "property list uchar float texcoord\nelement edge 1\nproperty int a\n"
                      "property int b\nend_header\n9 0 0 0\n9 1 0 0\n9 1 1 0\n9 0 1 0\n"
                      "7 4 0 1 2 3 2 0.5 0.5\n0 1\n"),
    ],
)  # fmt: skip
def test_every_way_to_write_a_square(name, text, tmp_path):
    path = tmp_path / name
    path.write_bytes(text.encode())
    mesh = read_mesh(path)
    corners = mesh.vertices[mesh.faces]
    expected = [[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 0]]]
    assert (corners == expected).all()


@pytest.mark.parametrize("order", ["<", ">"])
def test_binary_rows_may_hold_more_than_the_mesh(order, tmp_path):
    kind = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    header = (
        f"ply\nformat {kind} 1.0\nelement camera 2\nproperty short id\nelement vertex 4\n"
        "property float nx\nproperty double x\nproperty double y\nproperty double z\n"
        "property uchar red\nelement face 1\nproperty list uchar float texcoord\n"
        "property list ushort int vertex_indices\nproperty uchar flags\nend_header\n"
    )
    vertex = np.dtype([("nx", order + "f4"), ("p", order + "f8", 3), ("red", "u1")])
    rows = np.zeros(4, vertex)
    rows["p"] = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    face = np.array(1, "u1").tobytes() + np.array(0.5, order + "f4").tobytes()
    face += np.array(4, order + "u2").tobytes() + np.arange(4).astype(order + "i4").tobytes()
    path = tmp_path / "part.ply"
    path.write_bytes(header.encode() + bytes(4) + rows.tobytes() + face + b"\7")
    mesh = read_mesh(path)
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert (mesh.vertices == rows["p"]).all()


def test_names_the_line_of_a_face(tmp_path):
    path = tmp_path / "part.obj"
    path.write_text(SQUARE + "\n\nf 1 2 3\nf 1 3 4\n")
    assert read_mesh(path).face_name(1) == "face 1 (line 8)"


def test_refuses_to_write_other_formats(tmp_path):
    with pytest.raises(MeshFileError, match=r"'\.step' is no format that is written here"):
        write_mesh(tmp_path / "part.step", np.zeros((3, 3)), np.array([[0, 1, 2]]))
    with pytest.raises(MeshFileError, match="Choose a place that can be written"):
        write_mesh(tmp_path / "nowhere" / "part.stl", np.zeros((3, 3)), np.array([[0, 1, 2]]))
