# SPDX-License-Identifier: Apache-2.0
"""Writes the drawing of the includes between the rooms of `pair/` into docs/architecture.md."""

import importlib.util
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "architecture.md"
BEGIN, END = "<!-- rooms -->\n", "<!-- end -->\n"
FLOOR = "volcontact/pair"


def includes() -> tuple[list[str], set[tuple[str, str]]]:
    """The rooms, ground floor first, and the pairs of a room and one that it includes."""
    spec = importlib.util.spec_from_file_location("layering", ROOT / "tests" / "test_layering.py")
    assert spec and spec.loader
    layering = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(layering)
    arrows = set()
    for path in (ROOT / "plugin" / FLOOR).rglob("*"):
        if path.suffix not in {".h", ".cc", ".inc"}:
            continue
        room = layering.room_of(FLOOR, path.relative_to(ROOT / "plugin").as_posix())
        for included in layering.INCLUDE.findall(path.read_text()):
            if included.startswith(f"{FLOOR}/"):
                arrows.add((room, layering.room_of(FLOOR, included)))
    return list(layering.ROOMS[FLOOR]), {(a, b) for a, b in arrows if a != b}


def drawing() -> str:
    """A row for each room, with a mark under the number of every room that it includes."""
    rooms, arrows = includes()
    width = max(map(len, rooms))
    lines = [f"{'':{width + 3}}" + "".join(f"{i:3d}" for i in range(1, len(rooms)))]
    for i, room in enumerate(rooms):
        marks = "".join("  x" if (room, other) in arrows else "  ." for other in rooms[:i])
        above = [other for other in rooms[i + 1 :] if (room, other) in arrows]
        assert not above, f"{room} includes {above}"
        lines.append(f"{i + 1:2d} {room:{width}}{marks}".rstrip())
    return "\n".join(lines)


def render() -> str:
    """The page with the drawing of the present sources."""
    before, rest = PAGE.read_text(encoding="utf-8").split(BEGIN)
    after = rest.split(END, 1)[1]
    return f"{before}{BEGIN}\n```text\n{drawing()}\n```\n\n{END}{after}"


if __name__ == "__main__":
    PAGE.write_text(render(), encoding="utf-8")
