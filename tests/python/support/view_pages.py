# SPDX-License-Identifier: Apache-2.0
"""A scene in the viewer, a page of it in Chromium, and what is seen on a screenshot."""

import os
import shutil
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from volcontact.view import Stage

SCENE = """
<mujoco>
  <option timestep="0.001"/>
  <statistic center="0 0 0.1" extent="0.5"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1" rgba="0.9 0.9 0.9 1"/>
    <body pos="0 0 0.12"><freejoint/>
      <geom name="crate" type="box" size=".1 .1 .1" mass="1" rgba="0.8 0.8 0.8 1"/></body>
  </worldbody>
  <custom>
    <numeric name="volcontact/option/implicit/auto" data="1"/>
  </custom>
</mujoco>
"""
BLUE, PINK = (47, 107, 255), (214, 36, 110)
needs_browser = pytest.mark.skipif(
    shutil.which("chromium") is None, reason="the program chromium is not installed"
)


@pytest.fixture
def stage():
    with Stage(SCENE) as stage:
        yield stage


def rest(stage):
    stage.step(800)


def like(picture, color):
    """How many pixels have about the hue of a colour."""
    pixels = picture.reshape(-1, 3).astype(float)
    pixels -= pixels.mean(axis=1, keepdims=True)
    wanted = np.array(color, float) - np.mean(color)
    lengths = np.linalg.norm(pixels, axis=1)
    return int(((pixels @ wanted > 0.96 * lengths * np.linalg.norm(wanted)) & (lengths > 40)).sum())


@pytest.fixture
def page(stage):
    """A browser page with the stage at rest, and what went wrong on it."""
    playwright = pytest.importorskip("playwright.sync_api")
    from volcontact.view.browser import Page

    rest(stage)
    stage.paused = True
    with Page(stage, port=8123) as shown, playwright.sync_playwright() as programs:
        options = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
        browser = programs.chromium.launch(executable_path=shutil.which("chromium"), args=options)
        page = browser.new_page(viewport={"width": 720, "height": 420})
        page.set_default_timeout(90e3)  # all of it is drawn by the processor, which may be busy
        faults = []
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on(
            "request", lambda request: faults.append(request.url) if _far(request.url) else None
        )
        page.goto(shown.address)
        page.get_by_text("One step").wait_for()
        yield shown, page, faults
        browser.close()


def _far(url):
    return url.startswith("http") and "//localhost" not in url


def shot(page, name):
    """A screenshot of what is beside the panel."""
    path = Path(os.environ.get("VOLCONTACT_SCREENSHOTS", ".")) / name
    page.screenshot(path=path)
    return np.asarray(Image.open(path).convert("RGB"))[:, :380]


def happens(shown, condition):
    """Whether it comes true within a minute: a busy page draws in parts, and obeys late."""
    end = time.monotonic() + 60.0
    while time.monotonic() < end:
        shown.run(seconds=1.0)
        if condition():
            return True
    return False
