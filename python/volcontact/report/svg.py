# SPDX-License-Identifier: Apache-2.0
"""Figures as SVG: for files, and for a page that gives them its colours."""

from __future__ import annotations

import io
import re

from matplotlib.figure import Figure

from volcontact.report import palette

# Colours on white paper, and the CSS variables of the page that replace them there.
INK, MUTED, LINE = "#1b1f27", "#5b6472", "#dfe3e8"
_VARIABLES = {
    INK: "var(--ink)",
    MUTED: "var(--muted)",
    LINE: "var(--line)",
    palette.VOLUMETRIC: "var(--volumetric)",
    palette.NATIVE: "var(--native)",
}
_PAPER = '<rect width="100%" height="100%" fill="#fff"/>'


def standing_alone(figure: Figure) -> str:
    """SVG of a figure, dark on white."""
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None})
    text = re.sub(r"<metadata>.*?</metadata>", "", buffer.getvalue(), flags=re.DOTALL)
    return re.sub(r"(<svg[^>]*>)", rf"\1{_PAPER}", text, count=1)


def inline(paper: str, name: str) -> str:
    """For the page: its colours for ink, and ids that no other figure of it has."""
    text = paper[paper.index("<svg") :].replace(_PAPER, "")
    for color, variable in _VARIABLES.items():
        text = text.replace(color, variable)
    opening, rest = text.split(">", 1)
    opening = re.sub(r' (width|height)="[^"]*"', "", opening)  # the page decides; viewBox stays
    text = f"{opening}>{rest}"
    text = re.sub(r'\bid="', f'id="{name}-', text)
    text = re.sub(r"url\(#", f"url(#{name}-", text)
    return re.sub(r'href="#', f'href="#{name}-', text)
