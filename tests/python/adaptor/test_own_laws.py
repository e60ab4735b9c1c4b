# SPDX-License-Identifier: Apache-2.0
"""Laws of a user's own: in Python, and in C++ by a project that stands outside of this one."""

from __future__ import annotations

import gc
import json
import math
import os
import re
import shutil
import subprocess
import sys
import weakref
from pathlib import Path
from typing import ClassVar

import mujoco
import numpy as np
import pytest
from scenes import over_floor

import volcontact as vc

ROOT = Path(__file__).parents[3]
BALL = vc.Pair(vc.Sphere(radius=0.05), vc.HalfSpace())


class LatchedSpring(vc.NormalLaw):
    """hunt_crossley once more: f = k V (1 + A v / v_i), v_i the speed at first touch."""

    name = "latched_spring"
    fields: ClassVar = {
        "stiffness": vc.LawField("N/m^3", 1e7, minimum=0.0, meaning="k_v"),
        "number": vc.LawField("-", 0.5, minimum=0.0, meaning="A = a v_i"),
    }
    states: ClassVar = {"impact_speed": vc.LawState("m/s", "value")}

    def evaluate(self, contact, state, elapsed):
        """f_n, and the impact speed kept."""
        speed = state["impact_speed"] or contact.approach_speed
        state["impact_speed"] = speed
        elastic = self.stiffness * contact.volume
        damping = self.number / speed
        return vc.NormalOutput(
            magnitude=elastic * max(0.0, 1.0 + damping * contact.approach_speed),
            elastic=elastic,
            elastic_energy=self.stiffness * contact.depth_moment,
            rolling_damping=self.stiffness * damping,
        )


class Spring(vc.FrictionLaw):
    """A tangential spring without a limit."""

    name = "spring"
    fields: ClassVar = {"stiffness": vc.LawField("N/m", 1e4, minimum=0.0)}
    states: ClassVar = {"deflection": vc.LawState("m", "vector")}

    def evaluate(self, contact, state, elapsed):
        """Force of the deflection, which follows the way."""
        deflection = state["deflection"] + contact.travel
        state["deflection"] = deflection
        force = -self.stiffness * deflection
        return vc.FrictionOutput(
            force=force,
            slide_energy=0.5 * self.stiffness * float(deflection @ deflection),
            slide_power=0.0,
        )


def at(height: float) -> np.ndarray:
    pose = np.eye(4)
    pose[2, 3] = height
    return pose


def bounce(normal: vc.NormalForce) -> list[float]:
    """Speeds of a ball of 1 kg that hits the floor with 1 m/s, by symplectic Euler steps."""
    model = vc.ContactModel(pairs=[BALL], normal=normal)
    height, speed, step, state = 0.0501, -1.0, 2e-5, None
    speeds = []
    for _ in range(400):
        report = model.evaluate(
            X_WA=at(height), V_WA=np.array([0, 0, 0, 0, 0, speed]), state=state, elapsed=step
        )
        state = report.state
        speed += step * report.force_on_A[2]
        height += step * speed
        speeds.append(speed)
    return speeds


def damping_number(restitution: float) -> float:
    """A of docs/theory.md, "Restitution": the root of ln((1 + A)/(1 - e A)) = A (1 + e)."""
    low, high = 1e-6, 1.0 / restitution - 1e-9
    for _ in range(200):
        middle = 0.5 * (low + high)
        share = math.log((1.0 + middle) / (1.0 - restitution * middle))
        low, high = (middle, high) if share < middle * (1.0 + restitution) else (low, middle)
    return low


def test_python_law_is_the_law_it_copies():
    mine = bounce(LatchedSpring(stiffness=1e9, number=damping_number(0.5)))
    theirs = bounce(vc.HuntCrossley(stiffness=1e9, restitution=0.5))
    assert mine[-1] == pytest.approx(0.5, abs=3e-3)
    assert mine == pytest.approx(theirs, rel=1e-6)


def test_python_friction_follows_the_way_of_its_site():
    model = vc.ContactModel(
        pairs=[BALL], normal=vc.VolumeSpring(stiffness=1e8), friction=Spring(stiffness=2e4)
    )
    report = model.evaluate(X_WA=at(0.049))
    assert (report.force_on_A[:2] == 0.0).all()
    moved = at(0.049)
    moved[:2, 3] = 3e-5, -4e-5
    report = model.evaluate(X_WA=moved, state=report.state, elapsed=1e-3)
    assert report.force_on_A[:2] == pytest.approx([-0.6, 0.8], rel=1e-9)
    assert report.sites[0].bristle_energy.slide == pytest.approx(0.5 * 2e4 * 25e-10, rel=1e-9)


def test_parameters_are_checked():
    assert LatchedSpring(number=2).number == 2.0
    assert LatchedSpring().stiffness == 1e7
    with pytest.raises(TypeError, match="latched_spring has no field 'damping'; it has stiffness"):
        LatchedSpring(damping=1.0)
    with pytest.raises(ValueError, match=r"stiffness = -1 \[N/m\^3\] is out of range"):
        LatchedSpring(stiffness=-1.0)
    with pytest.raises(ValueError, match="number = nan"):
        LatchedSpring(number=math.nan)


def test_what_a_law_raises_comes_out():
    class Broken(vc.NormalLaw):
        name = "broken"

        def evaluate(self, contact, state, elapsed):
            message = "no such luck"
            raise KeyError(message)

    model = vc.ContactModel(pairs=[BALL, BALL], normal=Broken())
    with pytest.raises(KeyError, match="no such luck"):
        model.evaluate(X_WA=at(0.049))
    assert not model.evaluate(X_WA=at(1.0)).touching


NORMAL = dict(magnitude=1.0, elastic=1.0, elastic_energy=0.0)
FRICTION = dict(force=np.zeros(3), slide_power=0.0)
# What evaluate returns, and what is said of it.
WRONG_RESULTS = {
    "nan": ({"magnitude": math.nan}, "mine: magnitude = nan [N]; evaluate must give finite"),
    "infinity": ({"elastic_energy": -math.inf}, "mine: elastic_energy = -inf [J]"),
    "rolling": ({"rolling_damping": math.inf}, "mine: rolling_damping = inf [N s/m^4]"),
    "nothing": (None, "mine: what evaluate returned is None; it must be a NormalOutput"),
    "a number": (9.81, "mine: what evaluate returned is a float; it must be a NormalOutput"),
    "the other": (vc.FrictionOutput(**FRICTION), "is a volcontact._volcontact.FrictionOutput; it"),
}


@pytest.mark.parametrize("wrong", WRONG_RESULTS)
def test_a_normal_law_that_gives_no_numbers_is_named(wrong):
    result, message = WRONG_RESULTS[wrong]

    class Mine(vc.NormalLaw):
        name = "mine"

        def evaluate(self, contact, state, elapsed):
            return vc.NormalOutput(**(NORMAL | result)) if isinstance(result, dict) else result

    model = vc.ContactModel(pairs=[BALL], normal=Mine())
    with pytest.raises((TypeError, ValueError), match=re.escape(message)):
        model.evaluate(X_WA=at(0.049))


@pytest.mark.parametrize(
    ("result", "message"),
    [
        ({"force": np.array([0.0, math.nan, 0.0])}, "mine: force[1] = nan [N]"),
        ({"torque": math.inf}, "mine: torque = inf [N m]"),
        ({"slide_power": math.nan}, "mine: slide_power = nan [W]"),
        ({"spin_energy": -math.inf}, "mine: spin_energy = -inf [J]"),
        (None, "mine: what evaluate returned is None; it must be a FrictionOutput"),
    ],
)
def test_a_friction_law_that_gives_no_numbers_is_named(result, message):
    class Mine(vc.FrictionLaw):
        name = "mine"

        def evaluate(self, contact, state, elapsed):
            return vc.FrictionOutput(**(FRICTION | result)) if result else None

    model = vc.ContactModel(pairs=[BALL], normal=vc.VolumeSpring(), friction=Mine())
    with pytest.raises((TypeError, ValueError), match=re.escape(message)):
        model.evaluate(X_WA=at(0.049))


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (math.nan, "mine: state 'way' = nan [m]"),
        ("far", "mine: state 'way' is a str; it must be a number"),
        (None, "mine: state 'way' is None; it must be a number"),
    ],
)
def test_a_state_that_is_no_number_is_named(value, message):
    class Mine(vc.NormalLaw):
        name = "mine"
        states: ClassVar = {"way": vc.LawState("m")}

        def evaluate(self, contact, state, elapsed):
            state["way"] = value
            return vc.NormalOutput(**NORMAL)

    model = vc.ContactModel(pairs=[BALL], normal=Mine())
    with pytest.raises((TypeError, ValueError), match=re.escape(message)):
        model.evaluate(X_WA=at(0.049))


def test_a_state_of_another_name_is_told():
    class Mine(vc.NormalLaw):
        name = "mine"
        states: ClassVar = {"way": vc.LawState("m")}

        def evaluate(self, contact, state, elapsed):
            state["weight"] = state.pop("way")
            return vc.NormalOutput(**NORMAL)

    with pytest.raises(ValueError, match="mine: state 'way' is missing"):
        vc.ContactModel(pairs=[BALL], normal=Mine()).evaluate(X_WA=at(0.049))


def test_model_keeps_its_law_and_lets_go_of_it():
    law = LatchedSpring()
    alive = weakref.ref(law)
    model = vc.ContactModel(pairs=[BALL], normal=law)
    del law
    gc.collect()
    assert model.evaluate(X_WA=at(0.049), V_WA=np.array([0, 0, 0, 0, 0, -1.0])).touching
    del model
    gc.collect()
    assert alive() is None


def test_laws_are_made_by_name():
    law = vc.make_normal("hunt_crossley", stiffness=2e8, damping=0.5)
    assert (law.stiffness, law.damping) == (2e8, 0.5)
    assert vc.make_friction("bristle", friction=0.2, static_friction=0.3, coupling="none").coupling
    with pytest.raises(ValueError, match="did you mean 'bristle'"):
        vc.make_friction("bristles")


# A user's project, built as a user builds it against the build tree of this checkout.


def crushable(yield_speed: float) -> str:
    """A ball that hits a floor at 1 m/s under the project's law."""
    return over_floor(
        'size="0.05"',
        height=0.0501,
        step=1e-5,
        speed=1.0,
        normal_law__crushable=1,
        stiffness=1e9,
        loss=1.0,
        yield_speed=yield_speed,
        friction=0.0,
    )


PROGRAM = """
import sys
import mujoco
import volcontact as vc
model = vc.load(sys.argv[1])
data = mujoco.MjData(model)
mujoco.mj_resetDataKeyframe(model, data, 0)
with vc.attach(model) as contact:
    mujoco.mj_step(model, data, 2000)
    energy = contact.energy(data)
    print(data.qvel[2], energy.dissipated, energy.elastic)
"""


@pytest.fixture(scope="module")
def own_plugin(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The plugin of the project in tests/own_law."""
    tree = ROOT / "build" / f"mujoco-{mujoco.__version__}"
    tools = ROOT / ".venv" / "tools" / "bin"
    cmake = shutil.which("cmake", path=f"{tools}{os.pathsep}{os.environ['PATH']}")
    if cmake is None or not (tree / "volcontactConfig.cmake").is_file():
        pytest.skip("needs the build tree of ./run, and CMake")
    out = tmp_path_factory.mktemp("own_law")
    configure = [cmake, "-S", str(ROOT / "tests" / "own_law"), "-B", str(out)]
    configure += ["-G", "Unix Makefiles", f"-Dvolcontact_DIR={tree}", "-DCMAKE_BUILD_TYPE=Release"]
    for command in (configure, [cmake, "--build", str(out)]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    return out / "libown_contact.so"


# The law springs back with f = k V (V / V_max). V of a shallow cap goes with h^2, so the way back
# gives int h^4 / h_max^2 of int h^2, which is 3/5, unless the impact was too slow.
@pytest.mark.parametrize(("yield_speed", "speed"), [(0.0, math.sqrt(0.6)), (2.0, 1.0)])
def test_own_law_in_a_scene(own_plugin: Path, yield_speed: float, speed: float):
    environment = {**os.environ, "VOLCONTACT_ADAPTOR": str(own_plugin)}
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM, crushable(yield_speed)],
        capture_output=True,
        text=True,
        check=False,
        env=environment,
    )
    assert run.returncode == 0, run.stderr
    out, dissipated, elastic = (float(word) for word in run.stdout.split())
    assert out == pytest.approx(speed, rel=5e-3)
    assert elastic == 0.0
    assert dissipated == pytest.approx(0.5 * (1.0 - out**2), abs=1e-3)


SPRINGS = """
<mujoco><option timestep="0.002" gravity="1 0 -9.81"/>
  <size nuserdata="400"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body pos="0 0 .0499"><freejoint/>
      <geom name="box" type="box" size=".05 .05 .05" mass="1"/></body>
  </worldbody>
  <custom>
    <tuple name="volcontact/material/soft">
      <element objtype="geom" objname="floor"/>
    </tuple>
    <tuple name="volcontact/material/hard">
      <element objtype="geom" objname="box"/>
    </tuple>
    <numeric name="volcontact/material/soft/friction_law/springs" data="1"/>
    <numeric name="volcontact/material/soft/shear_stiffness" data="1e7"/>
    <numeric name="volcontact/material/hard/shear_stiffness" data="3e7"/>
  </custom>
</mujoco>"""
REST = """
import json, sys
import mujoco
import volcontact as vc
model = vc.load(sys.argv[1])
data = mujoco.MjData(model)
with vc.attach(model) as contact:
    (pair,) = contact.description["pairs"]
    mujoco.mj_step(model, data, 1000)
    before = data.qpos.copy()
    mujoco.mj_step(model, data, 500)
    print(json.dumps([pair, data.qvel.tolist(), (data.qpos - before).tolist()]))
"""


# h^2 k/m = 30: explicit steps would shake the box. Its law has no name in common with the bristles.
def test_own_friction_too_stiff_for_explicit_steps_is_implicit(own_plugin: Path):
    run = subprocess.run(
        [sys.executable, "-c", REST, SPRINGS],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "VOLCONTACT_ADAPTOR": str(own_plugin)},
    )
    assert run.returncode == 0, run.stderr
    pair, speeds, moved = json.loads(run.stdout)
    assert pair["implicit"] == "always, for its friction"
    assert pair["shear_stiffness"] == pytest.approx(7.5e6)
    assert np.abs(speeds).max() < 1e-6
    assert np.abs(moved).max() < 1e-9


def test_scene_without_the_own_plugin_names_the_laws_there_are():
    with pytest.raises(ValueError, match="one of hunt_crossley, volume_spring"):
        vc.load(crushable(0.0))
