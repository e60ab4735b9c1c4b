# SPDX-License-Identifier: Apache-2.0
"""Defaults of the laws in Python beside those of a scene without keys: docs/python.md has them."""

import pytest

import volcontact as vc

SCENE = """
<mujoco><worldbody><geom type="plane" size="1 1 1"/>
  <body pos="0 0 1"><freejoint/><geom size="0.1" friction="0.7"/></body>
</worldbody></mujoco>"""
# Of a pair in a scene; of the law in Python. All others are the same.
DIFFERENT = {
    "damping": (1.0, 0.0),
    "stiffness": (5e6, 1e7),  # two sides of 1e7 in series
    "friction": (1.0, 0.2),  # the larger of the geoms' own
    "static_friction": (1.0, 0.2),
}


@pytest.mark.parametrize("friction_law", ["elastic_coulomb", "regularized_coulomb", "bristle"])
def test_defaults_differ_where_the_page_says(friction_law):
    keys = {"material": {"friction_law": friction_law}}
    with vc.attach(vc.load(SCENE, **keys), **keys) as contact:
        (pair,) = contact.description["pairs"]
    seen = 0
    for law in (vc.HuntCrossley(), vc.make_friction(friction_law)):
        for name in (word for word in pair if hasattr(law, word)):
            value = getattr(law, name)
            if name in DIFFERENT:
                assert (pair[name], value) == DIFFERENT[name]
            else:
                assert pair[name] == value, name
            seen += 1
    assert seen >= 7
