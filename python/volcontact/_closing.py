# SPDX-License-Identifier: Apache-2.0
"""What is used as a context manager and closes at its end."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TypeVar

_Self = TypeVar("_Self", bound="Closing")


class Closing(ABC):
    """Closes at the end of its `with` block."""

    @abstractmethod
    def close(self) -> None:
        """Gives back what is held. May be called twice."""

    def __enter__(self: _Self) -> _Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
