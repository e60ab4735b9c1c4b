# SPDX-License-Identifier: Apache-2.0
"""Press: k_v and the offset of the depth gauge from force over depth."""

from __future__ import annotations

from volcontact.identify.analytic.force_depth import force_depth
from volcontact.identify.direct.sheets import Sheet
from volcontact.identify.direct.solids import solids_of
from volcontact.identify.readings import LEVEL, Reading


def press(sheet: Sheet, *, level: float = LEVEL) -> Reading:
    """Reads a press test.

    Args:
        sheet: with `depth`, `force` and perhaps `speed`; the solids `a` and `b`.
        level: of the intervals.

    Returns:
        As `analytic.force_depth`.

    Raises:
        ValueError: the sheet does not have what the test needs.
    """
    a, b = solids_of(sheet)
    columns = sheet.columns
    offset = float(sheet.constants["offset"]) if "offset" in sheet.constants else None
    return force_depth(
        columns["depth"],
        columns["force"],
        a,
        b,
        speeds=columns["speed"] if sheet.has("speed") else None,
        offset=offset,
        level=level,
        name="press",
    )
