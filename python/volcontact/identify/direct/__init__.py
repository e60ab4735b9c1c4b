# SPDX-License-Identifier: Apache-2.0
"""Bench tests: parameters straight from the curves that an engineer measures.

    from volcontact.identify import direct

    found = direct.bench("press", "press.csv", out="results")
    found["stiffness"], found.mjcf("pad"), found.findings

The sheet of a test is CSV with units in its head: `direct.template("press")` is one to fill in.
Procedures, formulas and ranges of validity: docs/bench_tests.md.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path

from volcontact.identify.direct.breakaway import breakaway
from volcontact.identify.direct.drop import drop
from volcontact.identify.direct.layouts import LAYOUTS
from volcontact.identify.direct.press import press
from volcontact.identify.direct.pull import pull, tilt
from volcontact.identify.direct.roll import roll
from volcontact.identify.direct.sheets import Sheet, SheetError, parse_sheet, read_sheet
from volcontact.identify.direct.sheets import template as _template
from volcontact.identify.direct.slip import slip
from volcontact.identify.direct.spin import spin
from volcontact.identify.readings import LEVEL, Reading

__all__ = ["Sheet", "SheetError", "bench", "breakaway", "read_bench", "template"]

ESTIMATORS: dict[str, Callable[..., Reading]] = {
    "press": press,
    "drop": drop,
    "tilt": tilt,
    "pull": pull,
    "slip": slip,
    "roll": roll,
    "spin": spin,
}


def bench(
    test: str,
    path: str | os.PathLike[str],
    out: str | os.PathLike[str] | None = None,
    *,
    given: Mapping[str, float | str] | None = None,
    level: float = LEVEL,
    report: bool = True,
) -> Reading:
    """Reads parameters off the data sheet of a bench test.

    Args:
        test: "press", "drop", "tilt", "pull", "slip", "roll" or "spin".
        path: of the sheet, CSV.
        out: folder for `identified.json`, `identified.xml` and `report.html`; None writes nothing.
        given: constants of the sheet in SI, in place of those that it has.
        level: of the intervals, above 0 and below 1.
        report: whether `report.html` is written.

    Returns:
        Values with intervals, the range of validity, findings in sentences and MJCF lines.

    Raises:
        FileNotFoundError: there is no such file.
        SheetError: the sheet does not have what the test needs.
        ValueError: there is no such test, or the data do not fit it.
    """
    _known(test)
    if not 0.0 < level < 1.0:
        raise ValueError(f"level = {level:g}: must be above 0 and below 1")
    found = ESTIMATORS[test](read_sheet(path, LAYOUTS[test], given), level=level)
    if out is not None:
        from volcontact.identify.direct.output import write

        write(found, Path(out), report=report)
    return found


def read_bench(
    test: str,
    text: str,
    *,
    given: Mapping[str, float | str] | None = None,
    level: float = LEVEL,
    source: str = "sheet",
) -> Reading:
    """The same for a sheet that is text.

    Args:
        test: as for `bench`.
        text: of the sheet.
        given: as for `bench`.
        level: as for `bench`.
        source: name of the sheet in messages.

    Raises:
        SheetError: the sheet does not have what the test needs.
        ValueError: there is no such test, or the data do not fit it.
    """
    _known(test)
    return ESTIMATORS[test](parse_sheet(text, LAYOUTS[test], source, given), level=level)


def template(test: str) -> str:
    """The data sheet of a test, with an example to write over.

    Raises:
        ValueError: there is no such test.
    """
    _known(test)
    return _template(LAYOUTS[test])


def _known(test: str) -> None:
    if test not in LAYOUTS:
        raise ValueError(f"test = {test!r}: must be one of {', '.join(LAYOUTS)}")
