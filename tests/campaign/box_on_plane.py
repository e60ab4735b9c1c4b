# SPDX-License-Identifier: Apache-2.0
"""A box falls flat on a plane: speed x damping x stiffness x step, without and with gravity."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np

import volcontact as vc
from volcontact._mujoco_views import dense

WORST = "motion"
NAME = "box_on_plane"
KEYS = ("speed", "damping", "stiffness", "timestep", "gravity", "implicit")
COLUMNS = (*KEYS, "energy", "motion", "ratio", "step", "speed_after", "warnings", "refused")

SPEEDS = (0.1, 1.0, 3.0, 10.0, 30.0)  # [m/s]
DAMPINGS = (0.0, 0.1, 1.0, 3.0, 10.0)  # a [s/m]
STIFFNESSES = (1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12)  # k_v [N/m^3]
STEPS = (2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2)  # [s]
GRAVITIES = (0.0, 9.81)
IMPLICIT = ("auto",)
MASS, HALF, GAP = 2.0, 0.1, 1e-4  # [kg], [m], [m]

SCENE = """
<mujoco>
  <option timestep="{timestep}" gravity="0 0 {gravity}"><flag energy="enable"/></option>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body pos="0 0 {height}">
      <freejoint/><geom type="box" size="{half} {half} {half}" mass="{mass}"/>
    </body>
  </worldbody>
</mujoco>"""


def cases(sample: int = 1) -> Iterator[dict[str, Any]]:
    """Every cell of the grid, or one in `sample`, drawn at random."""
    draw = random.Random(0)
    grid = itertools.product(SPEEDS, DAMPINGS, STIFFNESSES, STEPS, GRAVITIES, IMPLICIT)
    for cell in grid:
        if draw.random() < 1.0 / sample:
            yield dict(zip(KEYS, cell, strict=True))


def examine(case: dict[str, Any]) -> dict[str, Any]:
    """The row of a cell."""
    model = mujoco.MjModel.from_xml_string(
        SCENE.format(
            timestep=case["timestep"],
            gravity=-case["gravity"],
            height=HALF + GAP,
            half=HALF,
            mass=MASS,
        )
    )
    material = {name: case[name] for name in ("stiffness", "damping")}
    options = {"implicit": case["implicit"]}
    # As long as a box takes that comes down again, or a hundred steps.
    steps = max(100, round(min(0.3, 4.0 * case["speed"] / 9.81) / case["timestep"]))
    return case | worst_energy(
        model, material, options, steps, {2: -case["speed"]}, MASS * case["gravity"] * HALF
    )


def worst_energy(
    model: mujoco.MjModel,
    material: dict[str, float],
    options: dict[str, Any],
    steps: int,
    speeds: dict[int, float],
    level: float,
) -> dict[str, Any]:
    """Steps from given speeds; potential energy counts from `level` [J].

    `motion` is the largest kinetic and potential energy after the start, by that at the start;
    `ratio` is the same with the elastic energy of the contacts, `step` when it was. A solid that
    is first seen deep in another one has elastic energy that no work has stored: then the second
    is larger than the first.
    """

    def energy() -> float:
        # The velocities of Euler's steps lag half a step behind the positions. With both at the
        # same time free flight keeps its energy to the last digit.
        mujoco.mj_subtreeVel(model, data)
        momentum = model.body_subtreemass[0] * data.subtree_linvel[0]
        lag = 0.5 * model.opt.timestep * float(model.opt.gravity @ momentum)
        return float(dense(data.energy).sum()) + lag - level

    data = mujoco.MjData(model)
    for dof, speed in speeds.items():
        data.qvel[dof] = speed
    row: dict[str, Any] = {"motion": 0.0, "ratio": 0.0, "step": 0}
    try:
        contact = vc.attach(model, material=material, options=options)
    except ValueError as error:
        return row | {"refused": str(error)}
    with contact:
        mujoco.mj_forward(model, data)
        start = energy()
        row["energy"] = start
        for step in range(1, steps + 1):
            mujoco.mj_step(model, data)
            # The energies of a step are those at its beginning; here are those at its end.
            mujoco.mj_forward(model, data)
            motion = energy() / start
            ratio = motion + contact.energy(data).elastic / start
            if not np.isfinite(ratio):
                return row | {"motion": float("inf"), "ratio": float("inf"), "step": step}
            row["motion"] = max(row["motion"], motion)
            if ratio > row["ratio"]:
                row |= {"ratio": ratio, "step": step}
        row["speed_after"] = float(np.abs(data.qvel).max())
        row["warnings"] = int(sum(warning.number for warning in data.warning))
    return row


def is_sound(row: dict[str, Any]) -> bool:
    """Contact makes no energy, and the simulation goes on."""
    if row.get("refused"):
        return True  # said in words
    return float(row["motion"]) <= 1.001 and int(row.get("warnings") or 0) == 0
