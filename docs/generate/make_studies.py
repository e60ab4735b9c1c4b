# SPDX-License-Identifier: Apache-2.0
"""Draws the figures of docs/studies from the rows of the two studies, and prints the numbers.

./run volcontact study run mjcf_models/studies/NAME/study.toml --out build/studies/NAME  # both
./run python docs/generate/make_studies.py
"""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pandas
from matplotlib.figure import Figure

from volcontact.report.palette import NATIVE, VOLUMETRIC
from volcontact.report.svg import standing_alone
from volcontact.study import Study, figures
from volcontact.study.estimates import sensitivity, wilson

ROOT = Path(__file__).resolve().parents[2]
ROWS = ROOT / "build" / "studies"
PAGES = ROOT / "docs" / "studies"
PEG, BATTERY = "peg_in_hole_misalignment", "battery_insert_0g"
RADIUS, DEPTH, CLEARANCE = 0.004, 0.003, 0.02e-3  # of the peg, at the start, of the hole [m]
ACROSS, TURNING, PUSH = 1e4, 10.0, 10.0  # the wrist [N/m], [N m/rad], [N]


def friction_share(rows: pandas.DataFrame, *, measured: bool) -> np.ndarray:
    """Largest friction of the two contacts over the push: the peg jams above 1.

    The balance of the jamming diagram, with vectors across the hole: the contacts at the end and at
    the rim push with N1 and N2, where N1 + N2 + F = 0 and, with friction up the peg at radius r,
    N2 = (e_z x M + mu r F) / l. In one plane that is |M/(r Fz) - mu (1 + lambda) Fx/Fz| < lambda.

    Args:
        rows: of the study.
        measured: force, moment and depth by the pose at the end; else by that of a rigid peg,
            turned by the clearance over the depth.
    """
    friction = rows["friction"].to_numpy()
    if measured:
        depth = (DEPTH - rows["depth"]).to_numpy()
        force = np.array([rows[f"misalignment_{a}"] - rows[a] for a in "xy"]) * ACROSS
        moment = TURNING * np.array([-rows["tilt_x"], rows["angle"] - rows["tilt_y"]])
    else:
        depth = np.full(len(rows), DEPTH)
        force = np.array([rows["misalignment_x"], rows["misalignment_y"]]) * ACROSS
        angle = rows["angle"].to_numpy()
        left = np.sign(angle) * np.maximum(np.abs(angle) - CLEARANCE / DEPTH, 0.0)
        moment = TURNING * np.array([0.0 * left, left])
    rim = (np.array([-moment[1], moment[0]]) + friction * RADIUS * force) / depth
    end = -force - rim
    share: np.ndarray = friction * (np.hypot(*rim) + np.hypot(*end)) / PUSH
    return share


def peg() -> None:
    """The jam boundary beside the diagram."""
    rows = Study.rows(ROWS / PEG).to_pandas()
    jams = (rows["outcome"] != "success").to_numpy()
    low, high = wilson(int(jams.sum()), len(rows))
    print(f"peg: {jams.sum()} of {len(rows)} jam, {jams.mean():.4f} ({low:.4f} to {high:.4f})")
    figure = Figure(figsize=(9.0, 3.4), layout="constrained")
    for place, measured in enumerate((False, True)):
        share = friction_share(rows, measured=measured)
        inside = share < 1.0
        same = (inside != jams).mean()
        print(
            f"  measured pose {measured}: inside {inside.sum()}, jam {jams[inside].sum()}; "
            f"outside {(~inside).sum()}, jam {jams[~inside].sum()}; agree {same:.3f}"
        )
        axes = figure.add_subplot(1, 2, place + 1)
        edges = np.array([0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2, 2.5, 3, 3.5, 4, 5, 6])
        middle = 0.5 * (edges[1:] + edges[:-1])
        points = []
        for a, b in itertools.pairwise(edges):
            here = (share >= a) & (share < b)
            bounds = wilson(int(jams[here].sum()), int(here.sum())) if here.any() else (0.0, 1.0)
            points.append((jams[here].mean() if here.any() else np.nan, *bounds))
            if here.any():
                print(f"    {a:.2f} to {b:.2f}: {here.sum()} trials, {jams[here].mean():.3f} jam")
        mean, least, most = np.array(points).T
        axes.errorbar(middle, mean, [mean - least, most - mean], fmt="o-", color=VOLUMETRIC)
        axes.axvline(1.0, color=NATIVE)
        axes.set_xlabel("friction of both contacts / push, by the diagram [-]")
        axes.set_ylabel("share of trials that jam [-]")
        title = "with the pose at the end" if measured else "rigid peg, before the trial"
        axes.set_title(title, fontsize=10)
    (PAGES / f"{PEG}.svg").write_text(standing_alone(figure), encoding="utf-8")
    columns = [rows["angle"].to_numpy(), rows["friction"].to_numpy()]
    drawn = figures.maps(*columns, ~jams, None, ["angle [rad]", "friction [-]"])
    (PAGES / f"{PEG}_map.svg").write_text(standing_alone(drawn), encoding="utf-8")


def battery() -> None:
    """What costs the battery box its seat."""
    table = Study.rows(ROWS / BATTERY)
    rows = table.to_pandas()
    study = Study(ROOT / "mjcf_models" / "studies" / BATTERY / "study.toml")
    good = int(rows["success"].sum())
    low, high = wilson(good, len(rows))
    print(f"battery: {good} of {len(rows)}, {good / len(rows):.4f} ({low:.4f} to {high:.4f})")
    print(rows["outcome"].value_counts().to_string())
    print(f"  peak force {rows['peak_force'].max():.1f} N, torque {rows['peak_torque'].max():.1f}")
    for response in ("success", "peak_force", "peak_torque"):
        found = sensitivity(study.settings, table, response)
        assert found is not None
        print(" ", response, *(f"{n} {v:.3f}" for n, v in zip(found.names, found.values)))  # noqa: B905
        if response == "success":
            drawn = figures.bars(found)
            (PAGES / f"{BATTERY}_indices.svg").write_text(standing_alone(drawn), encoding="utf-8")
    guides = rows[[n for n in rows.columns if n.startswith("guide_")]].max(axis=1).to_numpy()
    edges = 1e-3 * np.array([-1, 0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0])
    figure = Figure(figsize=(5.6, 3.2), layout="constrained")
    axes = figure.add_subplot()
    for a, b in itertools.pairwise(edges):
        here = (guides > a) & (guides <= b)
        if not here.any():
            continue
        seats = int(rows["success"][here].sum())
        low, high = wilson(seats, int(here.sum()))
        share = seats / here.sum()
        print(f"  nearest guide {1e3 * a:.1f} to {1e3 * b:.1f} mm: {seats} of {here.sum()}")
        middle = 500.0 * (a + b)
        bars = [[share - low], [high - share]]
        axes.errorbar([middle], [share], bars, fmt="o", color=VOLUMETRIC)
    axes.set_xlabel("how far the nearest corner guide stands too near [mm]")
    axes.set_ylabel("share of trials that seat [-]")
    axes.set_ylim(0.0, 1.0)
    (PAGES / f"{BATTERY}.svg").write_text(standing_alone(figure), encoding="utf-8")


if __name__ == "__main__":
    peg()
    battery()
