# SPDX-License-Identifier: Apache-2.0
"""Fills the blocks of pages, as of those of engines and laws, and draws the pictures of these.

The text of a page is written by hand. Between `<!-- block: argument -->` and `<!-- end -->` stands
what the code and the tables of results have to say: `page_blocks.py` has the blocks. Run
`./run python docs/generate/make_blocks.py` after a change of a law, of results or of these pages.
"""

from __future__ import annotations

import re
from pathlib import Path

from make_concepts import save
from parts.page_blocks import BLOCK
from parts.page_pictures import PICTURE

DOCS = Path(__file__).parents[1]
_BLOCK = re.compile(r"(<!-- (\w+): (.+?) -->)\n.*?(<!-- end -->)", re.DOTALL)


def pages() -> list[Path]:
    """Those that have blocks."""
    every = [*DOCS.glob("*.md"), *DOCS.glob("*/*.md")]
    return sorted(page for page in every if _BLOCK.search(page.read_text(encoding="utf-8")))


def render(text: str) -> str:
    """The text of a page with its blocks made anew."""
    return _BLOCK.sub(lambda m: f"{m[1]}\n\n{BLOCK[m[2]](m[3])}\n{m[4]}", text)


def main() -> None:
    """Fills and draws all."""
    for page in pages():
        page.write_text(render(page.read_text(encoding="utf-8")), encoding="utf-8")
    save(PICTURE, DOCS)


if __name__ == "__main__":
    main()
