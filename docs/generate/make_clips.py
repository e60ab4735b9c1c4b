# SPDX-License-Identifier: Apache-2.0
"""Draws the moving pictures of the README and the gallery: scenes under both contacts.

`./run python docs/generate/make_clips.py [NAME ...]` writes docs/pictures/NAME.webp, and
battery_box.gif for the README.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import imageio_ffmpeg

ROOT = Path(__file__).resolve().parents[2]
PICTURES = ROOT / "docs" / "pictures"
MODELS = ROOT / "mjcf_models"
RATE = 15  # pictures a second
NATIVE_WARNED = 3  # of MuJoCo, under native contact: that is shown
README = "battery_box"  # in the README as a GIF, which every reader of Markdown shows
# Both: slower than the film by the rate, and as wide as a column of text.
SCALED = f"setpts=N/{RATE}/TB,scale={{width}}:-1:flags=lanczos"
GIF = (
    ",split[a][b];[a]palettegen=max_colors=64:stats_mode=diff[p];"
    "[b][p]paletteuse=dither=none:diff_mode=rectangle"
)


@dataclass(frozen=True)
class Clip:
    """A scene on film, volumetric contact beside native.

    Attributes:
        scene: path below mjcf_models.
        duration: [s].
        interval: between two pictures [s].
        camera: of the scene; empty: its first.
        width: of both runs side by side [pixel].
    """

    scene: str
    duration: float
    interval: float
    camera: str = ""
    width: int = 640


CLIPS = {
    "battery_box": Clip("battery_box/scene.xml", 1.4, 0.02, width=800),
    "peg_in_hole": Clip("peg_in_hole/scene_mesh.xml", 0.36, 0.006),
    "tippe_top": Clip("tippe_top/scene.xml", 2.2, 0.02, "follow"),
    "gear_pair": Clip("gear_pair/scene.xml", 0.1, 0.002, "teeth"),
    "acu_insert": Clip("acu_insert/scene.xml", 24.0, 0.4, "seat"),
    "canadarm_berth": Clip("canadarm_berth/scene.xml", 45.0, 0.75, "grasp"),
    "box_pile": Clip("box_pile/scene.xml", 1.5, 0.03),
}


def film(clip: Clip, folder: Path) -> Path:
    """The film that `volcontact compare` makes of a scene."""
    compare = [sys.executable, "-m", "volcontact.cli", "compare", str(MODELS / clip.scene)]
    compare += ["--out", str(folder), "--duration", str(clip.duration)]
    compare += ["--frame-interval", str(clip.interval)]
    compare += ["--camera", clip.camera] if clip.camera else []
    status = subprocess.run(compare).returncode
    if status not in (0, NATIVE_WARNED):
        raise SystemExit(f"{clip.scene}: volcontact compare ended with {status}")
    return folder / "run.mp4"


def encode(film: Path, out: Path, width: int) -> None:
    """A moving picture of a film; what comes out hangs on the ending."""
    gif = out.suffix == ".gif"
    options = ["-vf", SCALED.format(width=width) + (GIF if gif else ""), "-r", str(RATE)]
    if not gif:
        options += ["-c:v", "libwebp_anim", "-quality", "60", "-compression_level", "6"]
    program = imageio_ffmpeg.get_ffmpeg_exe()
    run = [program, "-y", "-v", "error", "-i", str(film), *options, "-loop", "0", str(out)]
    subprocess.run(run, check=True)
    print(f"{out}: {out.stat().st_size / 1e3:.0f} kB")


def main() -> None:
    """Films scenes, all or those that are named."""
    PICTURES.mkdir(exist_ok=True)
    for name in sys.argv[1:] or CLIPS:
        with tempfile.TemporaryDirectory() as folder:
            found = film(CLIPS[name], Path(folder))
            encode(found, PICTURES / f"{name}.webp", CLIPS[name].width)
            if name == README:
                encode(found, PICTURES / f"{name}.gif", CLIPS[name].width)


if __name__ == "__main__":
    main()
