# SPDX-License-Identifier: Apache-2.0
"""A normal law of one's own, in Python: a spring that yields.

./run python python/examples/own_law.py
"""

from typing import ClassVar

import numpy as np

import volcontact as vc


class YieldingSpring(vc.NormalLaw):
    """Force of the volume up to a limit, and constant from there on."""

    name = "yielding_spring"
    fields: ClassVar[dict[str, vc.LawField]] = {
        "stiffness": vc.LawField("N/m^3", 1e7, minimum=1.0),
        "limit": vc.LawField("N", 100.0, minimum=0.0, meaning="the force is never larger"),
    }
    stiffness: float
    limit: float

    def evaluate(self, contact: vc.NormalInput, state: dict, elapsed: float) -> vc.NormalOutput:
        """The force at one contact site."""
        force = self.stiffness * contact.volume
        bounded = min(force, self.limit)
        energy = self.stiffness * contact.depth_moment
        return vc.NormalOutput(magnitude=bounded, elastic=bounded, elastic_energy=energy)


def main() -> None:
    """Presses a ball into a floor."""
    model = vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(radius=0.05), vc.HalfSpace())],
        normal=YieldingSpring(stiffness=1e7, limit=20.0),
        friction=None,
    )
    for depth in (0.5e-3, 1e-3, 2e-3, 4e-3):
        X_WA = np.eye(4)
        X_WA[2, 3] = 0.05 - depth
        report = model.evaluate(X_WA=X_WA)
        print(f"{1e3 * depth:.1f} mm deep: {report.force_on_A[2]:.2f} N")


if __name__ == "__main__":
    main()
