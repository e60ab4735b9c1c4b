# SPDX-License-Identifier: Apache-2.0
"""Random calls of a whole scene, right and wrong ones: as new after a reset."""

import os
import random
import sys

import pytest

import volcontact as vc

pytest.importorskip("fmpy", reason="FMPy is missing: pip install fmpy")
from fmpy.fmi1 import FMICallException
from scene_master import SceneInstance

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="made on Linux")
SEQUENCES = int(os.environ.get("FMU_FUZZ_SEQUENCES", "60"))
CALLS = 20
SCENE = """<mujoco>
  <option timestep="0.001"/>
  <custom><numeric name="volcontact/material/all/stiffness" data="1e8"/>
    <tuple name="volcontact/material/all"><element objtype="geom" objname="ball"/></tuple></custom>
  <worldbody>
    <geom name="floor" type="plane" size="2 2 .1"/>
    <body name="ball" pos="0 0 .049"><freejoint name="free"/>
      <geom name="ball" type="sphere" size=".05" mass="1"/></body>
    <body name="hand" mocap="true" pos="1 0 .1"><geom type="sphere" size=".04"/></body>
  </worldbody>
</mujoco>"""
INPUTS = {
    "body.ball.applied_force": 3, "body.ball.applied_torque": 3, "mocap.hand.position": 3,
    "mocap.hand.quaternion": 4, "gravity": 3, "timestep": 1, "material.all.stiffness": 1,
    "contact.volume": 1,
}  # fmt: skip
OUTPUTS = {
    "joint.free.position": 7, "body.ball.velocity": 3, "contact.normal_force": 1, "time": 1,
    "contact.dissipated_energy": 4,
}  # fmt: skip


def number(chance):
    return chance.choice(
        [0.0, float("nan"), float("inf"), 1e300, -1.0, 1e-3, chance.gauss(0.0, 1.0), 9.0]
    )


def call(instance, chance, states):
    kind = chance.randrange(9)
    if kind <= 2:
        name = chance.choice(list(INPUTS))
        instance.set(name, [number(chance) for _ in range(INPUTS[name])])
    elif kind <= 4:
        instance.step(chance.choice([1e-3, 3e-3, 1.5e-3, 0.0, -1.0, float("nan")]))
    elif kind == 5:
        name = chance.choice(list(OUTPUTS))
        instance.get(name, OUTPUTS[name])
    elif kind == 6:
        states.append(instance.save())
    elif kind == 7 and states:
        instance.restore(chance.choice(states))
    elif kind == 8 and states:
        content = bytearray(instance.bytes_of(states[-1]))
        if chance.random() < 0.5:
            content[chance.randrange(len(content))] ^= 0x55
        if chance.random() < 0.3:
            del content[len(content) // 2 :]
        instance.restore_bytes(bytes(content))


def run(instance):
    instance.reset()
    rows = []
    for k in range(4):
        instance.set("body.ball.applied_force", [1.0, 0.0, -5.0 * k])
        instance.step(2e-3)
        for name, count in OUTPUTS.items():
            rows += instance.get(name, count).tolist()
    return rows


@pytest.mark.parametrize("fmi", [2, 3])
def test_after_any_calls_a_reset_gives_a_new_instance(tmp_path, fmi):
    path = vc.export_scene_fmu(SCENE, tmp_path / "ball.fmu", fmi=fmi)
    instance = SceneInstance(path)
    as_new = run(instance)
    assert as_new[10] > 1.0  # [N]
    refused = 0
    for sequence in range(SEQUENCES):
        chance, states = random.Random(sequence), []
        instance.reset()
        for _ in range(CALLS):
            status = 0
            try:
                call(instance, chance, states)
            except FMICallException as error:
                status = error.status
            assert status in (0, 2, 3), instance.messages[-1]  # fine, discard, error
            refused += status > 0
        for state in states:
            instance.free(state)
        assert run(instance) == as_new, f"after sequence {sequence}"
    assert refused > SEQUENCES
    instance.close()
