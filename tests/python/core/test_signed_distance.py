# SPDX-License-Identifier: Apache-2.0
"""vc.SignedDistance: a solid by a Python callable, off the step."""

from __future__ import annotations

import gc
import math
import threading
import weakref

import numpy as np
import pytest

import volcontact as vc

BOX = [[-0.2] * 3, [0.2] * 3]


def ball(points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points, axis=1) - 0.2


def smooth_ball(distance=ball) -> vc.SignedDistance:
    return vc.SignedDistance(distance, BOX, curvature=1.5 / 0.2)


def at(z: float) -> np.ndarray:
    pose = np.eye(4)
    pose[2, 3] = z
    return pose


def cap(depth: float) -> float:
    return math.pi * depth**2 * (3 * 0.2 - depth) / 3


def test_callable_ball_is_the_spherical_cap():
    for depth in (0.05, 0.2):
        metrics = vc.interference(vc.HalfSpace(), smooth_ball(), at(0.2 - depth), tolerance=1e-2)
        assert metrics.engine == "octree" and metrics.status == "ok"
        assert metrics.volume_error <= 1e-2 * metrics.volume
        assert abs(metrics.volume - cap(depth)) <= metrics.volume_error
        assert metrics.normal == pytest.approx([0, 0, -1], abs=1e-2)


def test_bound_from_the_slope_alone_is_certain():
    solid = vc.SignedDistance(ball, BOX)
    metrics = vc.interference(vc.HalfSpace(), solid, at(0.1), tolerance=0.2)
    assert abs(metrics.volume - cap(0.1)) <= metrics.volume_error <= 0.2 * metrics.volume


def test_steeper_function_needs_its_lipschitz_bound():
    solid = vc.SignedDistance(lambda p: 3 * ball(p), BOX, lipschitz=3, curvature=3 * 1.5 / 0.2)
    metrics = vc.interference(vc.HalfSpace(), solid, at(0.1), tolerance=1e-2)
    assert abs(metrics.volume - cap(0.1)) <= metrics.volume_error <= 1e-2 * metrics.volume


# A gyroid sheet's volume in a box, against a lattice of midpoints with an error below 1 %.
def test_gyroid_equals_its_quadrature():
    def gyroid(points: np.ndarray) -> np.ndarray:
        x, y, z = 60.0 * points.T
        sheet = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
        return np.abs(sheet) / 60.0 - 0.004

    half, n = 0.03, 120
    ticks = (np.arange(n) + 0.5) / n * 2 * half - half
    lattice = np.stack(np.meshgrid(ticks, ticks, ticks), axis=-1).reshape(-1, 3)
    truth = np.mean(gyroid(lattice) < 0) * (2 * half) ** 3
    foam = vc.SignedDistance(gyroid, [[-0.05] * 3, [0.05] * 3], lipschitz=math.sqrt(3))
    metrics = vc.interference(foam, vc.Box((half, half, half)), tolerance=0.1)
    assert abs(metrics.volume - truth) <= metrics.volume_error + 0.01 * truth
    assert abs(metrics.volume - truth) <= 0.03 * truth


def test_one_call_serves_many_cells():
    sizes = []

    def counted(points: np.ndarray) -> np.ndarray:
        sizes.append(len(points))
        assert points.shape == (len(points), 3) and points.dtype == np.float64
        return ball(points)

    vc.interference(vc.HalfSpace(), smooth_ball(counted), at(0.1), tolerance=1e-2)
    assert sum(sizes) > 20 * len(sizes)


def test_threads_change_no_bit():
    one = vc.interference(vc.HalfSpace(), smooth_ball(), at(0.1), tolerance=1e-2)
    for threads in (2, 3, 8):
        many = vc.interference(
            vc.HalfSpace(), smooth_ball(), at(0.1), tolerance=1e-2, threads=threads
        )
        assert many.volume == one.volume and many.depth_moment == one.depth_moment
        assert np.array_equal(many.inertia, one.inertia)


def test_python_threads_may_ask_at_once():
    expected = vc.interference(vc.HalfSpace(), smooth_ball(), at(0.1), tolerance=1e-2).volume
    volumes = []

    def ask():
        metrics = vc.interference(vc.HalfSpace(), smooth_ball(), at(0.1), tolerance=1e-2)
        volumes.append(metrics.volume)

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert volumes == [expected] * 4


def test_callable_may_ask_in_turn():
    expected = vc.interference(vc.HalfSpace(), smooth_ball(), at(0.1), tolerance=1e-2)

    def asking(points: np.ndarray) -> np.ndarray:
        inner = vc.interference(vc.HalfSpace(), smooth_ball(), at(0.1), tolerance=1e-2)
        assert inner.volume == expected.volume
        return ball(points)

    outer = vc.interference(vc.HalfSpace(), smooth_ball(asking), at(0.1), tolerance=1e-2)
    assert outer.volume == expected.volume and np.array_equal(outer.inertia, expected.inertia)


def test_callable_that_holds_its_own_solid_is_collected():
    class Holder:
        def distance(self, points: np.ndarray) -> np.ndarray:
            return ball(points)

    holder = Holder()
    holder.solid = vc.SignedDistance(holder.distance, BOX)
    gone = weakref.ref(holder)
    del holder
    gc.collect()
    assert gone() is None


def test_two_callables_meet():
    a, b = smooth_ball(), vc.SignedDistance(ball, BOX, curvature=1.5 / 0.2)
    metrics = vc.interference(a, b, at(0.3), tolerance=1e-2)
    # the lens of two equal balls: two caps of half the depth
    assert abs(metrics.volume - 2 * cap(0.05)) <= metrics.volume_error


@pytest.mark.parametrize(
    ("distance", "message"),
    [
        (lambda p: p, r"shape \(n,\)"),
        (lambda p: 0.0, r"shape \(n,\)"),
        (lambda p: ball(p)[:-1], r"shape \(n,\)"),
        (lambda p: np.full(len(p), np.nan), "nan"),
        (lambda p: np.full(len(p), np.inf), "inf"),
        (lambda p: ["far"] * len(p), "far"),
    ],
)
def test_bad_answers_come_out_as_errors(distance, message):
    with pytest.raises(ValueError, match=message):
        vc.interference(vc.HalfSpace(), smooth_ball(distance), at(0.1))
    # and leave nothing behind
    assert vc.interference(vc.HalfSpace(), smooth_ball(), at(0.1), tolerance=1e-2).status == "ok"


def test_what_the_callable_raises_comes_out():
    def broken(points: np.ndarray) -> np.ndarray:
        raise KeyError("no such part")

    with pytest.raises(KeyError, match="no such part"):
        vc.interference(vc.HalfSpace(), smooth_ball(broken), at(0.1))


def test_refuses_what_cannot_be():
    with pytest.raises(TypeError, match="callable"):
        vc.SignedDistance(0.1, BOX)
    with pytest.raises(ValueError, match="lipschitz"):
        vc.SignedDistance(ball, BOX, lipschitz=0.0)
    with pytest.raises(ValueError, match="curvature"):
        vc.SignedDistance(ball, BOX, curvature=-1.0)
    with pytest.raises(ValueError, match="bounds"):
        vc.SignedDistance(ball, BOX[::-1])


def test_contact_models_refuse_it():
    with pytest.raises(ValueError, match=r"serves vc\.interference only"):
        vc.Pair(vc.HalfSpace(), smooth_ball())
    with pytest.raises(ValueError, match=r"serves vc\.interference only"):
        vc.Pair(smooth_ball(), vc.HalfSpace())
