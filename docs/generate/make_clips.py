# SPDX-License-Identifier: Apache-2.0
"""Draws the moving picture of the README: the battery box under both contacts, in slow motion.

`./run python docs/generate/make_clip.py` writes docs/pictures/battery_box.gif.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import imageio_ffmpeg

ROOT = Path(__file__).resolve().parents[2]
CLIP = ROOT / "docs" / "pictures" / "battery_box.gif"
SCENE = ROOT / "mjcf_models" / "battery_box" / "scene.xml"
DURATION = 1.4  # [s], until the box lies in its seat
INTERVAL = 0.02  # [s] between two pictures
RATE = 15  # pictures a second: 0.3 times as fast as it is
WIDTH = 800  # [pixel], of both runs side by side
FILTER = (
    f"setpts=N/{RATE}/TB,scale={WIDTH}:-1:flags=lanczos,split[a][b];"
    "[a]palettegen=max_colors=64:stats_mode=diff[p];"
    "[b][p]paletteuse=dither=none:diff_mode=rectangle"
)


def main() -> None:
    """Runs the comparison, and makes the clip of its film."""
    with tempfile.TemporaryDirectory() as folder:
        compare = [sys.executable, "-m", "volcontact.cli", "compare", str(SCENE), "--out", folder]
        compare += ["--duration", str(DURATION), "--frame-interval", str(INTERVAL)]
        subprocess.run(compare, check=True)
        CLIP.parent.mkdir(exist_ok=True)
        film = Path(folder) / "run.mp4"
        subprocess.run(
            [imageio_ffmpeg.get_ffmpeg_exe(), "-y", "-v", "error", "-i", str(film),
             "-vf", FILTER, "-r", str(RATE), str(CLIP)],
            check=True,
        )  # fmt: skip
    print(f"{CLIP}: {CLIP.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
