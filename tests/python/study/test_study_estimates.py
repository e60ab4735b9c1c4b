# SPDX-License-Identifier: Apache-2.0
"""Probabilities, rare events, searches and indices of studies whose answers are known."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pyarrow as pa
import pytest
from study_files import FUNCTION_STUDY, function_study

import volcontact as vc
from volcontact.study.adaptive import importance
from volcontact.study.designs import Design
from volcontact.study.estimates import first_order, rare_event, sensitivity, wilson
from volcontact.study.file.reading import parse_study

RARE = 1e-5
SCORE = 4.264890793922825  # of a standard normal, exceeded with probability 1e-5
NORMALS = FUNCTION_STUDY.replace('distribution = "uniform"\nlow = 1.0\nhigh = 3.0', "YY").replace(
    "YY", 'distribution = "norm"'
)


def test_wilson_interval_by_hand():
    low, high = wilson(8, 10)
    assert (low, high) == pytest.approx((0.4901625, 0.9433178), abs=1e-6)  # [Wilson1927]
    assert wilson(0, 5)[0] == 0.0 and wilson(5, 5)[1] == 1.0


def test_intervals_hold_the_probability_of_a_closed_form(tmp_path):
    """P(x > 1) of a standard normal: the 95 % interval holds it in 90 to 99 of 100 seeds."""
    true = 0.5 * math.erfc(1.0 / math.sqrt(2.0))
    held = 0
    settings = parse_study(FUNCTION_STUDY, function_study(tmp_path).parent)
    for seed in range(100):
        sample = dataclasses.replace(settings.sample, seed=seed, trials=1000)
        design = Design(dataclasses.replace(settings, sample=sample))
        values = design.values(np.arange(1000))
        low, high = wilson(int(np.count_nonzero(values["x"] > 1.0)), 1000)
        held += low <= true <= high
    assert 90 <= held <= 99


def rare(folder, seed, threshold, response, trials=10000, text=NORMALS):
    """The estimate of the method, and how many trials it took."""
    text = text.replace(
        "seed = 3",
        f'seed = {seed}\nmethod = "importance"\nresponse = "sum"\nthreshold = {threshold}\n'
        "round = 1000",
    )
    steps = importance(parse_study(text, function_study(folder).parent))
    answer, columns = None, []
    while sum(len(part["x"]) for part in columns) < trials:
        values = steps.send(answer)
        answer = response(values["x"], values["y"])
        columns.append({**values, "sum": answer})
    table = pa.table({name: np.concatenate([p[name] for p in columns]) for name in columns[0]})
    return rare_event(table, "sum", threshold)


@pytest.mark.parametrize(
    ("threshold", "response"),
    [
        (math.sqrt(2.0) * SCORE, lambda x, y: x + y),  # one direction
        (-2.0 * math.log(RARE), lambda x, y: x**2 + y**2),  # all around
    ],
)
def test_rare_event_of_known_probability(threshold, response, tmp_path):
    """1e-5 within a factor of 1.5, with fewer than 20,000 trials, for 20 seeds."""
    held = 0
    for seed in range(20):
        found = rare(tmp_path, seed, threshold, response)
        assert found.trials < 20000 and found.events > 50
        assert RARE / 1.5 < found.probability < RARE * 1.5
        held += found.low <= RARE <= found.high
    assert held >= 16


def test_rare_event_by_a_rare_choice(tmp_path):
    """What makes the event is a choice of one in a hundred, and one tail of a normal."""
    text = NORMALS.replace('[vary.y]\ndistribution = "norm"', "[vary.y]\n@")
    text = text.replace("@", "choices = [0.0, 2.0]\nweights = [0.99, 0.01]")
    threshold = 5.09
    tails = [0.5 * math.erfc((threshold - y) / math.sqrt(2.0)) for y in (0.0, 2.0)]
    true = 0.99 * tails[0] + 0.01 * tails[1]
    assert 0.9e-5 < true < 1.1e-5 and 0.99 * tails[0] < 0.02 * true
    held = 0
    for seed in range(20):
        found = rare(tmp_path, seed, threshold, lambda x, y: x + y, text=text)
        assert true / 1.5 < found.probability < true * 1.5
        held += found.low <= true <= found.high
    assert held >= 16


def test_rare_event_of_a_study_that_was_interrupted(tmp_path):
    """The rounds follow from rows: resumed without its last parts it is the same study."""
    text = NORMALS.replace(
        "seed = 3",
        f'seed = 3\nmethod = "importance"\nresponse = "sum"\nthreshold = {math.sqrt(2) * SCORE}\n'
        "round = 500",
    )
    study = vc.Study(function_study(tmp_path, text), trials=5000)
    study.run(tmp_path / "out", engine="serial")
    rows = study.rows(tmp_path / "out")
    found = rare_event(rows, "sum", math.sqrt(2) * SCORE)
    assert RARE / 1.5 < found.probability < RARE * 1.5
    parts = sorted((tmp_path / "out" / "trials").glob("*.parquet"))
    assert len(parts) >= 10
    for part in (parts[3], *parts[6:]):
        part.unlink()
    study.resume(tmp_path / "out", engine="serial")
    assert study.rows(tmp_path / "out").equals(rows)


@pytest.mark.parametrize(("direction", "best"), [("maximise", 1.0), ("minimise", -1.0)])
def test_search_finds_the_worst(direction, best, tmp_path):
    text = FUNCTION_STUDY.replace(
        'distribution = "norm"', 'distribution = "uniform"\nlow = -1\nhigh = 1'
    )
    text = text.replace(
        "seed = 3", f'seed = 3\nmethod = "optimise"\nresponse = "sum"\ndirection = "{direction}"'
    )
    study = vc.Study(function_study(tmp_path, text), trials=100)
    study.run(tmp_path / "out", engine="serial")
    x = study.rows(tmp_path / "out")["x"].to_numpy()
    random = np.median(np.abs(x[:20] - best))
    assert np.median(np.abs(x[-20:] - best)) < 0.5 * random


@pytest.mark.parametrize("method", ["saltelli", "monte_carlo", "morris"])
def test_indices_of_a_sum(method, tmp_path):
    """x + y, with variances 1 and 1/3: x decides three quarters."""
    text = FUNCTION_STUDY.replace("seed = 3", f'seed = 3\nmethod = "{method}"')
    study = vc.Study(function_study(tmp_path, text), trials=4096 if method != "morris" else 300)
    study.run(tmp_path / "out", engine="serial")
    found = sensitivity(study.settings, study.rows(tmp_path / "out"), "sum")
    assert found is not None and found.names == ("x", "y")
    assert (found.errors > 0).all()
    if method != "morris":
        assert found.values == pytest.approx([0.75, 0.25], abs=0.05)
        assert (np.abs(found.values - [0.75, 0.25]) < 2.0 * found.errors).all()


def test_first_order_of_what_decides_nothing():
    generator = np.random.default_rng(1)
    values, errors = first_order([generator.random(2000)], generator.random(2000))
    assert abs(values[0]) < 2.0 * errors[0] < 0.1
