# SPDX-License-Identifier: Apache-2.0
"""Names of a scene where people read them: a file may give any, also such as steer a terminal."""

from __future__ import annotations

import re

# Control characters but for tab and new line, those that are not seen or turn the direction of
# writing, and halves of characters.
_UNSEEN = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ud800-\udfff]"
)
_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def printable(text: str) -> str:
    r"""The text with what would not be seen spelled out, as in Python: \x1b for escape."""
    return _UNSEEN.sub(_spelled, text)


def cell(text: str) -> str:
    """A text as cell of a CSV file: spreadsheets take one that begins like a formula for one."""
    return printable(f"'{text}" if text.startswith(_FORMULA) else text)


def drawn(text: str) -> str:
    """A text as a label of a figure: Matplotlib takes what stands between dollars for a formula."""
    return printable(text).replace("$", r"\$")


def _spelled(found: re.Match[str]) -> str:
    code = ord(found[0])
    return f"\\x{code:02x}" if code < 256 else f"\\u{code:04x}"
