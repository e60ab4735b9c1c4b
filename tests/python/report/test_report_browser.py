# SPDX-License-Identifier: Apache-2.0
"""The report in a browser: wide and narrow, light and dark, with nothing from anywhere else."""

import os
import shutil
from pathlib import Path

import pytest

from volcontact.cli import main

SCENE = Path(__file__).parents[3] / "mjcf_models" / "battery_box" / "scene.xml"

pytestmark = pytest.mark.skipif(
    shutil.which("chromium") is None, reason="the program chromium is not installed"
)


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    out = tmp_path_factory.mktemp("report")
    arguments = ["compare", str(SCENE), "--duration", "1.2", "--frame-interval", "0.3"]
    arguments += ["--width", "320", "--height", "240", "--force-limit", "1e5", "--out", str(out)]
    assert main(arguments) == 0
    return out


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as programs:
        browser = programs.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"]
        )
        yield browser
        browser.close()


@pytest.fixture
def open_page(report, browser):
    """Opens the report; what it logs as an error, or asks of others, is a fault."""
    faults, pages = [], []

    def open_page(width, scheme="light"):
        page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
        page.on("console", lambda m: faults.append(m.text) if m.type == "error" else None)
        page.on("pageerror", lambda error: faults.append(str(error)))
        file = f"file://{report / 'report.html'}"
        page.on("request", lambda r: _own(r.url, file) or faults.append(r.url))
        page.goto(file)
        pages.append(page)
        folder = os.environ.get("VOLCONTACT_SCREENSHOTS")
        if folder:
            page.screenshot(path=Path(folder) / f"report_{width}_{scheme}.png", full_page=True)
        return page

    yield open_page
    for page in pages:
        page.close()
    assert faults == []


def _own(url, file):
    return url == file or url.startswith("data:")


@pytest.mark.parametrize("width", [360, 1600])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_page_fits_and_follows_the_scheme(open_page, width, scheme):
    page = open_page(width, scheme)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    paper = page.evaluate("getComputedStyle(document.body).backgroundColor")
    red = int(paper.split("(")[1].split(",")[0])
    assert red > 200 if scheme == "light" else red < 60


def test_slider_moves_pictures_contacts_and_marks(open_page):
    page = open_page(1600)

    def seen():
        picture = page.locator("#big-volumetric").get_attribute("src")
        mark = page.locator(".plot .now").first.evaluate("e => e.style.left")
        return picture, page.locator("#rows-volumetric").inner_text(), mark

    last = seen()
    assert page.locator("#now").inner_text() == "1.20 s"
    page.locator("#slider").fill("0")
    first = seen()
    assert all(a != b for a, b in zip(first, last, strict=True))
    assert first[1].strip() == "nothing touches"
    assert "worksite" in last[1] or "with" in last[1]
    # A click in the middle of a curve goes to the middle of the run.
    page.locator(".plot").first.click()
    assert page.locator("#now").inner_text() == "0.60 s"


def test_pointer_reads_numbers_off_a_curve(open_page, report):
    page = open_page(1600)
    plot = page.locator('.plot[data-curve="height"]')
    plot.hover()
    text = plot.locator(".tip").inner_text()
    assert "volumetric 0." in text and "native 0." in text
    page.locator("h1").hover()
    assert not plot.locator(".tip").is_visible()


def test_page_is_small(report):
    assert (report / "report.html").stat().st_size < 15e6
