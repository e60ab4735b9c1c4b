# SPDX-License-Identifier: Apache-2.0
"""A stage in MuJoCo's own window, on a display without a screen."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np
from PIL import Image

has_window = hasattr(mujoco, "Renderer") and shutil.which("Xvfb") is not None
_PROGRAM = """
import os, sys, threading, time
import numpy as np
from PIL import ImageGrab
from volcontact.view import Stage, window
from volcontact.view.recorded import open_recorded

sys.path.insert(0, sys.argv[2])
from view_pages import BLUE, like

def grab():  # until the contact is seen: the first picture takes a busy machine a while
    for _ in range(80):
        time.sleep(1.0)
        picture = ImageGrab.grab(xdisplay="").convert("RGB")
        if like(np.asarray(picture), BLUE) > 1000:
            picture.save(sys.argv[1])
            break
    os._exit(0)

with STAGE as stage:
    PREPARE
    threading.Thread(target=grab).start()
    window.show(stage)
"""


def picture_of_window(stage, prepare, name, folder):
    """What the window shows as soon as volumetric contact is seen in it.

    Args:
        stage: expression of the stage.
        prepare: statement about `stage` before it is shown.
        name: of the picture, among the screenshots of the tests.
        folder: to run in.
    """
    path = Path(os.environ.get("VOLCONTACT_SCREENSHOTS", folder)) / name
    path.unlink(missing_ok=True)
    environment = {k: v for k, v in os.environ.items() if k not in ("MUJOCO_GL", "DISPLAY")}
    display = ["xvfb-run", "-a", "-s", "-screen 0 1200x900x24"]
    program = _PROGRAM.replace("STAGE", stage).replace("PREPARE", prepare)
    subprocess.run(
        [*display, sys.executable, "-c", program, str(path), str(Path(__file__).parent)],
        check=True,
        env={**environment, "LIBGL_ALWAYS_SOFTWARE": "1"},
        cwd=folder,
        timeout=150,
    )
    assert path.exists(), "no patch and no arrow was seen within 80 s"
    return np.asarray(Image.open(path).convert("RGB"))
