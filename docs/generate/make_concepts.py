# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of docs/concepts.md, of what the core computes.

`./run python docs/generate/make_concepts.py`, after a change of a law or of this script.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from parts.concepts_sections import INK, Distance, arrow, distance, draw_section, pose
from parts.performance_plots import STYLE

import volcontact as vc
from volcontact.report.palette import NATIVE, VOLUMETRIC

PICTURES = Path(__file__).parents[1] / "concepts"
Drawn = tuple[Figure, list[float]]  # a picture, and the numbers it shows


def overlap() -> Drawn:
    """What one pair gives: volume, centroid, area vector, depth."""
    box, can = vc.Box((0.1, 0.05, 0.04)), vc.Cylinder(radius=0.04, half_length=0.035)
    at = pose(0.01, 0.068, 24.0)
    found = vc.interference(box, can, at)
    figure = Figure(figsize=(6.4, 3.1), layout="constrained")
    axes = figure.subplots()
    reach = (-0.115, 0.125), (-0.045, 0.125)
    draw_section(axes, distance(box, np.eye(4)), distance(can, at), *reach)
    centroid, normal = found.centroid, found.normal
    axes.plot(centroid[0], centroid[2], "o", color="white", mec=INK, ms=6, zorder=5)
    arrow(axes, centroid, 0.055 * normal, "normal on A, force", NATIVE)
    axes.text(-0.095, -0.035, "A", weight="bold")
    axes.text(0.02, 0.09, "B", weight="bold")
    axes.annotate(
        f"interference\nvolume {1e6 * found.volume:.1f} cm³",
        (centroid[0] + 0.01, centroid[2] + 0.003),
        xytext=(0.062, 0.06),
        arrowprops=dict(arrowstyle="-", color=INK, lw=0.7),
    )
    axes.annotate(
        f"its centroid;\n{1e3 * found.depth:.1f} mm deep,\npatch {1e4 * found.area:.1f} cm²",
        (centroid[0], centroid[2]),
        xytext=(-0.112, 0.06),
        arrowprops=dict(arrowstyle="-", color=INK, lw=0.7),
    )
    return figure, [found.volume, *centroid, *normal, found.depth, found.area]


def sites() -> Drawn:
    """A peg that jams in a bore touches at two places, which push against each other."""
    block = vc.Box((0.06, 0.04, 0.03)) - vc.Cylinder(radius=0.0205, half_length=0.05)
    peg = vc.Cylinder(radius=0.02, half_length=0.04)
    at = pose(0.0006, 0.02, 2.4)
    found = vc.interference(block, peg, at)
    figure = Figure(figsize=(6.4, 3.1), layout="constrained")
    axes = figure.subplots()
    draw_section(
        axes, distance(block, np.eye(4)), distance(peg, at), (-0.08, 0.08), (-0.034, 0.064)
    )
    largest = max(site.volume for site in found.sites)
    numbers = []
    for i, site in enumerate(found.sites):
        length = 0.03 * site.volume / largest
        arrow(axes, site.centroid, -length * site.normal, f" site {i}", NATIVE)
        numbers += [site.volume, *site.centroid, *site.normal]
    axes.text(-0.056, -0.027, "A, bored", weight="bold")
    axes.text(0.0, 0.051, "B, a peg", weight="bold", ha="center")
    axes.text(0.03, 0.05, "normal forces on B", color=NATIVE)
    return figure, numbers


def engines() -> Drawn:
    """How the three ways to integrate see the same overlap. A picture of the idea in the plane."""
    box, ball = vc.Box((0.1, 0.05, 0.04)), vc.Ellipsoid((0.06, 0.05, 0.045))
    at = pose(0.005, 0.068, 18.0)
    a, b = distance(box, np.eye(4)), distance(ball, at)
    figure = Figure(figsize=(8.0, 1.8), layout="constrained")
    panels = figure.subplots(1, 3)
    x, z = (-0.075, 0.075), (0.005, 0.075)
    for axes, title in zip(panels, ("lines", "columns", "octree"), strict=True):
        draw_section(axes, a, b, x, z)
        axes.set_title(title, family="monospace", fontsize=10)
    draw_rays(panels[0], a, b)
    draw_chords(panels[1], at)
    draw_cells(panels[2], lambda u, v: max(a(u, v), b(u, v)), (x[0], -0.04), x[1] - x[0], 6)
    for axes in panels:
        axes.set(xlim=x, ylim=z)
    return figure, [vc.interference(box, ball, at).volume]


def _column(a: Distance, b: Distance, x: float) -> tuple[float, float]:
    """From where to where both solids reach on the vertical through x; (0, 0) when nowhere."""
    heights = np.linspace(0.0, 0.08, 1601)
    inside = [z for z in heights if max(a(x, z), b(x, z)) <= 0.0]
    return (inside[0], inside[-1]) if inside else (0.0, 0.0)


def draw_rays(axes: Axes, a: Distance, b: Distance) -> None:
    """The overlap on the nodes of a Gauss rule."""
    nodes = 0.005 + 0.043 * np.polynomial.legendre.leggauss(9)[0]
    for x in nodes:
        low, high = _column(a, b, x)
        if high > low:
            axes.plot([x, x], [low, high], color=INK, lw=1.2)


def draw_normals(axes: Axes, a: Distance, b: Distance) -> None:
    """The surface of the overlap, and its normals at the nodes of a Gauss rule."""
    nodes = 0.005 + 0.0485 * np.polynomial.legendre.leggauss(9)[0]
    ends = [(x, *_column(a, b, x)) for x in nodes]
    ends = [(x, low, high) for x, low, high in ends if high > low]
    for height in (1, 2):
        axes.plot([e[0] for e in ends], [e[height] for e in ends], ".", color=INK, ms=4)
    step = 1e-5
    for x, low, high in ends:
        for z in (low, high):
            face = a if a(x, z) > b(x, z) else b
            slope = np.array(
                [face(x + step, z) - face(x - step, z), face(x, z + step) - face(x, z - step)]
            )
            way = 0.009 * slope / np.linalg.norm(slope)
            axes.annotate(
                "", (x + way[0], z + way[1]), (x, z), arrowprops=dict(arrowstyle="->", color=INK)
            )


def draw_chords(axes: Axes, at: np.ndarray) -> None:
    """The same ball as a mesh: a column under each edge, the sum exact for the triangles."""
    angle = np.linspace(0.0, 2.0 * np.pi, 25)
    rim = at[[0, 2]] @ np.array(
        [0.06 * np.cos(angle), 0 * angle, 0.045 * np.sin(angle), 1 + 0 * angle]
    )
    axes.plot(rim[0], rim[1], color=INK, lw=0.8, marker=".", ms=3)
    for x, z in rim.T[:-1]:
        if z < 0.04:
            axes.plot([x, x], [z, 0.04], color=INK, lw=1.2)


def draw_cells(
    axes: Axes, both: Distance, corner: tuple[float, float], size: float, left: int
) -> None:
    """Cells that are certainly inside or outside are not divided."""
    middle = both(corner[0] + size / 2, corner[1] + size / 2)
    reach = size * np.sqrt(0.5)
    if middle > reach:
        return
    if middle < -reach or left == 0:
        axes.add_patch(Rectangle(corner, size, size, fill=False, ec=INK, lw=0.5))
        return
    for i in (0, 1):
        for j in (0, 1):
            low = corner[0] + i * size / 2, corner[1] + j * size / 2
            draw_cells(axes, both, low, size / 2, left - 1)


def normal_law() -> Drawn:
    """Force over volume in one bounce of a ball: without loss, with damping, by restitution."""
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.subplots()
    laws = {
        "volume_spring": (vc.VolumeSpring(stiffness=1e8), INK),
        "hunt_crossley, damping 0.5 s/m": (vc.HuntCrossley(stiffness=1e8, damping=0.5), VOLUMETRIC),
        "hunt_crossley, restitution 0.3": (
            vc.HuntCrossley(stiffness=1e8, restitution=0.3),
            NATIVE,
        ),
    }
    numbers = []
    for label, (law, color) in laws.items():
        volume, force, speed = bounce(law)
        text = f"{label}: leaves with {abs(speed):.2f} of its speed"
        axes.plot(1e9 * volume, force, color=color, label=text)
        numbers += [volume.max(), force.max(), speed]
    axes.set_xlabel("interference volume [mm³]")
    axes.set_ylabel("normal force [N]")
    axes.set_ylim(top=470.0)
    axes.legend(loc="upper right", fontsize=9)
    return figure, numbers


def bounce(law: vc.NormalForce) -> tuple[np.ndarray, np.ndarray, float]:
    """Volumes [m^3], forces [N] and the last speed [m/s] of a ball of 1 kg that falls at 1 m/s."""
    ball = vc.Pair(vc.Sphere(radius=0.05), vc.HalfSpace())
    model = vc.ContactModel(pairs=[ball], normal=law, friction=None)
    h, height, speed, state = 2e-6, 0.05, -1.0, None
    rows = []
    while not rows or height < 0.05:
        report = model.evaluate(
            X_WA=pose(0.0, height),
            V_WA=np.array([0.0, 0.0, 0.0, 0.0, 0.0, speed]),
            state=state,
            elapsed=h,
        )
        state, force = report.state, report.force_on_A[2]
        rows.append((report.sites[0].metrics.volume if report.sites else 0.0, force))
        speed += h * force
        height += h * speed
    volume, force = np.array(rows).T
    return volume, force, speed


def friction_laws() -> Drawn:
    """How far a box creeps in half a second under a load within the cone, by law."""
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.subplots()
    shares = np.linspace(0.05, 0.95, 10)
    laws = {
        "regularized_coulomb, slip_speed 1 mm/s": (
            vc.RegularizedCoulomb(friction=0.4, slip_speed=1e-3),
            VOLUMETRIC,
        ),
        "elastic_coulomb, the default": (vc.ElasticCoulomb(friction=0.4), INK),
        "bristle": (vc.Bristle(friction=0.4, static_friction=0.4), NATIVE),
    }
    numbers = []
    for label, (law, color) in laws.items():
        ways = [creep(law, share) for share in shares]
        axes.plot(shares, 1e3 * np.array(ways), "o-", ms=3, color=color, label=label)
        numbers += ways
    axes.set_xlabel("sideways load over friction times normal force")
    axes.set_ylabel("moved in half a second [mm]")
    axes.legend()
    return figure, numbers


def creep(law: vc.Friction, share: float) -> float:
    """Way [m] of a box of 1 kg in the second half second under `share` of what moves it."""
    half, stiffness = 0.05, 1e7
    box = vc.Pair(vc.Box(half_sizes=(half, half, half)), vc.HalfSpace())
    model = vc.ContactModel(
        pairs=[box], normal=vc.HuntCrossley(stiffness=stiffness), friction=law, rolling=False
    )
    height = half - 9.81 / (stiffness * 4 * half**2)  # at rest
    h, x, speed, state, at_half = 2.5e-4, 0.0, 0.0, None, 0.0
    for i in range(4000):
        report = model.evaluate(
            X_WA=pose(x, height),
            V_WA=np.array([0.0, 0.0, 0.0, speed, 0.0, 0.0]),
            state=state,
            elapsed=h,
        )
        state = report.state
        load = share * 0.4 * 9.81 * min(1.0, i * h / 0.2)
        speed += h * (load + report.force_on_A[0])
        x += h * speed
        if i == 1999:
            at_half = x
    return x - at_half


def coupling() -> Drawn:
    """Sliding and spin weaken each other: friction of a disc that does both, by coupling."""
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.subplots()
    radius, slide = 0.05, 0.1
    ratios = np.linspace(0.0, 6.0, 61)  # rim speed over sliding speed
    numbers = []
    for word, color in (("ellipsoid", VOLUMETRIC), ("quadrature", NATIVE), ("none", INK)):
        law = vc.RegularizedCoulomb(friction=0.4, slip_speed=1e-4, coupling=word)
        disc = vc.Pair(vc.Cylinder(radius=radius, half_length=0.02), vc.HalfSpace())
        model = vc.ContactModel(pairs=[disc], normal=vc.VolumeSpring(stiffness=1e7), friction=law)
        shares = []
        for ratio in ratios:
            twist = np.array([0.0, 0.0, ratio * slide / radius, slide, 0.0, 0.0])
            report = model.evaluate(X_WA=pose(0.0, 0.0199), V_WA=twist)
            shares.append(-report.force_on_A[0] / (0.4 * report.force_on_A[2]))
        axes.plot(ratios, shares, color=color, label=f"coupling {word}")
        numbers += shares
    axes.set_xlabel("rim speed of the spin over sliding speed")
    axes.set_ylabel("friction against sliding,\nshare of friction times normal force")
    axes.set_ylim(0.0, 1.08)
    axes.legend()
    return figure, numbers


PICTURE: dict[str, Callable[[], Drawn]] = {
    "overlap": overlap,
    "sites": sites,
    "engines": engines,
    "normal_law": normal_law,
    "friction_laws": friction_laws,
    "coupling": coupling,
}


def digest(numbers: list[float]) -> str:
    """Of what a picture shows, to four digits: its file carries it."""
    text = " ".join(f"{number:.3e}" if abs(number) > 1e-12 else "0" for number in numbers)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def save(pictures: dict[str, Callable[[], Drawn]], folder: Path) -> None:
    """Draws pictures in the style of the pages; each knows the numbers it was drawn from."""
    with matplotlib.rc_context(STYLE):
        for name, draw in pictures.items():
            figure, numbers = draw()
            about = {"Date": None, "Source": digest(numbers)}
            figure.savefig(folder / f"{name}.svg", metadata=about)


def main() -> None:
    """Draws all."""
    PICTURES.mkdir(exist_ok=True)
    save(PICTURE, PICTURES)


if __name__ == "__main__":
    main()
