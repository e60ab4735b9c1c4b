# SPDX-License-Identifier: Apache-2.0
"""`volcontact view`: a scene live, with contact patches and forces."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from volcontact.cli.arguments import add_file, plain_command, positive, scene
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers

_EXAMPLES = """\
  volcontact view scene.xml
  volcontact view scene.xml --speed 0.1 --paused
  volcontact view scene.xml --browser                  on a machine without a display
  volcontact view scene.xml --browser --host 0.0.0.0 --port 9000
"""


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = plain_command(
        commands,
        "view",
        "step a scene live and draw its overlaps, patches and forces",
        _EXAMPLES,
    )
    add_file(parser, "scene", metavar="SCENE", type=scene, help="MJCF file")
    parser.add_argument(
        "--browser",
        action="store_true",
        help="in the browser, by viser, in place of MuJoCo's window",
    )
    parser.add_argument(
        "--contact",
        choices=("volumetric", "native"),
        default="volumetric",
        help="kind of contact to begin with (default: %(default)s)",
    )
    parser.add_argument(
        "--speed",
        type=positive,
        default=1.0,
        metavar="X",
        help="simulated seconds a second (default: %(default)s)",
    )
    parser.add_argument("--paused", action="store_true", help="wait at the start")
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        metavar="NAME",
        help="where the browser may be: this machine alone by default, 0.0.0.0 for all",
    )
    parser.add_argument(
        "--port", type=int, default=8080, metavar="N", help="for the browser (default: 8080)"
    )
    parser.add_argument(
        "--seconds", type=positive, metavar="S", help="end after so much real time [s]"
    )
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    from volcontact.view import Stage, browser, window

    in_browser = arguments.browser
    reason = "" if in_browser else window.why_no_window()
    if reason:
        raise RuntimeError(reason)
    with Stage(arguments.scene, contact=arguments.contact) as stage:
        stage.speed, stage.paused = arguments.speed, arguments.paused
        if not in_browser:
            window.show(stage, seconds=arguments.seconds)
            return 0
        with browser.Page(stage, host=arguments.host, port=arguments.port) as page:
            terminal.out.print(f"open {page.address}, end with Ctrl-C", markup=False)
            page.run(seconds=arguments.seconds)
    return 0
