# SPDX-License-Identifier: Apache-2.0
"""Repairs give back the solid that was broken, say what they did, and never write anything else."""

from __future__ import annotations

import json

import numpy as np
import pytest

from volcontact.cli import main
from volcontact.meshes import cgal
from volcontact.meshes.reading import read_mesh, write_mesh
from volcontact.meshes.repairing import repair

trimesh = pytest.importorskip("trimesh")

pytestmark = pytest.mark.skipif(cgal.program() is None, reason=cgal.MISSING)

BOX = trimesh.creation.box((1.0, 2.0, 3.0))
VERTICES, FACES = np.asarray(BOX.vertices), np.asarray(BOX.faces, dtype=np.int64)
FLIPPED = FACES.copy()
FLIPPED[5] = FLIPPED[5, ::-1]
SHAKEN = VERTICES[FACES].reshape(-1, 3) + 1e-7 * np.sin(np.arange(108.0)).reshape(-1, 3)
APART = np.arange(36).reshape(-1, 3)


@pytest.mark.parametrize(
    ("vertices", "faces", "options", "step"),
    [
        (VERTICES, FACES[2:], {}, "a hole of 4 edges around"),
        (VERTICES, FLIPPED, {}, "1 face turned to agree"),
        (VERTICES, FACES[:, ::-1], {}, "all faces of a part turned"),
        (VERTICES, np.concatenate([FACES, FACES[:1]]), {}, "1 face that stood there twice"),
        (VERTICES, np.concatenate([FACES, FACES[:, [0, 0, 1]]]), {}, "12 faces with a corner"),
        (SHAKEN, APART, {"weld": 1e-6}, "28 points welded"),
    ],
    ids=["hole", "flipped", "inside out", "twice", "folded", "shaken"],
)
def test_a_broken_box_becomes_the_box(vertices, faces, options, step, tmp_path):
    source, target = tmp_path / "broken.obj", tmp_path / "whole.ply"
    write_mesh(source, vertices, faces)
    done = repair(source, target, **options)
    assert done.before.bounds_volume is ("with a corner" in step)
    assert any(text.startswith(step) for text in done.steps), done.steps
    assert done.written and done.after.bounds_volume
    result = read_mesh(target)
    volume = trimesh.Trimesh(result.vertices, result.faces, process=False).volume
    assert np.isclose(volume, 6.0, rtol=1e-6)


def test_walls_between_parts_go(tmp_path):
    """Two boxes that share a face become one, and the volume stays."""
    parts = [BOX, BOX.copy().apply_translation([1.0, 0.0, 0.0])]
    both = trimesh.util.concatenate(parts)
    source, target = tmp_path / "two.off", tmp_path / "one.off"
    write_mesh(source, np.asarray(both.vertices), np.asarray(both.faces))
    done = repair(source, target)
    assert done.after.parts == 1
    assert np.isclose(done.after.moments.volume, 12.0, rtol=1e-14)


def test_a_box_inside_a_box_becomes_a_hollow(tmp_path):
    both = trimesh.util.concatenate([BOX, trimesh.creation.box((0.5, 0.5, 0.5))])
    source, target = tmp_path / "two.obj", tmp_path / "hollow.obj"
    write_mesh(source, np.asarray(both.vertices), np.asarray(both.faces))
    done = repair(source, target)
    assert np.isclose(done.after.moments.volume, 6.0 - 0.125, rtol=1e-14)
    assert np.isclose(done.volume_change, 5.875 / 6.125 - 1.0, rtol=1e-12)


@pytest.fixture
def crossing(tmp_path):
    both = trimesh.util.concatenate([BOX, BOX.copy().apply_translation([0.5, 0.5, 0.5])])
    path = tmp_path / "crossing.obj"
    write_mesh(path, np.asarray(both.vertices), np.asarray(both.faces))
    return path


def test_what_stays_broken_is_not_written(crossing, tmp_path, capsys):
    target = tmp_path / "out.obj"
    assert main(["mesh", "repair", str(crossing), str(target)]) == 1
    assert "bounds no volume, nothing was written" in capsys.readouterr().err
    assert not target.exists()
    assert main(["mesh", "repair", str(crossing), str(target), "--anyway"]) == 1
    assert "it was written all the same" in capsys.readouterr().err
    assert target.exists()


def test_a_wrap_is_made_when_asked_and_tells_how_the_volume_grew(crossing, tmp_path, capsys):
    target = tmp_path / "wrapped.ply"
    arguments = ["mesh", "repair", str(crossing), str(target), "--wrap", "0.2", "--json"]
    assert main([*arguments, "--offset", "0.02"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["written"] and result["after"]["bounds_volume"]
    # Two boxes of 6 with 1.875 in common, which the file counts twice; the wrap lies 0.02 outside.
    union, surface = 12.0 - 0.5 * 1.5 * 2.5, 2 * 22.0 - 2 * (0.75 + 1.25 + 3.75)
    layer = 0.02 * surface + 0.5 * 0.2**2 * 2 * 5.5  # 0.2 also fills the edges that show inwards
    assert union < result["after"]["volume"] < union + layer
    assert np.isclose(result["volume_change"], result["after"]["volume"] / 12.0 - 1.0)
    assert "wrapped" in result["steps"][-1]


def test_no_file_is_overwritten_silently(tmp_path, capsys):
    path = tmp_path / "part.stl"
    write_mesh(path, VERTICES, FACES)
    content = path.read_bytes()
    assert main(["mesh", "repair", str(path), str(path)]) == 1
    assert "it exists. Choose another name, or say --overwrite." in capsys.readouterr().err
    assert path.read_bytes() == content
    assert main(["mesh", "repair", str(path), str(path), "--overwrite"]) == 0
    assert "the volume is what it was" in capsys.readouterr().out


def test_holes_stay_when_they_shall(tmp_path, capsys):
    source, target = tmp_path / "open.off", tmp_path / "out.off"
    write_mesh(source, VERTICES, FACES[1:])
    assert main(["mesh", "repair", str(source), str(target), "--no-fill"]) == 1
    assert "left open" in capsys.readouterr().out


def test_without_cgal_the_command_says_what_is_missing(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("VOLCONTACT_CGAL", "")
    path = tmp_path / "part.stl"
    write_mesh(path, VERTICES, FACES)
    assert main(["mesh", "repair", str(path), str(tmp_path / "out.stl")]) == 1
    assert "a repair needs CGAL" in capsys.readouterr().err
    assert main(["mesh", "check", str(path)]) == 0
    printed = capsys.readouterr()
    assert "bounds a volume, if no faces cross" in printed.out
    assert "crossing faces were not looked for" in printed.err


def test_check_prints_json_for_machines(tmp_path, capsys):
    good, bad = tmp_path / "good.stl", tmp_path / "bad.stl"
    write_mesh(good, VERTICES, FACES)
    bad.write_bytes(good.read_bytes()[:300])
    assert main(["mesh", "check", str(good), str(bad), "--json"]) == 1
    printed = capsys.readouterr()
    first, second = json.loads(printed.out)["meshes"]
    assert first["bounds_volume"] is True
    assert np.isclose(first["volume"], 6.0)
    assert "byte 300" in second["error"]
