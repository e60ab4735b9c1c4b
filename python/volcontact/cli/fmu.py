# SPDX-License-Identifier: Apache-2.0
"""`volcontact fmu`: contact as a Functional Mock-up Unit for other simulators."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from volcontact.cli.arguments import add_file, add_keys, plain_command
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers

_EXAMPLES = """\
  volcontact fmu scene.xml --bodies ball world --out ball.fmu
  volcontact fmu scene.xml --bodies lid box --fmi 3 --kind me --orientation matrix --out lid.fmu
  volcontact fmu --scene scene.xml --contact ball floor --out scene.fmu
  volcontact fmu merge linux/ball.fmu windows/ball.fmu --out ball.fmu
"""
_MERGE = "merge"
_SLOTS = 4


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = plain_command(
        commands,
        "fmu",
        "write contact, or a whole scene, as a Functional Mock-up Unit (FMI 2.0, 3.0)",
        _EXAMPLES,
    )
    add_file(
        parser,
        "scene",
        metavar="SCENE",
        nargs="*",
        help="MJCF file whose bodies the simulator moves; or the word merge and FMUs of one unit "
        "made on several platforms",
    )
    add_file(
        parser,
        "--scene",
        dest="whole",
        metavar="SCENE",
        help="MJCF file that the unit steps by itself, with MuJoCo in it",
    )
    parser.add_argument(
        "--bodies", nargs="+", default=[], metavar="BODY", help="their names; world is one"
    )
    parser.add_argument(
        "--contact",
        nargs=2,
        action="append",
        default=[],
        metavar=("A", "B"),
        help="with --scene: bodies or geoms whose contact has values of its own",
    )
    parser.add_argument(
        "--fmi", type=int, choices=(2, 3), default=2, help="version (default: %(default)s)"
    )
    parser.add_argument(
        "--kind",
        choices=("me", "cs", "both"),
        default="both",
        help="Model Exchange, Co-Simulation (default: %(default)s)",
    )
    parser.add_argument(
        "--orientation",
        choices=("quaternion", "matrix"),
        default="quaternion",
        help="how bodies are turned (default: %(default)s)",
    )
    parser.add_argument(
        "--frame",
        choices=("world", "body"),
        default="world",
        help="of twists and wrenches (default: %(default)s)",
    )
    parser.add_argument(
        "--slots",
        type=int,
        default=_SLOTS,
        metavar="N",
        help="contact sites with values of their own (default: %(default)s)",
    )
    parser.add_argument(
        "--scalars", action="store_true", help="FMI 3 without arrays, for masters that know none"
    )
    parser.add_argument(
        "--sources", action="store_true", help="put the sources inside, for other platforms"
    )
    parser.add_argument("--out", type=Path, metavar="FILE", help="of the FMU (default: SCENE.fmu)")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    add_keys(parser)
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    from volcontact.fmu import export_fmu, merge_fmus

    if arguments.whole is not None:
        return _whole_scene(arguments, terminal)
    if not arguments.scene:
        raise ValueError("name a scene: SCENE and --bodies, or --scene SCENE")
    first, *rest = arguments.scene
    if first == _MERGE:
        out = arguments.out or Path("merged.fmu")
        folders = merge_fmus(rest, out)
        _tell(terminal, {"fmu": str(out), "binaries": folders})
        return 0
    if arguments.contact:
        raise ValueError("--contact goes with --scene; of bodies the unit has all contact")
    if rest:
        raise ValueError(f"one scene at a time, not {' '.join(arguments.scene)}")
    if not Path(first).is_file():
        raise ValueError(f"no such file: {first}")
    out = export_fmu(
        first,
        arguments.out or Path(first).with_suffix(".fmu").name,
        bodies=arguments.bodies,
        fmi=arguments.fmi,
        kind=arguments.kind,
        orientation=arguments.orientation,
        frame=arguments.frame,
        slots=arguments.slots,
        arrays=not arguments.scalars,
        sources=arguments.sources,
        material=dict(arguments.material),
        options=dict(arguments.option),
    )
    _tell(
        terminal,
        {"fmu": str(out), "fmi": arguments.fmi, "kind": arguments.kind, "bodies": arguments.bodies},
    )
    return 0


def _whole_scene(arguments: argparse.Namespace, terminal: Terminal) -> int:
    from volcontact.fmu import export_scene_fmu

    if arguments.scene:
        raise ValueError(
            f"one scene at a time, not {' '.join([arguments.whole, *arguments.scene])}"
        )
    defaults: dict[str, tuple[object, ...]] = {
        "kind": ("both", "cs"),
        "orientation": ("quaternion",),
        "frame": ("world",),
        "slots": (_SLOTS,),
        "sources": (False,),
    }
    for name, values in defaults.items():
        if getattr(arguments, name) not in values:
            raise ValueError(f"--{name} is for the contact of bodies, not for a whole --scene")
    out = export_scene_fmu(
        arguments.whole,
        arguments.out or Path(arguments.whole).with_suffix(".fmu").name,
        fmi=arguments.fmi,
        bodies=arguments.bodies or None,
        contacts=[(a, b) for a, b in arguments.contact],
        arrays=not arguments.scalars,
        material=dict(arguments.material),
        options=dict(arguments.option),
    )
    _tell(terminal, {"fmu": str(out), "fmi": arguments.fmi, "kind": "cs", "scene": arguments.whole})
    return 0


def _tell(terminal: Terminal, result: dict[str, object]) -> None:
    if terminal.json:
        terminal.result(result)
        return
    terminal.out.print(f"wrote {result['fmu']}", markup=False)
