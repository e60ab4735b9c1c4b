# SPDX-License-Identifier: Apache-2.0
"""Pictures of the pages of engines and laws, of what the core computes."""

from __future__ import annotations

import csv
from collections.abc import Callable
from functools import partial

import numpy as np
from make_accuracy import RESULTS
from make_concepts import Drawn, bounce, draw_cells, draw_chords, draw_normals, draw_rays
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from parts.concepts_sections import INK, arrow, distance, draw_section, pose

import volcontact as vc
from volcontact.report.palette import NATIVE, VOLUMETRIC

STIFFNESS, FRICTION = 1e7, 0.3  # [N/m^3], [-]


# ---- Engines -------------------------------------------------------------------------------------


def engine(name: str) -> Drawn:
    """How it sees an overlap, beside its errors of the volume, pair by pair."""
    figure = Figure(figsize=(8.0, 2.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    volume = _IDEA[name](left)
    return figure, [volume, *_errors(right, name)]


def _errors(axes: Axes, name: str) -> list[float]:
    with (RESULTS / "accuracy.csv").open(encoding="utf-8", newline="") as file:
        rows = [
            row for row in csv.DictReader(file) if row["engine"] == name and row["poses"] != "0"
        ]
    shown = []
    for measure, color in (("median", VOLUMETRIC), ("worst", NATIVE)):
        errors = sorted(max(float(row[f"volume_{measure}"]), 1e-16) for row in rows)
        share = (np.arange(len(errors)) + 1.0) / len(errors)
        axes.step(errors, share, where="post", color=color, label=f"{measure} of a pair")
        shown += errors
    axes.set(
        xscale="log", xlabel="error of the volume [-]", ylabel="share of pairs", ylim=(0, 1.02)
    )
    axes.legend(loc="best", fontsize=9)
    return shown


def _ball_in_plane(axes: Axes) -> float:
    plane, ball, at = vc.HalfSpace(), vc.Sphere(radius=0.05), pose(0.0, 0.022)
    draw_section(axes, distance(plane, np.eye(4)), distance(ball, at), (-0.09, 0.09), (-0.05, 0.08))
    found = vc.interference(plane, ball, at)
    axes.plot(0.0, found.centroid[2], "o", color="white", mec=INK, ms=5)
    axes.annotate("", (0.0, 0.0), (0.0, -0.028), arrowprops=dict(arrowstyle="<->", color=INK))
    axes.text(0.003, -0.02, "h")
    return found.volume


def _two_boxes(axes: Axes) -> float:
    a, b, at = vc.Box((0.08, 0.05, 0.03)), vc.Box((0.05, 0.05, 0.03)), pose(0.02, 0.05, 24.0)
    draw_section(axes, distance(a, np.eye(4)), distance(b, at), (-0.09, 0.10), (-0.04, 0.11))
    found = vc.interference(a, b, at)
    for x, z in _cut(_corners(at, 0.05, 0.03), 0.08, 0.03):
        axes.plot(x, z, "o", color="white", mec=INK, ms=4)
    arrow(axes, found.centroid, -0.03 * found.normal, "", NATIVE)
    return found.volume


def _corners(at: np.ndarray, x: float, z: float) -> list[np.ndarray]:
    signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    return [(at @ [i * x, 0.0, j * z, 1.0])[[0, 2]] for i, j in signs]


def _cut(polygon: list[np.ndarray], x: float, z: float) -> list[np.ndarray]:
    """What a rectangle leaves of a polygon: one side after the other."""
    for axis, limit in ((0, x), (1, z)):
        for sign in (-1.0, 1.0):
            depth = [limit - sign * corner[axis] for corner in polygon]
            left = []
            for i, corner in enumerate(polygon):
                before, here, there = polygon[i - 1], depth[i], depth[i - 1]
                if here * there < 0.0:
                    left.append(before + (corner - before) * there / (there - here))
                if here >= 0.0:
                    left.append(corner)
            polygon = left
    return polygon


def _integrated(draw: Callable[..., None], axes: Axes) -> float:
    box, ball, at = (
        vc.Box((0.1, 0.05, 0.04)),
        vc.Ellipsoid((0.06, 0.05, 0.045)),
        pose(0.005, 0.068, 18.0),
    )
    a, b = distance(box, np.eye(4)), distance(ball, at)
    draw_section(axes, a, b, (-0.085, 0.085), (-0.005, 0.12))
    draw(axes, a, b, at)
    return vc.interference(box, ball, at).volume


_IDEA: dict[str, Callable[[Axes], float]] = {
    "closed_form": _ball_in_plane,
    "clip": _two_boxes,
    "lines": partial(_integrated, lambda axes, a, b, at: draw_rays(axes, a, b)),
    "surface_sweep": partial(_integrated, lambda axes, a, b, at: draw_normals(axes, a, b)),
    "columns": partial(_integrated, lambda axes, a, b, at: draw_chords(axes, at)),
    "octree": partial(
        _integrated,
        lambda axes, a, b, at: draw_cells(
            axes, lambda u, v: max(a(u, v), b(u, v)), (-0.075, -0.04), 0.15, 6
        ),
    ),
}


# ---- Laws ----------------------------------------------------------------------------------------


def plot(xlabel: str, ylabel: str) -> tuple[Figure, Axes]:
    """A figure with one pair of axes."""
    figure = Figure(figsize=(6.4, 3.0), layout="constrained")
    axes = figure.subplots()
    axes.set(xlabel=xlabel, ylabel=ylabel)
    return figure, axes


def model_of(
    solid: vc.Box, normal: vc.NormalForce, friction: vc.Friction | None
) -> vc.ContactModel:
    """A solid on a floor."""
    pairs = [vc.Pair(solid, vc.HalfSpace())]
    return vc.ContactModel(pairs=pairs, normal=normal, friction=friction)


def volume_spring() -> Drawn:
    """Force against depth: what the law makes of three shapes."""
    figure, axes = plot("depth [mm]", "normal force [N]")
    depths = np.geomspace(1e-4, 4e-3, 31)
    corner = np.eye(4)
    corner[:3, :3] = _on_its_corner()
    shapes = {
        "flat face, 20 cm²": (vc.Box((0.02, 0.025, 0.02)), np.eye(4), 0.02),
        "ball, R = 50 mm": (vc.Sphere(0.05), np.eye(4), 0.05),
        "corner of a box": (vc.Box((0.02, 0.02, 0.02)), corner, 0.02 * np.sqrt(3.0)),
    }
    shown: list[float] = []
    for (label, (solid, at, height)), color in zip(
        shapes.items(), (INK, VOLUMETRIC, NATIVE), strict=True
    ):
        model = model_of(solid, vc.VolumeSpring(stiffness=STIFFNESS), None)
        forces = []
        for depth in depths:
            at[2, 3] = height - depth
            forces.append(model.evaluate(X_WA=at).force_on_A[2])
        axes.plot(1e3 * depths, forces, color=color, label=label)
        shown += forces
    axes.set(xscale="log", yscale="log")
    axes.legend()
    return figure, shown


def _on_its_corner() -> np.ndarray:
    """A turn that takes (1, 1, 1) up."""
    up = np.ones(3) / np.sqrt(3.0)
    side = np.array([1.0, -1.0, 0.0]) / np.sqrt(2.0)
    return np.array([side, np.cross(up, side), up])


def hunt_crossley() -> Drawn:
    """Restitution over damping times speed: the relation, and bounces in the core."""
    figure, axes = plot("damping times impact speed, a v [-]", "restitution e [-]")
    numbers = np.geomspace(0.02, 10.0, 60)
    axes.plot(numbers, [_restitution(number) for number in numbers], color=INK, label="relation")
    drops = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)
    found = [abs(bounce(vc.HuntCrossley(stiffness=1e8, damping=damping))[2]) for damping in drops]
    axes.plot(drops, found, "o", ms=4, color=VOLUMETRIC, label="balls that fall at 1 m/s")
    axes.set_xscale("log")
    axes.legend()
    return figure, found


def _restitution(number: float) -> float:
    """Root of ln((1 + A)/(1 - e A)) = A (1 + e), by halving."""
    low, high = 0.0, min(1.0, 1.0 / number)
    for _ in range(60):
        e = 0.5 * (low + high)
        short = number * e >= 1.0 or np.log((1.0 + number) / (1.0 - e * number)) > number * (
            1.0 + e
        )
        low, high = (low, e) if short else (e, high)
    return e


def slide(
    law: vc.Friction, speed: float, spin: float = 0.0, depth: float = 1e-4
) -> vc.ContactReport:
    """A disc that slides and spins on a floor."""
    model = model_of(vc.Cylinder(0.05, 0.02), vc.VolumeSpring(stiffness=STIFFNESS), law)
    twist = np.array([0.0, 0.0, spin, speed, 0.0, 0.0])
    return model.evaluate(X_WA=pose(0.0, 0.02 - depth), V_WA=twist)


def regularized_coulomb() -> Drawn:
    """Friction over slip."""
    figure, axes = plot("slip [mm/s]", "friction over normal force [-]")
    speeds = np.linspace(-12e-3, 12e-3, 121)
    shown: list[float] = []
    for slip_speed, color in ((1e-3, VOLUMETRIC), (5e-3, NATIVE)):
        law = vc.RegularizedCoulomb(friction=FRICTION, slip_speed=slip_speed)
        reports = [slide(law, speed) for speed in speeds]
        shares = [-report.force_on_A[0] / report.force_on_A[2] for report in reports]
        axes.plot(1e3 * speeds, shares, color=color, label=f"slip_speed {1e3 * slip_speed:g} mm/s")
        shown += shares
    axes.legend()
    return figure, shown


def elastic_coulomb() -> Drawn:
    """A box that is pulled until it slides, and pulled back, on a soft and on a stiff material."""
    figure, axes = plot("way [um]", "friction over normal force [-]")
    shown: list[float] = []
    for stiffness, color in ((STIFFNESS, VOLUMETRIC), (10.0 * STIFFNESS, NATIVE)):
        law = vc.ElasticCoulomb(friction=FRICTION)
        normal = vc.VolumeSpring(stiffness=stiffness)
        model = model_of(vc.Box((0.05, 0.05, 0.05)), normal, law)
        h, x, state, ways, shares = 1e-3, 0.0, None, [], []
        depth = 1e-4 * STIFFNESS / stiffness  # under the same load
        for i in range(900):
            speed = 2e-4 * (1.0 if i < 500 else -1.0)
            x += h * speed
            twist = np.array([0.0, 0.0, 0.0, speed, 0.0, 0.0])
            report = model.evaluate(X_WA=pose(x, 0.05 - depth), V_WA=twist, state=state, elapsed=h)
            state = report.state
            ways.append(x)
            shares.append(-report.force_on_A[0] / report.force_on_A[2])
        axes.plot(1e6 * np.array(ways), shares, color=color, label=f"k_v = {stiffness:g} N/m^3")
        shown += shares[::40]
    axes.legend(loc="center left")
    return figure, shown


def bristle() -> Drawn:
    """A box that is pulled slowly, rests, and is pulled back."""
    figure, axes = plot("way [um]", "friction over normal force [-]")
    law = vc.Bristle(
        friction=0.3, static_friction=0.4, stribeck_speed=2e-3, dwell_time=0.1, bristle_damping=50.0
    )
    solid = vc.Box((0.05, 0.05, 0.05))
    model = model_of(solid, vc.VolumeSpring(stiffness=STIFFNESS), law)
    h, x, state = 1e-3, 0.0, None
    ways, shares = [], []
    for i in range(1600):
        # Half a second of rest between the two pulls; the first is slow, the second quick.
        speed = 3e-4 if i < 600 else 0.0 if i < 1100 else -1.2e-3
        x += h * speed
        twist = np.array([0.0, 0.0, 0.0, speed, 0.0, 0.0])
        report = model.evaluate(X_WA=pose(x, 0.05 - 1e-4), V_WA=twist, state=state, elapsed=h)
        state = report.state
        ways.append(x)
        shares.append(-report.force_on_A[0] / report.force_on_A[2])
    axes.plot(1e6 * np.array(ways), shares, color=VOLUMETRIC)
    for level, name in ((0.3, "friction"), (0.4, "static_friction"), (-0.3, ""), (-0.4, "")):
        axes.axhline(level, color=INK, lw=0.6, ls=":")
        axes.text(-400.0, level + 0.01, name, fontsize=9)
    return figure, shares[::40]


def coupling() -> Drawn:
    """What a disc has at once of sliding friction and spin torque."""
    figure, axes = plot(
        "spin torque over friction force times radius [-]", "sliding over whole [-]"
    )
    shown: list[float] = []
    angles = np.linspace(0.0, 0.5 * np.pi, 41)
    for word, color in (("ellipsoid", VOLUMETRIC), ("quadrature", NATIVE), ("none", INK)):
        law = vc.RegularizedCoulomb(friction=FRICTION, slip_speed=1e-6, coupling=word)
        points = []
        for angle in angles:
            report = slide(law, 0.1 * np.cos(angle), 2.0 * np.sin(angle) / 0.05 * 0.1)
            whole = FRICTION * report.force_on_A[2]
            torque = np.abs(report.torque_on_A[2]) / (0.05 * whole)
            points.append((torque, -report.force_on_A[0] / whole))
        x, y = np.array(points).T
        axes.plot(x, y, "-" if word != "none" else "o", ms=3, color=color, label=word)
        shown += [*x, *y]
    axes.set(xlim=(-0.02, 0.8), ylim=(-0.02, 1.05))
    axes.legend(title="coupling")
    return figure, shown


def rolling() -> Drawn:
    """Torque against rolling, up to the rim of the patch."""
    figure, axes = plot(
        "angular velocity [rad/s]", "rolling torque over\nforce times patch radius [-]"
    )
    turns = np.linspace(0.0, 400.0, 81)
    depth, radius = 1e-3, 0.05
    rim = np.sqrt(2.0 * radius * depth - depth**2)
    shown: list[float] = []
    for damping, color in ((0.5, VOLUMETRIC), (2.0, NATIVE)):
        law = vc.HuntCrossley(stiffness=STIFFNESS, damping=damping)
        model = model_of(vc.Sphere(radius), law, None)
        shares = []
        for turn in turns:
            # The patch itself is at rest: no slip, and no approach at its centroid.
            twist = np.array([0.0, turn, 0.0, 0.0, 0.0, 0.0])
            site = model.evaluate(X_WA=pose(0.0, radius - depth), V_WA=twist).sites[0]
            shares.append(-site.torque_on_A[1] / (site.normal_force * rim))
        axes.plot(turns, shares, color=color, label=f"damping {damping:g} s/m")
        shown += shares
    axes.set_ylim(bottom=0.0)
    axes.legend(loc="lower right")
    return figure, shown


def formulations() -> Drawn:
    """Energy that comes from nowhere on the way of a ball round the edge of a box."""
    figure, axes = plot("turns round the loop [-]", "energy made over\nlargest stored [-]")
    shown: list[float] = []
    for word, color in (("gonthier", NATIVE), ("potential", VOLUMETRIC)):
        made = _made_on_a_loop(word)
        axes.plot(np.linspace(0.0, 2.0, len(made)), made, color=color, label=word)
        shown += list(made[::20])
    axes.legend(title="formulation")
    return figure, shown


def _made_on_a_loop(formulation: str) -> np.ndarray:
    """Work of the contact plus what it stores, along two turns of a loop at the edge of a box."""
    model = vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(0.03), vc.Box((0.1, 0.1, 0.1)))],
        normal=vc.VolumeSpring(stiffness=STIFFNESS),
        formulation=formulation,
    )
    work, energies, previous = [0.0], [], None
    for angle in np.linspace(0.0, 4.0 * np.pi, 401):
        at = np.eye(4)
        at[:3, 3] = 0.113 + 0.008 * np.cos(angle), 0.0, 0.118 + 0.006 * np.sin(angle)
        report = model.evaluate(X_WA=at)
        energies.append(report.elastic_energy)
        if previous is not None:
            mean = 0.5 * (report.force_on_A + previous[0])
            work.append(work[-1] + mean @ (at[:3, 3] - previous[1]))
        previous = report.force_on_A, at[:3, 3]
    stored = np.array(energies)
    return (np.array(work) + stored - stored[0]) / stored.max()


PICTURE: dict[str, Callable[[], Drawn]] = {
    **{f"engines/{name}": partial(engine, name) for name in _IDEA},
    "laws/volume_spring": volume_spring,
    "laws/hunt_crossley": hunt_crossley,
    "laws/regularized_coulomb": regularized_coulomb,
    "laws/elastic_coulomb": elastic_coulomb,
    "laws/bristle": bristle,
    "laws/coupling": coupling,
    "laws/rolling": rolling,
    "laws/formulations": formulations,
}
