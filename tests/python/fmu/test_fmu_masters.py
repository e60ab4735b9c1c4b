# SPDX-License-Identifier: Apache-2.0
"""FMUs in masters of others: FMPy with CVODE and the body as equations, libcosim, fmi-sim."""

import csv
import os
import shutil
import subprocess
from pathlib import Path

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact.running.simulation import to_start

fmpy = pytest.importorskip("fmpy", reason="FMPy is missing: pip install fmpy")
from fmu_master import Exchange, Master, RigidBody  # noqa: E402 - needs FMPy

MODELS = Path(__file__).parents[3] / "mjcf_models"


def master_of(tmp_path, name, body, fmi=2):
    """The scene's body in the master, from its start."""
    scene = MODELS / name / "scene.xml"
    path = vc.export_fmu(
        scene, tmp_path / f"{name}.fmu", bodies=[body, "world"], fmi=fmi, kind="me"
    )
    model = vc.load(scene)
    data = mujoco.MjData(model)
    to_start(model, data)
    unit = Exchange(path)
    return (
        Master(unit, RigidBody.of(model, body), body, data.qpos.copy(), data.qvel.copy()),
        model,
        data,
    )


def run_mujoco(model, data, duration, step=None):
    if step is not None:
        model.opt.timestep = step
    with vc.attach(model):
        while data.time < duration - 1e-9:
            mujoco.mj_step(model, data)
    return data


def test_bouncing_ball_has_the_times_of_the_closed_form(tmp_path):
    master, _, _ = master_of(tmp_path, "bouncing_ball", "ball")
    before = master.energy()
    rows, events = master.run(0.8)
    assert events[0][0] == pytest.approx(np.sqrt(2 / 9.81), rel=1e-8)  # falls 1 m
    assert [event[1] for event in events] == [1, -1]
    # Restitution 0.8 as validated: to 1 % of the speed of release.
    top = rows[-1, 3] + rows[-1, 13] ** 2 / (2 * 9.81) - 0.05
    assert top == pytest.approx(0.64, rel=2e-2)
    assert master.energy() - before == pytest.approx(0.0, abs=1e-6 * before)
    master.unit.close()


@pytest.mark.parametrize("fmi", [2, 3])
def test_spinning_disc_stops_when_mujoco_and_the_integral_say(tmp_path, fmi):
    master, _, _ = master_of(tmp_path, "spinning_disc", "disc", fmi)
    before = master.energy()
    rows, events = master.run(0.5)
    assert events[-1][0] == pytest.approx(0.45542, rel=3e-3)  # docs/validation.md
    assert rows[-1, 1] == pytest.approx(0.21658, rel=3e-3)
    assert master.energy() - before == pytest.approx(0.0, abs=1e-6 * before)
    assert master.evaluations < 4000  # an implicit solver takes long steps
    master.unit.close()


def test_ball_in_cylinder_meets_the_wall_and_goes_on_as_in_mujoco(tmp_path):
    master, model, data = master_of(tmp_path, "ball_in_cylinder", "ball")
    before = master.energy()
    rows, events = master.run(0.42)
    assert events[0][0] == pytest.approx(0.390596, abs=1e-5)  # docs/validation.md
    assert master.energy() - before == pytest.approx(0.0, abs=1e-6 * before)
    there = run_mujoco(model, data, 0.42, 2e-5).qpos[:3]
    assert rows[-1, 1:4] == pytest.approx(there, abs=1e-6)
    master.unit.close()


def test_tippe_top_tilts_as_in_mujoco(tmp_path):
    master, model, data = master_of(tmp_path, "tippe_top", "top")
    before = master.energy()
    rows, _ = master.run(0.25)
    assert master.energy() - before == pytest.approx(0.0, abs=1e-6 * before)
    quaternion = run_mujoco(model, data, 0.25).qpos[3:7]
    turned = rows[-1, 4:8] / np.linalg.norm(rows[-1, 4:8])  # solvers drift
    assert abs(turned @ quaternion) == pytest.approx(1.0, abs=1e-12)  # 3e-6 rad
    master.unit.close()


def test_fmpy_steps_the_bristles_of_a_dragged_ball_as_the_model_does(tmp_path):
    """Co-Simulation: the state of the law follows the way of the body."""
    model = vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(radius=0.05), vc.HalfSpace())],
        normal=vc.VolumeSpring(stiffness=1e8),
        friction=vc.Bristle(friction=0.3, static_friction=0.3),
    )
    path = vc.export_fmu(model, tmp_path / "ball.fmu", bodies=["ball", "floor"], kind="cs")
    times = np.linspace(0.0, 0.02, 21)
    names = ["ball.position[1]", "ball.position[3]", "ball.velocity[1]"]
    signals = np.array(
        [(t, 2e-3 * t, 0.049, 2e-3) for t in times],
        dtype=[("time", float)] + [(name, float) for name in names],
    )
    rows = fmpy.simulate_fmu(
        str(path), fmi_type="CoSimulation", stop_time=0.02, output_interval=1e-3, input=signals,
        output=["ball.force[1]", "dissipated_energy[3]"],
    )  # fmt: skip
    state, pose, twist = None, np.eye(4), np.r_[0, 0, 0, 2e-3, 0, 0]
    for t in times:
        pose[:3, 3] = 2e-3 * t, 0, 0.049
        report = model.evaluate(
            X_WA=pose, V_WA=twist, state=state, elapsed=1e-3 if state is not None else 0.0
        )
        state = report.state
    assert report.force_on_A[0] < -1.0
    assert rows["ball.force[1]"][-1] == pytest.approx(report.force_on_A[0], rel=2e-2)


def test_libcosim_gets_the_force_and_steps(tmp_path):
    cosim = pytest.importorskip(
        "libcosimpy", reason="libcosimpy is missing: pip install libcosimpy"
    )
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    assert cosim
    path = vc.export_fmu(MODELS / "bouncing_ball" / "scene.xml", tmp_path / "ball.fmu",
                         bodies=["ball", "world"], kind="cs")  # fmt: skip
    about = fmpy.read_model_description(str(path))
    references = {v.name: v.valueReference for v in about.modelVariables}
    execution = CosimExecution.from_step_size(step_size=1_000_000)  # [ns]
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    slave = execution.add_local_slave(CosimLocalSlave(str(path), "ball"))
    execution.real_initial_value(slave, references["ball.position[3]"], 0.049)
    execution.step(5)
    force = observer.last_real_values(slave, [references["ball.force[3]"]])[0]
    volume = np.pi * 1e-6 * (0.15 - 1e-3) / 3
    assert force == pytest.approx(1e9 * volume, rel=1e-9)
    execution.stop()


def fmi_sim(path, out, *arguments):
    """Runs an FMU in fmi-sim; the names and the last row of what it wrote."""
    built = Path(__file__).parents[3] / "build" / "fmi-sim" / "bin"
    program = shutil.which(
        "fmi-sim",
        path=os.pathsep.join([str(built), os.environ["PATH"], f"{Path.home()}/.cargo/bin"]),
    )
    if program is None:
        pytest.skip("NOT RUN: fmi-sim is missing; ./run soak builds it")
    done = subprocess.run(
        [program, "--model", str(path), "--output-file", str(out), *arguments],
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    rows = list(csv.reader(out.read_text().splitlines()))
    return dict(zip(rows[0], rows[-1], strict=True))


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("interface", ["model-exchange", "co-simulation"])
def test_fmi_sim_gets_the_force_of_the_cap(tmp_path, fmi, interface):
    """It knows no arrays of FMI 3."""
    path = vc.export_fmu(MODELS / "bouncing_ball" / "scene.xml", tmp_path / "ball.fmu",
                         bodies=["ball", "world"], fmi=fmi, arrays=False)  # fmt: skip
    row = fmi_sim(path, tmp_path / "rows.csv", interface, "-f", "0.01", "--step", "0.001",
                  "--init-values", "ball.position[3]=0.049")  # fmt: skip
    volume = np.pi * 1e-6 * (0.15 - 1e-3) / 3
    assert float(row["ball.force[3]"]) == pytest.approx(1e9 * volume, rel=1e-9)
    assert float(row["volume"]) == pytest.approx(volume, rel=1e-9)
    assert row["touching"] == "true"


def test_libcosim_steps_a_whole_scene(tmp_path):
    pytest.importorskip("libcosimpy", reason="libcosimpy is missing: pip install libcosimpy")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    scene = MODELS / "bouncing_ball" / "scene.xml"
    path = vc.export_scene_fmu(scene, tmp_path / "ball.fmu")
    model = vc.load(scene)
    data = mujoco.MjData(model)
    to_start(model, data)
    about = fmpy.read_model_description(str(path))
    references = {v.name: v.valueReference for v in about.modelVariables}
    execution = CosimExecution.from_step_size(step_size=5_000_000)  # [ns], many time steps
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    slave = execution.add_local_slave(CosimLocalSlave(str(path), "ball"))
    execution.step(100)
    height = observer.last_real_values(slave, [references["body.ball.position[3]"]])[0]
    run_mujoco(model, data, 0.5)
    assert height == data.qpos[2]
    assert data.qvel[2] > 1.0
    execution.stop()


@pytest.mark.parametrize("fmi", [2, 3])
def test_fmi_sim_steps_a_whole_scene(tmp_path, fmi):
    """The last state of a bounce, to the bit."""
    scene = MODELS / "bouncing_ball" / "scene.xml"
    path = vc.export_scene_fmu(scene, tmp_path / "ball.fmu", fmi=fmi, arrays=False)
    model = vc.load(scene)
    step = model.opt.timestep
    row = fmi_sim(path, tmp_path / "rows.csv", "co-simulation", "-f", "0.5", "--step", repr(step))
    data = mujoco.MjData(model)
    to_start(model, data)
    run_mujoco(model, data, 0.5)
    assert float(row["body.ball.position[3]"]) == data.qpos[2]
    assert data.qvel[2] > 1.0  # it has bounced
