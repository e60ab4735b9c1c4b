# SPDX-License-Identifier: Apache-2.0
"""Runs the tour, a notebook that `volcontact new --template tour` writes, and keeps what it shows.

./run python docs/generate/make_tour.py [NOTEBOOK]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import nbformat
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient

import volcontact

TOUR = Path(volcontact.__file__).parent / "templates" / "tour" / "tour.ipynb"
_KEPT = {"image/png", "image/svg+xml"}


def executed(path: Path) -> nbformat.NotebookNode:
    """The notebook after its cells have run in its folder; an error in a cell is raised."""
    notebook = nbformat.read(path, as_version=4)
    resources = {"metadata": {"path": str(path.resolve().parent)}}
    with tempfile.TemporaryDirectory() as sockets:  # no port is opened
        kernel = AsyncKernelManager(
            kernel_name="python3", transport="ipc", ip=str(Path(sockets, "kernel"))
        )
        NotebookClient(notebook, km=kernel, resources=resources, timeout=600).execute()
    return notebook


def tidy(notebook: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """The same without times, and of each picture the picture alone."""
    for cell in notebook.cells:
        cell.metadata = {}
        for number, output in enumerate(cell.get("outputs", [])):
            if "execution_count" in output:
                output.execution_count = None
            if _KEPT & output.get("data", {}).keys():
                output.data.pop("text/plain", None)
                output.metadata = {}
            cell.outputs[number] = output
        if "execution_count" in cell:
            cell.execution_count = None
        if "outputs" in cell:
            cell.outputs = _joined(cell.outputs)
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    return notebook


def _joined(outputs: list[nbformat.NotebookNode]) -> list[nbformat.NotebookNode]:
    """What a cell prints comes in pieces, as it happens to be sent."""
    joined: list[nbformat.NotebookNode] = []
    for output in outputs:
        if joined and output.output_type == "stream" and joined[-1].get("name") == output.name:
            joined[-1].text += output.text
        else:
            joined.append(output)
    return joined


def main() -> None:
    """Writes the tour, or another notebook, in its place."""
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else TOUR
    nbformat.write(tidy(executed(path)), path)


if __name__ == "__main__":
    main()
