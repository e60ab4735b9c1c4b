# SPDX-License-Identifier: Apache-2.0
"""True volumes of overlaps, by formulas that share nothing with the engines."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.spatial import ConvexHull

from .bodies import Body

# A plane n . x <= d, all four numbers exact.
Plane = tuple[tuple[Fraction, Fraction, Fraction], Fraction]


def ellipsoid_cap(_: Body, b: Body, pose: np.ndarray) -> float:
    """Ball or ellipsoid in the half-space: the cap of a unit ball, stretched."""
    axes = np.asarray(b.sizes if b.kind == "ellipsoid" else b.sizes * 3, dtype=np.longdouble)
    support = np.sqrt(((axes * pose[2, :3].astype(np.longdouble)) ** 2).sum())
    depth = (support - pose[2, 3]) / support
    return float(axes.prod() * np.pi * depth**2 * (3 - depth) / 3)


def lens(a: Body, b: Body, pose: np.ndarray) -> float:
    """Two balls of one radius: two equal caps."""
    assert a.sizes == b.sizes
    radius = np.longdouble(a.sizes[0])
    depth = radius - np.sqrt((pose[:3, 3].astype(np.longdouble) ** 2).sum()) / 2
    return float(2 * np.pi * depth**2 * (3 * radius - depth) / 3)


def turned_solid(_: Body, b: Body, pose: np.ndarray) -> float:
    """Solid of revolution in the half-space: discs or rings on its axis, each cut by a line."""
    up, height = pose[2, :3], pose[2, 3]
    lean = float(np.hypot(up[0], up[1]))
    rims, ends = _profile(b)

    def cut(t: float) -> float:
        """Where the plane crosses the disc at t, as a distance from the axis."""
        return -(height + t * up[2]) / lean

    def area(t: float) -> float:
        outer, inner = rims(t)
        return _segment(outer, cut(t)) - _segment(inner, cut(t))

    # Where the plane touches a rim the area has a kink.
    kinks = list(ends)
    for piece in pairwise(ends):
        grid = np.linspace(*piece, 400)
        for rim in (0, 1):
            for side in (-1.0, 1.0):
                values = [cut(t) - side * rims(t)[rim] for t in grid]
                kinks += [
                    brentq(lambda t, r=rim, s=side: cut(t) - s * rims(t)[r], p, q, xtol=1e-15)
                    for (p, q), (f, g) in zip(pairwise(grid), pairwise(values), strict=True)
                    if f * g < 0
                ]
    # sin: takes the square roots out of the ends.
    total = 0.0
    for p, q in pairwise(sorted(kinks)):
        middle, half = (p + q) / 2, (q - p) / 2
        total += quad(
            lambda s, m=middle, h=half: area(m + h * np.sin(s)) * h * np.cos(s),
            -np.pi / 2,
            np.pi / 2,
            epsabs=0.0,
            epsrel=1e-11,
            limit=200,
        )[0]
    return total


def _profile(b: Body) -> tuple[Callable[[float], tuple[float, float]], tuple[float, ...]]:
    """Outer and inner radius at a place on the axis; the places where the formula changes."""
    first, second = b.sizes
    if b.kind == "cylinder":
        return lambda t: (first, 0.0), (-second, second)
    if b.kind == "capsule":

        def rims(t: float) -> tuple[float, float]:
            beyond = max(abs(t) - second, 0.0)
            return float(np.sqrt(max(first**2 - beyond**2, 0.0))), 0.0

        return rims, (-second - first, -second, second, second + first)
    assert b.kind == "torus"

    def ring(t: float) -> tuple[float, float]:
        width = float(np.sqrt(max(second**2 - t**2, 0.0)))
        return first + width, first - width

    return ring, (-second, second)


def _segment(radius: float, cut: float) -> float:
    """Area of the part u <= cut of a disc."""
    if radius <= 0.0 or cut <= -radius:
        return 0.0
    c = min(cut / radius, 1.0)
    return radius**2 * float(np.arccos(-c) + c * np.sqrt((1 - c) * (1 + c)))


def ball_on_bore(a: Body, b: Body, pose: np.ndarray) -> float:
    """A ball on the rim of a bored block: discs of the ball, less what is over the bore."""
    bore, top = a.sizes[3], a.sizes[2]
    (radius,), (x, y, height) = b.sizes, pose[:3, 3]
    aside = float(np.hypot(x, y))

    def area(z: float) -> float:
        disc = float(np.sqrt(max(radius**2 - (z - height) ** 2, 0.0)))
        return np.pi * disc**2 - _common(disc, bore, aside)

    # Where the disc begins to stand out, and where it does so all around.
    ends = [height - np.sqrt(radius**2 - (bore + s * aside) ** 2) for s in (-1.0, 1.0)]
    return sum(
        quad(area, p, q, epsabs=0.0, epsrel=1e-11, limit=200)[0]
        for p, q in pairwise([*sorted(ends), top])
    )


def _common(r: float, s: float, distance: float) -> float:
    """Area common to two discs."""
    if distance <= abs(r - s):
        return np.pi * min(r, s) ** 2
    if distance >= r + s:
        return 0.0
    to_chord = (distance**2 + r**2 - s**2) / (2 * distance)
    return _segment(r, -to_chord) + _segment(s, to_chord - distance)


def peg_in_bore(a: Body, b: Body, pose: np.ndarray) -> float:
    """A tilted peg that ends outside a bored block: what sticks out of the bore, by its angle.

    The line at an angle on the bore's wall is in the peg on one stretch, the roots of a quadratic.
    """
    bore, half = a.sizes[3], a.sizes[2]
    axis, middle = pose[:3, 2], pose[:3, 3]

    def ray(angle: float, z: np.ndarray | float) -> tuple[float, np.ndarray, np.ndarray]:
        """The ray from the bore's axis is in the peg where alpha r^2 + 2 beta r + gamma <= 0."""
        out = np.array([np.cos(angle), np.sin(angle), 0.0])
        from_middle = np.multiply.outer(np.atleast_1d(z), [0.0, 0.0, 1.0]) - middle
        along = from_middle @ axis
        alpha = 1 - (axis @ out) ** 2
        beta = from_middle @ out - along * (axis @ out)
        return alpha, beta, (from_middle**2).sum(axis=1) - along**2 - b.sizes[0] ** 2

    def depth(angle: float, z: float) -> float:
        alpha, beta, gamma = ray(angle, z)
        return -float((alpha * bore**2 + 2 * beta * bore + gamma)[0])

    def stretch(angle: float) -> tuple[float, float]:
        # The quadratic in z through three of its values.
        low, mid, high = (-depth(angle, z) for z in (-half, 0.0, half))
        c2, c1 = (low + high - 2 * mid) / (2 * half**2), (high - low) / (2 * half)
        root = c1**2 - 4 * c2 * mid
        if root <= 0:
            return 0.0, 0.0
        q = -(c1 + np.copysign(np.sqrt(root), c1)) / 2
        first, second = sorted((q / c2, mid / q))
        return max(first, -half), min(second, half)

    nodes, weights = np.polynomial.legendre.leggauss(24)

    def wedge(angle: float) -> float:
        low, high = stretch(angle)
        if low >= high:
            return 0.0
        alpha, beta, gamma = ray(angle, (low + high) / 2 + (high - low) / 2 * nodes)
        reach = (-beta + np.sqrt(beta**2 - alpha * gamma)) / alpha
        return float(weights @ ((reach - bore) * (reach + bore))) * (high - low) / 4

    # The arcs on which the peg sticks out at the lower or at the upper end.
    grid = np.linspace(0.0, 2 * np.pi, 721)
    ends = []
    for z in (-half, half):
        values = [depth(t, z) for t in grid]
        ends += [
            brentq(depth, p, q, args=(z,), xtol=1e-14)
            for (p, q), (f, g) in zip(pairwise(grid), pairwise(values), strict=True)
            if f * g < 0
        ]
    ends.sort()
    return sum(
        quad(wedge, p, q, epsabs=0.0, epsrel=1e-10, limit=200)[0]
        for p, q in pairwise([*ends, ends[0] + 2 * np.pi])
        if wedge((p + q) / 2) > 0.0
    )


def ball_in_mesh(a: Body, b: Body, pose: np.ndarray) -> float:
    """Ball in a mesh: cones from the middle of the ball over the triangles, cut by the ball.

    A triangle, seen from the foot of its plane, is three fans of one edge each. The part of a fan
    within the ball adds a flat cone, the part beyond it a cone with a piece of the sphere for base.
    """
    assert a.points is not None and a.triangles is not None
    radius = b.sizes[0]
    corners = (a.points - pose[:3, 3])[a.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    corners, normals = corners[lengths > 0], normals[lengths > 0] / lengths[lengths > 0, None]
    heights = np.einsum("ni,ni->n", normals, corners[:, 0])
    feet = heights[:, None] * normals
    squares = np.maximum(radius**2 - heights**2, 0.0)  # of the radii of the discs in the planes
    total = 0.0
    for k in range(3):
        begin, edge = corners[:, k], corners[:, (k + 1) % 3] - corners[:, k]
        # The line is in the disc where |begin - foot + t edge|^2 < square.
        c2 = (edge**2).sum(axis=1)
        c1 = ((begin - feet) * edge).sum(axis=1)
        c0 = ((begin - feet) ** 2).sum(axis=1) - squares
        root = np.sqrt(np.maximum(c1**2 - c2 * c0, 0.0))
        enter, leave = np.clip((-c1 - root) / c2, 0, 1), np.clip((-c1 + root) / c2, 0, 1)
        cuts = [begin + t[:, None] * edge for t in (0 * enter, enter, leave, 0 * enter + 1)]
        for piece, (p, q) in enumerate(pairwise(cuts)):
            twice = np.einsum("ni,ni->n", normals, np.cross(p - feet, q - feet))
            if piece == 1:
                total += (heights * twice).sum() / 6
                continue
            angles = np.arctan2(twice, ((p - feet) * (q - feet)).sum(axis=1))
            base = _solid_angle(feet, p, q) - angles * (np.sign(heights) - heights / radius)
            beyond = np.abs(heights) >= radius
            base[beyond] = _solid_angle(feet, p, q)[beyond]
            total += (heights * squares * angles / 6 + radius**3 / 3 * base).sum()
    return float(total)


def _solid_angle(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Of triangles, seen from the origin, shape (n,)."""
    p, q, r = (np.linalg.norm(x, axis=1) for x in (a, b, c))
    ab, bc, ca = ((x * y).sum(axis=1) for x, y in ((a, b), (b, c), (c, a)))
    across = np.einsum("ni,ni->n", a, np.cross(b, c))
    return 2 * np.arctan2(across, p * q * r + ab * r + bc * p + ca * q)


def polytopes(a: Body, b: Body, pose: np.ndarray) -> float:
    """Convex polytopes: every face cut by all other planes, in rational numbers."""
    rotation = [[Fraction(float(x)) for x in row] for row in pose[:3, :3]]
    shift = [Fraction(float(x)) for x in pose[:3, 3]]
    planes = _planes(a)
    for n, d in _planes(b):
        turned = tuple(_dot(row, n) for row in rotation)
        planes.append((turned, d + _dot(turned, shift)))
    return float(sum(d * _face_measure(k, planes) for k, (_, d) in enumerate(planes)) / 3)


def _dot(x: list[Fraction] | tuple[Fraction, ...], y: list[Fraction] | tuple) -> Fraction:
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


def _planes(body: Body) -> list[Plane]:
    one, zero = Fraction(1), Fraction(0)
    if body.kind == "half_space":
        return [((zero, zero, one), zero)]
    if body.kind == "box":
        axes = ((one, zero, zero), (zero, one, zero), (zero, zero, one))
        return [
            (tuple(s * c for c in axis), Fraction(half))
            for axis, half in zip(axes, body.sizes, strict=True)
            for s in (1, -1)
        ]
    assert body.points is not None
    planes = []
    for triangle in ConvexHull(body.points).simplices:
        p, q, r = ([Fraction(float(c)) for c in body.points[i]] for i in triangle)
        u, v = (
            [x - y for x, y in zip(q, p, strict=True)],
            [x - y for x, y in zip(r, p, strict=True)],
        )
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        d = _dot(n, p)
        planes.append((n, d) if d > 0 else (tuple(-c for c in n), -d))  # the origin is inside
    return planes


def _face_measure(k: int, planes: list[Plane]) -> Fraction:
    """Area of face k of the intersection divided by the length of its normal."""
    n, d = planes[k]
    axis = max(range(3), key=lambda i: abs(n[i]))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    far = Fraction(1000)
    corners = [(-far, -far), (far, -far), (far, far), (-far, far)]
    for other, (m, e) in enumerate(planes):
        if other == k:
            continue
        # On plane k the coordinate along `axis` is (d - n_i u - n_j v) / n_axis.
        slope = m[axis] / n[axis]
        p, q, c = m[i] - slope * n[i], m[j] - slope * n[j], e - slope * d
        if p == q == 0:
            if c < 0 or (c == 0 and other < k):  # of two equal faces one counts
                return Fraction(0)
            continue
        corners = _clip(corners, p, q, c)
        if not corners:
            return Fraction(0)
    twice = sum(
        u[0] * v[1] - u[1] * v[0] for u, v in zip(corners, corners[1:] + corners[:1], strict=True)
    )
    return abs(twice) / 2 / abs(n[axis])


def _clip(corners: list, p: Fraction, q: Fraction, c: Fraction) -> list:
    """The part p u + q v <= c of a convex polygon."""
    sides = [p * u + q * v - c for u, v in corners]
    kept = []
    for k, (u, side) in enumerate(zip(corners, sides, strict=True)):
        v, next_side = corners[(k + 1) % len(corners)], sides[(k + 1) % len(corners)]
        if side <= 0:
            kept.append(u)
        if side * next_side < 0:
            s = side / (side - next_side)
            kept.append((u[0] + s * (v[0] - u[0]), u[1] + s * (v[1] - u[1])))
    return kept
