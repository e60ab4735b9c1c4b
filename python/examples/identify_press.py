# SPDX-License-Identifier: Apache-2.0
"""Stiffness of a pad and the offset of the gauge, from a press test with a ball.

The readings are made up here, with noise; in a laboratory they come from the gauge and load cell.
"""

import tempfile
from pathlib import Path

import numpy as np

import volcontact as vc
from volcontact.identify import direct

RADIUS, STIFFNESS, OFFSET = 0.02, 5e9, 3e-4  # of the ball [m], of the pad [N/m^3], of the gauge [m]


def measure(file: Path) -> None:
    """Presses the ball in ten steps and writes the sheet."""
    noise = np.random.default_rng(0)
    lines = [f"# a = sphere:radius={RADIUS}", "# b = half_space", "depth [mm],force [N]"]
    for depth in np.linspace(5e-5, 6e-4, 10):
        pose = np.eye(4)
        pose[2, 3] = RADIUS - depth
        volume = vc.interference(vc.HalfSpace(), vc.Sphere(radius=RADIUS), pose).volume
        force = STIFFNESS * volume + 0.1 * noise.standard_normal()
        lines.append(f"{1e3 * (depth + OFFSET):.4f},{force:.2f}")
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main() -> None:
    """Measures, reads the sheet, prints values with their intervals and the lines for MJCF."""
    with tempfile.TemporaryDirectory() as name:
        measure(Path(name) / "press.csv")
        found = direct.bench("press", Path(name) / "press.csv")
    for key, value in found.values.items():
        print(f"{key}: {value.value:.5g}, {value.low:.5g} to {value.high:.5g} {value.unit}")
    for line in (*found.validity, *found.findings):
        print(line)
    print(found.mjcf("pad"))


if __name__ == "__main__":
    main()
