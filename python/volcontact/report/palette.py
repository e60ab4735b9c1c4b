# SPDX-License-Identifier: Apache-2.0
"""One colour per thing, the same in curves and in pictures."""

VOLUMETRIC = "#2f6bff"
NATIVE = "#d6246e"
RUN_COLORS = {"volumetric": VOLUMETRIC, "native": NATIVE}

KINETIC = "#f2b134"
POTENTIAL = "#7f8c9a"
ELASTIC = "#1aa179"
DISSIPATED = {"normal": "#8a4fff", "roll": "#4fb3ff", "slide": "#c77dff", "spin": "#ff8fab"}
UNEXPLAINED = "#b8bec6"

# Of solids, by material, as long as they last; then one for all others.
MATERIALS = ("#44749e", "#d98533", "#5b8c5a", "#8a6bb1", "#b5524a", "#3f9c9c", "#a08a3c", "#c06c9a")
OTHER_MATERIALS = "#9aa3ad"


def rgb(color: str) -> tuple[float, float, float]:
    """Red, green and blue, each 0 to 1, of "#rrggbb"."""
    red, green, blue = (int(color[i : i + 2], 16) / 255.0 for i in (1, 3, 5))
    return red, green, blue
