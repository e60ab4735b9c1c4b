# SPDX-License-Identifier: Apache-2.0
"""The script that judges collections of meshes, on files that are made here."""

from __future__ import annotations

import csv
import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from volcontact.meshes import cgal
from volcontact.meshes.reading import write_mesh

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


@pytest.fixture
def collections() -> ModuleType:
    path = BENCHMARKS / "mesh_collections.py"
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.skipif(cgal.program() is None, reason=cgal.MISSING)
def test_every_file_gets_a_row(collections, tmp_path, monkeypatch):
    folders = tmp_path / "metaworld" / "deep", tmp_path / "robosuite"
    for folder in folders:
        folder.mkdir(parents=True)
    write_mesh(folders[0] / "good.obj", CORNERS, FACES)
    write_mesh(folders[0] / "open.stl", CORNERS, FACES[1:])
    (folders[1] / "cut.STL").write_bytes(b"cut")
    (folders[1] / "notes.txt").write_text("no mesh")
    out = tmp_path / "rows.csv"
    monkeypatch.setattr(sys, "argv", ["x", str(tmp_path), "--poses", "0", "--out", str(out)])
    collections.main()
    with out.open(encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    assert [(row["file"], row["verdict"]) for row in rows] == [
        ("deep/good.obj", "solid"),
        ("deep/open.stl", "open"),
        ("cut.STL", "unreadable"),
    ]
    assert (rows[0]["volume"], rows[1]["open_edges"]) == ("0.166667", "3")
    assert rows[2]["refused"].startswith("byte 3: the file ends inside the header")


def test_random_poses_are_poses(collections):
    random = np.random.default_rng(1)
    for _ in range(20):
        X = collections.random_pose(random, np.array([1.0, 2.0, 3.0]))
        assert np.allclose(X[:3, :3] @ X[:3, :3].T, np.eye(3), atol=1e-15)
        assert np.isclose(np.linalg.det(X[:3, :3]), 1.0)
        assert (np.abs(X[:3, 3]) <= [1.3, 2.6, 3.9]).all()


def test_the_recorded_run_found_what_it_must():
    """Of every file of both packages; no solid of the run had a number that was none."""
    with (BENCHMARKS / "results" / "mesh_collections.csv").open(encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    assert len(rows) > 700
    assert {row["package"] for row in rows} == {"metaworld", "robosuite"}
    assert sum(row["verdict"] == "solid" for row in rows) > 250
    assert all(row["refused"] for row in rows if row["verdict"] == "unreadable")
    assert not any(int(row["not_finite"] or 0) for row in rows)
