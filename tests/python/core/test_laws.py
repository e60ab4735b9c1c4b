# SPDX-License-Identifier: Apache-2.0
"""The laws as Python sees them: one spelling, keyword only, read back by name."""

from __future__ import annotations

import pytest

import volcontact as vc


def test_fields_are_keywords_and_properties() -> None:
    law = vc.HuntCrossley(stiffness=2e7, damping=0.3)
    assert (law.stiffness, law.damping, law.name) == (2e7, 0.3, "hunt_crossley")


def test_defaults_come_from_the_table() -> None:
    law = vc.RegularizedCoulomb()
    assert law.friction == 0.2
    assert law.coupling == "ellipsoid"
    assert "slip_speed [m/s]" in (vc.RegularizedCoulomb.__doc__ or "")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: vc.HuntCrossley(stiffness=-1.0),
            r"hunt_crossley: stiffness = -1 \[N/m\^3\] is out of range: must be > 0",
        ),
        (lambda: vc.RegularizedCoulomb(slip_speed=0.0), r"slip_speed = 0 \[m/s\]"),
        (
            lambda: vc.RegularizedCoulomb(coupling="elipsoid"),
            r"unknown coupling 'elipsoid': one of ellipsoid, quadrature, none "
            r"\(did you mean 'ellipsoid'\?\)",
        ),
    ],
)
def test_bad_value_is_a_value_error(call, message) -> None:
    with pytest.raises(ValueError, match=message):
        call()


def test_unknown_keyword_is_a_type_error() -> None:
    with pytest.raises(TypeError):
        vc.HuntCrossley(stifness=1.0)
    with pytest.raises(TypeError):
        vc.HuntCrossley(1e7)


def test_layers_convert_material_data() -> None:
    assert vc.layer_stiffness(modulus=1e7, thickness=0.05) == pytest.approx(2e8)
    confined = vc.layer_stiffness(modulus=1e7, thickness=0.05, poisson_ratio=0.25)
    assert confined == pytest.approx(1.2 * 2e8)  # (1 - nu) / ((1 + nu) (1 - 2 nu))
    assert vc.series_stiffness(2e8, 5e8) == pytest.approx(1.428571e8, rel=1e-6)
    assert vc.series_restitution(1e8, 0.7, 5e8, 0.7) == pytest.approx(0.7)
    with pytest.raises(ValueError, match="poisson_ratio"):
        vc.layer_stiffness(modulus=1e7, thickness=0.05, poisson_ratio=0.5)


def test_bristle_refuses_static_below_kinetic_friction() -> None:
    with pytest.raises(ValueError, match=r"static_friction = 0\.1"):
        vc.Bristle(friction=0.2, static_friction=0.1)
