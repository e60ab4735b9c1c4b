# SPDX-License-Identifier: Apache-2.0
"""Sphinx: the site that `./run docs` makes of the pages of the repository, each in its place."""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import latex2mathml.converter
from docutils import nodes
from sphinx.application import Sphinx

ROOT = Path(__file__).parents[1]

project = "volcontact"
copyright = "the volcontact developers"
language = "en"
extensions = [
    "autoapi.extension",
    "hawkmoth",
    "myst_nb",
    "sphinx.ext.githubpages",
    "sphinx.ext.napoleon",
]
include_patterns = [
    "*.md",
    "docs/**.md",
    "plugin/**.md",
    "mjcf_models/**.md",
    "python/examples/*.md",
    "python/volcontact/templates/tour/tour.ipynb",
]
# Sphinx looks through every folder that is not named here.
exclude_patterns = [".*", "build", "tests", "**/__pycache__"]
root_doc = "docs/index"
html_theme = "furo"
html_title = "volcontact"
html_copy_source = False
html_show_sourcelink = False
html_math_renderer = "mathml"
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4
nb_execution_mode = "off"  # docs/generate/make_tour.py has run it, and a test compares
nb_ipywidgets_js: dict[str, dict[str, str]] = {}  # which would be loaded from elsewhere

# ---- References from the code -------------------------------------------------------------------

_ARRAY = re.compile(r"Annotated\[NDArray\[numpy\.\w+\], dict\(.*?order='.'\)\]")
_SOLIDS = re.compile(r"HalfSpace \| Sphere \|[\w |]*Mesh\b")


_NORM = re.compile(r"\|(\w+)\|")
_TRAILING = re.compile(r"^( +)([^/\n]+[,;\w\d]) +/\* (.*) \*/$", re.MULTILINE)
_ARGUMENT = re.compile(r"(\w+) {2,}(\S.*)")


def unread(folder: str, names: list[str]) -> set[str]:
    """What of a folder of the package no name of the reference is in."""
    if Path(folder).name in ("fmu", "identify", "study", "file"):
        wanted = {"__init__.py", "export.py", "merge.py", "scene_export.py", "file", "settings.py"}
        return set(names) - wanted
    hidden = ("cli", "view", "templates", "report", "meshes", "__pycache__")
    return {name for name in names if name in hidden or name.endswith(".so")}


def readable_sources() -> str:
    """A copy of the package whose annotations are short: docstrings tell the shapes of arrays."""
    copy = Path(tempfile.mkdtemp(prefix="volcontact-docs-")) / "volcontact"
    shutil.copytree(ROOT / "python" / "volcontact", copy, ignore=unread)
    stub = copy / "_volcontact.pyi"
    text = _ARRAY.sub("numpy.ndarray", stub.read_text(encoding="utf-8"))
    text = _NORM.sub(r"‖\1‖", _SOLIDS.sub("Solid", text))  # bars mean something else there
    stub.write_text(text, encoding="utf-8")
    return str(copy)


def readable_header() -> str:
    """A folder with the C header, every comment in front of what it is about and marked as such."""
    header = ROOT / "plugin" / "c_api" / "volcontact.h"
    text = _TRAILING.sub(r"\1/** \3 */\n\1\2", header.read_text(encoding="utf-8"))
    copy = Path(tempfile.mkdtemp(prefix="volcontact-docs-"))
    text = re.sub(r"^/\* (?!SPDX|The contact model|----)", "/** ", text, flags=re.MULTILINE)
    (copy / header.name).write_text(text, encoding="utf-8")
    return str(copy)


def read_comment(app: Sphinx, lines: list[str], transform: str, options: Any) -> None:
    """Comments of the C header as reStructuredText: arguments in columns are a list."""
    found: list[str] = []
    for line in (line.strip().removeprefix("* ") for line in lines):
        argument = _ARGUMENT.fullmatch(line)
        found.append(f"* ``{argument[1]}``: {argument[2]}" if argument else line)
    lines[:] = found


autoapi_dirs = [readable_sources()]
autoapi_generate_api_docs = False  # docs/reference/python.md has the order
autoapi_add_toctree_entry = False
autoapi_options = ["members", "imported-members"]
suppress_warnings = ["autoapi.python_import_resolution"]  # constants and parts that are left out
hawkmoth_root = readable_header()
hawkmoth_autoconf: list[str] = []  # the header includes nothing
napoleon_use_ivar = True

# The navigation is added here: the pages are Markdown that reads well without Sphinx too.
SECTIONS = {
    "Start": [
        "README",
        "docs/gallery",
        "docs/start",
        "docs/tutorials/index",
        "A tour in a notebook </python/volcontact/templates/tour/tour>",
        *(
            f"docs/tutorials/{name}"
            for name in (
                "ten_minutes",
                "drop",
                "insertion",
                "jamming",
                "own_scene",
                "own_meshes",
                "own_law",
                "decision",
            )
        ),
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
        "docs/reference/python",
        "docs/reference/c",
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
    app.connect("hawkmoth-process-docstring", read_comment)
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
