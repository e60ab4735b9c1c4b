# SPDX-License-Identifier: Apache-2.0
"""Fills the pages of engines and laws, docs/engines and docs/laws, and draws their pictures.

The text of a page is written by hand. Between `<!-- block: argument -->` and `<!-- end -->` stands
what the code and the tables of results have to say: `component_blocks.py` has the blocks. Run
`./run python docs/make_component_pages.py` after a change of a law, of results or of these pages.
"""

from __future__ import annotations

import re
from pathlib import Path

import matplotlib
from component_blocks import BLOCK
from component_pictures import PICTURE
from make_concepts import digest
from performance_plots import STYLE

DOCS = Path(__file__).parent
_BLOCK = re.compile(r"(<!-- (\w+): (.+?) -->)\n.*?(<!-- end -->)", re.DOTALL)


def pages() -> list[Path]:
    """All of them."""
    return sorted([*(DOCS / "engines").glob("*.md"), *(DOCS / "laws").glob("*.md")])


def render(text: str) -> str:
    """The text of a page with its blocks made anew."""
    return _BLOCK.sub(lambda m: f"{m[1]}\n\n{BLOCK[m[2]](m[3])}\n{m[4]}", text)


def main() -> None:
    """Fills and draws all."""
    for page in pages():
        page.write_text(render(page.read_text(encoding="utf-8")), encoding="utf-8")
    with matplotlib.rc_context(STYLE):
        for name, draw in PICTURE.items():
            figure, numbers = draw()
            about = {"Date": None, "Source": digest(numbers)}
            figure.savefig(DOCS / f"{name}.svg", metadata=about)


if __name__ == "__main__":
    main()
