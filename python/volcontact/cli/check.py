# SPDX-License-Identifier: Apache-2.0
"""`volcontact check`: what volcontact understands of a scene, without stepping it."""

from __future__ import annotations

import argparse
import warnings
from typing import TYPE_CHECKING

from rich.box import SIMPLE_HEAD
from rich.markup import escape
from rich.table import Table

import volcontact
from volcontact.cli.arguments import add_command
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers

_EXAMPLES = """\
  volcontact check scene.xml
  volcontact check scene.xml --json
"""


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = add_command(
        commands,
        "check",
        "print the solids, pairs, materials and options that a scene has under volcontact",
        _EXAMPLES,
    )
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    from volcontact.report.description import tables

    model = volcontact.load(arguments.scene)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # they are part of the description
        with volcontact.attach(model) as contact:
            description = contact.description
    description["userdata"]["line"] = size_line(description["userdata"])
    if terminal.json:
        terminal.result(description)
        return 0
    for part in tables(description, sources=False):
        terminal.out.print(part.title, style="bold")
        if part.note:
            terminal.out.print(part.note, markup=False)
        table = Table(*(escape(column) for column in part.columns), box=SIMPLE_HEAD)
        for row in part.rows:
            table.add_row(*(escape(cell) for cell in row))
        terminal.out.print(table)
    for warning in description.get("warnings", ()):
        terminal.warning(str(warning))
    return 0


def size_line(userdata: dict[str, int]) -> str:
    """What a program that does not use `volcontact.load` must find in the file.

    Args:
        userdata: `needed` and `present` numbers, of a model that `load` made.

    Returns:
        The MJCF line, or that the file has enough.
    """
    in_file = userdata["present"] - userdata["needed"]
    if in_file >= userdata["needed"]:
        return f'the file has room: nuserdata="{in_file}"'
    return f'<size nuserdata="{userdata["needed"] + in_file}"/>'
