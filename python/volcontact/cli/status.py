# SPDX-License-Identifier: Apache-2.0
"""The exit status of commands that ran a scene, and what they note."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.running.recording import Recording

TROUBLE = 3


def report_warnings(runs: Iterable[Recording], terminal: Terminal) -> int:
    """Prints what MuJoCo and volcontact warned of; 0 without any, else `TROUBLE`."""
    status = 0
    for run in runs:
        if run.stopped is not None:
            terminal.warning(f"{run.contact} contact: {run.stopped}")
            status = TROUBLE
        if run.warnings:
            counts = ", ".join(f"{name} {count} times" for name, count in run.warnings.items())
            terminal.warning(f"{run.contact} contact: MuJoCo warned of {counts}")
            status = TROUBLE
        if run.dropped:
            terminal.warning(
                f"{run.contact} contact: in {run.dropped} evaluations a force was no finite number "
                "and was left out"
            )
            status = TROUBLE
    return status


def print_notes(runs: Iterable[Recording], terminal: Terminal) -> None:
    """Prints what was left as it is and hardly meant, each line once."""
    for note in dict.fromkeys(note for run in runs for note in run.notes):
        terminal.note(note)
