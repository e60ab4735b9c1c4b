# SPDX-License-Identifier: Apache-2.0
"""The environment volcontact/ORUInsertion-v0. Warnings are errors in all tests."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import gymnasium
import mujoco
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import volcontact as vc
from volcontact.gym import ENV_ID, ForceGuided, oru_insertion
from volcontact.gym.scene_files import scene_file

ROOT = Path(__file__).parents[3]
KINDS = ["volumetric", "native"]


def benchmark() -> ModuleType:
    path = ROOT / "tests" / "benchmarks" / "field" / "oru_insertion.py"
    spec = importlib.util.spec_from_file_location("oru_insertion_benchmark", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its dataclass looks there
    spec.loader.exec_module(module)
    return module


RUNS = benchmark()


@pytest.fixture
def env():
    made = gymnasium.make(ENV_ID)
    yield made
    made.close()


@pytest.mark.parametrize("kind", KINDS)
def test_passes_the_checker(kind: str) -> None:
    env = gymnasium.make(ENV_ID, contact=kind)
    check_env(env.unwrapped)
    env.close()


def test_gymnasium_finds_it_by_the_name_of_the_module() -> None:
    program = f'import gymnasium; gymnasium.make("volcontact.gym:{ENV_ID}").close()'
    subprocess.run([sys.executable, "-W", "error", "-c", program], check=True)


def test_installed_scene_is_that_of_the_checkout() -> None:
    """What CMake installs is complete: MuJoCo compiles it to the same model."""
    installed = Path(vc._volcontact.__file__).parent / "gym" / "mjcf_models" / oru_insertion.SCENE
    ours, theirs = (
        mujoco.MjModel.from_xml_path(str(path))
        for path in (scene_file(oru_insertion.SCENE), installed)
    )
    for name in ("geom_pos", "geom_size", "body_mass", "actuator_gainprm", "numeric_data"):
        assert np.array_equal(getattr(ours, name), getattr(theirs, name))


def test_step_is_the_scene_stepped(env) -> None:
    """The pose after three actions is that of the same controls in the scene."""
    misalignment = np.array([0.003, -0.002, 0.0, 0.004, 0.003, -0.002])
    observation, _ = env.reset(options={"misalignment": misalignment})
    action = np.array([0.5, -0.5, -1.0, 0.25, 0.0, 1.0], np.float32)
    for _ in range(3):
        observation, *_ = env.step(action)
    model = vc.load(scene_file(oru_insertion.SCENE))
    model.opt.timestep = oru_insertion.TIMESTEP
    data = mujoco.MjData(model)
    data.qpos[:] = data.act[:] = misalignment + oru_insertion.START
    data.ctrl[:] = action * 0.02
    with vc.attach(model):
        mujoco.mj_forward(model, data)
        mujoco.mj_step(model, data, round(0.3 / model.opt.timestep))
    assert observation["pose"] == pytest.approx(data.qpos - misalignment, abs=1e-7)
    assert observation["velocity"] == pytest.approx(data.qvel, abs=1e-7)
    assert observation["set_point"] == pytest.approx(data.act - misalignment, abs=1e-7)
    assert observation["wrench"] == pytest.approx(data.sensordata, rel=1e-6, abs=1e-6)
    assert not observation["sites"].any()  # nothing touches yet


@pytest.mark.parametrize("kind", KINDS)
def test_forces_of_the_sites_are_what_the_carrier_holds(kind: str) -> None:
    """Of a seated box at rest, with their moments about the grasp."""
    env = gymnasium.make(ENV_ID, contact=kind)
    observation, _ = env.reset(seed=0)
    policy = ForceGuided()
    for _ in range(250):
        observation, _, terminated, _, info = env.step(policy(observation))
        if terminated:
            break
    assert info["is_success"]
    for _ in range(30):  # until it has come to rest
        observation, *_ = env.step(np.zeros(6, np.float32))
    places, forces = np.hsplit(observation["sites"].astype(float), 2)
    assert 6 <= np.count_nonzero(np.linalg.norm(forces, axis=1)) <= oru_insertion.SITES
    if kind == "volumetric":  # native contact has more points than are observed
        held = observation["wrench"]
        assert forces.sum(axis=0) == pytest.approx(-held[:3], abs=0.1)
        assert np.cross(places, forces).sum(axis=0) == pytest.approx(-held[3:], abs=0.1)
    env.close()


def test_pushing_blindly_overloads(env) -> None:
    """Turned by two degrees and straight down: the limits end the episode."""
    env.reset(options={"misalignment": [0.006, 0.006, 0.0, 0.03, -0.03, 0.0]})
    down = np.array([0, 0, -1, 0, 0, 0], np.float32)
    for _ in range(300):
        _, reward, terminated, truncated, info = env.step(down)
        if terminated or truncated:
            break
    assert terminated and info["overload"] and not info["is_success"]
    assert reward < -0.5
    over_force = info["peak_force"] > oru_insertion.FORCE_LIMIT
    assert over_force or info["peak_torque"] > oru_insertion.TORQUE_LIMIT


def test_rewards_of_progress_sum_to_the_way_gone(env) -> None:
    _, before = env.reset(seed=3)
    total = 0.0
    for _ in range(60):
        _, reward, terminated, *_, after = env.step(np.array([0, 0, -1, 0, 0, 0], np.float32))
        assert not terminated
        total += reward

    def way(info: dict[str, float]) -> float:
        return info["distance"] + oru_insertion.ARM * np.radians(info["angle"])

    gone = (way(before) - way(after)) / oru_insertion.START[2]
    assert total == pytest.approx(gone, abs=1e-9)


def test_observations_know_the_misalignment_only_by_what_is_felt(env) -> None:
    seen = [
        env.reset(options={"misalignment": np.full(6, size) * [1, 1, 0, 1, 1, 1]})[0]
        for size in (0.0, 0.005)
    ]
    for name in ("pose", "velocity", "set_point", "wrench", "sites"):
        assert seen[0][name] == pytest.approx(seen[1][name], abs=1e-7)


def test_several_environments_do_not_disturb_each_other() -> None:
    policy = ForceGuided()

    def alone(seed: int) -> np.ndarray:
        env = gymnasium.make(ENV_ID)
        observation, _ = env.reset(seed=seed)
        for _ in range(120):
            observation, *_ = env.step(policy(observation))
        env.close()
        return observation["wrench"]

    envs = gymnasium.make_vec(ENV_ID, num_envs=3)
    observation, _ = envs.reset(seed=5)
    for _ in range(120):
        observation, *_ = envs.step(policy(observation))
    envs.close()
    for i in range(3):
        assert np.array_equal(observation["wrench"][i], alone(5 + i))


def test_runs_in_processes() -> None:
    envs = gymnasium.make_vec(
        ENV_ID, num_envs=2, vectorization_mode="async", vector_kwargs={"context": "spawn"}
    )
    observation, _ = envs.reset(seed=1)
    for _ in range(5):
        observation, *_ = envs.step(np.zeros((2, 6), np.float32))
    assert observation["pose"].shape == (2, 6)
    envs.close()


@pytest.mark.parametrize("kind", KINDS)
def test_script_seats_a_sample_of_episodes(kind: str) -> None:
    """Among them the hardest of the recorded ones: docs/environment.md."""
    recorded = [e for e in RUNS.read() if (e.contact, e.policy) == (kind, "scripted")]
    hardest = max(recorded, key=lambda e: max(e.force / 111.0, e.torque / 22.0)).seed
    ended = list(RUNS.run(kind, "scripted", [*range(9), hardest], 4))
    assert {e.seed for e in ended} == {*range(9), hardest}
    assert sum(e.end == "seated" for e in ended) >= 9


def test_recorded_runs_meet_what_is_asked() -> None:
    recorded = RUNS.read()
    for contact, policy, count in RUNS.KINDS:
        seeds = [e.seed for e in recorded if (e.contact, e.policy) == (contact, policy)]
        assert seeds == list(range(count))
    ours = [e for e in recorded if (e.contact, e.policy) == ("volumetric", "scripted")]
    assert len(ours) >= 1000
    assert sum(e.end == "seated" for e in ours[:100]) > 95
    for e in recorded:
        over = e.force > oru_insertion.FORCE_LIMIT or e.torque > oru_insertion.TORQUE_LIMIT
        assert (e.end == "overload") == over


def test_recorded_run_is_what_runs_today() -> None:
    """Forces to a tenth: another release of MuJoCo rounds otherwise."""
    by_seed = {e.seed: e for e in RUNS.read() if e.policy == "scripted" and e.contact != "native"}
    for e in RUNS.run("volumetric", "scripted", [0, 1], 2):
        assert e.end == by_seed[e.seed].end
        assert e.force == pytest.approx(by_seed[e.seed].force, rel=0.1)


def test_page_has_the_recorded_runs() -> None:
    page = (ROOT / "docs" / "environment.md").read_text(encoding="utf-8")
    assert "\n".join(RUNS.table(RUNS.read())) in page


def test_draws_the_scene() -> None:
    env = gymnasium.make(ENV_ID, render_mode="rgb_array")
    env.reset(seed=0)
    picture = env.render()
    assert isinstance(picture, np.ndarray)
    assert picture.shape == (480, 640, 3) and picture.std() > 10.0
    env.close()


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ({"contact": "soft"}, "contact"),
        ({"misalignment": -0.001}, "misalignment"),
        ({"turning": 3.0}, "turning"),
        ({"render_mode": "human"}, "render_mode"),
    ],
)
def test_refuses_what_makes_no_sense(arguments: dict, name: str) -> None:
    with pytest.raises(ValueError, match=f"^{name} = .*must be"):
        oru_insertion.OruInsertion(**arguments)


def test_refuses_a_misalignment_of_another_shape(env) -> None:
    with pytest.raises(ValueError, match="six finite numbers"):
        env.reset(options={"misalignment": [0.001, 0.002]})


@pytest.mark.parametrize("arguments", [{"speed": 0.1}, {"settling": 0.0}, {"push": 200.0}], ids=str)
def test_script_refuses_what_makes_no_sense(arguments: dict) -> None:
    with pytest.raises(ValueError, match="must be above 0"):
        ForceGuided(**arguments)
