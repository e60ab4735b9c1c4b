# SPDX-License-Identifier: Apache-2.0
"""Figures of the report of an identification."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from volcontact.identify import rotations
from volcontact.identify.estimators.mcmc import Chain
from volcontact.identify.estimators.scales import Box
from volcontact.identify.measurements import Trial
from volcontact.identify.settings import Settings
from volcontact.identify.units import SI
from volcontact.report.palette import NATIVE, VOLUMETRIC

_FRAMES = 150  # of a motion


def beside(settings: Settings, trial: Trial, predicted: dict[str, np.ndarray]) -> Figure:
    """Measured as dots, simulated as lines."""
    shown = [each for each in settings.measures if each.weight]
    figure = Figure(figsize=(8, 2.4 * len(shown)), layout="constrained")
    for axes, each in zip(figure.subplots(len(shown), 1, squeeze=False)[:, 0], shown, strict=True):
        samples = trial.samples[each.name]
        measured, simulated = samples.values, predicted[each.name]
        if each.kind == "orientation" and len(measured):
            first = rotations.inverse(measured[0])
            measured = np.degrees(rotations.vector(rotations.product(first, measured)))
            simulated = np.degrees(rotations.vector(rotations.product(first, simulated)))
        count = simulated.shape[1]
        for column in range(count):
            color = f"C{column}"
            label = "xyz"[column] if count == 3 else ""
            axes.plot(trial.times, simulated[:, column], color=color, lw=1.2, label=label)
            axes.plot(trial.times[samples.index], measured[:, column], ".", color=color, ms=3)
        unit = "deg" if each.kind == "orientation" else SI[each.kind]
        axes.set_ylabel(f"{each.name} [{unit}]" if unit else each.name)
        if count == 3:
            axes.legend(frameon=False, ncols=3, fontsize="small")
    axes.set_xlabel("time [s]")
    return figure


def histograms(settings: Settings, raw: list[dict[str, np.ndarray]]) -> Figure:
    """Sizes of the errors of all samples, and of the means of trials."""
    shown = [each for each in settings.measures if each.weight]
    figure = Figure(figsize=(8, 2.2 * len(shown)), layout="constrained")
    for axes, each in zip(figure.subplots(len(shown), 1, squeeze=False)[:, 0], shown, strict=True):
        size = [np.linalg.norm(one[each.name], axis=1) for one in raw]
        every = np.concatenate(size)
        means = np.array([np.mean(one) for one in size if len(one)])
        top = max(float(np.nanquantile(every, 0.99)), float(np.nanmax(means)), 1e-300)
        bins = np.linspace(0.0, top, 40)
        for data, color, label in ((every, VOLUMETRIC, "samples"), (means, NATIVE, "trials")):
            weights = np.full(len(data), 1.0 / len(data))
            axes.hist(data, bins, weights=weights, histtype="step", color=color, label=label)
        axes.set_xlabel(f"error of {each.name} [{SI[each.kind]}]")
        axes.legend(frameon=False)
    return figure


def correlations(names: list[str], matrix: np.ndarray) -> Figure:
    """How parameters make up for each other."""
    side = 1.5 + 0.6 * len(names)
    figure = Figure(figsize=(side + 1, side), layout="constrained")
    axes = figure.subplots()
    image = axes.imshow(matrix, vmin=-1, vmax=1, cmap="RdBu")
    axes.set_xticks(range(len(names)), names, rotation=45, ha="right")
    axes.set_yticks(range(len(names)), names)
    for i in range(len(names)):
        for j in range(len(names)):
            axes.text(j, i, f"{matrix[i, j]:.2f}", ha="center", va="center", fontsize=8)
    figure.colorbar(image, label="correlation")
    return figure


def chain(settings: Settings, box: Box, walked: Chain) -> Figure:
    """Where the walkers of a chain were, step by step, for each parameter."""
    count = len(settings.parameters)
    figure = Figure(figsize=(8, 1.4 * count), layout="constrained")
    steps, walkers = walked.samples.shape[:2]
    every = max(1, steps // 200), max(1, walkers // 8)
    seen = walked.samples[:: every[0], :: every[1], :count]
    values = [[box.values(point) for point in row] for row in seen]
    axes = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    for place, each in zip(axes, settings.parameters, strict=True):
        lines = [[point[each.name] for point in row] for row in values]
        place.plot(walked.burn + every[0] * np.arange(len(seen)), lines, lw=0.5, color=VOLUMETRIC)
        place.set_ylabel(each.name)
        if each.log:
            place.set_yscale("log")
    axes[-1].set_xlabel("step")
    return figure


def profile(name: str, values: list[float], rises: list[float], settings: Settings) -> Figure:
    """The least cost over one parameter."""
    from scipy import stats

    figure = Figure(figsize=(5, 2.6), layout="constrained")
    axes = figure.subplots()
    axes.plot(values, rises, "o-", color=VOLUMETRIC)
    level = 0.5 * float(stats.chi2.ppf(settings.uncertainty.level, 1))
    axes.axhline(level, color=NATIVE, lw=1, ls="--")
    axes.set_ylim(0, max(3 * level, 1e-12))
    if next(each for each in settings.parameters if each.name == name).log:
        axes.set_xscale("log")
    axes.set_xlabel(name)
    axes.set_ylabel("rise of the cost")
    return figure


def motion(
    settings: Settings, trial: Trial, predicted: dict[str, np.ndarray]
) -> dict[str, Any] | None:
    """Measured and simulated poses of the first body that has both, for the page to draw."""
    by = {(each.of, each.kind): each for each in reversed(settings.measures) if each.weight}
    bodies = [of for of, kind in by if kind == "position" and (of, "orientation") in by]
    if not bodies:
        return None
    place, turn = by[bodies[0], "position"].name, by[bodies[0], "orientation"].name
    a, b = trial.samples[place], trial.samples[turn]
    common, at_a, at_b = np.intersect1d(a.index, b.index, return_indices=True)
    every = max(1, len(common) // _FRAMES)
    common, at_a, at_b = common[::every], at_a[::every], at_b[::every]
    simulated = np.nan_to_num(np.hstack([predicted[place][common], predicted[turn][common]]))
    measured = np.hstack([a.values[at_a], b.values[at_b]])
    return {
        "half": _half_sizes(settings, bodies[0]),
        "step": float(np.mean(np.diff(trial.times[common]))) if len(common) > 1 else 0.02,
        "measured": np.round(measured, 5).tolist(),
        "simulated": np.round(simulated, 5).tolist(),
    }


def _half_sizes(settings: Settings, body: str) -> list[float]:
    """Half of a box about the body that stands for it."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(settings.scene))
    number = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_BODY), body)
    half = np.full(3, 1e-3)
    for geom in range(model.ngeom):
        if model.geom_bodyid[geom] == number:
            size = model.geom_size[geom] if int(model.geom_type[geom]) == 6 else None
            reach = size if size is not None else np.full(3, model.geom_rbound[geom])
            half = np.maximum(half, np.abs(model.geom_pos[geom]) + reach)
    return [float(x) for x in half]
