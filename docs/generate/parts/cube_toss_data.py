# SPDX-License-Identifier: Apache-2.0
"""What the tosses of a real cube say by themselves, before anything is simulated.

Flights have the centre of mass: p + R c moves on a parabola. Where a corner hits, the flights
before and after give the impulse and the velocities of the contact point. Where the cube slides on
a face, its deceleration is friction.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from volcontact.identify import rotations

GRAVITY, MASS, HALF = 9.81, 0.37, 0.0517  # [m/s^2] [kg] [m]
CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
_LONG = 12  # frames of a flight that is fitted
_SPEEDS = (0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 1.0)  # [m/s]


@dataclass(frozen=True)
class Toss:
    """One motion: t [s], shape (n,); p [m], shape (n, 3); q, body to world, shape (n, 4)."""

    t: np.ndarray
    p: np.ndarray
    q: np.ndarray

    @property
    def turned(self) -> np.ndarray:
        """Rotation matrices, shape (n, 3, 3)."""
        return matrices(self.q)

    def lowest(self) -> np.ndarray:
        """Height of the lowest corner of a sharp cube [m], shape (n,)."""
        corners = self.p[:, None] + np.einsum("tij,cj->tci", self.turned, HALF * CORNERS)
        return corners[:, :, 2].min(axis=1)


def read(path: Path) -> list[Toss]:
    """All tosses of the set."""
    import pyarrow.parquet as parquet

    table = parquet.read_table(path)
    column = {name: table[name].to_numpy() for name in table.column_names}
    found = []
    for label in np.unique(column["toss"]):
        here = column["toss"] == label
        found.append(
            Toss(
                column["t"][here],
                np.stack([column[name][here] for name in ("px", "py", "pz")], -1),
                np.stack([column[name][here] for name in ("qw", "qx", "qy", "qz")], -1),
            )
        )
    return found


def matrices(q: np.ndarray) -> np.ndarray:
    """Rotation matrices of quaternions, shape (..., 3, 3)."""
    return np.stack(
        [rotations.rotate(q, np.broadcast_to(e, (*q.shape[:-1], 3))) for e in np.eye(3)], axis=-1
    )


def centre_of_mass(tosses: list[Toss]) -> tuple[np.ndarray, np.ndarray, float]:
    """Of the body frame, from the first flights: p + R c is a parabola.

    Returns:
        c [m], its standard deviations [m], and the standard deviation of the residuals [m].
    """
    rows, right = [], []
    for toss in tosses:
        count = int(np.argmax(toss.lowest() < 2e-3))
        if count < _LONG:
            continue
        t = toss.t[:count] - toss.t[count // 2]
        line = np.vander(t, 2, increasing=True)
        off = np.eye(count) - line @ np.linalg.pinv(line)
        turned = toss.turned[:count]
        for axis in range(3):
            y = toss.p[:count, axis] + (0.5 * GRAVITY * t**2 if axis == 2 else 0.0)
            fall = -0.5 * t**2 if axis == 2 else np.zeros(count)  # lengths may have a scale
            rows.append(off @ np.column_stack([-turned[:, axis], fall]))
            right.append(off @ y)
    a, b = np.concatenate(rows), np.concatenate(right)
    found = np.linalg.lstsq(a, b, rcond=None)[0]
    noise = float((b - a @ found).std())
    deviations = noise * np.sqrt(np.diag(np.linalg.inv(a.T @ a)))
    return found[:3], deviations[:3], noise


@dataclass(frozen=True)
class Flight:
    """A body in free flight at an instant: its centre, speed, spin (world) and turn."""

    place: np.ndarray
    speed: np.ndarray
    spin: np.ndarray
    turn: np.ndarray
    error: tuple[float, float]  # largest residuals [m], [rad]


def flight(toss: Toss, part: slice, at: float, centre: np.ndarray) -> Flight:
    """Parabola and steady turn through samples, at a time (which may lie outside)."""
    t = toss.t[part] - at
    line = np.vander(t, 2, increasing=True)
    y = toss.p[part] + toss.turned[part] @ centre
    y[:, 2] += 0.5 * GRAVITY * t**2
    straight = np.linalg.lstsq(line, y, rcond=None)[0]
    q, middle = toss.q[part], len(t) // 2
    about = np.vander(t - t[middle], 2, increasing=True)
    off, spin = np.zeros(3), np.zeros(3)
    for _ in range(6):
        so_far = rotations.product(
            rotations.quaternion(np.outer(t - t[middle], spin)),
            rotations.product(rotations.quaternion(off), q[middle])[None],
        )
        error = rotations.vector(rotations.product(q, rotations.inverse(so_far)))
        change = np.linalg.lstsq(about, error, rcond=None)[0]
        off, spin = off + change[0], spin + change[1]
    first = rotations.product(rotations.quaternion(off), q[middle])
    turn = rotations.product(rotations.quaternion(-spin * t[middle]), first)
    residual = float(np.abs(y - line @ straight).max()), float(np.abs(error).max())
    return Flight(straight[0], straight[1], spin, turn, residual)


@dataclass(frozen=True)
class Impacts:
    """Single hits of a corner, each of shape (n,).

    Attributes:
        approach: speed of the contact point towards the board before [m/s].
        restitution: of that point.
        slip: of it along the board before [m/s].
        ratio: tangential over normal impulse, where it still slides afterwards in the same way.
        depth: how far below the board a sharp corner is when the velocities change [m].
    """

    approach: np.ndarray
    restitution: np.ndarray
    slip: np.ndarray
    ratio: np.ndarray
    depth: np.ndarray


def impacts(tosses: list[Toss], centre: np.ndarray, inertia: float, radius: float) -> Impacts:
    """Of hits between two flights of five frames or more, whose impulse goes through the corner.

    Args:
        tosses: all.
        centre: of mass, in the body frame [m].
        inertia: [kg m^2].
        radius: of the corners [m].
    """
    found = []
    for toss in tosses:
        air = toss.lowest() > -2e-4
        for before, after in _hits(air):
            one = _impact(toss, before, after, centre, inertia, radius)
            if one is not None:
                found.append(one)
    return Impacts(*np.array(found).T)


def _hits(air: np.ndarray) -> list[tuple[slice, slice]]:
    """Flights before and after each touch of up to three frames."""
    edges = np.flatnonzero(np.diff(air.astype(int)))
    ends = [0, *(int(e) + 1 for e in edges), len(air)]
    parts = [(a, b) for a, b in itertools.pairwise(ends)]
    found = []
    for (a, b), (c, d), (e, f) in zip(parts, parts[1:], parts[2:], strict=False):
        if air[a] and not air[c] and d - c <= 3 and b - a >= 5 and f - e >= 5:
            found.append((slice(max(a, b - 20), b), slice(e, min(f, e + 20))))
    return found


def _impact(
    toss: Toss, before: slice, after: slice, centre: np.ndarray, inertia: float, radius: float
) -> tuple[float, ...] | None:
    at = float(toss.t[before.stop - 1]) + 0.003
    one, two = flight(toss, before, at, centre), flight(toss, after, at, centre)
    if max(one.error[0], two.error[0]) > 5e-4 or max(one.error[1], two.error[1]) > 4e-3:
        return None
    change = two.speed - one.speed
    late = float((one.place - two.place) @ change / (change @ change))  # where the lines cross
    turn = rotations.product(rotations.quaternion(late * one.spin), one.turn)
    turned = matrices(turn)
    heights = CORNERS @ turned[2]
    order = np.argsort(heights)
    if HALF * (heights[order[1]] - heights[order[0]]) < 0.015:
        return None  # two corners
    corner = turned @ CORNERS[order[0]]
    arm = (HALF - radius) * corner - radius * np.array([0, 0, 1.0]) - turned @ centre
    impulse = MASS * change
    kick = inertia * (two.spin - one.spin)
    if np.linalg.norm(kick - np.cross(arm, impulse)) > 1.2 * inertia:
        return None  # more than one hit
    first = one.speed + np.cross(one.spin, arm)
    last = two.speed + np.cross(two.spin, arm)
    slip = float(np.linalg.norm(first[:2]))
    slides_on = float(last[:2] @ first[:2]) / slip > 0.1
    ratio = float(np.linalg.norm(impulse[:2]) / impulse[2]) if slides_on else np.nan
    place = one.place + late * one.speed - turned @ centre
    place[2] -= 0.5 * GRAVITY * late**2
    depth = -float(place[2] + HALF * corner[2])
    return -float(first[2]), -float(last[2] / first[2]), slip, ratio, depth


def sliding(tosses: list[Toss]) -> list[tuple[float, float, int, float, float, float]]:
    """Friction of faces that slide, by speed: from, to, windows, median and quartiles."""
    speeds, ratios = [], []
    for toss in tosses:
        flat = np.abs(toss.turned[:, 2, :]).max(axis=1) > np.cos(0.02)
        edges = [0, *(np.flatnonzero(np.diff(flat.astype(int))) + 1), len(flat)]
        for a, b in itertools.pairwise(edges):
            if not flat[a]:
                continue
            for begin in range(int(a) + 3, int(b) - 8, 4):
                part = slice(begin, begin + 8)
                t = toss.t[part] - toss.t[part].mean()
                if np.ptp(toss.p[part, 2]) > 4e-4:
                    continue
                powers = np.vander(t, 3, increasing=True)
                _, speed, half = np.linalg.lstsq(powers, toss.p[part, :2], rcond=None)[0]
                size = float(np.linalg.norm(speed))
                if size > _SPEEDS[0]:
                    speeds.append(size)
                    ratios.append(-2.0 * float(half @ speed) / size / GRAVITY)
    speed, ratio = np.array(speeds), np.array(ratios)
    found = []
    for low, high in itertools.pairwise(_SPEEDS):
        here = ratio[(speed > low) & (speed <= high)]
        quartiles = np.quantile(here, [0.25, 0.75])
        found.append((low, high, len(here), float(np.median(here)), *map(float, quartiles)))
    return found
