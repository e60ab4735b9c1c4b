# SPDX-License-Identifier: Apache-2.0
"""Random scenes: trees of bodies, all joints, limits, equalities, tendons, actuators, integrators.

The account of contact is audited step by step: what its forces gave to the motion and what it then
held in elastic energy may not be more than what it held before.

MuJoCo warns of steps that it cannot do. It counts against contact unless it does so with its own
contacts, too, or without any: springs that are too stiff for the step stay still until something
moves them, and native contact may touch nothing that hangs on them. The latter is tried, from the
last state in which nothing was much faster than with native contact, and holds only where contact
has given nothing to the motion in all until then.
"""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np

import volcontact as vc
from volcontact._mujoco_views import dense

WORST = "gain"
NAME = "generated_scenes"
KEYS = ("seed",)
COLUMNS = (
    *(*KEYS, "integrator", "timestep", "stiffness", "dofs", "geoms", "parts"),
    *("gain", "step", "numerical", "energy", "speed", "native_speed"),
    *("warnings", "native_warnings", "alone", "dropped", "refused"),
)
SCENES = 10_000
STEPS = 150
MOST_TURN = 1.0  # [rad] or [m] in a step: with native contact, too, the scene is lost
INTEGRATORS = ("Euler", "implicit", "implicitfast", "discrete", "RK4")


def cases(sample: int = 1) -> Iterator[dict[str, Any]]:
    """The numbers of the scenes."""
    for seed in range(0, SCENES, sample):
        yield {"seed": seed}


class Scene:
    """A scene as MJCF text, from its number."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        r = self.random
        integrators = [i for i in INTEGRATORS if hasattr(mujoco.mjtIntegrator, _constant(i))]
        self.integrator = r.choice(integrators)
        self.timestep = r.choice((2e-4, 5e-4, 1e-3, 2e-3, 5e-3))
        self.stiffness = 10.0 ** r.uniform(5.0, 11.0)
        self.damping = r.choice((0.0, 0.1, 1.0, 5.0))
        self.friction = r.choice((0.0, 0.3, 1.0))
        self.numbers = itertools.count()
        self.parts: list[str] = []
        self.joints: list[str] = []
        self.bodies: list[str] = []
        tops = "".join(self._body(0, self._place()) for _ in range(r.randint(1, 4)))
        ground = '<geom type="plane" size="3 3 1"/>'
        if r.random() < 0.3:
            ground += '<geom type="box" size=".1 .4 .1" pos=".2 0 .1"/>'
        self.text = f"""
<mujoco>
  <option timestep="{self.timestep}" integrator="{self.integrator}"><flag energy="enable"/></option>
  <default><geom friction="{self.friction}" density="{r.choice((300, 1000, 5000))}"/></default>
  <worldbody>{ground}{tops}</worldbody>
  {self._tendons()}{self._equalities()}{self._actuators()}
</mujoco>"""

    def _place(self) -> str:
        r = self.random
        return f"{r.uniform(-0.4, 0.4):.4f} {r.uniform(-0.4, 0.4):.4f} {r.uniform(0.1, 0.5):.4f}"

    def _axis(self) -> str:
        return " ".join(f"{self.random.gauss(0.0, 1.0):.3f}" for _ in range(3))

    def _geom(self) -> str:
        r = self.random
        size = [f"{r.uniform(0.03, 0.12):.4f}" for _ in range(3)]
        kind = r.choice(("box", "sphere", "capsule", "cylinder", "ellipsoid"))
        count = {"sphere": 1, "capsule": 2, "cylinder": 2}.get(kind, 3)
        return f'<geom type="{kind}" size="{" ".join(size[:count])}"/>'

    def _joint(self, depth: int) -> str:
        r = self.random
        if depth == 0 and r.random() < 0.6:
            return "<freejoint/>"
        kind = r.choice(("hinge", "slide", "ball") if depth else ("hinge", "slide"))
        name = f"joint{next(self.numbers)}"
        extra = ""
        if kind != "ball":
            self.joints.append(name)
            extra = f' axis="{self._axis()}"'
            if r.random() < 0.4:
                self._note("limit")
                far = 0.3 if kind == "slide" else 1.0
                extra += f' limited="true" range="{-far} {far}"'
        if r.random() < 0.3:
            self._note("spring")
            extra += f' stiffness="{10 ** r.uniform(0, 3):.1f}"'
        if r.random() < 0.5:
            extra += f' damping="{10 ** r.uniform(-3, 1):.4f}"'
        if r.random() < 0.3:
            extra += f' armature="{10 ** r.uniform(-4, -1):.5f}"'
        if kind != "ball" and r.random() < 0.2:
            self._note("frictionloss")
            extra += f' frictionloss="{r.uniform(0.01, 1.0):.3f}"'
        return f'<joint name="{name}" type="{kind}"{extra}/>'

    def _body(self, depth: int, place: str) -> str:
        r = self.random
        name = f"body{len(self.bodies)}"
        self.bodies.append(name)
        inner = self._joint(depth) + self._geom()
        for _ in range(r.choice((0, 0, 1, 2)) if depth < 3 else 0):
            here = " ".join(f"{r.choice((-1, 1)) * r.uniform(0.12, 0.25):.4f}" for _ in range(3))
            inner += self._body(depth + 1, here)
        return f'<body name="{name}" pos="{place}">{inner}</body>'

    def _note(self, part: str) -> None:
        if part not in self.parts:
            self.parts.append(part)

    def _tendons(self) -> str:
        r = self.random
        self.tendons = 0
        if len(self.joints) < 2 or r.random() > 0.3:
            return ""
        self._note("tendon")
        self.tendons = 1
        legs = "".join(
            f'<joint joint="{name}" coef="{r.uniform(-1, 1):.3f}"/>'
            for name in r.sample(self.joints, 2)
        )
        extra = r.choice(('stiffness="50"', 'damping="1"', 'limited="true" range="-.3 .3"', ""))
        return f'<tendon><fixed name="tendon" {extra}>{legs}</fixed></tendon>'

    def _equalities(self) -> str:
        r = self.random
        text = ""
        if len(self.joints) > 1 and r.random() < 0.2:
            self._note("equality")
            one, two = r.sample(self.joints, 2)
            text += (
                f'<joint joint1="{one}" joint2="{two}" polycoef="0 {r.uniform(-1, 1):.3f} 0 0 0"/>'
            )
        if len(self.bodies) > 1 and r.random() < 0.2:
            self._note("weld")
            one, two = r.sample(self.bodies, 2)
            kind = r.choice(("connect", "weld"))
            anchor = ' anchor="0 0 0"' if kind == "connect" else ""
            text += f'<{kind} body1="{one}" body2="{two}"{anchor}/>'
        return f"<equality>{text}</equality>" if text else ""

    def _actuators(self) -> str:
        r = self.random
        text = ""
        for name in self.joints:
            if r.random() > 0.4:
                continue
            kind = r.choice(("motor", "position", "velocity"))
            self._note(kind)
            gain = {"motor": "", "position": f'kp="{10 ** r.uniform(0, 3):.1f}"'}
            text += f'<{kind} joint="{name}" {gain.get(kind, "kv=" + chr(34) + "1" + chr(34))}/>'
        return f"<actuator>{text}</actuator>" if text else ""


def _constant(integrator: str) -> str:
    return f"mjINT_{integrator.upper()}"


def examine(case: dict[str, Any]) -> dict[str, Any]:
    """The row of a scene: the same steps with volumetric and with native contact."""
    scene = Scene(case["seed"])
    try:
        model = mujoco.MjModel.from_xml_string(scene.text)
    except ValueError as error:
        return case | {"refused": f"MuJoCo: {str(error).splitlines()[0]}"}
    row = case | {
        "integrator": scene.integrator,
        "timestep": scene.timestep,
        "stiffness": scene.stiffness,
        "dofs": model.nv,
        "geoms": model.ngeom,
        "parts": " ".join(scene.parts),
    }
    # A scene that MuJoCo itself cannot step says nothing about contact.
    native = mujoco.MjData(model)
    fastest = 0.0
    for _ in steps_of(model, native, case["seed"]):
        fastest = max(fastest, speed_of(native))
    row |= {"native_speed": fastest, "native_warnings": warnings_in(native)}
    data = mujoco.MjData(model)
    try:
        contact = vc.attach(model, material=material_of(scene))
    except ValueError as error:
        return row | {"refused": str(error)}
    with contact:
        row |= audited(model, data, contact, case["seed"])
    if row["warnings"] and not row["native_warnings"]:
        row["alone"] = int(warns_alone(model, scene, row))
    return row


def warns_alone(model: mujoco.MjModel, scene: Scene, row: dict[str, Any]) -> bool:
    """Whether MuJoCo warns without any contact, in as many steps again, from a state in which
    contact has given nothing and nothing is much faster than with native contact."""
    data = mujoco.MjData(model)
    alone = mujoco.MjData(model)
    with vc.attach(model, material=material_of(scene)) as contact:
        for _ in steps_of(model, data, row["seed"]):
            mujoco.mj_forward(model, data)
            if contact.energy(data).work > 0.0 or speed_of(data) > 2.0 * row["native_speed"]:
                break
            mujoco.mj_copyData(alone, model, data)
    alone.qfrc_applied[:] = 0.0
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    mujoco.mj_step(model, alone, STEPS)
    return warnings_in(alone) > 0


def speed_of(data: mujoco.MjData) -> float:
    """The fastest degree of freedom."""
    return float(np.abs(data.qvel).max(initial=0.0))


def material_of(scene: Scene) -> dict[str, float]:
    """The material of all its geoms."""
    return {
        "stiffness": scene.stiffness,
        "damping": scene.damping,
        "friction": scene.friction,
    }


def steps_of(model: mujoco.MjModel, data: mujoco.MjData, seed: int) -> Iterator[int]:
    """Steps with random controls and a random start."""
    numbers = np.random.default_rng(seed)
    data.qvel[:] = 0.5 * numbers.standard_normal(model.nv)
    for step in range(STEPS):
        if step % 50 == 0:
            data.ctrl[:] = numbers.uniform(-1.0, 1.0, model.nu)
        yield step
        mujoco.mj_step(model, data)


def audited(
    model: mujoco.MjModel, data: mujoco.MjData, contact: vc.Contact, seed: int
) -> dict[str, Any]:
    """The step in which contact gave most that it did not hold, by the energy there was."""
    row: dict[str, Any] = {"gain": 0.0, "step": 0, "energy": 0.0, "speed": 0.0}
    before = held = None
    for step in steps_of(model, data, seed):
        mujoco.mj_forward(model, data)
        now = contact.energy(data)
        kinetic = float(dense(data.energy)[1])
        scale = kinetic + now.elastic + 1e-6
        if before is not None:
            made = (now.work - before.work) + (now.elastic - before.elastic)
            made -= (now.owed - before.owed) + (now.released - before.released)
            gain = made / max(scale, held)
            if not math.isfinite(gain):
                return row | {"gain": math.inf, "step": step, "warnings": warnings_in(data)}
            if gain > row["gain"]:
                row |= {"gain": gain, "step": step, "energy": held}
        before, held = now, scale
        row["speed"] = max(row["speed"], speed_of(data))
    if before is not None:
        row["numerical"] = before.numerical
    return row | {"warnings": warnings_in(data), "dropped": contact.dropped(data)}


def warnings_in(data: mujoco.MjData) -> int:
    """How many warnings MuJoCo gave."""
    return int(sum(warning.number for warning in data.warning))


def counts(row: dict[str, Any]) -> bool:
    """Whether MuJoCo steps the scene itself: what it cannot do says nothing about contact."""
    if row.get("refused") or int(row.get("native_warnings") or 0):
        return False
    return float(row["native_speed"]) * float(row["timestep"]) <= MOST_TURN


def is_sound(row: dict[str, Any]) -> bool:
    """Contact made at most a thousandth of the energy that there was, in any step."""
    if not counts(row):
        return True
    warned = int(row.get("warnings") or 0) and not int(row.get("alone") or 0)
    return not warned and not int(row.get("dropped") or 0) and float(row["gain"]) <= 1e-3
