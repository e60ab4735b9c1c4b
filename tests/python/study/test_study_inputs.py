# SPDX-License-Identifier: Apache-2.0
"""What a study draws: the laws asked for, and the same values whoever asks and in any order."""

from __future__ import annotations

import numpy as np
import pytest
from study_files import FUNCTION_STUDY, function_study

import volcontact as vc
from volcontact.study.designs import Design, trial_generator
from volcontact.study.file.reading import read_study
from volcontact.study.file.settings import StudyError

stats = pytest.importorskip("scipy.stats", reason="scipy is missing")
MANY = np.arange(4000)


def drawn(folder, old="", new="", trials=4000):
    text = FUNCTION_STUDY.replace("trials = 40", f"trials = {trials}").replace(old, new, 1)
    return Design(read_study(function_study(folder, text)))


@pytest.mark.parametrize("method", ["monte_carlo", "latin_hypercube", "sobol"])
def test_values_follow_their_laws(method, tmp_path):
    values = drawn(tmp_path, "seed = 3", f'seed = 3\nmethod = "{method}"').values(MANY)
    assert stats.kstest(values["x"], "norm").pvalue > 1e-3
    assert stats.kstest(values["y"], "uniform", (1.0, 2.0)).pvalue > 1e-3
    if method != "monte_carlo":  # in strata: far nearer to the mean than chance
        assert values["x"].mean() == pytest.approx(0.0, abs=2e-3)


@pytest.mark.parametrize("method", ["monte_carlo", "sobol", "latin_hypercube", "saltelli"])
def test_trial_has_the_same_values_whoever_asks(method, tmp_path):
    design = drawn(tmp_path, "seed = 3", f'seed = 3\nmethod = "{method}"', trials=1000)
    trials = np.arange(design.trials)
    whole = design.values(trials)
    mixed = np.random.default_rng(0).permutation(trials)
    asked = drawn(tmp_path, "seed = 3", f'seed = 3\nmethod = "{method}"', trials=1000)
    for part in np.array_split(mixed, 7):
        for name, column in asked.values(part).items():
            assert np.array_equal(column, whole[name][part])
    other = drawn(tmp_path, "seed = 3", f'seed = 4\nmethod = "{method}"', trials=1000)
    assert not np.array_equal(other.values(trials)["x"], whole["x"])


@pytest.mark.parametrize("method", ["monte_carlo", "sobol"])
def test_more_trials_begin_with_the_same(method, tmp_path):
    few, more = (
        drawn(tmp_path, "seed = 3", f'seed = 3\nmethod = "{method}"', trials=n).values(
            np.arange(300)
        )
        for n in (300, 3000)
    )
    assert np.array_equal(few["x"], more["x"])


def test_correlated_normals(tmp_path):
    text = FUNCTION_STUDY.replace(
        "[sample]", '[[correlation]]\ninputs = ["x", "y"]\nmatrix = [[1, 0.8], [0.8, 1]]\n[sample]'
    )
    text = text.replace('"uniform"\nlow = 1.0\nhigh = 3.0', '"norm"\nmean = 5.0\nstd = 2.0')
    values = Design(read_study(function_study(tmp_path, text))).values(MANY)
    assert np.corrcoef(values["x"], values["y"])[0, 1] == pytest.approx(0.8, abs=0.02)
    assert stats.kstest((values["y"] - 5.0) / 2.0, "norm").pvalue > 1e-3


def test_rows_of_a_table_stay_together(tmp_path):
    (tmp_path / "gaps.csv").write_text("# measured\ngap,width\n0.1,1\n0.2,2\n0.4,4\n")
    table = 'table = "gaps.csv"\ncolumn = '
    text = FUNCTION_STUDY.replace('distribution = "norm"', f'{table}"gap"')
    text = text.replace('distribution = "uniform"\nlow = 1.0\nhigh = 3.0', f'{table}"width"')
    values = Design(read_study(function_study(tmp_path, text))).values(MANY)
    assert np.array_equal(values["y"], 10.0 * values["x"])
    shares = np.unique(values["x"], return_counts=True)[1] / len(MANY)
    assert shares == pytest.approx([1 / 3] * 3, abs=0.03)


def test_choices_by_weight(tmp_path):
    new = 'choices = ["a", "b"]\nweights = [3, 1]'
    values = drawn(tmp_path, 'distribution = "norm"', new).values(MANY)
    assert np.mean(values["x"] == "a") == pytest.approx(0.75, abs=0.03)


def test_rotations_are_uniform(tmp_path):
    """A uniform rotation carries an axis to all of the sphere: heights are uniform (Archimedes)."""
    values = drawn(tmp_path, 'distribution = "norm"', 'distribution = "rotation"').values(MANY)
    w, x, y, z = (values[f"x_{axis}"] for axis in "wxyz")
    assert w**2 + x**2 + y**2 + z**2 == pytest.approx(np.ones(len(MANY)), abs=1e-12)
    for height in (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x**2 + y**2)):
        assert stats.kstest(height, "uniform", (-1.0, 2.0)).pvalue > 1e-3


def test_grid_has_every_pair_and_its_ends(tmp_path):
    text = FUNCTION_STUDY.replace('distribution = "norm"', "choices = [1, 2, 3]")
    text = text.replace("high = 3.0", "high = 3.0\npoints = 5")
    text = text.replace("seed = 3", 'seed = 3\nmethod = "grid"')
    design = Design(read_study(function_study(tmp_path, text)))
    values = design.values(np.arange(design.trials))
    assert design.trials == 15
    assert sorted(set(values["y"].tolist())) == [1.0, 1.5, 2.0, 2.5, 3.0]
    assert len(set(zip(values["x"].tolist(), values["y"].tolist(), strict=True))) == 15


def test_designs_of_sensitivity_have_their_sizes(tmp_path):
    saltelli = drawn(tmp_path, "seed = 3", 'seed = 3\nmethod = "saltelli"', trials=1000)
    assert saltelli.trials == 128 * (2 + 2)  # the largest power of two that fits
    morris = drawn(tmp_path, "seed = 3", 'seed = 3\nmethod = "morris"', trials=100)
    assert morris.trials == 33 * 3
    cube = morris.cube(0)
    moves = np.diff(cube[:3], axis=0)
    assert (np.count_nonzero(moves, axis=1) == 1).all()  # one input at a time
    text = FUNCTION_STUDY.replace('"norm"', '"rotation"')
    text = text.replace("seed = 3", 'seed = 3\nmethod = "morris"')
    study = vc.Study(function_study(tmp_path, text))
    with pytest.raises(StudyError, match="takes neither rotations"):
        study.check()


def test_trials_own_numbers_depend_on_its_number_alone():
    first = trial_generator(5, 17).random(3)
    trial_generator(5, 16).random(100)
    assert np.array_equal(first, trial_generator(5, 17).random(3))
    assert not np.array_equal(first, trial_generator(5, 18).random(3))
    assert not np.array_equal(first, trial_generator(6, 17).random(3))
