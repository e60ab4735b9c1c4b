# SPDX-License-Identifier: Apache-2.0
"""Every message of the code is in docs/troubleshooting.md."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "docs" / "troubleshooting.md"
CPP = ("plugin/volcontact", "plugin/adaptor", "plugin/c_api", "python/bindings")
SHORTEST = 12  # of the fixed words of a message that say something

_CALL = re.compile(r"throw std::\w+\(|\b(?:require|fail|refuse|warn\w*|mju_warning)\(")
_LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def longest(words: list[str]) -> str:
    """The longest run of fixed words of a message."""
    return max(words, key=len, default="").replace("`", "").strip(" :,.")


def messages_of_cpp(text: str) -> Iterator[str]:
    for call in _CALL.finditer(text):
        statement = text[call.end() : text.find(";", call.end())]
        joined = re.sub(r'"\s*\n\s*"', "", statement)  # adjacent literals are one
        yield longest([word.replace(r"\"", '"') for word in _LITERAL.findall(joined)])


def messages_of_python(text: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(text)):
        call = node.exc if isinstance(node, ast.Raise) else node
        if not isinstance(call, ast.Call):
            continue
        if call is node and not ast.unparse(call.func).endswith("warn"):
            continue
        constants = [part for argument in call.args for part in ast.walk(argument)]
        yield longest(
            [c.value for c in constants if isinstance(c, ast.Constant) and isinstance(c.value, str)]
        )


def messages() -> list[tuple[str, str]]:
    found = set()
    for folder in CPP:
        for path in (ROOT / folder).rglob("*.*"):
            if path.suffix in (".cc", ".h"):
                found |= {(path.name, m) for m in messages_of_cpp(path.read_text("utf-8"))}
    for path in (ROOT / "python" / "volcontact").rglob("*.py"):
        found |= {(path.name, m) for m in messages_of_python(path.read_text("utf-8"))}
    return sorted((name, message) for name, message in found if len(message) >= SHORTEST)


def test_the_search_finds_messages_of_both_languages() -> None:
    found = {message for _, message in messages()}
    assert "two planes cannot be a pair" in found  # adaptor
    assert "this contact is closed" in found  # package
    assert len(found) > 80


def test_every_message_is_in_the_page() -> None:
    page = PAGE.read_text("utf-8").replace("`", "")
    missing = [f"{source}: {message}" for source, message in messages() if message not in page]
    assert not missing, "add rows to docs/troubleshooting.md for\n" + "\n".join(missing)
