# SPDX-License-Identifier: Apache-2.0
"""What C++ cannot get memory for is a MemoryError; the next call is as if it had not been."""

import subprocess
import sys

import pytest

# In a process of its own: its address space ends where it is, but for some bytes.
CODE = """
import resource, sys, threading
import numpy as np
import volcontact as vc

def ball(rings, bumps):
    tilt, turn = np.meshgrid(
        np.linspace(0.0, np.pi, rings + 1)[1:-1],
        np.linspace(0.0, 2.0 * np.pi, 2 * rings, endpoint=False),
        indexing="ij",
    )
    radius = 0.2 + 0.02 * np.cos(bumps * tilt) * np.cos(7.0 * turn)
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
        low = (rings - 2) * sides
        faces += [(last, j, k), (low + k, low + j, last + 1)]
        for i in range(rings - 2):
            low, high = (i + 1) * sides, i * sides
            faces += [(high + j, low + j, low + k), (high + j, low + k, high + k)]
    return vc.Mesh(points, np.array(faces))

def limited(size):
    pages = int(open("/proc/self/statm").read().split()[0])
    limit = resource.RLIM_INFINITY if size is None else pages * resource.getpagesize() + size
    resource.setrlimit(resource.RLIMIT_AS, (limit, resource.RLIM_INFINITY))

one, other, X = ball(120, 5.0), ball(121, 3.0), np.eye(4)
X[:3, 3] = [0.1, 0.05, 0.02]
pair = vc.Pair(one, other)
model = vc.ContactModel(pairs=[pair], normal=vc.VolumeSpring(stiffness=1e7))
still = np.zeros(6)
calls = [
    lambda: vc.interference(one, other, X).volume,
    lambda: model.evaluate(X_WA=np.eye(4), X_WB=X, V_WA=still, V_WB=still).metrics.volume,
]
vc.interference(vc.Sphere(0.1), vc.Sphere(0.1), X)

def run():
    for call in calls:
        for size in (0, 1 << 20, 4 << 20):
            limited(size)
            try:
                call()
                outcome = "none"
            except MemoryError:
                outcome = "MemoryError"
            limited(None)
            print(outcome)
        print(repr(call()))

# The stack of the first thread grows when it is used, and where it may not the process ends.
threading.stack_size(1 << 26)
thread = threading.Thread(target=run)
thread.start()
thread.join()
print(repr(vc.interference(ball(120, 5.0), ball(121, 3.0), X).volume))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the limit of an address space is Linux's")
def test_too_little_memory_is_an_error_and_no_end():
    ran = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    lines = ran.stdout.split("\n")
    assert lines[:3] == ["MemoryError"] * 3
    assert lines[4:7] == ["MemoryError"] * 3
    # The same bits as of memory that never failed.
    assert lines[3] == lines[7] == lines[8]
