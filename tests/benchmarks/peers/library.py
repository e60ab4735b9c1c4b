# SPDX-License-Identifier: Apache-2.0
"""What a library must do to be timed."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from .bodies import Body


class Unsupported(Exception):
    """The library has no such solid or pair."""


class Query(Protocol):
    """One way of one library to ask about a pair; made anew for each pair.

    Attributes:
        library: its name
        variant: which of its ways
        gives: what the answer is: 'volume', 'surface' or 'points'
        note: how the solids were given to it, and what to know about the answer
    """

    library: str
    variant: str
    gives: str
    note: str

    def __init__(self, a: Body, b: Body) -> None:
        """Builds the solids. Raises Unsupported."""

    def place(self, pose: np.ndarray) -> None:
        """Sets the pose of B in A. Not timed."""

    def ask(self) -> Any:
        """The query. Timed."""

    def finds(self, answer: Any) -> bool:
        """Whether the answer is a contact."""

    def volume(self, answer: Any) -> float | None:
        """The volume of the overlap [m^3], where the answer has one."""
