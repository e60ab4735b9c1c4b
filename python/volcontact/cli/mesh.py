# SPDX-License-Identifier: Apache-2.0
"""`volcontact mesh`: whether mesh files are solids, and repair."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from rich.markup import escape

from volcontact.cli.arguments import add_file, plain_command, positive
from volcontact.cli.terminal import Terminal
from volcontact.meshes.triangles import MeshFileError, counted

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers
    from volcontact.meshes.judging import Judgement

_EXAMPLES = """\
  volcontact mesh check part.stl
  volcontact mesh repair part.stl repaired.ply
"""
_CHECK_EXAMPLES = """\
  volcontact mesh check part.stl
  volcontact mesh check meshes/*.obj --json
"""
_REPAIR_EXAMPLES = """\
  volcontact mesh repair part.stl repaired.ply
  volcontact mesh repair part.stl repaired.ply --weld 1e-6
  volcontact mesh repair scan.obj closed.obj --wrap 0.002
"""
_NOT_A_SOLID = 1


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = plain_command(
        commands, "mesh", "say whether mesh files are solids, and repair them", _EXAMPLES
    )
    ways = parser.add_subparsers(metavar="COMMAND", required=True)
    _add_check(ways)
    _add_repair(ways)


def _add_check(ways: Subparsers) -> None:
    parser = plain_command(
        ways,
        "check",
        "say whether meshes bound a volume, and if not, why and where",
        _CHECK_EXAMPLES,
    )
    add_file(parser, "files", metavar="FILE", nargs="+", help="STL, OBJ, PLY or OFF file")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    parser.set_defaults(execute=check)


def _add_repair(ways: Subparsers) -> None:
    parser = plain_command(
        ways,
        "repair",
        "weld, orient, stitch and fill a mesh, and say what that changed",
        _REPAIR_EXAMPLES,
    )
    add_file(parser, "source", metavar="IN", help="STL, OBJ, PLY or OFF file")
    parser.add_argument(
        "target", metavar="OUT", help="file to write; PLY, OBJ and OFF keep every digit, STL rounds"
    )
    parser.add_argument(
        "--weld",
        type=positive,
        default=0.0,
        metavar="LENGTH",
        help="make points one that are nearer than this along each axis (default: equal points)",
    )
    parser.add_argument("--no-fill", action="store_true", help="leave holes open")
    parser.add_argument(
        "--wrap",
        type=positive,
        metavar="LENGTH",
        help="if that gives no solid: wrap a surface around it, which enters no opening narrower "
        "than LENGTH and grows the solid",
    )
    parser.add_argument(
        "--offset",
        type=positive,
        metavar="LENGTH",
        help="distance of the wrap (default: a thirtieth of --wrap)",
    )
    parser.add_argument("--overwrite", action="store_true", help="write over a file that exists")
    parser.add_argument(
        "--anyway", action="store_true", help="write the result even if it bounds no volume"
    )
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    parser.set_defaults(execute=repair)


def check(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs `mesh check` and returns the exit status."""
    from volcontact.meshes import cgal
    from volcontact.meshes.judging import judge
    from volcontact.meshes.reading import read_mesh

    status = 0
    results: list[dict[str, Any]] = []
    for file in arguments.files:
        try:
            judgement = judge(read_mesh(file))
        except MeshFileError as error:
            status = _NOT_A_SOLID
            results.append({"file": file, "error": str(error)})
            if not terminal.json:
                terminal.error(str(error))
            continue
        if judgement.bounds_volume is False:
            status = _NOT_A_SOLID
        results.append(judgement.as_json())
        if not terminal.json:
            _print(judgement, terminal)
    if terminal.json:
        terminal.result({"meshes": results})
    if cgal.program() is None:
        terminal.warning(f"crossing faces were not looked for: {cgal.MISSING}")
    return status


def repair(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs `mesh repair` and returns the exit status."""
    from volcontact.meshes.repairing import repair as repair_file

    done = repair_file(
        arguments.source,
        arguments.target,
        weld=arguments.weld,
        fill=not arguments.no_fill,
        wrap=arguments.wrap,
        offset=arguments.offset,
        overwrite=arguments.overwrite,
        anyway=arguments.anyway,
    )
    if terminal.json:
        terminal.result(done.as_json())
    else:
        for step in done.steps or ("nothing was changed",):
            terminal.out.print(f"- {step}", markup=False)
        _print(done.after, terminal, name=arguments.target if done.written else "the result")
        terminal.out.print(f"  {_change(done.volume_change)}", markup=False)
    if done.after.bounds_volume:
        return 0
    lost = "it was written all the same" if done.written else "nothing was written"
    terminal.error(
        f"{arguments.target}: the result bounds no volume, {lost}. "
        "Repair it where it was made, or try --wrap LENGTH."
    )
    return _NOT_A_SOLID


def _change(change: float | None) -> str:
    if change is None:
        return "the volume before is not known: the file bounded none"
    if abs(change) < 1e-6:
        return "the volume is what it was"
    return f"the volume changed by {100.0 * change:+.3g} %"


def _print(judgement: Judgement, terminal: Terminal, name: str | None = None) -> None:
    answer = {
        True: "[green]bounds a volume[/]",
        False: "[red]bounds no volume[/]",
        None: "bounds a volume, if no faces cross",
    }[judgement.bounds_volume]
    path = judgement.mesh.path if name is None else name
    terminal.out.print(f"[bold]{escape(path)}[/]: {answer}", soft_wrap=True)
    for title, text in _facts(judgement):
        terminal.out.print(f"  {title:<20}{text}", markup=False, soft_wrap=True)
    for finding in judgement.findings:
        color = "red" if finding.serious else "yellow"
        terminal.out.print(f"  [{color}]-[/] {escape(finding.text)}", soft_wrap=True)
        for place in finding.places:
            terminal.out.print(f"      {escape(place)}", soft_wrap=True)
        if finding.more:
            terminal.out.print("      ...")


def _facts(judgement: Judgement) -> list[tuple[str, str]]:
    mesh, moments = judgement.mesh, judgement.moments
    facts = [
        ("format", mesh.format),
        ("faces", f"{len(mesh.faces)} in {counted(judgement.parts, 'part')}"),
        ("points", f"{judgement.welded_vertices} different"),
        ("size", " x ".join(f"{x:.6g}" for x in judgement.size) + " in the unit of the file"),
        ("closed", _yes_no(judgement.closed)),
        ("faces turned alike", _yes_no(judgement.oriented)),
        ("faces that cross", _crossings(judgement.crossings)),
    ]
    if moments is not None:
        diagonal = ", ".join(f"{x:.6g}" for x in moments.inertia.diagonal())
        facts += [
            ("volume", f"{moments.volume:.9g}"),
            ("centroid", ", ".join(f"{x:.6g}" for x in moments.centroid)),
            ("inertia, xx yy zz", diagonal),
        ]
    return facts


def _yes_no(value: bool) -> str:
    return "yes" if value else "no"


def _crossings(count: int | None) -> str:
    if count is None:
        return "not examined"
    return counted(count, "pair") if count else "none"
