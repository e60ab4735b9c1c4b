# SPDX-License-Identifier: Apache-2.0
"""Bodies on a floor of flush boxes: closed forms of one floor."""

from __future__ import annotations

import mujoco
import pytest
from case import GRAVITY, Case, Figure, Run, depth_of_ball, load, simulate

RADIUS, TILE = 0.05, 0.1  # [m]


def tiles(columns: int, rows: int) -> str:
    """Boxes side by side about the origin, their faces up at z = 0."""
    places = [
        (TILE * (i - (columns - 1) / 2), TILE * (j - (rows - 1) / 2))
        for i in range(columns)
        for j in range(rows)
    ]
    return "".join(
        f'<geom type="box" size="{TILE / 2} {TILE / 2} 0.02" pos="{x!r} {y!r} -0.02"/>'
        for x, y in places
    )


def scene(floor: str, body: str, step: float, gravity: float = 0.0, **keys: float) -> str:
    """MJCF text of a body over a floor, with keys of their pair, `__` for `/`."""
    numbers = "".join(
        f'<numeric name="volcontact/pair/p/{key.replace("__", "/")}" data="{value!r}"/>'
        for key, value in keys.items()
    )
    return f"""
<mujoco>
  <option timestep="{step!r}" integrator="RK4" gravity="0 0 {-gravity!r}"/>
  <default><geom friction="{keys["friction"]!r} 0.005 0.0001"/></default>
  <worldbody>{floor}<body name="body" {body}</body></worldbody>
  <custom>{numbers}
    <tuple name="volcontact/pair/p">
      <element objtype="body" objname="world"/><element objtype="body" objname="body"/>
    </tuple>
  </custom>
</mujoco>"""


def thrown(text: str, duration: float, velocity: list[float], *, native: bool = False) -> Run:
    """A run from a velocity [m/s, rad/s]; rows of place and velocity."""

    def throw(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        data.qvel[:] = velocity

    def watch(_: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, ...]:
        return (*data.qpos, *data.qvel)

    return simulate(load(text), duration, watch, every=50, setup=throw, native=native)


def rebound(place: str, case: Case, *, native: bool = False, **keys: float) -> tuple[float, float]:
    """Speed up and speed aside of a ball that hits tiles at 1 m/s, after it [m/s]."""
    ball = f'pos="{place} {RADIUS + 1e-6!r}"><freejoint/><geom size="{RADIUS}" mass="1"/>'
    text = scene(tiles(2, 2), ball, 1e-5, friction=0.0, stiffness=1e9, **keys)
    run = thrown(text, 0.02, [0, 0, -1, 0, 0, 0], native=native)
    if not native:
        case.account(run)
    last = run.rows[-1]
    return float(last[10]), float((last[8] ** 2 + last[9] ** 2) ** 0.5)


def slide(case: Case, *, native: bool = False) -> tuple[float, float]:
    """How far a flat block slides over tiles, aslant, and how far it turned [m, rad]."""
    mass, stiffness, area = 1.0, 1e9, 0.06**2
    height = 0.005 - mass * GRAVITY / (stiffness * area)
    block = (
        f'pos="-0.23 -0.01 {height!r}"><freejoint/>'
        f'<geom type="box" size="0.03 0.03 0.005" mass="{mass}"/>'
    )
    text = scene(tiles(8, 4), block, 5e-5, GRAVITY, friction=0.3, stiffness=stiffness, damping=5.0)
    run = thrown(text, 0.6, [1.2, 0.1, 0, 0, 0, 0], native=native)
    if not native:
        case.account(run)
    way = run.rows[-1, 1:3] - run.rows[0, 1:3]
    return float((way @ way) ** 0.5), 2.0 * float(run.rows[-1, 7])


def roll(case: Case, *, native: bool = False) -> tuple[float, float]:
    """Speed of a ball that rolls over seams, and its way aside [m/s, m]."""
    stiffness = 1e10
    depth = depth_of_ball(GRAVITY, RADIUS, stiffness)
    ball = f'pos="-0.25 0.003 {RADIUS - depth!r}"><freejoint/><geom size="{RADIUS}" mass="1"/>'
    text = scene(tiles(8, 4), ball, 5e-5, GRAVITY, friction=0.3, stiffness=stiffness, damping=0.0)
    speed = 0.5
    run = thrown(text, 1.0, [speed, 0, 0, 0, speed / RADIUS, 0], native=native)
    if not native:
        case.account(run)
    return float(run.rows[-1, 8]), float(run.rows[-1, 2]) - 0.003


def measure() -> Case:
    """Impacts on seams, and motion over them."""
    case = Case(
        "Flush solids",
        "A floor of adjacent boxes acts as one solid: a ball that hits a seam, or the corner of "
        "four tiles, leaves as from one floor, straight up without friction; a block slides as far "
        "as Coulomb friction allows, v0^2/(2 mu g), and does not turn; a rolling ball keeps "
        "rolling.",
    )
    for place, where in (("0 0.03", "a seam"), ("0 0", "a corner"), ("0.001 0.002", "by a corner")):
        for asked in (0.8, 1.0):
            # One of the two: none at all is a restitution of 1.
            keys = {"restitution": asked} if asked < 1.0 else {"damping": 0.0}
            up, aside = rebound(place, case, **keys)
            native = rebound(place, case, native=True, **keys)
            name = f"{where}, e = {asked:g}: "
            case.figures.append(Figure(name + "speed up", "m/s", asked, 1e-4, up, native[0]))
            case.figures.append(Figure(name + "aside", "m/s", 0.0, 1e-9, aside, native[1]))
    way, turn = slide(case)
    native_way, native_turn = slide(case, native=True)
    expected = (1.2**2 + 0.1**2) / (2 * 0.3 * GRAVITY)
    case.figures.append(Figure("block: way", "m", expected, 1e-4, way, native_way))
    case.figures.append(Figure("block: turn", "rad", 0.0, 1e-9, turn, native_turn))
    speed, aside = roll(case)
    native_speed, native_aside = roll(case, native=True)
    case.figures.append(Figure("ball that rolls: speed", "m/s", 0.5, 1e-3, speed, native_speed))
    case.figures.append(Figure("ball that rolls: aside", "m", 0.0, 1e-9, aside, native_aside))
    return case


@pytest.mark.once
def test_flush_solids() -> None:
    measure().check()
