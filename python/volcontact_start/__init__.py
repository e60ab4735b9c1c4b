# SPDX-License-Identifier: Apache-2.0
"""The program `volcontact` from its first moment: it may be interrupted while it is being loaded.

Apart from the package, which loads MuJoCo and NumPy with its first line.
"""

from __future__ import annotations

import os
import signal
from typing import Any

_INTERRUPTED = 130


def main() -> int:
    """Loads the program, runs it and returns its exit status."""
    usual: dict[int, Any] = {
        signal.SIGINT: signal.default_int_handler,
        signal.SIGTERM: signal.SIG_DFL,
    }
    held = {number: usual[number] for number in usual if signal.getsignal(number) == usual[number]}
    for number in held:
        signal.signal(number, _end)
    from volcontact.cli import main as program

    for number, handler in held.items():
        signal.signal(number, handler)
    return program()


def _end(*_: object) -> None:
    """Ends at once: nothing is written yet, and half-loaded modules would complain."""
    os.write(2, b"error: interrupted\n")
    os._exit(_INTERRUPTED)
