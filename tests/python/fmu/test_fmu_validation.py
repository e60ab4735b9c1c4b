# SPDX-License-Identifier: Apache-2.0
"""Whole motions by Model Exchange, FMPy and CVODE, against closed forms and docs/validation.md."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

import volcontact as vc
from volcontact.running.simulation import to_start

pytest.importorskip("fmpy", reason="FMPy is missing: pip install fmpy")
from fmu_master import Exchange, Master, RigidBody

MODELS = Path(__file__).parents[3] / "mjcf_models"
G = 9.81  # [m/s^2]


def started(tmp_path, name, body, *, laws=(), place=None):
    """The scene's body in the master, from its start or from a place at rest."""
    scene = MODELS / name / "scene.xml"
    path = vc.export_fmu(scene, tmp_path / f"{name}.fmu", bodies=[body, "world"], kind="me")
    model = vc.load(scene)
    data = mujoco.MjData(model)
    to_start(model, data)
    if place is not None:
        data.qpos[:3], data.qvel[:] = place, 0.0
    unit = Exchange(path)
    for law, value in laws:
        unit.set(f"law.{law}", [value])
    return Master(unit, RigidBody.of(model, body), body, data.qpos.copy(), data.qvel.copy())


def test_seven_bounces_come_when_restitution_says(tmp_path):
    """t_n = sqrt(2 h/g) (1 + 2 sum e^k), later by the impacts, which last 40 to 60 us each."""
    master = started(tmp_path, "bouncing_ball", "ball", laws=[("stiffness", 1e15)])
    before = master.energy()
    _, events = master.run(3.2)
    touches = np.array([time for time, touch, *_ in events if touch == 1])
    releases = np.array([time for time, touch, *_ in events if touch == -1])
    assert len(touches) == len(releases) == 7
    powers = np.concatenate([[0.0], np.cumsum(0.8 ** np.arange(1, 7))])
    wanted = np.sqrt(2.0 / G) * (1.0 + 2.0 * powers)
    in_contact = np.concatenate([[0.0], np.cumsum(releases - touches)[:-1]])
    assert touches - in_contact == pytest.approx(wanted, rel=1e-3)  # docs/validation.md asks that
    assert touches[0] == pytest.approx(wanted[0], rel=1e-8)
    flights = touches[1:] - releases[:-1]
    assert 0.5 * G * flights == pytest.approx(np.sqrt(2 * G) * 0.8 ** np.arange(1, 7), rel=1e-3)
    assert master.energy() - before == pytest.approx(0.0, abs=1e-6 * before * len(touches))
    master.unit.close()


def test_small_swings_in_the_bore_have_the_period_of_a_rolling_ball(tmp_path):
    """T = 2 pi sqrt(7 (R - r)/(5 g)) for stiff contact."""
    bore, ball, stiffness, angle = 1.0, 0.1, 1e9, 0.02
    depth = np.sqrt(G * np.sqrt(1 / ball * (1 / ball - 1 / bore)) / (stiffness * np.pi))
    reach = bore - ball + depth
    master = started(
        tmp_path, "ball_in_cylinder", "ball", laws=[("stiffness", stiffness), ("damping", 0.0)],
        place=[reach * np.sin(angle), 0.0, -reach * np.cos(angle)],
    )  # fmt: skip
    before = master.energy()
    rows, _ = master.run(1.8)
    time, x = rows[:, 0], rows[:, 1]
    at = np.flatnonzero(x[:-1] * x[1:] < 0.0)
    crossed = time[at] - x[at] * (time[at + 1] - time[at]) / (x[at + 1] - x[at])
    assert len(crossed) == 2
    period = 2.0 * (crossed[1] - crossed[0])
    assert period == pytest.approx(2 * np.pi * np.sqrt(7 * (bore - ball) / (5 * G)), rel=5e-3)
    assert period == pytest.approx(2.25294, rel=1e-5)  # of MuJoCo's run, docs/validation.md
    assert master.energy() - before == pytest.approx(0.0, abs=1e-8 * abs(before))
    master.unit.close()


def test_the_tippe_top_turns_over_and_falls_when_mujocos_does(tmp_path):
    """Events of docs/validation.md, which has them to 1 ms."""
    master = started(tmp_path, "tippe_top", "top")
    before = master.energy()
    rows, _ = master.run(4.8)
    time, q = rows[:, 0], rows[:, 4:8] / np.linalg.norm(rows[:, 4:8], axis=1)[:, None]
    up = 1.0 - 2.0 * (q[:, 1] ** 2 + q[:, 2] ** 2)
    tilt = np.arccos(np.clip(up, -1.0, 1.0))
    early = time < 0.6
    assert time[early][np.argmin(tilt[early])] == pytest.approx(0.186, abs=1.5e-3)
    assert tilt[early].min() == pytest.approx(0.00472834, rel=1e-3)
    gap = rows[:, 3] + 16e-3 * up - 5e-3  # of the stem
    first = np.flatnonzero((gap[:-1] > 0.0) & (gap[1:] <= 0.0))[0]
    touch = time[first] + 1e-3 * gap[first] / (gap[first] - gap[first + 1])
    assert touch == pytest.approx(1.49062, abs=2e-5)
    beyond = time[np.argmax(tilt > np.radians(150.0))]
    assert beyond == pytest.approx(1.604, abs=1.5e-3)
    assert time[np.argmax((time > beyond) & (tilt < np.radians(120.0)))] == pytest.approx(
        4.726, abs=1.5e-3
    )
    assert master.energy() - before == pytest.approx(0.0, abs=1e-6 * before)
    assert master.evaluations < 25000
    master.unit.close()
