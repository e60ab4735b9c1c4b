# SPDX-License-Identifier: Apache-2.0
"""`volcontact view`: a scene live, or a recorded run, with contact patches and forces."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from volcontact.cli.arguments import add_drive, add_file, drive_of, plain_command, positive, scene
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers
    from volcontact.view import Stage

_EXAMPLES = """\
  volcontact view scene.xml
  volcontact view scene.xml --speed 0.1 --paused
  volcontact view scene.xml --keyframe above --ctrl push=5
  volcontact view scene.xml --record 2 --clip fall.mp4    two seconds, to look through and to keep
  volcontact view results                              what run or compare wrote with --out
  volcontact view scene.xml --browser                  on a machine without a display
  volcontact view scene.xml --browser --host 0.0.0.0 --port 9000
"""


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = plain_command(
        commands,
        "view",
        "step a scene live, or show a recorded run, with its overlaps, patches and forces",
        _EXAMPLES,
    )
    add_file(
        parser,
        "scene",
        metavar="SCENE",
        type=scene_or_folder,
        help="MJCF file, or the folder that run or compare wrote with --out: its run is shown "
        "without stepping",
    )
    add_file(
        parser,
        "--scene",
        dest="scene_of_folder",
        metavar="FILE",
        type=scene,
        help="the scene of a recorded run, if its file has moved",
    )
    parser.add_argument(
        "--browser",
        action="store_true",
        help="show it in the browser (with viser) instead of MuJoCo's window",
    )
    parser.add_argument(
        "--contact",
        choices=("volumetric", "native"),
        help="contact to start with, or the run of a folder to show (default: volumetric)",
    )
    parser.add_argument(
        "--speed",
        type=positive,
        default=1.0,
        metavar="X",
        help="simulated seconds per real second (default: %(default)s)",
    )
    parser.add_argument("--paused", action="store_true", help="start paused")
    add_drive(parser)
    parser.add_argument(
        "--record",
        type=positive,
        metavar="S",
        help="simulate this long first [s], then show the run with a time slider",
    )
    parser.add_argument(
        "--clip",
        type=clip,
        metavar="FILE",
        help="at the end, write what was shown to this .mp4; needs the extra report",
    )
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        metavar="NAME",
        help="address to serve the browser on: this machine only by default, 0.0.0.0 for all",
    )
    parser.add_argument(
        "--port", type=int, default=8080, metavar="N", help="port for the browser (default: 8080)"
    )
    parser.add_argument(
        "--seconds", type=positive, metavar="S", help="end after this much real time [s]"
    )
    parser.set_defaults(execute=execute)


def clip(text: str) -> Path:
    """Reads the name of a film."""
    path = Path(text)
    if path.suffix.lower() != ".mp4":
        raise argparse.ArgumentTypeError(f"{text}: the name of a clip must end in .mp4")
    if not path.parent.is_dir():
        raise argparse.ArgumentTypeError(f"no such folder: {path.parent}")
    return path


def scene_or_folder(text: str) -> str:
    """Reads the path of a scene, or of a folder that holds a recorded run."""
    if not Path(text).is_dir():
        return scene(text)
    from volcontact.report import files

    if not Path(text, files.TRAJECTORY).is_file():
        raise argparse.ArgumentTypeError(
            f"{text} holds no {files.TRAJECTORY}: `volcontact run SCENE --out {text}` makes one"
        )
    return text


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    from volcontact.view import browser, window

    in_browser = arguments.browser
    reason = "" if in_browser else window.why_no_window()
    if reason:
        raise RuntimeError(reason)
    if arguments.clip is not None:
        from volcontact.report import film  # says now what is not installed

        del film
    with _stage(arguments, terminal) as stage:
        stage.speed, stage.paused = arguments.speed, arguments.paused
        try:
            if not in_browser:
                window.show(stage, seconds=arguments.seconds)
            else:
                with browser.Page(stage, host=arguments.host, port=arguments.port) as page:
                    terminal.out.print(f"open {page.address}, end with Ctrl-C", markup=False)
                    page.run(seconds=arguments.seconds)
        except KeyboardInterrupt:
            if arguments.clip is None:
                raise
        if arguments.clip is not None:
            _write_clip(stage, arguments.clip, terminal)
    return 0


def _stage(arguments: argparse.Namespace, terminal: Terminal) -> Stage:
    from volcontact.view import Stage
    from volcontact.view.playback import record

    if Path(arguments.scene).is_dir():
        return _recorded(arguments)
    if arguments.scene_of_folder is not None:
        raise ValueError(f"--scene is for a folder, and {arguments.scene} is a scene: leave it out")
    drive = drive_of(arguments)
    contact: Literal["volumetric", "native"] = arguments.contact or "volumetric"
    if arguments.record is None:
        return Stage(arguments.scene, contact=contact, drive=drive)
    with terminal.progress() as bars:
        return record(
            arguments.scene,
            arguments.record,
            contact=contact,
            drive=drive,
            progress=bars.task("recording"),
        )


def _recorded(arguments: argparse.Namespace) -> Stage:
    from volcontact.view.recorded import open_recorded

    given = {
        "--record": arguments.record,
        "--keyframe": arguments.keyframe,
        "--ctrl": arguments.ctrl or None,
        "--controls": arguments.controls,
    }
    for name, value in given.items():
        if value is not None:
            raise ValueError(
                f"{name} drives a scene, and {arguments.scene} is a recorded run: leave it out"
            )
    return open_recorded(
        arguments.scene, contact=arguments.contact, scene=arguments.scene_of_folder
    )


def _write_clip(stage: Stage, path: Path, terminal: Terminal) -> None:
    from volcontact.view.clip import write_clip

    with terminal.progress() as bars:
        count = write_clip(stage, path, progress=bars.task("clip"))
    terminal.out.print(f"written: {path}, {count} pictures", markup=False, soft_wrap=True)
