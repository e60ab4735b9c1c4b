# SPDX-License-Identifier: Apache-2.0
"""Arguments that several commands share, and how their values are read."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import shtab

if TYPE_CHECKING:
    from typing import TypeAlias

    from volcontact.given_keys import Value
    from volcontact.running.driving import Drive

    Subparsers: TypeAlias = argparse._SubParsersAction[argparse.ArgumentParser]


def add_command(
    commands: Subparsers, name: str, purpose: str, examples: str
) -> argparse.ArgumentParser:
    """Adds a command with its help text and examples, the scene and --json."""
    parser = plain_command(commands, name, purpose, examples)
    add_file(parser, "scene", metavar="SCENE", type=scene, help="MJCF file")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    return parser


def plain_command(
    commands: Subparsers, name: str, purpose: str, examples: str
) -> argparse.ArgumentParser:
    """Adds a command with its help text and examples, and no argument yet."""
    return commands.add_parser(
        name,
        help=purpose,
        description=purpose[0].upper() + purpose[1:] + ".",
        epilog=f"examples:\n{examples}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def add_file(parser: argparse.ArgumentParser, *names: str, **rest: Any) -> None:
    """Adds an argument that shells complete with the names of files."""
    argument = parser.add_argument(*names, **rest)
    argument.complete = shtab.FILE  # type: ignore[attr-defined]


def add_time(parser: argparse.ArgumentParser, duration: float) -> None:
    """Adds --duration and --timestep."""
    parser.add_argument(
        "--duration",
        type=positive,
        default=duration,
        metavar="S",
        help="simulated time [s] (default: %(default)s)",
    )
    parser.add_argument(
        "--timestep", type=positive, metavar="S", help="timestep [s] (default: the scene's)"
    )


def add_keys(parser: argparse.ArgumentParser) -> None:
    """Adds --material and --option, for scenes without keys of their own."""
    parser.add_argument(
        "--material",
        type=key,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="material of all geoms for which the file gives none, such as stiffness=1e9; "
        "may be repeated",
    )
    parser.add_argument(
        "--option",
        type=key,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="option that overrides the file's, such as mesh=exact_or_hull; may be repeated",
    )


def add_drive(parser: argparse.ArgumentParser) -> None:
    """Adds --keyframe, --ctrl and --controls."""
    add_keyframe(parser)
    parser.add_argument(
        "--ctrl",
        type=controls,
        action="extend",
        default=[],
        metavar="NAME=VALUE,...",
        help="controls that stay constant over the run, in the scene's units; may be repeated",
    )
    add_file(
        parser,
        "--controls",
        metavar="FILE",
        type=existing,
        help="controls over time: a CSV or Parquet table with a column time [s] and one column per "
        "actuator, interpolated linearly",
    )


def add_keyframe(parser: argparse.ArgumentParser) -> None:
    """Adds --keyframe."""
    parser.add_argument(
        "--keyframe",
        metavar="NAME",
        help="keyframe of the scene to start from (default: that called start, if there is one)",
    )


def drive_of(arguments: argparse.Namespace) -> Drive:
    """What `add_drive` read."""
    from volcontact.running.driving import Drive

    names = [name for name, _ in arguments.ctrl]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"--ctrl: {name!r} stands there {names.count(name)} times: leave one")
    return Drive(arguments.keyframe, dict(arguments.ctrl), arguments.controls)


def controls(text: str) -> list[tuple[str, float]]:
    """Reads NAME=VALUE,NAME=VALUE."""
    pairs = []
    for part in text.split(","):
        name, _, value = part.rpartition("=")
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not name or not math.isfinite(number):
            raise argparse.ArgumentTypeError(f"{part!r} must be NAME=VALUE with a finite number")
        pairs.append((name.strip(), number))
    return pairs


def existing(text: str) -> str:
    """Reads the path of a file."""
    if not Path(text).is_file():
        raise argparse.ArgumentTypeError(f"no such file: {text}")
    return text


def key(text: str) -> tuple[str, Value]:
    """Reads a name and a number or word."""
    name, separator, value = text.partition("=")
    if not (name and separator and value):
        raise argparse.ArgumentTypeError(f"{text!r} must be NAME=VALUE")
    try:
        return name, float(value)
    except ValueError:
        from volcontact.given_keys import NUMBERS

        if name in NUMBERS:
            raise argparse.ArgumentTypeError(f"{name} takes a number, got {value!r}") from None
        return name, value


def scene(text: str) -> str:
    """Reads the path of a scene."""
    return existing(text)


def positive(text: str) -> float:
    """Reads a number above 0."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value > 0.0):
        raise argparse.ArgumentTypeError(f"{text!r} must be a number above 0")
    return value


def pixels(text: str) -> int:
    """Reads the width or height of a picture."""
    if not (text.isdecimal() and 16 <= int(text) <= 4096):
        raise argparse.ArgumentTypeError(f"{text!r} must be a whole number from 16 to 4096")
    return int(text)
