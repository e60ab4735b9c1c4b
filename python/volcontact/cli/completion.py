# SPDX-License-Identifier: Apache-2.0
"""`volcontact completion`: what a shell needs to complete commands, options and files."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

import shtab

from volcontact.cli.arguments import plain_command
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers

_EXAMPLES = """\
  volcontact completion bash > ~/.local/share/bash-completion/completions/volcontact
  volcontact completion zsh > ~/.zfunc/_volcontact         with fpath+=~/.zfunc in .zshrc
"""


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = plain_command(
        commands, "completion", "print the completion script of a shell", _EXAMPLES
    )
    parser.add_argument("shell", choices=shtab.SUPPORTED_SHELLS, help="which shell")
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    from volcontact.cli import make_parser

    terminal.out.out(shtab.complete(make_parser(), arguments.shell), highlight=False)
    return 0
