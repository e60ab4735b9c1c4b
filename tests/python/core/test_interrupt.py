# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C ends what takes long in C++, within about a second, and leaves all in order."""

import os
import signal
import threading
import time

import numpy as np
import pytest

import volcontact as vc

MOST = 1.0  # [s] of the processor, from the signal to the exception; to the end it were 30


@pytest.fixture
def own_handler():
    """Python's own handler of SIGINT, whatever the caller of the tests has set."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def bumpy_ball(rings: int) -> vc.Mesh:
    """A closed mesh with 2 rings (2 rings - 2) triangles, none of them level with another."""
    tilt, turn = np.meshgrid(
        np.linspace(0.0, np.pi, rings + 1)[1:-1],
        np.linspace(0.0, 2.0 * np.pi, 2 * rings, endpoint=False),
        indexing="ij",
    )
    radius = 0.2 + 0.02 * np.cos(5.0 * tilt) * np.cos(7.0 * turn)
    around = np.stack(
        [np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=-1
    )
    points = np.concatenate(
        [(radius[..., None] * around).reshape(-1, 3), [[0, 0, 0.2], [0, 0, -0.2]]]
    )
    sides, last = 2 * rings, len(points) - 2
    faces = []
    for j in range(sides):
        k = (j + 1) % sides
        faces.append((last, j, k))
        for i in range(rings - 2):
            low, high = (i + 1) * sides, i * sides
            faces += [(high + j, low + j, low + k), (high + j, low + k, high + k)]
        low = (rings - 2) * sides
        faces.append((low + k, low + j, last + 1))
    return vc.Mesh(points, np.array(faces))


def interrupted_after(seconds: float, work) -> float:
    """Runs work, which a SIGINT ends; returns how much longer the processor worked on it."""
    sent = []

    def send():
        sent.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(seconds, send)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        work()
    timer.join()
    return time.process_time() - sent[0]


@pytest.mark.parametrize("threads", [1, 2])
def test_a_long_octree_of_meshes_ends(own_handler, threads):
    a, b = bumpy_ball(60), bumpy_ball(50)
    pose = np.eye(4)
    pose[:3, 3] = [0.15, 0.1, 0.05]

    def work():
        vc.interference(a, b, pose, engine="octree", tolerance=1e-9, threads=threads)

    assert interrupted_after(0.3, work) < MOST
    # The memory of the engines is as good as new.
    small = vc.interference(vc.Sphere(0.2), vc.Sphere(0.2), pose, engine="octree")
    exact = vc.interference(vc.Sphere(0.2), vc.Sphere(0.2), pose)
    assert small.volume == pytest.approx(exact.volume, abs=small.volume_error + exact.volume_error)


def test_a_long_evaluation_of_a_model_ends(own_handler):
    pose = np.eye(4)
    pose[:3, 3] = [0.15, 0.1, 0.05]
    model = vc.ContactModel(
        pairs=[vc.Pair(bumpy_ball(60), bumpy_ball(50))],
        normal=vc.HuntCrossley(),
        engine="octree",
        tolerance=1e-9,
    )
    assert interrupted_after(0.3, lambda: model.evaluate(X_WB=pose)) < MOST
