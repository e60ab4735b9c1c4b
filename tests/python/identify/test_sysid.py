# SPDX-License-Identifier: Apache-2.0
"""Our parameters in MuJoCo's own toolbox for identification."""

import sys
import types

import mujoco
import numpy as np
import pytest
from identify_files import SCENE, TRUE, motions, write_study

import volcontact as vc
from volcontact.identify import sysid as adapter  # type: ignore[attr-defined]


@pytest.fixture
def toolbox():
    try:
        return adapter.toolbox()
    except ModuleNotFoundError as reason:
        pytest.skip(str(reason))


def test_without_the_toolbox_it_says_what_is_missing(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco.sysid", None)
    monkeypatch.delattr(mujoco, "sysid", raising=False)
    with pytest.raises(ModuleNotFoundError, match=r"has no mujoco\.sysid: MuJoCo 4 has it"):
        adapter.toolbox()
    empty = types.ModuleType("mujoco.sysid")
    monkeypatch.setitem(sys.modules, "mujoco.sysid", empty)
    monkeypatch.setattr(mujoco, "sysid", empty, raising=False)
    with pytest.raises(ModuleNotFoundError, match=r"pip install 'mujoco\[sysid\]'"):
        adapter.toolbox()


def test_plugin_of_a_spec_is_the_contact_of_attach(toolbox):
    """The same bits in the toolbox's own rollout as in a loop of steps."""
    from mujoco import rollout

    text = SCENE.format(**TRUE)
    spec = adapter.with_volumetric_contact(mujoco.MjSpec.from_string(text))
    assert adapter.with_volumetric_contact(spec) is spec  # once is enough
    model = spec.compile()
    data = mujoco.MjData(model)
    start = toolbox.create_initial_state(model, data.qpos, data.qvel, data.act)
    state, _ = rollout.rollout(model, data, start, nstep=120)
    plain = vc.load(text)
    with vc.attach(plain):
        data = mujoco.MjData(plain)
        for row in state[0]:
            mujoco.mj_step(plain, data)
            np.testing.assert_array_equal(row[1:8], data.qpos)


def test_every_kind_of_target_is_written(toolbox):
    spec = mujoco.MjSpec.from_string(
        SCENE.format(**TRUE).replace(
            '<geom name="ball"',
            '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><geom name="ball"',
        )
    )
    made = toolbox.ParameterDict()
    for name, target, log in (
        ("k", "volcontact/pair/p/stiffness", True),
        ("z", "inertial/ball/pos/2", False),
        ("m", "inertial/ball/mass", False),
        ("i", "inertial/ball/diaginertia/1", False),
        ("g", "option/gravity/2", False),
        ("mu", "geom/floor/friction/0", False),
    ):
        made.add(adapter.parameter(name, target, 0.5, 0.25, 2.0, log=log))
    model = toolbox.apply_param_modifiers(made, spec)
    assert adapter.values(made) == pytest.approx(dict.fromkeys(made.keys(), 0.5))
    found = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_NUMERIC, "volcontact/pair/p/stiffness")
    assert model.numeric_data[model.numeric_adr[found]] == pytest.approx(0.5, rel=1e-15)
    assert model.body("ball").ipos[2] == 0.5
    assert model.body("ball").mass[0] == 0.5
    assert sorted(model.body("ball").inertia) == [0.5, 1.0, 1.0]
    assert model.opt.gravity[2] == 0.5
    assert model.geom("floor").friction[0] == 0.5


@pytest.mark.parametrize(
    ("target", "said"),
    [
        ("volcontact/pair/p/stifness", "the scene has no such number"),
        ("geom/bal/size/0", "the scene has no geom 'bal'"),
        ("geom/ball/sizes", "there is no attribute 'sizes'"),
        ("sizes", "must be volcontact/"),
    ],
)
def test_target_that_is_not_there_is_told(toolbox, target, said):
    made = toolbox.ParameterDict()
    made.add(adapter.parameter("x", target, 0.5, 0.25, 2.0))
    with pytest.raises(vc.StudyError, match=said):
        toolbox.apply_param_modifiers(made, mujoco.MjSpec.from_string(SCENE.format(**TRUE)))


def test_bounds_are_checked(toolbox):
    with pytest.raises(vc.StudyError, match="'k': 2 <= 1 <= 3 does not hold"):
        adapter.parameter("k", "option/timestep", 1.0, 2.0, 3.0)
    with pytest.raises(vc.StudyError, match="low = 0 must be above 0"):
        adapter.parameter("k", "option/timestep", 1.0, 0.0, 3.0, log=True)


def test_parameters_of_a_study_file(toolbox, tmp_path):
    path = write_study(tmp_path, motions()[:20])
    made = adapter.parameters(path)
    assert made.keys() == ["stiffness", "damping", "friction"]
    low, high = made.get_bounds()
    np.testing.assert_allclose(np.exp([low[0], high[0]]), [1e6, 1e8])
    assert (low[2], high[2]) == (0.05, 1.0)  # linear
    text = path.read_text().replace("[0.05, 5]", '[0.05, 5]\nmode = "scale"')
    path.write_text(text)
    with pytest.raises(vc.StudyError, match="only mode = 'set'"):
        adapter.parameters(path)


def test_toolbox_finds_the_numbers_again(toolbox, capsys):
    import runpy
    from pathlib import Path

    example = Path(__file__).parents[3] / "python" / "examples" / "identify_with_sysid.py"
    runpy.run_path(str(example), run_name="__main__")
    said = capsys.readouterr().out.splitlines()
    numbers = dict(line.split(" = ") for line in said if " = " in line)
    assert float(numbers["stiffness"]) == pytest.approx(4e6, rel=1e-4)
    assert float(numbers["damping"]) == pytest.approx(0.5, rel=1e-4)
