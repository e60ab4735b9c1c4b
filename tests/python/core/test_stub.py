# SPDX-License-Identifier: Apache-2.0
"""python/volcontact/_volcontact.pyi: what the compiled module offers, and its types."""

from __future__ import annotations

import ast
import importlib.util
from pathlib import Path

from volcontact import _volcontact

SCRIPT = Path(__file__).parents[3] / "python" / "make_stub.py"


def make_stub():
    """python/make_stub.py as a module."""
    spec = importlib.util.spec_from_file_location("make_stub", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_stub_is_up_to_date():
    module = make_stub()
    assert module.STUB.read_text(encoding="utf-8") == module.render(), (
        "run './run python python/make_stub.py'"
    )


def test_stub_names_everything_and_python_types_only():
    tree = ast.parse(make_stub().STUB.read_text(encoding="utf-8"))
    named = {node.name for node in tree.body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    assert named == {name for name in dir(_volcontact) if not name.startswith("__")}
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    assert len(functions) > 100
    for function in functions:
        arguments = [a for a in function.args.args + function.args.kwonlyargs if a.arg != "self"]
        types = [a.annotation for a in arguments] + [function.returns]
        for annotation in types:
            assert annotation is not None, function.name
            # What nanobind cannot translate, it leaves as C++ in quotes.
            assert "::" not in ast.unparse(annotation), function.name
