# SPDX-License-Identifier: Apache-2.0
"""Identification files and measurements: what is wrong is told in a line, before anything runs."""

import itertools

import numpy as np
import pytest
from identify_files import STUDY, motions, write_study

import volcontact as vc
from volcontact.identify.measurements import read_trials
from volcontact.identify.reading import parse_settings, read_settings
from volcontact.identify.run import check
from volcontact.identify.windows import impacts, windowed


@pytest.fixture(scope="module")
def rows():
    return motions()


@pytest.fixture
def study(tmp_path, rows):
    return write_study(tmp_path, rows)


def changed(study, old, new):
    text = STUDY.replace(old, new, 1)
    assert text != STUDY
    study.write_text(text)
    return study


WRONG = {
    "unknown table": ("[identify]", "[identfy]", "identfy: is unknown; did you mean 'identify'?"),
    "no scene": ('scene = "scene.xml"', "", "scene is missing"),
    "no such scene": ("scene.xml", "scenes.xml", "there is no such file"),
    "unknown unit": ("sigma = 1e-4", 'sigma = 1e-4\nunit = "furlong"', "is no unit of position"),
    "columns": ('"x", "y", "z"', '"x", "y"', "a position has 3 columns"),
    "no sigma": ("sigma = 1e-4\n", "", "sigma is missing"),
    "sigma": ("sigma = 1e-4", "sigma = 0", "sigma = 0: must be above 0"),
    "kind": ("[measure.position]", '[measure.position]\nkind = "place"', "'place': is unknown"),
    "swapped": ("[0.05, 5]", "[5, 0.05]", "two numbers, the smaller one first"),
    "log": ("[0.05, 5]", "[0, 5]", "must be above 0 on a logarithmic scale"),
    "law": ("[0.05, 1]", "[-1, 1]", "friction"),
    "start": ("[0.05, 5]", "[0.05, 5]\nstart = 7", "start = 7"),
    "prior": ("[0.05, 5]", "[0.05, 5]\nprior = [1, 0]", "standard deviation above 0"),
    "times": ("[0.05, 5]", '[0.05, 5]\ntimes = "k"', "is no other parameter"),
    "no target": ('target = "volcontact/pair/p/damping"', "", "target is missing"),
    "method": ("[identify]", '[estimator]\nmethod = "magic"\n[identify]', "'magic': is unknown"),
    "loss": (
        "[identify]",
        '[estimator]\nloss = "absolute"\n[identify]',
        "least squares needs a smooth loss",
    ),
    "nuisance": (
        "[identify]",
        '[estimator]\nmethod = "cma"\n[nuisance]\nclock = 1e-3\n[identify]',
        "by least squares alone",
    ),
    "profile": ("[identify]", '[uncertainty]\nprofile = ["x"]\n[identify]', "is no parameter"),
    "judge": (
        'time = "t"',
        'time = "t"\nfit = [0, 1]\njudge = [1]',
        "trial '1' is fitted to as well",
    ),
    "twice": ('time = "t"', 'time = "t"\nfit = [1, 1]', "stands there twice"),
    "quat": ("[identify]", "[frame]\nquat = [1, 1, 0, 0]\n[identify]", "of length 1"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_line_is_told(study, case):
    old, new, said = WRONG[case]
    with pytest.raises(vc.StudyError) as told:
        read_settings(changed(study, old, new))
    assert said in str(told.value)
    assert "\n" not in str(told.value)


SCENES = {
    "target": ("volcontact/pair/p/damping", "volcontact/pair/p/dampin", "no such number"),
    "body": ('of = "ball"', 'of = "bal"', "no body 'bal'; did you mean 'ball'?"),
    "column": ('"x", "y"', '"px", "y"', "there is no column 'px'"),
    "trial": ('time = "t"', 'time = "t"\nfit = [7]', "there is no trial '7'"),
    "order": (
        'columns = ["qw", "qx", "qy", "qz"]',
        'columns = ["qx", "qy", "qz", "qw"]',
        'the measured spin fits "xyzw"',
    ),
    "window": ("[identify]", "[window]\nduration = 0.001\n[identify]", "less than two samples"),
    "moves nothing": (
        'target = "volcontact/pair/p/damping"\nbounds = [0.05, 5]',
        'target = "geom/floor/size/2"\nbounds = [0.05, 5]',
        "moves nothing: from 0.545 to 4.5",
    ),
}


@pytest.mark.parametrize("case", SCENES)
def test_what_scene_and_measurements_do_not_have_is_told(study, case):
    old, new, said = SCENES[case]
    with pytest.raises(vc.StudyError) as told:
        check(read_settings(changed(study, old, new)))
    assert said in str(told.value)


@pytest.mark.parametrize(
    ("place", "value", "said"),
    [
        ((3, 2), np.nan, "trial 0: column 'x' has nan at sample 3"),
        ((4, 1), 0.0, "two samples have the time 0 s"),
        ((2, 5), 0.5, "a quaternion has length 1"),
    ],
)
def test_measurements_that_cannot_be_are_told(tmp_path, rows, place, value, said):
    bad = rows.copy()
    bad[place] = value
    with pytest.raises(vc.StudyError, match=said):
        read_trials(read_settings(write_study(tmp_path, bad)))


def test_trial_of_one_sample_is_told(tmp_path, rows):
    with pytest.raises(vc.StudyError, match="has 1 samples; a trial needs at least two"):
        read_trials(read_settings(write_study(tmp_path, rows[:1])))


def test_empty_cells_are_missing_samples(tmp_path, rows):
    with_holes = rows.astype(object)
    with_holes[5, 3] = None
    trials = read_trials(read_settings(write_study(tmp_path, with_holes)))
    position, turn = trials[0].samples["position"], trials[0].samples["orientation"]
    assert len(position.index) == len(turn.index) - 1
    assert 5 not in position.index
    np.testing.assert_array_equal(position.values[5], rows[6, 2:5])


def test_units_frames_and_orders_are_understood(tmp_path, rows):
    """The same motion in millimetres, milliseconds, x y z w and a frame turned about z."""
    plain = read_trials(read_settings(write_study(tmp_path, rows)))[0]
    turned = rows.copy()
    turned[:, 1] *= 1000.0
    turned[:, 2], turned[:, 3] = 1000.0 * (rows[:, 3] - 0.5), -1000.0 * rows[:, 2]
    turned[:, 4] *= 1000.0
    half = np.sqrt(0.5)  # a quarter back about z, then the measured turn
    w, x, y, z = rows[:, 5:9].T
    turned[:, 5:9] = half * np.array([x + y, y - x, z - w, w + z]).T
    text = STUDY.replace('time = "t"', 'time = "t"\ntime_unit = "ms"')
    text = text.replace('"z"]\nsigma = 1e-4', '"z"]\nunit = "mm"\nsigma = 0.1')
    text = text.replace("sigma = 1e-3", 'sigma = 1e-3\norder = "xyzw"')
    text += f"\n[frame]\npos = [0, 0.5, 0]\nquat = [{half}, 0, 0, {half}]\n"
    settings = read_settings(write_study(tmp_path, turned, text))
    assert settings.measures[0].sigma == pytest.approx(1e-4)
    again = read_trials(settings)[0]
    np.testing.assert_allclose(again.times, plain.times, atol=1e-12)
    for name in ("position", "orientation"):
        one, two = again.samples[name].values, plain.samples[name].values
        np.testing.assert_allclose(one, two, atol=1e-12)


def test_impacts_end_windows(study):
    settings = read_settings(
        changed(study, "[identify]", "[window]\nimpacts = 1\nacceleration = 15\n[identify]")
    )
    trial = read_trials(settings)[1]
    hits = impacts(settings, trial)
    # Thrown down at .3 m/s from 12 mm above the floor it touches after 28 ms, at .57 m/s.
    touch = (np.sqrt(0.09 + 2 * 9.81 * 0.012) - 0.3) / 9.81
    # So soft a ball takes a second sample until its force is felt.
    assert touch - 0.007 <= hits[0] <= touch + 0.014
    cut = windowed(settings, [trial])[0]
    end = hits[1] if len(hits) > 1 else trial.times[-1]
    assert cut.times[-1] == pytest.approx(end)


def test_segments_share_their_nodes(study):
    settings = read_settings(changed(study, "[identify]", "[window]\nsegment = 0.04\n[identify]"))
    trial = read_trials(settings)[0]
    parts = windowed(settings, [trial])
    assert sum(len(part.times) - 1 for part in parts) == len(trial.times) - 1
    for one, two in itertools.pairwise(parts):
        np.testing.assert_array_equal(
            one.samples["position"].values[-1], two.samples["position"].values[0]
        )


def test_fields_of_laws_have_bounds_of_their_own(tmp_path, rows):
    text = STUDY.replace("bounds = [1e6, 1e8]\n", "")
    given = read_settings(write_study(tmp_path, rows, text)).parameters[0]
    assert (given.low, given.high, given.log) == (1e5, 1e11, True)


def test_every_field_of_every_law_has_bounds():
    import inspect

    from volcontact import Bristle, ElasticCoulomb, HuntCrossley, RegularizedCoulomb
    from volcontact.identify.ranges import DEFAULTS, reason_against

    for law in (HuntCrossley, ElasticCoulomb, Bristle, RegularizedCoulomb):
        fields = {name for name, item in inspect.getmembers(law) if isinstance(item, property)}
        assert fields - {"name", "state_size", "coupling"} <= DEFAULTS.keys()
    for field, (low, high, _) in DEFAULTS.items():
        assert not reason_against(field, low) and not reason_against(field, high)


def test_path_of_no_file():
    with pytest.raises(FileNotFoundError, match="no such study"):
        read_settings("nowhere.toml")
    with pytest.raises(vc.StudyError, match=r"study\.toml"):
        parse_settings("[identify", None)
