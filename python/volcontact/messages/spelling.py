# SPDX-License-Identifier: Apache-2.0
"""Hints for messages about a name that is not known."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

_MOST_SHOWN = 12


def nearest(word: str, words: Iterable[str]) -> str:
    """The hint `; did you mean ...?`, or what there is, of much the closest."""
    known = sorted(words)
    near = difflib.get_close_matches(word, known, n=1)
    if near:
        return f"; did you mean {near[0]!r}?"
    if len(known) > _MOST_SHOWN:
        closest = difflib.get_close_matches(word, known, n=_MOST_SHOWN, cutoff=0.0)
        return f"; of {len(known)} the closest are {', '.join(closest)}"
    return f"; there is {', '.join(known)}" if known else "; there is none"
