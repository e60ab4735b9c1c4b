# SPDX-License-Identifier: Apache-2.0
"""Chains in linear problems: posteriors are normal, or Student's where the noise is unknown."""

import csv
import json

import numpy as np
import pytest

import volcontact as vc
from volcontact.identify.estimators.mcmc import LENGTH, Request, walk
from volcontact.identify.reading import read_settings
from volcontact.identify.run import run

MIDDLE = np.array([0.5, 0.4])
DESIGN = np.column_stack([np.ones(12), np.linspace(0.0, 1.0, 12)])
COVARIANCE = 0.01**2 * np.linalg.inv(DESIGN.T @ DESIGN)


def normal(points):
    shift = points - MIDDLE
    return -0.5 * np.einsum("mi,ij,mj->m", shift, np.linalg.inv(COVARIANCE), shift)


def request(steps=3000, **given):
    return Request(**{"steps": steps, "walkers": 16, "burn": 200, "seed": 1} | given)


def test_chain_of_a_normal_density_has_its_moments():
    chain = walk(normal, MIDDLE, 0.01 * np.ones(2), request())
    assert chain.enough
    assert chain.finding() == ""
    samples = chain.samples.reshape(-1, 2)
    independent = len(samples) / chain.times.max()
    sigma = np.sqrt(np.diag(COVARIANCE))
    error = 4.0 / np.sqrt(independent)  # four standard deviations of a mean
    np.testing.assert_allclose(samples.mean(axis=0), MIDDLE, atol=error * sigma.min())
    found = np.cov(samples.T)
    np.testing.assert_allclose(np.diag(found), sigma**2, rtol=error * np.sqrt(2.0))
    r = found[0, 1] / np.sqrt(found[0, 0] * found[1, 1])
    truth = COVARIANCE[0, 1] / sigma.prod()
    assert r == pytest.approx(truth, abs=error * (1.0 - truth**2))


def test_autocorrelation_time_is_that_of_a_known_process():
    """Of x' = a x + noise it is (1 + a) / (1 - a)."""
    import emcee

    generator, a = np.random.default_rng(5), 0.8
    x = np.zeros((20000, 16, 1))
    noise = generator.standard_normal(x.shape)
    for step in range(1, len(x)):
        x[step] = a * x[step - 1] + noise[step]
    time = emcee.autocorr.integrated_time(x, tol=0, quiet=True)
    assert time[0] == pytest.approx((1.0 + a) / (1.0 - a), rel=0.05)


def test_short_chain_claims_nothing():
    chain = walk(normal, MIDDLE, 0.01 * np.ones(2), request(steps=60, burn=10))
    assert not chain.enough
    assert "too short" in chain.finding()
    assert f"{LENGTH} times" in chain.finding()


def test_chain_goes_on_where_it_was_stopped(tmp_path):
    whole = walk(normal, MIDDLE, 0.01 * np.ones(2), request(100, file=tmp_path / "a", burn=5))
    calls = 0

    def stopped(points):
        nonlocal calls
        calls += 1
        if calls > 150:
            raise KeyboardInterrupt
        return normal(points)

    asked = request(100, file=tmp_path / "b", burn=5)
    with pytest.raises(KeyboardInterrupt):
        walk(stopped, MIDDLE, 0.01 * np.ones(2), asked)
    again = walk(normal, MIDDLE, 0.01 * np.ones(2), asked)
    np.testing.assert_array_equal(again.samples, whole.samples)
    assert again.accepted == whole.accepted
    with pytest.raises(vc.StudyError, match="of another study"):
        walk(normal, MIDDLE, 0.01 * np.ones(2), request(100, file=tmp_path / "b", sign="x"))


def test_too_few_walkers_are_told():
    with pytest.raises(vc.StudyError, match="walkers = 5: 2 unknowns need at least 6"):
        walk(normal, MIDDLE, 0.01 * np.ones(2), request(walkers=5))


SCENE = """\
<mujoco>
  <option timestep="0.01" gravity="0 0 -5"/>
  <worldbody>
    <body name="mass">
      <joint name="slide" type="slide" axis="0 0 1"/>
      <geom name="mass" type="sphere" size="0.05" mass="1"/>
    </body>
  </worldbody>
</mujoco>
"""
STUDY = """\
[identify]
scene = "scene.xml"
contact = "native"
[measurements]
file = "fall.csv"
[measure.height]
kind = "joint"
of = "slide"
columns = ["z"]
sigma = 1e-3
[parameter.gravity]
target = "option/gravity/2"
bounds = [-15, -2]
[nuisance]
velocity = 0.05
[estimator]
starts = 1
[uncertainty]
scale = {scale}
mcmc = 2100
burn = 100
walkers = 6
"""


def fall(folder, scale):
    """Heights of a mass that falls, with noise, and the linear model of the samples."""
    steps = np.arange(0, 40, 2)
    gravity = 1e-4 * steps * (steps + 1) / 2  # of the semi-implicit Euler steps
    noise = 1e-3 * np.random.default_rng(3).standard_normal(len(steps))
    noise[0] = 0.0  # which the start is taken from
    z = -9.0 * gravity + noise
    with (folder / "fall.csv").open("w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(["t", "z"])
        writer.writerows(
            (repr(float(t)), repr(float(h))) for t, h in zip(1e-2 * steps, z, strict=True)
        )
    (folder / "scene.xml").write_text(SCENE)
    (folder / "study.toml").write_text(STUDY.format(scale=str(scale).lower()))
    return z, np.column_stack([gravity, 1e-2 * steps])


def start_speed(z):
    """The parabola through the first five samples, from which the study starts."""
    powers = np.vander(0.02 * np.arange(5), 3, increasing=True)
    return np.linalg.lstsq(powers, z[:5], rcond=None)[0][1]


def test_study_has_the_posterior_of_its_linear_model(tmp_path):
    pytest.importorskip("emcee")
    z, design = fall(tmp_path, scale=False)
    found = run(read_settings(tmp_path / "study.toml"), tmp_path / "out", workers=1)
    chain = found.summary["chain"]
    assert chain["enough"], chain
    assert found.summary["uncertainty"] == "MCMC"
    # Errors are less of sigma, the speed known before to 0.05 m/s about that of the start.
    v0 = start_speed(z)
    rows = np.concatenate([design / 1e-3, [[0.0, 1.0 / 0.05]]])
    right = np.append((z - design[:, 1] * v0) / 1e-3, 0.0)
    covariance = np.linalg.inv(rows.T @ rows)
    mean = covariance @ rows.T @ right
    sigma = np.sqrt(covariance[0, 0])
    each = found.summary["parameters"]["gravity"]
    independent = 6 * chain["steps"] / chain["autocorrelation"]["gravity"]
    assert each["deviation"] == pytest.approx(sigma, rel=4.0 / np.sqrt(2.0 * independent))
    # Of a quantile at 2.5 % the standard deviation is sqrt(q (1 - q) / n) over the density there.
    error = 4.0 * np.sqrt(0.025 * 0.975 / independent) / 0.0584 * sigma
    assert each["low"] == pytest.approx(mean[0] - 1.96 * sigma, abs=error)
    assert each["high"] == pytest.approx(mean[0] + 1.96 * sigma, abs=error)
    assert "autocorrelation time" in (tmp_path / "out" / "report.html").read_text()
    kept = json.loads((tmp_path / "out" / "identified.json").read_text())
    assert kept["chain"] == chain


def test_unknown_noise_widens_the_posterior_to_students(tmp_path):
    """With the speed known, gravity alone: the scale is that of the residuals, n degrees less 1."""
    z, design = fall(tmp_path, scale=True)
    text = STUDY.format(scale="true").replace("velocity = 0.05", "velocity = 0")
    (tmp_path / "study.toml").write_text(text.replace("sigma = 1e-3", "sigma = 7"))
    found = run(read_settings(tmp_path / "study.toml"), None, workers=1)
    y = z - design[:, 1] * start_speed(z)
    column = design[:, 0]
    mean = column @ y / (column @ column)
    free = len(z) - 1
    spread = np.sqrt(np.sum((y - mean * column) ** 2) / free / (column @ column))
    from scipy import stats

    each, chain = found.summary["parameters"]["gravity"], found.summary["chain"]
    assert chain["enough"]
    independent = 6 * chain["steps"] / chain["autocorrelation"]["gravity"]
    error = 4.0 * np.sqrt(0.025 * 0.975 / independent) / 0.0584 * spread
    reach = stats.t.ppf(0.975, free) * spread
    assert each["low"] == pytest.approx(mean - reach, abs=error)
    assert each["high"] == pytest.approx(mean + reach, abs=error)


def test_chain_needs_a_likelihood(tmp_path):
    fall(tmp_path, scale=False)
    text = STUDY.format(scale="false").replace("starts = 1", 'method = "cma"')
    (tmp_path / "study.toml").write_text(text.replace("[nuisance]\nvelocity = 0.05\n", ""))
    with pytest.raises(vc.StudyError, match="mcmc: needs errors with a likelihood"):
        read_settings(tmp_path / "study.toml")
