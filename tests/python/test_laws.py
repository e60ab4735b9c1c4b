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
            r"unknown coupling 'elipsoid': one of ellipsoid, none \(did you mean 'ellipsoid'\?\)",
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
