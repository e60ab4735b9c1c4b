# SPDX-License-Identifier: Apache-2.0
"""Stiffness and damping of a steel ball on a steel plate, from formulas alone."""

from volcontact.identify import analytic


def main() -> None:
    """Prints k_v from Hertz's contact by what is to agree, and a from a restitution."""
    steel = analytic.Elastic(modulus=210e9, poisson_ratio=0.3)
    for match in ("depth", "stiffness", "energy", "patch"):
        found = analytic.hertz(load=100.0, radius=0.01, material=steel, other=steel, match=match)
        print(f"same {match}: {found['stiffness']:.4g} N/m^3")
    print(f"depth: {1e6 * found['depth']:.3f} um, pressure {1e-9 * found['pressure']:.3f} GPa")
    for line in (*found.validity, *found.findings):
        print(line)
    damping = analytic.damping_from_restitution(restitution=0.9, speed=0.5)
    print(damping.mjcf("ball"))


if __name__ == "__main__":
    main()
