# SPDX-License-Identifier: Apache-2.0
"""Wrong arguments are answered by one line that names the argument, what it takes and what came."""

import re

import numpy as np
import pytest

import volcontact as vc
from volcontact.messages.spelling import nearest

BALL, FLOOR = vc.Sphere(radius=1.0), vc.HalfSpace()
MODEL = vc.ContactModel(pairs=[vc.Pair(BALL, FLOOR)], normal=vc.HuntCrossley())
EYE, STILL = np.eye(4), np.zeros(6)


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (lambda: vc.Sphere(raduis=1.0), "Sphere has no argument 'raduis'; did you mean 'radius'?"),
        (lambda: vc.Sphere(radius="1"), "Sphere: radius takes a number, got str '1'"),
        (
            lambda: vc.Sphere(1.0, 2.0),
            "Sphere takes at most 1 arguments without a name (radius), got 2",
        ),
        (lambda: vc.Sphere(1.0, radius=2.0), "Sphere got 'radius' twice"),
        (lambda: vc.Sphere(), "Sphere needs radius: a number"),
        (
            lambda: vc.Box(half_sizes=1.0),
            "Box: half_sizes takes 3 numbers, (x, y, z), got float 1.0",
        ),
        (
            lambda: vc.Box([1.0, 2.0]),
            "Box: half_sizes takes 3 numbers, (x, y, z), got list [1.0, 2.0]",
        ),
        (
            lambda: vc.HuntCrossley(stifness=1.0),
            "has no argument 'stifness'; did you mean 'stiffness'?",
        ),
        (lambda: vc.HuntCrossley(1e9), "HuntCrossley takes its arguments by name: stiffness=..."),
        (
            lambda: vc.interference(BALL, FLOOR, [0, 0, 0]),
            "interference: X_AB takes a pose, numpy.array of shape (4, 4), got list [0, 0, 0]",
        ),
        (
            lambda: vc.interference(BALL, FLOOR, X_AB=np.eye(3)),
            "got an array of float64 of shape (3, 3)",
        ),
        (
            lambda: vc.interference(BALL, 3),
            "b takes a solid, such as Sphere(radius=0.05), got int 3",
        ),
        (
            lambda: MODEL.evaluate(X_WA=EYE, X_WB=EYE, V_WA=0.0, V_WB=STILL),
            "evaluate: V_WA takes numpy.array of numbers, shape (6,), got float 0.0",
        ),
        (lambda: MODEL.evaluate(pose=EYE), "evaluate has no argument 'pose'"),
        (
            lambda: vc.ContactModel(pairs=[vc.Pair(BALL, FLOOR)], normal=1),
            "normal takes a normal law, such as HuntCrossley(stiffness=1e9), got int 1",
        ),
        (
            lambda: vc.ContactModel(pairs=[3], normal=vc.HuntCrossley()),
            "pairs takes a list of Pair",
        ),
        (lambda: vc.Mesh("a.stl"), "Mesh needs faces: numpy.array of whole numbers, shape (n, 3)"),
        (
            lambda: vc.layer_stiffness(70e9, 0.02),
            "takes its arguments by name: modulus=..., thickness",
        ),
    ],
)
def test_wrong_argument_is_named(call, line):
    with pytest.raises(TypeError, match=re.escape(line)) as caught:
        call()
    text = str(caught.value)
    assert "\n" not in text
    assert "volcontact._volcontact" not in text


def test_good_calls_and_other_errors_are_as_they_were():
    assert vc.Sphere(radius=2).radius == 2.0
    assert vc.interference(BALL, FLOOR).volume == pytest.approx(2 / 3 * np.pi)
    with pytest.raises(ValueError, match="radius = -1"):
        vc.Sphere(radius=-1.0)

    class Refuses(vc.NormalLaw):
        name = "refuses"

        def evaluate(self, given):
            raise TypeError("by its author")

    with pytest.raises(TypeError):
        vc.ContactModel(pairs=[vc.Pair(BALL, FLOOR)], normal=Refuses(wrong=1))


def test_of_many_names_the_closest_are_told() -> None:
    known = ["zed.force", *(f"link{i}.position[{k}]" for i in range(20) for k in range(3))]
    assert nearest("zed.forc", known) == "; did you mean 'zed.force'?"
    shown = nearest("z_f", known)
    assert shown.startswith(f"; of {len(known)} the closest are ")
    assert "zed.force" in shown and shown.count(",") == 11
    assert nearest("zzz", ["mass", "size"]) == "; there is mass, size"
