# SPDX-License-Identifier: Apache-2.0
"""The outputs of search_pairs are added up."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / "benchmarks" / "random_search.py"


def search() -> ModuleType:
    """The script as a module."""
    spec = importlib.util.spec_from_file_location(SCRIPT.stem, SCRIPT)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def failure(index: int, a: str, volume: float) -> dict[str, Any]:
    return {
        "what": "wrong volume",
        "family": "cones",
        "index": index,
        "engine": "lines",
        "status": "ok",
        "volume": volume,
        "volume_error": 1.0,
        "expected": 100.0,
        "doubt": 0.1,
        "a": a,
        "b": "Sphere(0.3)",
        "X_AB": "np.eye(4)",
    }


COUNT = {"count": "lines", "family": "cones", "cases": 10, "overlapping": 8, "undecided": 1}
COUNT |= {"slowest": 0.5, "known": [8, 7, 6, 5]}
END = {"refused": 2, "seconds": 3.0}


def text(seed: int, *lines: dict[str, Any]) -> str:
    return "".join(json.dumps(line) + "\n" for line in (*lines, {"chunk": ["cones", seed, 10]}))


def test_outputs_are_added_up() -> None:
    first = text(1, failure(3, "Frustum(0.4, 0, 0.3)", 103.0), COUNT, END)
    second = text(
        2, failure(5, "(Box((1, 1, 1)) - Sphere(0.1))", 91.0), COUNT | {"slowest": 2.0}, END
    )
    result = search().summary([first, second])
    (row,) = result["rows"]
    assert (row["cases"], row["overlapping"], row["undecided"]) == (20, 16, 2)
    assert (row["known"], row["slowest"]) == ([16, 14, 12, 10], 2.0)
    assert (result["cases"], result["refused"], result["seconds"]) == (20, 4, 6)
    (kind,) = result["failures"]
    assert kind["number"] == 2
    assert kind["worst"] == pytest.approx(0.08)  # 9 of 100 off, 1 of it claimed
    assert kind["pairs"] == {"Frustum - Sphere": 1, "Sphere - composed": 1}
    assert [example["seed"] for example in kind["examples"]] == [1, 2]


def test_a_search_goes_on_behind_a_case_that_ends_it(tmp_path: Path) -> None:
    # A program that crashes in case 4 of 10.
    program = tmp_path / "program"
    crash = json.dumps({"crash": 11, "index": 4})
    program.write_text(
        f"#!/bin/sh\nif [ $3 = 0 ]; then echo '{crash}'; exit 3; fi\n"
        f"echo '{json.dumps(COUNT | {'cases': 5})}'\necho '{json.dumps(END)}'\necho $3 $4 >&2\n"
    )
    program.chmod(0o755)
    search().run(program, tmp_path, "cones", 1, 10)
    kept = (tmp_path / search().file_of("cones", 1, 10)).read_text()
    result = search().summary([kept])
    assert [(c["seed"], c["index"], c["crash"]) for c in result["crashes"]] == [(1, 4, 11)]
    assert result["cases"] == 5


def test_chunks_hold_the_cases_asked_for() -> None:
    module = search()
    chunks = module.chunks_of(1_000_000, list(module.SHARES))
    assert sum(module.SHARES.values()) == pytest.approx(1.0)
    assert sum(size for _, _, size in chunks) == pytest.approx(1_000_000, rel=1e-2)
    assert len({module.file_of(*chunk) for chunk in chunks}) == len(chunks)


def test_what_other_engines_answered_alike_is_taken_over(tmp_path: Path) -> None:
    program = tmp_path / "program"
    program.write_text('#!/bin/sh\necho \'{"answers": "00ab"}\'\n', encoding="utf-8")
    program.chmod(0o755)
    script = search()
    name = script.file_of("cones", 1, 10)
    ends = {
        "same": [COUNT, END | {"answers": "00ab"}],
        "failed": [failure(3, "Sphere(1)", 1.0), COUNT, END | {"answers": "00ab"}],
        "other": [COUNT, END | {"answers": "00ac"}],
        "unknown": [COUNT, END],
    }
    for version, lines in ends.items():
        for each in tmp_path.glob("*/"):
            (each / name).unlink(missing_ok=True)
        old, new = tmp_path / version, tmp_path / f"after-{version}"
        old.mkdir()
        new.mkdir()
        (old / name).write_text(text(1, *lines), encoding="utf-8")
        assert script.carry(program, new, "cones", 1, 10) == (version == "same")
        assert (new / name).exists() == (version == "same")
        if version == "same":
            summary = script.summary([(new / name).read_text(encoding="utf-8")])
            assert (summary["cases"], summary["judged_elsewhere"]) == (10, 10)
