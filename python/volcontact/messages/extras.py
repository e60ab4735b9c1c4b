# SPDX-License-Identifier: Apache-2.0
"""What each extra of the package brings, and what to install where one is missing."""

from __future__ import annotations

# By the module that shows it is there; pyproject.toml has the packages.
EXTRAS = {
    "imageio_ffmpeg": "report",
    "jinja2": "report",
    "matplotlib": "report",
    "PIL": "report",
    "pyarrow": "report",
    "viser": "view",
    "gymnasium": "gym",
    "optuna": "study",
    "SALib": "study",
    "cma": "study",
    "scipy": "study",
    "tomli": "study",
    "ray": "ray",
    "distributed": "dask",
}


def advice(module: str | None) -> str | None:
    """What to install for a module that was not found; None when it is of no extra."""
    top = (module or "").partition(".")[0]
    if top not in EXTRAS:
        return None
    return f'{top} is not installed: pip install "volcontact[{EXTRAS[top]}]"'
