# SPDX-License-Identifier: Apache-2.0
"""Draws the curve of docs/tutorials/insertion.md from a run of its template.

./run python docs/generate/make_tutorials.py
"""

from __future__ import annotations

from pathlib import Path

import volcontact
from volcontact.report.plots import plots_of_run
from volcontact.running.driving import Drive
from volcontact.running.simulation import simulate

PICTURE = Path(__file__).parents[1] / "tutorials" / "insertion.svg"
TEMPLATE = Path(volcontact.__file__).parent / "templates" / "insertion"


def main() -> None:
    """Writes the picture."""
    run = simulate(
        TEMPLATE / "scene.xml",
        duration=1.5,
        drive=Drive(table=TEMPLATE / "press.csv"),
        frame_interval=None,
    )
    (curve,) = plots_of_run(run, ["shaft.force_z:joint.press.position"])
    PICTURE.write_text(curve.paper, encoding="utf-8")


if __name__ == "__main__":
    main()
