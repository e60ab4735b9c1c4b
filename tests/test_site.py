# SPDX-License-Identifier: Apache-2.0
"""The site of `./run docs` can be read from a disk: no page loads anything from a host.

A program of its own, since the site is built without the package: `test_site.py FOLDER`.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

_LOADED = re.compile(
    r"<(?:script|img|iframe|source|video|audio)\b[^>]*\bsrc=[\"']?((?:https?:)?//[^\"'\s>]+)"
    r"|<link\b(?![^>]*rel=[\"']?(?:canonical|search|index|next|prev))[^>]*"
    r"\bhref=[\"']?((?:https?:)?//[^\"'\s>]+)"
)
_IMPORTED = re.compile(r"(?:@import\s+|url\()[\"']?((?:https?:)?//[^\"')\s]+)")


def requests(site: Path) -> list[str]:
    """What the pages and style sheets load from elsewhere, each with its file."""
    found = []
    for path in sorted(site.rglob("*")):
        pattern = {".html": _LOADED, ".css": _IMPORTED}.get(path.suffix)
        if pattern is not None:
            for match in pattern.finditer(path.read_text(encoding="utf-8")):
                found.append(f"{path}: {next(filter(None, match.groups()))}")
    return found


def main() -> int:
    """Prints what is wrong; 0 when nothing is."""
    site = Path(sys.argv[1])
    if not (site / "docs" / "index.html").is_file():
        print(f"{site}: there is no site here; './run docs' builds it")
        return 1
    bad = requests(site)
    print("\n".join(bad))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
