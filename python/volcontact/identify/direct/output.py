# SPDX-License-Identifier: Apache-2.0
"""Files of a bench test: identified.json, identified.xml and report.html."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from volcontact._files import appearing
from volcontact.identify.readings import Curve, Reading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

RESULT, SCENE, REPORT = "identified.json", "identified.xml", "report.html"
_PAGE = Path(__file__).with_name("bench.html.jinja")
_SHOWN = 24  # curves of a report

# A ball on a plate, for the lines to stand in: it loads as it is.
_MODEL = """\
<!-- Bench test {name}, read by volcontact. Copy the lines below <custom> into your scene, and list
  your own two geoms in the tuple. -->
<mujoco model="identified">
  <option timestep="1e-4"/>
  <worldbody>
    <geom name="plate" type="plane" size="1 1 0.1" friction="{friction} 0.005 0.0001"/>
    <body name="part" pos="0 0 0.05">
      <freejoint/>
      <geom name="part" type="sphere" size="0.05" mass="1" friction="{friction} 0.005 0.0001"/>
    </body>
  </worldbody>
  <custom>
    {lines}
    <tuple name="volcontact/pair/identified">
      <element objtype="geom" objname="part"/>
      <element objtype="geom" objname="plate"/>
    </tuple>
  </custom>
</mujoco>
"""


def scene_of(found: Reading) -> str:
    """A small scene with the values, which loads as it is."""
    lines = found.mjcf("identified").replace("\n", "\n    ")
    values = found.parameters()
    friction = values.get("friction", values.get("static_friction", 0.3))
    return _MODEL.format(name=found.name, lines=lines, friction=f"{friction:.6g}")


def write(found: Reading, out: Path, *, report: bool = True) -> None:
    """Writes the files into a folder, made when missing.

    Raises:
        OSError: a file cannot be written.
    """
    out.mkdir(parents=True, exist_ok=True)
    with appearing(out / RESULT) as made:
        made.write_text(json.dumps(found.as_dict(), indent=2) + "\n", encoding="utf-8")
    with appearing(out / SCENE) as made:
        made.write_text(scene_of(found), encoding="utf-8")
    if report:
        _write_report(found, out / REPORT)


def _write_report(found: Reading, file: Path) -> None:
    import jinja2
    from markupsafe import Markup

    from volcontact.report.svg import standing_alone

    figures = []
    for curve in found.curves[:_SHOWN]:
        text = standing_alone(_figure(curve))
        figures.append(Markup(text[text.index("<svg") :]))
    page = jinja2.Environment(autoescape=True).from_string(_PAGE.read_text(encoding="utf-8"))
    text = page.render(
        found=found,
        level=f"{100 * found.level:g} %",
        rows=[row_of(name, found) for name in found.values],
        figures=figures,
        mjcf=found.mjcf(),
    )
    with appearing(file) as made:
        made.write_text(text, encoding="utf-8")


def row_of(name: str, found: Reading) -> list[str]:
    """Name, value, interval and unit of a quantity, as they are printed."""
    each = found.values[name]
    known = f"{each.low:.6g} to {each.high:.6g}" if each.low == each.low else ""
    unit = "" if each.unit == "-" else each.unit
    return [name, f"{each.value:.6g}", known, unit, "" if each.told else "not told by the data"]


def _figure(curve: Curve) -> Figure:
    from matplotlib.figure import Figure

    from volcontact.report.palette import NATIVE, VOLUMETRIC

    figure = Figure(figsize=(7, 3.2), layout="constrained")
    axes = figure.subplots()
    axes.plot(curve.line_x, curve.line_y, color=VOLUMETRIC, lw=1.3, label="law")
    axes.plot(curve.x, curve.y, ".", color=NATIVE, ms=5, label="measured")
    axes.set_title(curve.title, fontsize="medium")
    axes.set_xlabel(curve.x_label)
    axes.set_ylabel(curve.y_label)
    axes.legend(frameon=False)
    return figure
