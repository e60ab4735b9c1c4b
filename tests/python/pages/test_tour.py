# SPDX-License-Identifier: Apache-2.0
"""The tour runs as a stranger has it, from the package alone, and shows what the page shows."""

from __future__ import annotations

import base64
import io
import subprocess
import sys
from pathlib import Path

import mujoco
import nbformat
import numpy as np
import pytest
from PIL import Image

import volcontact
from volcontact.cli import main

MAKER = Path(__file__).parents[3] / "docs" / "generate" / "make_tour.py"
TOUR = Path(volcontact.__file__).parent / "templates" / "tour" / "tour.ipynb"
NEWEST = tuple(map(int, mujoco.mj_versionString().split("."))) >= (4,)


@pytest.fixture(scope="module")
def tour(tmp_path_factory) -> nbformat.NotebookNode:
    """The notebook that `new` writes, run in a folder that has nothing else."""
    folder = tmp_path_factory.mktemp("tour") / "mine"
    assert main(["new", str(folder), "--template", "tour"]) == 0
    assert [path.name for path in folder.iterdir()] == ["tour.ipynb"]
    notebook = folder / "tour.ipynb"
    for cell in (empty := nbformat.read(notebook, as_version=4)).cells:
        if cell.cell_type == "code":
            cell.outputs = []
    nbformat.write(empty, notebook)
    done = subprocess.run(
        [sys.executable, MAKER, notebook], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return nbformat.read(notebook, as_version=4)


def outputs(notebook: nbformat.NotebookNode, mime: str) -> dict[str, str]:
    """What the cells show of a kind, by the name of the cell."""
    return {
        cell.id: output.data[mime]
        for cell in notebook.cells
        for output in cell.get("outputs", [])
        if mime in output.get("data", {})
    }


def printed(notebook: nbformat.NotebookNode) -> dict[str, str]:
    return {
        cell.id: output.text
        for cell in notebook.cells
        for output in cell.get("outputs", [])
        if output.output_type == "stream"
    }


def test_every_cell_of_code_tells_or_shows_something(tour):
    for cell in tour.cells:
        if cell.cell_type == "code" and cell.id != "imports":
            assert cell.outputs, cell.id
    assert not any(name.endswith("stderr") for name in printed(tour))


def test_pictures_show_what_they_say(tour):
    pictures = outputs(tour, "image/png")
    assert sorted(pictures) == ["hole-picture", "insertion-picture", "rest-code"]
    for name, text in pictures.items():
        pixels = np.asarray(Image.open(io.BytesIO(base64.b64decode(text))).convert("RGB"))
        assert pixels.shape == (360, 560, 3)
        assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 40, name
    assert "force_z" in outputs(tour, "image/svg+xml")["insertion-code"]


def test_numbers_are_those_of_formulas(tour):
    text = printed(tour)
    # A cap of 1 mm of a ball of 50 mm, and m g / (k A) of the cube.
    assert text["overlap-code"].count("156.032 mm^3") == 2
    assert text["rest-code"].count("24.525 um") == 2
    assert "volumetric: 0.0000 mm/s" in text["slope-code"]


@pytest.mark.skipif(not NEWEST, reason="the page shows the numbers of the newest MuJoCo")
def test_the_page_shows_what_the_cells_print(tour):
    page = nbformat.read(TOUR, as_version=4)
    assert printed(page) == printed(tour), "run './run python docs/generate/make_tour.py'"
    assert outputs(page, "image/png").keys() == outputs(tour, "image/png").keys()
