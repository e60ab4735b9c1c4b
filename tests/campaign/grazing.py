# SPDX-License-Identifier: Apache-2.0
"""A light, fast solid is first seen deep in a heavy one, beside its way."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator
from typing import Any

import mujoco
from box_on_plane import is_sound, worst_energy

__all__ = ["COLUMNS", "KEYS", "NAME", "WORST", "cases", "examine", "is_sound"]

WORST = "motion"
NAME = "grazing"
KEYS = (
    *("light", "heavy", "ratio_of_masses", "friction", "stiffness", "damping", "timestep"),
    *("speed", "depth"),
)
COLUMNS = (*KEYS, "energy", "motion", "ratio", "step", "speed_after", "warnings", "refused")

# Half height h: both are as high as wide, the light one a fifth of the heavy one.
SOLIDS = {
    "box": lambda h: f'type="box" size="{h} {h} {h}"',
    "sphere": lambda h: f'type="sphere" size="{h}"',
    "ellipsoid": lambda h: f'type="ellipsoid" size="{1.2 * h} {0.8 * h} {h}"',
    "capsule": lambda h: f'type="capsule" size="{0.6 * h} {0.4 * h}"',
    "cylinder": lambda h: f'type="cylinder" size="{0.8 * h} {h}"',
}
HEAVY_HALF, LIGHT_HALF = 0.1, 0.02  # [m]
LIGHT = 0.01  # [kg]
PAIRS = [("box", heavy) for heavy in SOLIDS] + [
    (light, "box") for light in SOLIDS if light != "box"
]
RATIOS = (1.0, 1e2, 1e3, 1e4, 1e6)
FRICTIONS = (0.0, 0.5)
STIFFNESSES = (1e8, 1e9, 1e10)  # [N/m^3]
DAMPINGS = (0.0, 1.0)  # [s/m]
STEPS = (1e-3, 2e-3, 5e-3)  # [s]
SPEEDS = (2.0, 10.0)  # [m/s]
DEPTHS = (1e-3, 1e-2)  # of the edge that is swept over [m]

SCENE = """
<mujoco>
  <option timestep="{timestep}" gravity="0 0 0"><flag energy="enable"/></option>
  <worldbody>
    <body><joint type="slide" axis="0 0 1"/><geom {heavy} mass="{heavy_mass}"/></body>
    <body pos="{x} 0 {z}">
      <joint type="slide" axis="1 0 0"/><geom {light} mass="{light_mass}"/>
    </body>
  </worldbody>
</mujoco>"""


def cases(sample: int = 1) -> Iterator[dict[str, Any]]:
    """Every cell of the grid, or one in `sample`, drawn at random."""
    draw = random.Random(0)
    grid = itertools.product(PAIRS, RATIOS, FRICTIONS, STIFFNESSES, DAMPINGS, STEPS, SPEEDS, DEPTHS)
    for pair, *cell in grid:
        if draw.random() < 1.0 / sample:
            yield dict(zip(KEYS, (*pair, *cell), strict=True))


def examine(case: dict[str, Any]) -> dict[str, Any]:
    """The row of a cell."""
    heavy, light = SOLIDS[case["heavy"]], SOLIDS[case["light"]]
    model = mujoco.MjModel.from_xml_string(
        SCENE.format(
            timestep=case["timestep"],
            heavy=heavy(HEAVY_HALF),
            light=light(LIGHT_HALF),
            heavy_mass=LIGHT * case["ratio_of_masses"],
            light_mass=LIGHT,
            x=-1.2 * (HEAVY_HALF + LIGHT_HALF) - 1e-4,
            z=HEAVY_HALF + LIGHT_HALF - case["depth"],
        )
    )
    material = {name: case[name] for name in ("stiffness", "damping", "friction")}
    steps = 20 + round(0.4 / (case["speed"] * case["timestep"]))
    return case | worst_energy(model, material, {}, steps, {1: case["speed"]}, 0.0)
