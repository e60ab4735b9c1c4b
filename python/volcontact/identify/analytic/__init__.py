# SPDX-License-Identifier: Apache-2.0
"""Parameters from formulas: Hertz, force over depth, restitutions, micro-slip stiffness.

from volcontact.identify import analytic

found = analytic.hertz(load=100.0, radius=0.02, modulus=210e9, poisson_ratio=0.3)
found["stiffness"], found.mjcf("ball"), found.validity
"""

from volcontact.identify.analytic.bristles import bristles_from_microslip, mindlin
from volcontact.identify.analytic.force_depth import force_depth
from volcontact.identify.analytic.hertz import Elastic, hertz, hertz_cylinder
from volcontact.identify.analytic.restitution import (
    damping_from_restitution,
    damping_from_table,
    restitution_at,
)

__all__ = [
    "Elastic",
    "bristles_from_microslip",
    "damping_from_restitution",
    "damping_from_table",
    "force_depth",
    "hertz",
    "hertz_cylinder",
    "mindlin",
    "restitution_at",
]
