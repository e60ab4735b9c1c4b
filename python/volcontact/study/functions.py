# SPDX-License-Identifier: Apache-2.0
"""The user's own functions: a Python file beside the study."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from volcontact.messages.spelling import nearest
from volcontact.study.file.settings import StudyError


class Functions:
    """Functions of a file, by name.

    Args:
        path: of the file; None has none.

    Raises:
        StudyError: the file cannot be imported.
    """

    def __init__(self, path: Path | None) -> None:
        self._module: ModuleType | None = None
        self._file = "" if path is None else path.name
        if path is None:
            return
        spec = importlib.util.spec_from_file_location(f"volcontact_study_{path.stem}", path)
        assert spec is not None and spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        try:
            spec.loader.exec_module(module)
        except Exception as error:
            kind = type(error).__name__
            raise StudyError(f"{path.name}: importing it failed, {kind}: {error}") from error
        self._module = module

    def get(self, name: str, where: str) -> Callable[..., Any]:
        """A function.

        Raises:
            StudyError: the file has no such function.
        """
        found = getattr(self._module, name, None)
        if not callable(found):
            known = [n for n, v in vars(self._module or object).items() if callable(v)]
            names = [n for n in known if not n.startswith("_")]
            raise StudyError(
                f"{where} = {name!r}: {self._file or 'no python file'} has no such "
                f"function{nearest(name, names)}"
            )
        function: Callable[..., Any] = found
        return function
