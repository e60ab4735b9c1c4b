# SPDX-License-Identifier: Apache-2.0
"""Where the scenes of the environments are."""

from __future__ import annotations

from pathlib import Path

from volcontact import _volcontact


def scene_file(name: str) -> Path:
    """A scene of the checkout that this file is part of, else the installed copy.

    Args:
        name: path below `mjcf_models`.

    Raises:
        FileNotFoundError: neither has it.
    """
    checkout = Path(__file__).parents[3] / "mjcf_models" / name
    # What CMake installs lies beside the compiled module, also where the rest is used in place.
    installed = Path(_volcontact.__file__).parent / "gym" / "mjcf_models" / name
    for path in (checkout, installed):
        if path.is_file():
            return path
    raise FileNotFoundError(f"no scene {name}: looked for {checkout} and {installed}")
