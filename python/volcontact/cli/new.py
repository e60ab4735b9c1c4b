# SPDX-License-Identifier: Apache-2.0
"""`volcontact new`: a scene to start from, with comments."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING

from rich.markup import escape

from volcontact._files import appearing_in
from volcontact.cli.arguments import plain_command
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers

TEMPLATES = {
    "drop": "a box falls onto a floor",
    "incline": "a box sticks to a slope",
    "peg_in_hole": "a peg falls through a hole that is cut exactly",
    "mesh_in_hole": "a mesh falls through the hole of another mesh",
    "insertion": "a shaft is pushed into a chamfered bore, exact and as meshes",
    "tour": "a notebook from two solids to a force curve, for Jupyter",
}

_FOLDER = Path(__file__).parents[1] / "templates"
_EXAMPLES = """\
  volcontact new my_scene
  volcontact new my_scene --template mesh_in_hole
  volcontact new my_press --template insertion
  volcontact new my_tour --template tour
  volcontact check my_scene/scene.xml
"""


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = plain_command(
        commands,
        "new",
        "write a scene to start from, with comments, into a new folder",
        _EXAMPLES + "\ntemplates:\n" + "".join(f"  {k:<16}{v}\n" for k, v in TEMPLATES.items()),
    )
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="folder to make")
    parser.add_argument(
        "--template",
        choices=tuple(TEMPLATES),
        default="drop",
        help="what to start from (default: %(default)s)",
    )
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    folder: Path = arguments.folder
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise FileExistsError(f"{folder} exists already: name a new folder, or an empty one")
    template = _FOLDER / arguments.template
    notebooks = [path.name for path in template.glob("*.ipynb")]
    first = folder / (notebooks[0] if notebooks else "scene.xml")
    written = []
    with appearing_in(folder) as new:
        for source in sorted(path for path in template.rglob("*") if path.is_file()):
            if source.suffix == ".pyc":  # an installer has compiled what it found
                continue
            name = source.relative_to(template)
            target = new / name
            target.parent.mkdir(parents=True, exist_ok=True)
            content = source.read_text(encoding="utf-8")
            if not notebooks:
                content = _with_names(content, folder, folder / name if _is_scene(name) else first)
            target.write_text(content, encoding="utf-8")
            written.append(str(folder / name))
    if terminal.json:
        terminal.result({"notebook" if notebooks else "scene": str(first), "files": written})
        return 0
    for name in written:
        terminal.out.print(f"written: {escape(name)}", soft_wrap=True)
    command = "jupyter lab" if notebooks else "volcontact check"
    terminal.out.print(f"next: {command} {escape(str(first))}", soft_wrap=True)
    return 0


def _is_scene(name: Path) -> bool:
    return name.suffix == ".xml"


def _with_names(content: str, folder: Path, scene: Path) -> str:
    """The comments of a template say what to type next."""
    for word, meant in (("SCENE", str(scene)), ("FOLDER", str(folder))):
        content = re.sub(rf"\b{word}\b", meant.replace("\\", r"\\"), content)
    return content
