# SPDX-License-Identifier: Apache-2.0
"""Writes volcontact/_volcontact.pyi, the types of the compiled core, for editors and type checkers.

Run `./run python python/make_stub.py` after changing a binding or a table of fields.
"""

from __future__ import annotations

from pathlib import Path

from nanobind.stubgen import StubGen

from volcontact import _volcontact

STUB = Path(__file__).parent / "volcontact" / "_volcontact.pyi"


def render() -> str:
    """The text of the stub.

    Returns:
        What nanobind makes of the compiled module.
    """
    generator = StubGen(_volcontact)
    generator.put(_volcontact)
    return "# SPDX-License-Identifier: Apache-2.0\n" + generator.get()


def main() -> None:
    """Writes the stub."""
    STUB.write_text(render(), encoding="utf-8")


if __name__ == "__main__":
    main()
