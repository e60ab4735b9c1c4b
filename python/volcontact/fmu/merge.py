# SPDX-License-Identifier: Apache-2.0
"""Joins FMUs of one unit, made on several platforms, into one."""

from __future__ import annotations

import os
import re
import zipfile
from collections.abc import Sequence
from pathlib import Path

from volcontact.fmu.packing import write_zip

_DATE = re.compile(rb' generationDateAndTime="[^"]*"')


def merge_fmus(paths: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str]) -> list[str]:
    """Writes an FMU with the binaries of all.

    Args:
        paths: FMUs that differ in their binaries and in the time when they were made.
        out: path of the new one.

    Returns:
        The folders of binaries that it has.

    Raises:
        ValueError: they are not of one unit, or two have different binaries for one platform.
    """
    if len(paths) < 2:
        raise ValueError("merge takes two FMUs or more")
    merged: dict[str, bytes] = {}
    for path in map(Path, paths):
        for name, content in _content(path).items():
            before = merged.setdefault(name, content)
            if _DATE.sub(b"", before) == _DATE.sub(b"", content):
                continue
            if name.startswith("binaries/"):
                raise ValueError(f"{path}: its {name} is another than that of an FMU before it")
            raise ValueError(
                f"{path} is of another unit than {paths[0]}: their {name} differ; export both "
                "from the same scene with the same arguments and the same volcontact"
            )
    write_zip(Path(out), merged)
    return sorted({name.split("/")[1] for name in merged if name.startswith("binaries/")})


def _content(path: Path) -> dict[str, bytes]:
    try:
        with zipfile.ZipFile(path) as fmu:
            names = [name for name in fmu.namelist() if not name.endswith("/")]
            if "modelDescription.xml" not in names:
                raise ValueError(f"{path} is no FMU: it has no modelDescription.xml")
            return {name: fmu.read(name) for name in names}
    except zipfile.BadZipFile as error:
        raise ValueError(f"{path} is no FMU: {error}") from None
