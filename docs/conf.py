# SPDX-License-Identifier: Apache-2.0
"""Sphinx: the site that `./run docs` makes of the pages of the repository, each in its place."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import latex2mathml.converter
from docutils import nodes
from sphinx.application import Sphinx

project = "volcontact"
copyright = "the volcontact developers"
language = "en"
extensions = ["myst_parser", "sphinx.ext.githubpages"]
include_patterns = [
    "*.md",
    "docs/**.md",
    "plugin/**.md",
    "mjcf_models/**.md",
    "python/examples/*.md",
]
root_doc = "docs/index"
html_theme = "furo"
html_title = "volcontact"
html_copy_source = False
html_show_sourcelink = False
html_math_renderer = "mathml"
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4

# The navigation is added here: the pages are Markdown that reads well without Sphinx too.
SECTIONS = {
    "Start": [
        "README",
        "docs/start",
        "docs/install",
        "docs/concepts",
        "docs/choosing",
        "docs/python",
        "docs/environment",
        "docs/convergence",
        "docs/studies",
        "docs/studies/peg_in_hole_misalignment",
        "docs/studies/battery_insert_0g",
        "docs/identification",
        "docs/identification/cube_tosses",
        "docs/bench_tests",
        "docs/identification/coverage",
        "python/examples/README",
        "docs/troubleshooting",
        "docs/faq",
    ],
    "Scenes": [
        "docs/writing_a_scene",
        "docs/mjcf_keys",
        "docs/components",
        "docs/meshes",
        "mjcf_models/README",
    ],
    "Engines": [
        f"docs/engines/{name}"
        for name in ("closed_form", "clip", "lines", "surface_sweep", "columns", "octree")
    ],
    "Laws": [
        f"docs/laws/{name}"
        for name in (
            "volume_spring",
            "hunt_crossley",
            "elastic_coulomb",
            "regularized_coulomb",
            "bristle",
            "coupling",
            "rolling",
            "gonthier",
            "potential",
        )
    ],
    "In MuJoCo and elsewhere": [
        "docs/plugin",
        "Building and loading it </plugin/README>",
        "docs/own_laws",
        "docs/c_container",
        "docs/fmu",
        "docs/hosts",
        *(f"docs/hosts/{name}" for name in ("scipy", "drake", "dart", "basilisk")),
        "docs/simulink",
    ],
    "Measured": [
        "docs/comparison",
        "docs/accuracy",
        "docs/validation",
        "docs/performance",
        "docs/assembly",
        "docs/third_party",
        "docs/campaign",
    ],
    "Inside": [
        "docs/theory",
        "docs/glossary",
        "docs/architecture",
        "CONTRIBUTING",
        "plugin/cgal/README",
        "CHANGELOG",
        "docs/references",
    ],
}


def add_navigation(app: Sphinx, page: str, source: list[str]) -> None:
    """Gives the first page the navigation, and the list of scenes its scenes."""
    if page == app.config.root_doc:
        for section, pages in SECTIONS.items():
            source[0] += toctree(
                f":caption: {section}", (page if ">" in page else f"/{page}" for page in pages)
            )
    elif page == "mjcf_models/README":
        source[0] += toctree(":glob:", ["/mjcf_models/*/README", "/mjcf_models/*/*/README"])


def toctree(option: str, pages: Iterable[str]) -> str:
    """A hidden table of contents."""
    return "\n".join(["", "", "```{toctree}", ":hidden:", option, "", *pages, "```", ""])


def visit_inline(translator: Any, node: nodes.math) -> None:
    """A formula in a line, as MathML, which browsers draw without a script."""
    translator.body.append(latex2mathml.converter.convert(node.astext()))
    raise nodes.SkipNode


def visit_block(translator: Any, node: nodes.math_block) -> None:
    """A formula on lines of its own."""
    formula = latex2mathml.converter.convert(node.astext(), display="block")
    translator.body.append(f'<div class="formula">{formula}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> None:
    """Sphinx calls this."""
    app.connect("source-read", add_navigation)
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
