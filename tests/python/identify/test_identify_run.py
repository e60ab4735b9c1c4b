# SPDX-License-Identifier: Apache-2.0
"""Identification of a motion whose parameters are known."""

import json

import mujoco
import numpy as np
import pytest
from identify_files import STUDY, TRUE, motions, write_study

import volcontact as vc
from volcontact.cli import main
from volcontact.identify.reading import read_settings
from volcontact.identify.run import run

ONE = "\n[estimator]\nstarts = 1\n"


@pytest.fixture(scope="module")
def rows():
    return motions()


def noisy(rows, seed, sigma=1e-4):
    generator = np.random.default_rng(seed)
    found = rows.copy()
    found[:, 2:5] += sigma * generator.standard_normal((len(rows), 3))
    return found


def test_parameters_are_recovered_without_noise(tmp_path, rows):
    study = write_study(tmp_path, rows, STUDY + ONE)
    found = run(read_settings(study), tmp_path / "out", workers=1, report=False)
    assert found.converged
    for name, value in TRUE.items():
        assert found.values[name] == pytest.approx(value, rel=1e-6)
    model = vc.load(tmp_path / "out" / "identified.xml")
    with vc.attach(model) as contact:
        pair = contact.description["pairs"][0]
    for name, value in TRUE.items():
        assert pair[name] == pytest.approx(value, rel=1e-5)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)


@pytest.mark.once
def test_starts_are_found_beside_the_parameters(tmp_path, rows):
    """Velocities at the start that were measured wrong."""
    wrong = rows[:40].copy()
    wrong[[0, 20], 9:12] += [[0.01, -0.02, 0.015], [-0.01, 0.0, 0.01]]
    study = write_study(tmp_path, wrong, STUDY + "[nuisance]\nvelocity = 1.0\n" + ONE)
    found = run(read_settings(study), None, workers=1)
    assert found.converged
    for name, value in TRUE.items():
        assert found.values[name] == pytest.approx(value, rel=1e-3)


def test_same_result_with_processes(tmp_path, rows):
    settings = read_settings(write_study(tmp_path, rows[:40], STUDY + ONE))
    one = run(settings, None, workers=1)
    two = run(settings, None, workers=2)
    assert one.values == two.values


@pytest.mark.once
def test_intervals_hold_the_truth(tmp_path, rows):
    """Of 12 repetitions with noise, 95 % intervals of three parameters: 36 in all."""
    held = 0
    for seed in range(12):
        text = STUDY.replace("[identify]", '[start]\nfrom = "measured"\n[identify]')
        study = write_study(tmp_path, noisy_but_for_start(rows, seed), text + ONE)
        found = run(read_settings(study), None, workers=1)
        for name, value in TRUE.items():
            each = found.summary["parameters"][name]
            held += each["low"] <= value <= each["high"]
    assert held >= 31  # 34.2 expected; fewer with a probability of 1 %


def noisy_but_for_start(rows, seed):
    found = noisy(rows, seed)
    starts = np.searchsorted(rows[:, 0], np.unique(rows[:, 0]))
    found[starts] = rows[starts]
    return found


def test_what_the_data_cannot_tell_is_named(tmp_path, rows):
    """Below what the steps resolve, the slip speed of regularised friction is nobody's to tell."""
    text = STUDY.replace("[0.05, 1]", "[0.05, 1]\nprior = [0.2, 0.1]")
    text += (
        "[parameter.slip]\n"
        'target = "volcontact/pair/p/slip_speed"\nbounds = [1e-5, 1e-3]\n[uncertainty]\n'
        'profile = ["slip"]\n' + ONE
    )
    scene = "volcontact/pair/p/friction"
    study = write_study(tmp_path, noisy_but_for_start(rows, 1), text)
    path = tmp_path / "scene.xml"
    said = path.read_text()
    line = next(each for each in said.splitlines() if scene in each)
    slip = line.replace("friction", "slip_speed").replace("0.3", "1e-4")
    path.write_text(said.replace(line, line + "\n" + slip))
    found = run(read_settings(study), None, workers=1)
    assert not found.summary["parameters"]["slip"]["told"]
    words = ("cannot be told", "hardly told", "lies at its")
    assert any("slip" in line and any(w in line for w in words) for line in found.findings)


def test_search_finds_the_parameter_and_goes_on_where_it_was_stopped(tmp_path, rows):
    text = STUDY[: STUDY.index("[parameter.damping]")]
    text += '[estimator]\nmethod = "cma"\nevaluations = 60\nseed = 3\n'
    study = write_study(tmp_path, rows[:40], text)
    (tmp_path / "scene.xml").write_text(
        (tmp_path / "scene.xml").read_text().replace('"1.0"', '"0.5"').replace('"0.3"', '"0.22"')
    )
    settings = read_settings(study)
    whole = run(settings, tmp_path / "a", workers=1, report=False)
    assert whole.values["stiffness"] == pytest.approx(TRUE["stiffness"], rel=0.01)
    log = (tmp_path / "a" / "evaluations.jsonl").read_text().splitlines(keepends=True)
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "evaluations.jsonl").write_text("".join(log[:20]) + log[20][:30])
    again = run(settings, tmp_path / "b", workers=1, report=False)
    assert again.values == whole.values
    study.write_text(text.replace("seed = 3", "seed = 4"))
    with pytest.raises(vc.StudyError, match="of another study"):
        run(read_settings(study), tmp_path / "b", workers=1)


def test_least_squares_go_on_with_the_first_guess_that_was_not_done(tmp_path, rows):
    text = STUDY[: STUDY.index("[parameter.damping]")] + "[estimator]\nstarts = 2\nseed = 5\n"
    settings = read_settings(write_study(tmp_path, rows[:20], text))
    whole = run(settings, tmp_path / "a", workers=1, report=False)
    kept = json.loads((tmp_path / "a" / "starts.json").read_text())
    assert len(kept["starts"]) == 2
    (tmp_path / "b").mkdir()
    stopped = kept | {"starts": kept["starts"][:1]}
    (tmp_path / "b" / "starts.json").write_text(json.dumps(stopped))
    again = run(settings, tmp_path / "b", workers=1, report=False)
    assert again.values == whole.values
    assert again.summary["starts"] == whole.summary["starts"]


def test_optuna_finds_about_the_same(tmp_path, rows):
    text = STUDY[: STUDY.index("[parameter.damping]")]
    text += '[estimator]\nmethod = "optuna"\nevaluations = 30\nseed = 3\n'
    study = write_study(tmp_path, rows[:20], text)
    (tmp_path / "scene.xml").write_text(
        (tmp_path / "scene.xml").read_text().replace('"1.0"', '"0.5"').replace('"0.3"', '"0.22"')
    )
    found = run(read_settings(study), None, workers=1)
    assert found.values["stiffness"] == pytest.approx(TRUE["stiffness"], rel=0.3)


@pytest.mark.once
def test_command_writes_everything_and_tells_whether_it_converged(tmp_path, rows, capsys):
    text = STUDY.replace('time = "t"', 'time = "t"\nfit = [0, 1]\njudge = [2]') + ONE
    study = write_study(tmp_path, rows, text)
    out = tmp_path / "out"
    assert main(["identify", str(study), "--out", str(out), "--workers", "1", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    kept = json.loads((out / "identified.json").read_text())
    assert told["parameters"] == kept["parameters"]
    assert kept["judge"]["position"]["mean"] < 1e-8
    page = (out / "report.html").read_text()
    for word in (
        "Trials not used",
        "Correlations",
        "The worst trial: 2",
        "data-motion",
        "stiffness",
    ):
        assert word in page
    study.write_text(text.replace("starts = 1", "starts = 1\nevaluations = 1"))
    assert main(["identify", str(study), "--out", str(tmp_path / "o2"), "--no-report"]) == 3
    assert "not converged: the evaluations ran out" in capsys.readouterr().err
    assert main(["identify", str(study), "--check"]) == 0
    assert "trials of the fit" in capsys.readouterr().out


def test_native_contact_is_identified_too(tmp_path, rows):
    """Its own motion, under MuJoCo's contact."""
    study = write_study(tmp_path, rows[:20], STUDY)
    scene = mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml"))
    scene.geom_solref[:] = [0.01, 0.4]
    data = mujoco.MjData(scene)
    measured = rows[:20].copy()
    data.qpos[:], data.qvel[:] = measured[0, 2:9], measured[0, 9:]
    for step in range(20 * 7):
        if step % 7 == 0:
            measured[step // 7, 2:9], measured[step // 7, 9:] = data.qpos, data.qvel
        mujoco.mj_step(scene, data)
    text = STUDY[: STUDY.index("[parameter.stiffness]")].replace(
        'scene = "scene.xml"', 'scene = "scene.xml"\ncontact = "native"'
    )
    text += (
        '[parameter.ratio]\ntarget = ["geom/ball/solref/1", "geom/floor/solref/1"]\n'
        "bounds = [0.1, 2]\nstart = 1.0\n" + ONE
    )
    study = write_study(tmp_path, measured, text)
    path = tmp_path / "scene.xml"
    path.write_text(path.read_text().replace('<geom name="', '<geom solref="0.01 1" name="'))
    found = run(read_settings(study), None, workers=1)
    assert found.values["ratio"] == pytest.approx(0.4, rel=1e-4)
