# SPDX-License-Identifier: Apache-2.0
"""Writes the tables of docs/bench_tests.md from the sheets of mjcf_models/identification.

    ./run python docs/generate/make_bench_tests.py

Text outside of the marks is written by hand.
"""

from __future__ import annotations

import math
from pathlib import Path

import mujoco
import numpy as np

from volcontact.identify.direct import ESTIMATORS
from volcontact.identify.direct.layouts import LAYOUTS
from volcontact.identify.direct.sheets import Sheet, read_sheet
from volcontact.identify.ranges import DEFAULTS

DOCS = Path(__file__).parents[1]
PAGE = DOCS / "bench_tests.md"
SCENES = DOCS.parent / "mjcf_models" / "identification"
BEGIN, END = "<!-- recovered -->\n", "<!-- end -->\n"
# Standard deviations of readings that a workshop can reach [SI], and how they are told.
NOISE = {
    "press": ({"force": 0.1, "depth": 2e-7}, "0.1 N, 0.2 um"),
    "drop": ({"height": 5e-4}, "0.5 mm"),
    "tilt": ({"angle": math.radians(0.05), "acceleration": 0.03}, "0.05 degree, 0.03 m/s^2"),
    "pull": ({"force": 0.01}, "0.01 N"),
    "slip": ({"displacement": 2e-8, "force": 2e-3}, "20 nm, 2 mN"),
    "roll": ({"rate": 0.01}, "0.01 rad/s"),
    "spin": ({"rate": 0.1}, "0.1 rad/s"),
}
_MORE = {"spin": {"lever": 0.1 / 3.0}, "press": {"offset": 3e-4}}


def truth(test: str) -> dict[str, float]:
    """Numbers of the scene."""
    model = mujoco.MjModel.from_xml_path(str(SCENES / test / "scene.xml"))
    found = dict(_MORE.get(test, {}))
    for place in range(model.nnumeric):
        parts = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_NUMERIC, place).split("/")
        if len(parts) == 4 and parts[1] == "pair" and parts[3] in DEFAULTS:
            found[parts[3]] = float(model.numeric_data[model.numeric_adr[place]])
    return found


def noisy(sheet: Sheet, test: str) -> Sheet:
    """The sheet with noise."""
    random = np.random.default_rng(0)
    columns = dict(sheet.columns)
    for name, sigma in NOISE[test][0].items():
        columns[name] = columns[name] + sigma * random.standard_normal(len(columns[name]))
    return Sheet(sheet.test, sheet.source, columns, sheet.labels, sheet.constants)


def below(error: float) -> str:
    """The power of ten that an error is below."""
    power = max(math.ceil(math.log10(max(abs(error), 1e-12))), -5)
    return f"< {100.0 * 10.0**power:g} %"


def table() -> str:
    """Each parameter: of the scene, as read without noise, and its interval with noise."""
    lines = [
        "| test | parameter | of the scene | read without noise, off by | noise of the readings | "
        "95 % interval |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for test, (_, said) in NOISE.items():
        sheet = read_sheet(SCENES / test / "sheet.csv", LAYOUTS[test])
        plain, rough = ESTIMATORS[test](sheet), ESTIMATORS[test](noisy(sheet, test))
        for name, value in truth(test).items():
            if name not in plain.values or name in sheet.constants:
                continue
            if name.replace("_", " ") in sheet.constants:
                continue
            each = rough.values[name]
            half = 50.0 * (each.high - each.low) / abs(value)
            unit = "" if each.unit == "-" else f" {each.unit}"
            off = below(plain[name] / value - 1.0)
            lines.append(
                f"| [{test}](#{test}) | `{name}` | {value:.5g}{unit} | {off} | {said} | "
                f"+- {half:.2g} % |"
            )
    return "\n".join(lines) + "\n"


def render() -> str:
    """The page."""
    text = PAGE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    after = rest.split(END, 1)[1]
    return f"{before}{BEGIN}\n{table()}\n{END}{after}"


if __name__ == "__main__":
    PAGE.write_text(render(), encoding="utf-8")
