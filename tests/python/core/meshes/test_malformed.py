# SPDX-License-Identifier: Apache-2.0
"""Over 300 files that are no solids: each gets a message with file, place and fix."""

from __future__ import annotations

import os
import re
import struct
from collections.abc import Callable

import numpy as np
import pytest

from volcontact.cli import main
from volcontact.meshes import cgal

# A box of 2 x 4 x 6 around the origin, faces outward.
POINTS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-2.0, 2.0) for z in (-3.0, 3.0)])
WALLS = "013 032 467 475 045 051 237 276 026 064 157 173"
FACES = np.array([[int(corner) for corner in face] for face in WALLS.split()])
SOMEWHERE = re.compile(r"(line|byte|face|vertex) \d+")

Writer = Callable[..., bytes]


def binary_stl(points=POINTS, faces=FACES, count=None) -> bytes:
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *points[f].ravel(), 0) for f in faces)
    return bytes(80) + struct.pack("<I", len(faces) if count is None else count) + body


def ascii_stl(points=POINTS, faces=FACES) -> bytes:
    lines = ["solid box"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x!r} {y!r} {z!r}" for x, y, z in points[face].tolist()]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid box", ""]).encode()


def obj(points=POINTS, faces=FACES) -> bytes:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    return "\n".join([*lines, ""]).encode()


def off(points=POINTS, faces=FACES, counts=None) -> bytes:
    lines = ["OFF", counts or f"{len(points)} {len(faces)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces.tolist()]
    return "\n".join([*lines, ""]).encode()


def ply_header(kind: str, points: object, faces: object, coordinate="float") -> bytes:
    return (
        f"ply\nformat {kind} 1.0\ncomment a box\nelement vertex {points}\n"
        + "".join(f"property {coordinate} {x}\n" for x in "xyz")
        + f"element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()


def ascii_ply(points=POINTS, faces=FACES, counts=None) -> bytes:
    lines = [f"{x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces.tolist()]
    announced = counts or (len(points), len(faces))
    return ply_header("ascii", *announced) + "\n".join([*lines, ""]).encode()


def binary_ply(points=POINTS, faces=FACES, counts=None, order="<") -> bytes:
    kind = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    body = b"".join(struct.pack(order + "3f", *point) for point in points)
    body += b"".join(struct.pack(order + "B3i", 3, *face) for face in faces.tolist())
    return ply_header(kind, *(counts or (len(points), len(faces)))) + body


def big_ply(points=POINTS, faces=FACES, counts=None) -> bytes:
    return binary_ply(points, faces, counts, order=">")


WRITERS: dict[str, tuple[str, Writer]] = {
    "stl": ("stl", binary_stl),
    "stl-ascii": ("stl", ascii_stl),
    "obj": ("obj", obj),
    "off": ("off", off),
    "ply-ascii": ("ply", ascii_ply),
    "ply": ("ply", binary_ply),
    "ply-big": ("ply", big_ply),
}
INDEXED = ("obj", "off", "ply-ascii", "ply", "ply-big")
COUNTED = ("off", "ply-ascii", "ply", "ply-big")
TEXT = ("stl-ascii", "obj", "off", "ply-ascii")


def moved(place: tuple[int, int], value: float) -> np.ndarray:
    points = POINTS.copy()
    with np.errstate(over="ignore"):
        points[place] = value
    return points


def broken_files() -> dict[str, tuple[str, bytes]]:
    """Files that are not whole or not consistent: name of the case -> suffix, content."""
    cases: dict[str, tuple[str, bytes]] = {}
    random = np.random.default_rng(1)
    for name, (suffix, write) in WRITERS.items():
        good = write()
        for percent in (1, 5, 11, 19, 28, 37, 46, 55, 64, 73, 82, 91):
            cases[f"{name}-cut-{percent}"] = suffix, good[: len(good) * percent // 100]
        for size in (1, 3, 83, 84, 1000):
            cases[f"{name}-garbage-{size}"] = suffix, random.bytes(size)
        for number in ("nan", "inf", "-inf", "1e30", "-1e13"):
            cases[f"{name}-{number}"] = suffix, write(moved((5, 1), float(number)))
        for other in ("stl", "obj", "off", "ply"):
            if other != suffix:
                cases[f"{name}-named-{other}"] = other, good
        cases[f"{name}-unknown-suffix"] = "dae", good
        cases[f"{name}-no-suffix"] = "", good
        cases[f"{name}-behind"] = suffix, good + b"12 and more\n"
    for name in INDEXED:
        suffix, write = WRITERS[name]
        for index in (8, -9, 2**31 - 2, -(2**31) + 1):
            faces = FACES.copy()
            faces[7, 2] = index
            cases[f"{name}-index-{index}"] = suffix, write(faces=faces)
    for name in COUNTED:
        suffix, write = WRITERS[name]
        cases[f"{name}-no-face"] = suffix, write(faces=FACES[:0])
        points = [(count, 12) for count in (9, 7, 0, 10**9, -8)]
        faces_announced = [(8, count) for count in (13, 11, 10**18, "twelve", 1e1)]
        for counts in points + faces_announced:
            text = f"{counts[0]} {counts[1]} 0"
            given = text if name == "off" else counts
            cases[f"{name}-counts-{text}"] = suffix, write(counts=given)
    for count in (0, 11, 13, 2**32 - 1):
        cases[f"stl-count-{count}"] = "stl", binary_stl(count=count)
    for name in TEXT:
        suffix, write = WRITERS[name]
        for new in ("three", "-3,0", "0x3", "3_0", "", "\0"):
            text = write().replace(b"-3.0", new.encode(), 1)
            cases[f"{name}-number-{new!r}"] = suffix, text
    for suffix in ("stl", "obj", "off", "ply"):
        cases[f"{suffix}-empty"] = suffix, b""
        cases[f"{suffix}-blank"] = suffix, b" \n\n \n"
        cases[f"{suffix}-page"] = suffix, b"<!DOCTYPE html><html><body>404 Not found</body></html>"
        cases[f"{suffix}-pointer"] = suffix, b"version https://git-lfs.github.com/spec/v1\noid 1\n"
    return cases | _by_hand()


def _by_hand() -> dict[str, tuple[str, bytes]]:
    vertices = obj().split(b"f ")[0]
    loop = b"solid a\nfacet normal 0 0 0\nouter loop\n"
    corner = b"vertex 0 0 0\n"
    header = ascii_ply().decode()
    cases = {
        "obj-curved": ("obj", b"v 0 0 0\ncstype bezier\ncurv 0 1 1 1\n"),
        "obj-unknown-word": ("obj", obj().replace(b"f 1", b"face 1", 1)),
        "obj-two-corners": ("obj", vertices + b"f 1 2\n"),
        "obj-index-zero": ("obj", vertices + b"f 0 1 2\n"),
        "obj-index-fraction": ("obj", vertices + b"f 1.5 1 2\n"),
        "obj-index-forward": ("obj", b"f 1 2 3\n" + vertices),
        "obj-two-numbers": ("obj", b"v 1 2\n" + vertices + b"f 1 2 3\n"),
        "obj-only-points": ("obj", vertices),
        "off-binary": ("off", off().replace(b"OFF\n", b"OFF BINARY\n")),
        "off-two-corners": ("off", off().replace(b"3 0 1 3", b"2 0 1")),
        "off-corners-missing": ("off", off().replace(b"3 0 1 3", b"4 0 1 3")),
        "off-no-counts": ("off", b"OFF\n"),
        "off-one-count": ("off", b"OFF\n8\n"),
        "stl-two-corners": ("stl", loop + 2 * corner + b"endloop\nendfacet\nendsolid\n"),
        "stl-four-corners": ("stl", loop + 4 * corner + b"endloop\nendfacet\nendsolid\n"),
        "stl-no-loop": ("stl", b"solid a\nfacet normal 0 0 0\nendfacet\nendsolid\n"),
        "stl-no-facet": ("stl", b"solid a\nendsolid a\n"),
        "stl-loop-open": ("stl", loop + 3 * corner + b"endfacet\nendsolid\n"),
        "stl-facet-outside": ("stl", ascii_stl() + loop[8:]),
        "ply-quad-short": ("ply", header.replace("3 0 1 3", "4 0 1 3").encode()),
        "ply-two-corners": ("ply", header.replace("3 0 1 3", "2 0 1").encode()),
        "ply-binary-two-corners": (
            "ply",
            binary_ply().replace(b"\x03\0\0\0\0\1\0\0\0\3\0\0\0", b"\x02\0\0\0\0\1\0\0\0"),
        ),
        "ply-list-of-many": (
            "ply",
            binary_ply(faces=FACES[:1]).replace(b"\3\0\0\0\0", b"\xff\0\0\0\0"),
        ),
    }
    for old, new in (
        ("format ascii 1.0\n", ""),
        ("format ascii 1.0", "format ebcdic 1.0"),
        ("property float x", "property quaternion x"),
        ("property float y\n", ""),
        ("property float z", "property list uchar float z"),
        ("property float z", "property float"),
        ("list uchar int vertex_indices", "list uchar int corners"),
        ("list uchar int vertex_indices", "int vertex_indices"),
        ("list uchar int", "list float int"),
        ("list uchar int", "list uchar float"),
        ("element face", "element strip"),
        ("element vertex", "element point"),
        ("element face", "element vertex"),
        ("end_header\n", ""),
        ("end_header", "the_end"),
        ("comment", "command"),
        ("ply\n", "play\n"),
    ):
        cases[f"ply-header-{old.strip()}-{new.strip()}"] = (
            "ply",
            header.replace(old, new, 1).encode(),
        )
    vertex, face = header.split("element vertex 8\n")[1].split("element face 12\n")
    swapped = header.split("element")[0] + "element face 12\n" + face.split("end_header")[0]
    swapped += "element vertex 8\n" + vertex + "end_header" + face.split("end_header")[1]
    cases["ply-faces-first"] = "ply", swapped.encode()
    return cases


def _joined(*solids: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    points = np.concatenate([p for p, _ in solids])
    starts = np.cumsum([0, *(len(p) for p, _ in solids[:-1])])
    return points, np.concatenate([f + s for (_, f), s in zip(solids, starts, strict=True)])


def _strip(turns: int) -> tuple[np.ndarray, np.ndarray]:
    """A closed band of twelve quads with half turns: a Moebius strip for one."""
    n = 12
    angle = 2.0 * np.pi * np.arange(n) / n
    lean = 0.5 * turns * angle
    middle = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    side = np.stack(
        [np.cos(lean) * np.cos(angle), np.cos(lean) * np.sin(angle), np.sin(lean)], axis=1
    )
    points = np.concatenate([middle - 0.3 * side, middle + 0.3 * side])
    faces = []
    for i in range(n):
        j = (i + 1) % n
        a, b = (i, i + n), (j, j + n) if j or not turns % 2 else (j + n, j)
        faces += [[a[0], b[0], b[1]], [a[0], b[1], a[1]]]
    return points, np.array(faces)


def not_solids() -> dict[str, tuple[np.ndarray, np.ndarray, str]]:
    """Whole files whose triangles bound no volume, and the word their message must have."""
    flip = FACES.copy()
    flip[3] = flip[3, ::-1]
    box, moved_box = (POINTS, FACES), (POINTS + 0.5, FACES)
    by_face, inside = (POINTS + np.array([2, 0, 0]), FACES), (0.5 * POINTS, FACES)
    line = np.linspace(0.0, 1.0, 3)[:, None] * [1.0, 2.0, 3.0]
    inner_flip = flip.copy()
    inner_flip[8] = inner_flip[8, ::-1]
    return {
        "open": (POINTS, FACES[1:], "open: 3 boundary edges in 1 hole"),
        "two-holes": (POINTS, FACES[[1, 3, 4, 5, 6, 7, 8, 9, 10, 11]], "in 2 holes"),
        "triangle": (POINTS, FACES[:1], "open: 3 boundary edges"),
        "sheet": (POINTS, FACES[:2], "open: 4 boundary edges"),
        "flipped": (POINTS, flip, "turned against each other"),
        "two-flipped": (POINTS, inner_flip, "turned against each other"),
        "inside-out": (POINTS, FACES[:, ::-1], "inside out"),
        "face-twice": (POINTS, np.concatenate([FACES, FACES[:1]]), "stand there twice"),
        "all-twice": (POINTS, np.concatenate([FACES, FACES]), "stand there twice"),
        "sheet-both-sides": (POINTS, np.concatenate([FACES[:2], FACES[:2, ::-1]]), "twice"),
        "flat": (POINTS * [1, 1, 0], FACES, "without area"),
        "line": (line, np.array([[0, 1, 2], [2, 1, 0]]), "there is no surface"),
        "point": (POINTS * 0.0, FACES, "there is no surface"),
        "folded": (POINTS, FACES[:, [0, 0, 1]], "there is no surface"),
        "fin": (POINTS, np.concatenate([FACES, [[0, 1, 7]]]), "more than two faces"),
        "moebius": (*_strip(1), "turned against each other"),
        "band": (*_strip(0), "in 2 holes"),
        "boxes-cross": (*_joined(box, moved_box), "cross or touch"),
        "boxes-same-face": (*_joined(box, by_face), "stand there twice"),
        "boxes-nested": (*_joined(box, inside), "not turned inwards"),
        "self-crossing": (moved((7, 0), -4.0), FACES, "cross or touch"),
    }


BROKEN = broken_files()
NOT_SOLID = {
    f"{name}-{kind}": (WRITERS[kind][0], WRITERS[kind][1](points, faces), word)
    for name, (points, faces, word) in not_solids().items()
    for kind in ("stl", "obj", "ply", "off", "stl-ascii")
}
NEEDS_CGAL = ("cross or touch", "not turned inwards")


def check(capsys, path: str) -> tuple[int, str]:
    """Exit status and all that `volcontact mesh check` prints."""
    status = main(["mesh", "check", path])
    printed = capsys.readouterr()
    text = printed.out + printed.err
    assert "Traceback" not in text
    return status, text


def test_there_are_over_300():
    assert len(BROKEN) + len(NOT_SOLID) > 300


def test_the_writers_make_solids(tmp_path, capsys):
    """Else the cases would be refused for another reason than they ought to be."""
    for name, (suffix, write) in WRITERS.items():
        path = tmp_path / f"{name}.{suffix}"
        path.write_bytes(write())
        status, text = check(capsys, str(path))
        assert (status, "volume              48" in text) == (0, True), text


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_file_gets_a_message_with_place_and_fix(name, tmp_path, capsys):
    suffix, content = BROKEN[name]
    path = tmp_path / (f"part.{suffix}" if suffix else "part")
    path.write_bytes(content)
    status, text = check(capsys, str(path))
    assert status == 1, text
    if "bounds no volume" in text:  # an OBJ file cut between two faces is whole, but open
        assert SOMEWHERE.search(text) and "volcontact mesh repair" in text, text
        return
    message = next(line for line in text.splitlines() if line.startswith("error: "))
    assert message.startswith(f"error: {path}: "), message
    problem, _, fix = message.removesuffix(".").rpartition(". ")
    assert len(problem) > 20 and len(fix) > 10, message
    whole_file = ("is no format", "no suffix", "no face")
    assert SOMEWHERE.search(problem) or any(words in problem for words in whole_file), message


@pytest.mark.parametrize("name", NOT_SOLID)
def test_what_is_no_solid_is_told_why_and_where(name, tmp_path, capsys):
    suffix, content, word = NOT_SOLID[name]
    if word in NEEDS_CGAL and cgal.program() is None:
        pytest.skip(cgal.MISSING)
    path = tmp_path / f"part.{suffix}"
    path.write_bytes(content)
    status, text = check(capsys, str(path))
    assert status == 1, text
    assert f"{path}: bounds no volume" in text
    assert word in text, text


def test_what_is_no_file_is_named(tmp_path, capsys):
    (tmp_path / "folder.stl").mkdir()
    os.mkfifo(tmp_path / "pipe.stl")
    (tmp_path / "dangling.stl").symlink_to(tmp_path / "nowhere.stl")
    (tmp_path / "round.stl").symlink_to(tmp_path / "round.stl")
    (tmp_path / "file").write_text("")
    huge = tmp_path / "huge.stl"
    with huge.open("wb") as file:
        file.truncate(1 << 32)  # takes no room on disk
    for name, word in {
        "folder.stl": "folder",
        "pipe.stl": "no regular file",
        "dangling.stl": "no such file",
        "round.stl": "cannot be read",
        "missing.stl": "no such file",
        "file/part.stl": "cannot be read",
        "huge.stl": "more than can be read",
        "n" * 300 + ".stl": "cannot be read",
        "zero\0.stl": "cannot be read",
    }.items():
        status, text = check(capsys, str(tmp_path / name))
        assert status == 1
        assert word in text, (name, text)


@pytest.mark.parametrize("kind", WRITERS)
def test_changed_bytes_never_crash(kind, tmp_path, capsys):
    """Any byte may be wrong. What comes of it may be a solid or not, but never an exception."""
    suffix, write = WRITERS[kind]
    random = np.random.default_rng(7)
    path = tmp_path / f"part.{suffix}"
    for _ in range(60):
        content = bytearray(write())
        for place in random.integers(0, len(content), random.integers(1, 6)):
            content[place] = random.integers(0, 256)
        path.write_bytes(content)
        status, text = check(capsys, str(path))
        assert status in (0, 1)
        assert text


@pytest.mark.parametrize("name", [*list(BROKEN)[::9], *list(NOT_SOLID)[::5]])
def test_repair_of_a_bad_file_never_crashes(name, tmp_path, capsys):
    if cgal.program() is None:
        pytest.skip(cgal.MISSING)
    suffix, content = (BROKEN.get(name) or NOT_SOLID[name])[:2]
    path, out = tmp_path / f"part.{suffix}", tmp_path / "out.ply"
    path.write_bytes(content)
    status = main(["mesh", "repair", str(path), str(out)])
    printed = capsys.readouterr()
    assert "Traceback" not in printed.out + printed.err
    assert status == (0 if out.exists() else 1)  # nothing but solids is written
    assert out.exists() or printed.err.startswith("error: ")
