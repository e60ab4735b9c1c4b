# SPDX-License-Identifier: Apache-2.0
"""Formulas for parameters: against closed forms, tables of docs/theory.md and the laws."""

import math
import re

import numpy as np
import pytest

import volcontact as vc
from volcontact.identify import analytic
from volcontact.identify.impacts import Impacts
from volcontact.identify.push import Push

STEEL = analytic.Elastic(210e9, 0.3)
RUBBER = analytic.Elastic(5e6, 0.48)


def cap(depth, radius):
    return math.pi * depth**2 * (radius - depth / 3.0)


def test_depth_of_hertz_is_met_by_the_volume_law():
    load, radius = 50.0, 0.01
    found = analytic.hertz(load, radius, STEEL)
    modulus = 210e9 / (1.0 - 0.3**2)
    depth = found["depth"]
    assert 4.0 / 3.0 * modulus * math.sqrt(radius) * depth**1.5 == pytest.approx(load)
    assert found["stiffness"] * cap(depth, radius) == pytest.approx(load, rel=1e-9)


def test_other_matches_have_their_known_ratio_to_that_of_the_depth():
    """V = pi R d^2 against F ~ d^1.5: closed forms for small depths."""
    at = {m: analytic.hertz(1e-3, 0.01, STEEL, match=m)["stiffness"] for m in ("depth", "patch")}
    assert at["patch"] / at["depth"] == pytest.approx(4.0, rel=1e-4)
    stiff = analytic.hertz(1e-3, 0.01, STEEL, match="stiffness")["stiffness"]
    assert stiff / at["depth"] == pytest.approx(9.0 / 16.0, rel=1e-4)
    # F d_v / 3 = 2/5 F d: the volume law has to go in 1.2 times as far.
    energy = analytic.hertz(1e-3, 0.01, STEEL, match="energy")["stiffness"]
    assert energy / at["depth"] == pytest.approx(1.0 / 1.44, rel=1e-4)


def test_stiffness_of_hertz_is_met_by_the_volume_law():
    load, radius = 20.0, 0.02
    found = analytic.hertz(load, radius, STEEL, match="stiffness")
    push = Push(vc.Sphere(radius=radius), vc.HalfSpace())
    depth = push.depth_of(load / found["stiffness"])
    step = 1e-4 * depth
    rise = push.volume(depth + step)[0] - push.volume(depth - step)[0]
    slope = found["stiffness"] * rise / (2.0 * step)
    assert slope == pytest.approx(found["contact_stiffness"], rel=1e-6)


def test_two_spheres_are_softer_than_one_on_a_plane():
    plane = analytic.hertz(10.0, 0.01, STEEL, other=STEEL)
    twin = analytic.hertz(10.0, 0.01, STEEL, other_radius=0.01, other=STEEL)
    # R is halved, so d^1.5 sqrt(R) = const; V is pi R d^2 with the relative R.
    assert twin["depth"] / plane["depth"] == pytest.approx(2.0 ** (1.0 / 3.0), rel=1e-9)
    push = Push(vc.Sphere(radius=0.01), vc.Sphere(radius=0.01))
    volume = push.volume(twin["depth"])[0]
    assert twin["stiffness"] * volume == pytest.approx(10.0, rel=1e-6)


def test_line_contact_in_half_width_and_matches():
    load, radius, length = 1000.0, 0.01, 0.03
    found = analytic.hertz_cylinder(load, radius, length, STEEL, datum=0.02, other=STEEL)
    modulus = 210e9 / (1.0 - 0.3**2) / 2.0
    b = math.sqrt(4.0 * load / length * radius / (math.pi * modulus))
    assert found["patch_radius"] == pytest.approx(b)
    assert found["pressure"] == pytest.approx(2.0 * load / (math.pi * b * length))
    # The overlap of a lying cylinder, from the engine.
    turned = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, radius], [0, 0, 0, 1]])
    push = Push(vc.Cylinder(radius=radius, half_length=0.5 * length), vc.HalfSpace(), turned)
    assert found["stiffness"] * push.volume(found["depth"])[0] == pytest.approx(load, rel=1e-4)
    # Energy and stiffness of the approach, by differences of its own depth.
    steps = np.linspace(1e-3, 1.0, 400) * load
    depths = [
        analytic.hertz_cylinder(F, radius, length, STEEL, datum=0.02, other=STEEL)["depth"]
        for F in steps
    ]
    energy = np.trapezoid(steps, depths) if hasattr(np, "trapezoid") else np.trapz(steps, depths)
    same = analytic.hertz_cylinder(
        load, radius, length, STEEL, datum=0.02, other=STEEL, match="energy"
    )
    deep = push.depth_of(load / same["stiffness"])
    assert same["stiffness"] * push.moment(deep) == pytest.approx(energy, rel=2e-3)
    slope = (steps[-1] - steps[-2]) / (depths[-1] - depths[-2])
    assert found["contact_stiffness"] == pytest.approx(slope, rel=1e-3)


def test_what_lies_outside_of_hertz_is_said():
    soft = analytic.hertz(100.0, 0.02, RUBBER)
    assert any("small strains" in line for line in soft.findings)
    hard = analytic.hertz(100.0, 0.005, STEEL, yield_stress=5e8)
    assert any("yields" in line for line in hard.findings)
    assert not analytic.hertz(1.0, 0.01, STEEL).findings
    assert all("N" in soft.validity[0] for _ in soft.validity)


def test_damping_is_that_of_the_table_of_the_theory():
    for e, number in ((0.9, 0.16648), (0.6, 0.97487), (0.3, 3.08708)):
        found = analytic.damping_from_restitution(e, 2.0)
        assert found["damping"] == pytest.approx(number / 2.0, rel=1e-4)
        assert float(analytic.restitution_at(found["damping"], 2.0)) == pytest.approx(e, abs=1e-12)
    assert analytic.damping_from_restitution(1.0, 2.0)["damping"] == 0.0


def test_law_itself_agrees_with_damping_from_restitution():
    """`hunt_crossley` integrated over an impact of a cube of 1 kg on its face."""
    a = analytic.damping_from_restitution(0.5, 1.0)["damping"]
    model = vc.ContactModel(
        pairs=[vc.Pair(vc.Box(half_sizes=[0.1, 0.1, 0.1]), vc.HalfSpace())],
        normal=vc.HuntCrossley(stiffness=1e8, damping=a),
    )
    pose, twist, h = np.eye(4), np.zeros(6), 2e-6
    pose[2, 3], twist[5] = 0.1, -1.0
    while pose[2, 3] <= 0.1:
        twist[5] += h * model.evaluate(X_WA=pose, V_WA=twist).force_on_A[2]
        pose[2, 3] += h * twist[5]
    assert twist[5] == pytest.approx(0.5, abs=2e-3)


def test_table_of_restitutions_tells_which_law_holds():
    v = np.array([0.1, 0.3, 1.0, 3.0])
    by_damping = analytic.damping_from_table(v, analytic.restitution_at(0.4, v))
    assert by_damping["damping"] == pytest.approx(0.4, rel=1e-9)
    assert by_damping.parameters().keys() == {"damping"}
    constant = analytic.damping_from_table(v, [0.71, 0.7, 0.69, 0.7])
    assert constant["restitution"] == pytest.approx(0.7)
    assert constant.parameters().keys() == {"restitution"}
    same = analytic.damping_from_table([1.0, 1.0, 1.01], [0.7, 0.71, 0.7])
    assert any("other heights" in line for line in same.findings)
    wild = analytic.damping_from_table(v, [0.9, 0.3, 0.8, 0.4])
    assert any("misses something" in line for line in wild.findings)


def test_force_over_depth_gives_stiffness_and_offset_of_any_solid():
    box = vc.Box(half_sizes=[0.01, 0.01, 0.01])
    depths = np.linspace(0.0, 1e-3, 12)
    force = 3e9 * 4e-4 * np.maximum(depths - 2e-4, 0.0)
    found = analytic.force_depth(depths, force, box, vc.HalfSpace())
    assert found["stiffness"] == pytest.approx(3e9, rel=1e-9)
    assert found["offset"] == pytest.approx(2e-4, rel=1e-6)
    assert not found.findings


def test_curve_that_is_no_volume_law_is_told():
    depths = np.linspace(1e-4, 1e-3, 12)
    ball = vc.Sphere(radius=0.02)
    found = analytic.force_depth(depths, 1e6 * depths**1.5, ball, vc.HalfSpace(), offset=0.0)
    assert found["power"] == pytest.approx(0.75, abs=0.01)
    assert any("power 0.75" in line for line in found.findings)
    assert any("off by more than 5 %" in line for line in found.findings)


def test_press_too_slow_for_damping_says_so():
    depths = np.linspace(1e-4, 1e-3, 12)
    ball = vc.Sphere(radius=0.02)
    noise = 1e-3 * np.sin(37.0 * np.arange(12))
    force = 1e9 * math.pi * depths**2 * (0.02 - depths / 3.0) * (1.0 + noise)
    found = analytic.force_depth(
        depths, force, ball, vc.HalfSpace(), speeds=np.full(12, 1e-5) * np.arange(12), offset=0.0
    )
    assert not found.values["damping"].told
    assert any("damping" in line for line in found.findings)
    assert found.parameters().keys() == {"stiffness"}


def test_bristles_are_a_spring_and_a_damper():
    plain = analytic.bristles_from_microslip(2e6)
    assert plain["bristle_stiffness"] == 2e6
    assert any("cannot be told" in line for line in plain.findings)
    rings = analytic.bristles_from_microslip(1e5, mass=1.0, damping_ratio=1.0)
    assert rings["bristle_damping"] == pytest.approx(2.0 * math.sqrt(1e5))
    loop = analytic.bristles_from_microslip(1e5, loss=0.1, frequency=10.0, viscous_friction=20.0)
    assert loop["bristle_damping"] + 20.0 == pytest.approx(0.1 * 1e5 / (20.0 * math.pi))


def test_secant_of_partial_slip_is_corrected_to_the_tangent():
    k, most = 3e6, 40.0  # tangent [N/m] and friction [N]
    for share in (0.01, 0.5, 0.95):
        way = 1.5 * most / k * (1.0 - (1.0 - share) ** (2.0 / 3.0))
        found = analytic.bristles_from_microslip(share * most / way, share=share)
        assert found["bristle_stiffness"] == pytest.approx(k, rel=1e-9)
        assert any("partial slip" in line for line in found.findings) == (share > 0.1)


def test_tangential_over_normal_stiffness_of_equal_bodies():
    """2 (1 - nu) / (2 - nu) [Mindlin1949]."""
    found = analytic.mindlin(100.0, 0.01, STEEL)
    assert found["tangential_ratio"] == pytest.approx(2.0 * 0.7 / 1.7)
    normal = analytic.hertz(100.0, 0.01, STEEL, other=STEEL)["contact_stiffness"]
    assert found["bristle_stiffness"] == pytest.approx(2.0 * 0.7 / 1.7 * normal)


def test_weight_during_an_impact_is_that_of_the_equation_of_motion():
    """Integrated apart, with small steps."""
    k, m, g, a, R = 1e10, 0.5, 9.81, 0.3, 0.025
    impacts = Impacts(Push(vc.Sphere(radius=R), vc.HalfSpace()), k, m, g, 1.0)

    def rebound(gravity, v):
        def rate(x, v):
            force = k * cap(x, R) * max(0.0, 1.0 + a * v) if x > 0.0 else 0.0
            return np.array([v, gravity - force / m])

        y, h = np.array([0.0, v]), 1e-6
        while y[0] >= 0.0:
            k1 = rate(*y)
            k2 = rate(*(y + 0.5 * h * k1))
            k3 = rate(*(y + 0.5 * h * k2))
            k4 = rate(*(y + h * k3))
            y = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        return -y[1]

    for v in (0.5, 1.0):
        share = rebound(g, v) / rebound(0.0, v)
        assert 1.0 - impacts.share(a, v) == pytest.approx(1.0 - share, rel=0.03)
        assert 1.0 - share > 1e-3


WRONG = {
    "load": (lambda: analytic.hertz(-1.0, 0.01, STEEL), "load = -1 [N]"),
    "radius": (lambda: analytic.hertz(1.0, 0.0, STEEL), "radius = 0 [m]"),
    "match": (lambda: analytic.hertz(1.0, 0.1, STEEL, match="force"), "must be one of depth"),
    "rigid": (
        lambda: analytic.hertz(1.0, 0.1, analytic.Elastic(math.inf)),
        "both bodies are rigid",
    ),
    "poisson": (
        lambda: analytic.hertz(1.0, 0.1, analytic.Elastic(1e9, 0.7)),
        "poisson_ratio = 0.7 [-]",
    ),
    "modulus": (lambda: analytic.hertz(1.0, 0.1, analytic.Elastic(0.0)), "modulus = 0 [Pa]"),
    "other": (lambda: analytic.hertz(1.0, 0.1, STEEL, other_radius=-1.0), "other_radius = -1"),
    "datum": (
        lambda: analytic.hertz_cylinder(1e5, 0.1, 0.1, STEEL, datum=1e-6),
        "must lie far below the contact",
    ),
    "restitution": (lambda: analytic.damping_from_restitution(1.2, 1.0), "restitution = 1.2 [-]"),
    "speed": (lambda: analytic.damping_from_restitution(0.5, 0.0), "speed = 0 [m/s]"),
    "table": (lambda: analytic.damping_from_table([1.0, 2.0], [0.5]), "one restitution for each"),
    "share": (lambda: analytic.bristles_from_microslip(1e5, share=1.0), "share = 1 [-]"),
    "half": (lambda: analytic.bristles_from_microslip(1e5, mass=1.0), "belong together"),
    "both": (
        lambda: analytic.bristles_from_microslip(
            1e5, mass=1.0, damping_ratio=0.1, loss=0.1, frequency=1.0
        ),
        "exclude each other",
    ),
    "loss": (lambda: analytic.bristles_from_microslip(1e5, loss=0.1), "belong together"),
    "viscous": (
        lambda: analytic.bristles_from_microslip(
            1e5, loss=0.1, frequency=10.0, viscous_friction=1e4
        ),
        "must be below the damping",
    ),
    "mindlin": (
        lambda: analytic.mindlin(1.0, 0.1, analytic.Elastic(math.inf)),
        "has no shear modulus",
    ),
    "falls": (
        lambda: analytic.force_depth([0, 1e-3], [5, 1], vc.Sphere(radius=1.0), vc.HalfSpace()),
        "the force falls with the depth",
    ),
    "nothing": (
        lambda: analytic.force_depth([0, 1e-3], [0, 0], vc.Sphere(radius=1.0), vc.HalfSpace()),
        "too few",
    ),
}


@pytest.mark.parametrize("case", WRONG)
@pytest.mark.filterwarnings("ignore:invalid value")
def test_wrong_numbers_are_told(case):
    call, said = WRONG[case]
    with pytest.raises(ValueError, match=re.escape(said)) as told:
        call()
    assert "\n" not in str(told.value)
