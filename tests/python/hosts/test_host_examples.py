# SPDX-License-Identifier: Apache-2.0
"""python/examples/hosts: other simulators, against closed forms and MuJoCo's run."""

import re
import runpy
from pathlib import Path

import mujoco
import numpy as np
import pytest

import volcontact as vc

integrate = pytest.importorskip("scipy.integrate", reason="scipy is missing")
optimize = pytest.importorskip("scipy.optimize", reason="scipy is missing")

HOSTS = Path(__file__).parents[3] / "python" / "examples" / "hosts"
RADIUS, GRAVITY, STIFFNESS, FRICTION = 0.05, 9.81, 1e8, 0.3

SCENE = """
<mujoco model="ball">
  <option timestep="2e-5" integrator="RK4" gravity="0 0 -9.81"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="ball" pos="0 0 0.1">
      <freejoint/>
      <geom name="ball" type="sphere" size="0.05" mass="1"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/ball/stiffness" data="1e8"/>
    <numeric name="volcontact/pair/ball/damping" data="0"/>
    <numeric name="volcontact/pair/ball/friction" data="0"/>
    <tuple name="volcontact/pair/ball">
      <element objtype="geom" objname="ball"/>
      <element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>
"""


@pytest.fixture(scope="module")
def example():
    return runpy.run_path(str(HOSTS / "scipy_ball.py"))


@pytest.fixture
def printed(example, capsys):
    """The numbers of the two lines the example prints."""
    example["main"]()
    lines = capsys.readouterr().out.splitlines()
    return [[float(n) for n in re.findall(r"-?\d+\.\d+(?:e[+-]\d+)?", line)] for line in lines]


def cap_energy(depth):
    """Of a spring k V, V = pi h^2 (R - h/3)."""
    return STIFFNESS * np.pi * (RADIUS * depth**3 / 3 - depth**4 / 12)


def test_bounce_is_that_of_its_energy(printed):
    fall, lasts, missed = printed[0]
    drop = 0.1 - RADIUS
    assert fall == pytest.approx(np.sqrt(2 * drop / GRAVITY), rel=1e-8)

    def squared(depth):  # half the square of the speed, by the energy
        return GRAVITY * (drop + depth) - cap_energy(depth)

    deepest = optimize.brentq(squared, 1e-4, 0.02)
    # depth = deepest (1 - s^2) takes the root out of the end of the integral.
    there, _ = integrate.quad(
        lambda s: 2 * s * deepest / np.sqrt(2 * squared(deepest * (1 - s * s))), 0, 1
    )
    assert lasts == pytest.approx(2 * there, rel=1e-6)
    assert abs(missed) < 1e-7


def test_skid_ends_when_the_closed_form_says(printed):
    time, speed, missed = printed[1]
    depth = min(
        (h.real for h in np.roots([-1 / 3, RADIUS, 0, -GRAVITY / (STIFFNESS * np.pi)]) if h > 0),
    )
    arm = 0.75 * (2 * RADIUS - depth) ** 2 / (3 * RADIUS - depth)  # centroid of the cap
    slows = FRICTION * GRAVITY * (1 + arm**2 / (0.4 * RADIUS**2))
    assert time == pytest.approx((1 - 1e-2) / slows, rel=1e-3)
    assert speed == pytest.approx(1 - FRICTION * GRAVITY * time, rel=1e-3)
    assert abs(missed) < 1e-7


def test_bounce_is_that_of_mujoco(printed):
    fall, lasts, _ = printed[0]
    model = vc.load(SCENE)
    data = mujoco.MjData(model)
    crossings, before = [], 0.05
    with vc.attach(model):
        while data.time < 0.13:
            mujoco.mj_step(model, data)
            gap = data.qpos[2] - RADIUS
            if gap * before < 0:  # between two steps: a straight line
                crossings.append(data.time - model.opt.timestep * gap / (gap - before))
            before = gap
    # The second order of the line over one step is below 1e-9 s; RK4 is rough only at touch.
    assert crossings == pytest.approx([fall, fall + lasts], abs=1e-7)
