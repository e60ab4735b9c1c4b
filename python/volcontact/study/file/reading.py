# SPDX-License-Identifier: Apache-2.0
"""Reads a study file into checked settings."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import Any

from volcontact.study.environments import with_environment
from volcontact.study.file.settings import (
    ADAPTIVE,
    Correlation,
    End,
    Input,
    Record,
    Sample,
    Settings,
    StudyError,
)
from volcontact.study.file.table import Table
from volcontact.study.inputs import CORRELATED, check_input, distribution_names

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

# Each method, and what it takes besides trials and seed.
METHODS: dict[str, tuple[str, ...]] = {
    "grid": (),
    "monte_carlo": (),
    "latin_hypercube": (),
    "sobol": (),
    "morris": ("levels", "response"),
    "saltelli": ("second_order", "response"),
    "optimise": ("response", "direction", "round"),
    "importance": ("response", "threshold", "round"),
}
OUTCOMES = (
    "success",
    "failure",
    "jammed",
    "timed_out",
    "force_limit",
    "torque_limit",
    "diverged",
    "error",
    "hung",
    "crashed",
)
_TABLES = (
    "study",
    "vary",
    "correlation",
    "sample",
    "end",
    "jammed",
    "success",
    "pose",
    "control",
    "record",
)
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
RESERVED = {"trial", "outcome", "reason", "success", "time", "weight", "level"}


def read_study(path: str | os.PathLike[str]) -> Settings:
    """Reads and checks a study file, all but what needs its scene.

    Raises:
        FileNotFoundError: there is no such file.
        StudyError: a line of it is wrong.
    """
    place = Path(path)
    if not place.is_file():
        raise FileNotFoundError(f"no such study: {place}")
    return parse_study(place.read_text(encoding="utf-8"), place.resolve().parent, place.name)


def parse_study(text: str, folder: Path, file: str = "study.toml") -> Settings:
    """The settings of the text of a study file whose paths begin at a folder.

    Raises:
        StudyError: a line of it is wrong.
    """
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise StudyError(f"{file}: {error}") from error
    top = Table(with_environment(content, file), file)
    tables = {name: top.take(name, None) for name in _TABLES}
    top.finish()

    def table(name: str) -> Table:
        return Table(tables[name] if tables[name] is not None else {}, f"{file} [{name}]")

    head = table("study")
    if tables["study"] is None:
        raise StudyError(f"{file}: the table [study] is missing; it names the scene")
    inputs = _inputs(tables["vary"], file, folder)
    values: dict[str, Any] = {
        "name": head.word("name", Path(folder).name),
        "text": text,
        "folder": folder,
        "inputs": inputs,
        "correlations": _correlations(tables["correlation"], file, inputs),
        **_head(head, folder),
    }
    is_function = bool(values["function"])
    values["record"] = _record(table("record"))
    values["sample"] = _sample(table("sample"), inputs)
    values["end"] = _end(table("end"), table("jammed"), is_function=is_function)
    pose = table("pose")
    if tables["pose"] is not None:
        values["pose"] = _pose(pose)
    control = table("control")
    if tables["control"] is not None:
        values["control"] = _control(control)
    success = table("success")
    values["hold"] = success.number("hold", 0.0, low=0.0)
    values["success_function"] = success.word("function", "")
    values["success"] = success.conditions()
    if not values["success"] and not values["success_function"]:
        raise StudyError(
            f"{file} [success]: there is no success criterion; say what success is, such as "
            '"position/peg/z" = [-inf, 0.026]'
        )
    if values["python"] is None:
        for key in ("prepare", "function", "success_function"):
            if values[key]:
                raise StudyError(f"{file} [study] python is missing: the file with {values[key]}()")
    return Settings(**values)


def _head(head: Table, folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = {
        "scene": _path(head, "scene", folder),
        "function": head.word("function", ""),
        "python": _path(head, "python", folder),
        "prepare": head.word("prepare", ""),
        "contact": head.word("contact", "volumetric", among=("volumetric", "native")),
        "material": dict(head.pairs("material")),
        "options": dict(head.pairs("options")),
        "time_limit": head.number("time_limit", 60.0, above=0.0),
    }
    if head.has("timestep"):
        found["timestep"] = head.number("timestep", above=0.0)
    if head.has("keyframe"):
        found["keyframe"] = head.word("keyframe")
    head.take("timestep", None)
    head.take("keyframe", None)
    head.finish()
    if (found["scene"] is None) == (not found["function"]):
        raise StudyError(
            f"{head.where}: give one of scene (an MJCF file), environment and function"
        )
    return found


def _path(table: Table, key: str, folder: Path) -> Path | None:
    text = table.word(key, "")
    if not text:
        return None
    path = folder / text
    if not path.is_file():
        raise table.error(key, text, f"there is no such file in {folder}")
    return path.resolve()


def _inputs(content: Any, file: str, folder: Path) -> tuple[Input, ...]:
    if not content:
        raise StudyError(f"{file}: nothing varies; add a table [vary.NAME]")
    if not isinstance(content, dict):
        raise StudyError(f"{file} [vary]: must have tables [vary.NAME]")
    found = []
    for name, entry in content.items():
        where = f"{file} [vary.{name}]"
        if not _NAME.fullmatch(name) or name in RESERVED:
            raise StudyError(
                f"{where}: a name is letters, digits and _, begins with a letter and is none of "
                + ", ".join(sorted(RESERVED))
            )
        found.append(_input(name, Table(entry, where), folder))
    return tuple(found)


def _input(name: str, table: Table, folder: Path) -> Input:
    values: dict[str, Any] = {"name": name, "targets": table.words("target")}
    values["mode"] = table.word("mode", "set", among=("set", "add", "scale"))
    values["points"] = table.whole("points", 0, low=0, high=1_000_000)
    if table.has("choices"):
        values |= {"kind": "choice", **_choices(table)}
    elif table.has("table"):
        values |= {"kind": "table", "table": _path(table, "table", folder)}
        values["column"] = table.word("column", name)
    else:
        values["distribution"] = table.word("distribution", among=distribution_names())
        values["kind"] = "rotation" if values["distribution"] == "rotation" else "distribution"
        values["arguments"] = tuple(
            (key, table.number(key)) for key in list(table._content) if key != "target"
        )
    table.finish()
    made = Input(**values)
    check_input(made, table.where)
    return made


def _choices(table: Table) -> dict[str, Any]:
    choices = table.take("choices")
    if not isinstance(choices, list) or not choices:
        raise table.error("choices", choices, "must be a list of numbers or of texts")
    if len({isinstance(choice, str) for choice in choices}) != 1:
        raise table.error("choices", choices, "must be all numbers or all texts")
    weights = table.numbers("weights", (1.0,) * len(choices))
    if len(weights) != len(choices) or min(weights) < 0.0 or not sum(weights) > 0.0:
        raise table.error("weights", list(weights), "must be one number of at least 0 a choice")
    total = sum(weights)
    return {"choices": tuple(choices), "weights": tuple(w / total for w in weights)}


def _correlations(content: Any, file: str, inputs: tuple[Input, ...]) -> tuple[Correlation, ...]:
    import numpy as np

    found = []
    named: set[str] = set()
    for entry in content or ():
        table = Table(entry, f"{file} [[correlation]]")
        names = table.words("inputs")
        matrix = table.take("matrix")
        table.finish()
        known = {each.name: each for each in inputs}
        for name in names:
            if name not in known or known[name].kind not in CORRELATED:
                raise table.error("inputs", list(names), f"{name} is no input with a distribution")
            if name in named:
                raise table.error("inputs", list(names), f"{name} stands in two correlations")
            named.add(name)
        try:
            array = np.asarray(matrix, float)
            good = array.shape == (len(names),) * 2 and bool(np.all(array == array.T))
            good = good and bool(np.all(np.diag(array) == 1.0))
            good = good and bool(np.linalg.eigvalsh(array).min() > 0.0)
        except ValueError:
            good = False
        if not good:
            raise table.error(
                "matrix",
                matrix,
                "must be symmetric and positive definite with ones on its diagonal",
            )
        found.append(Correlation(names, tuple(tuple(map(float, row)) for row in matrix)))
    return tuple(found)


def _sample(table: Table, inputs: tuple[Input, ...]) -> Sample:
    method = table.word("method", "monte_carlo", among=METHODS)
    trials = table.whole("trials", 100, low=1, high=100_000_000)
    seed = table.whole("seed", 0, low=0, high=2**63 - 1)
    options: dict[str, Any] = {}
    for key in METHODS[method]:
        if key == "response":
            if table.has(key) or method in ADAPTIVE:
                options[key] = table.word(key)
        elif key == "direction":
            options[key] = table.word(key, "maximise", among=("maximise", "minimise"))
        elif key == "threshold":
            options[key] = table.number(key)
        elif key == "round":
            options[key] = table.whole(key, 20 if method == "optimise" else 2000, low=2, high=10**6)
        elif key == "levels":
            options[key] = table.whole(key, 4, low=2, high=1000)
        else:
            options[key] = bool(table.take(key, False))
        table.take(key, None)
    table.finish()
    if method == "grid":
        for each in inputs:
            if each.kind == "rotation":
                raise StudyError(f"{table.where}: a grid has no rotations; vary angles")
            if not each.points and each.kind != "choice":
                raise StudyError(f"{table.where}: a grid needs points = ... in [vary.{each.name}]")
    return Sample(method, trials, seed, options)


def _end(table: Table, jammed: Table, *, is_function: bool) -> End:
    inf = float("inf")
    duration = table.number("duration", *((1.0,) if is_function else ()), above=0.0)
    made = End(
        duration=duration,
        watch=table.number("watch", 0.0, low=0.0),
        force_limit=table.number("force_limit", inf, above=0.0),
        torque_limit=table.number("torque_limit", inf, above=0.0),
        force=table.words("force"),
        torque=table.words("torque"),
        jam_time=jammed.number("for", 0.2, above=0.0),
        jammed=jammed.conditions(),
    )
    table.finish()
    for key in ("force", "torque"):
        if len(getattr(made, key)) not in (0, 3):
            raise table.error(key, list(getattr(made, key)), "must be three quantities, x y z")
    return made


def _pose(table: Table) -> dict[str, Any]:
    found: dict[str, Any] = {"body": table.word("body")}
    if table.has("keyframe"):
        found["keyframe"] = table.word("keyframe")
    else:
        found["pos"] = table.numbers("pos")
        found["quat"] = table.numbers("quat", (1.0, 0.0, 0.0, 0.0))
        if len(found["pos"]) != 3 or len(found["quat"]) != 4:
            raise StudyError(f"{table.where}: pos has three numbers, quat four")
    table.take("keyframe", None)
    table.take("quat", None)
    table.finish()
    return found


def _control(table: Table) -> dict[str, Any]:
    found = {"policy": table.word("policy"), "period": table.number("period", 0.1, above=0.0)}
    found["gains"] = {key: table.number(key) for key in list(table._content)}
    return found


def _record(table: Table) -> Record:
    places = []
    for name, patterns in table.pairs("places"):
        names = [patterns] if isinstance(patterns, str) else patterns
        if not isinstance(names, list) or not all(isinstance(p, str) for p in names):
            raise table.error("places", {name: patterns}, "must name geoms, as post = ['post_*']")
        places.append((name, tuple(names)))
    wanted = Table(dict(table.pairs("trajectories")), f"{table.where} trajectories")
    trajectories: dict[str, Any] = {
        "worst": wanted.whole("worst", 0, low=0, high=10_000),
        "every": wanted.whole("every", 0, low=0, high=10**9),
        "most": wanted.whole("most", 100, low=1, high=10**6),
        "outcomes": wanted.words("outcomes"),
    }
    for outcome in trajectories["outcomes"]:
        if outcome not in OUTCOMES:
            known = ", ".join(OUTCOMES)
            raise wanted.error("outcomes", outcome, f"is no outcome; there is {known}")
    wanted.finish()
    made = Record(
        places=tuple(places),
        final=table.pairs("final"),
        peak=table.pairs("peak"),
        columns=table.words("columns"),
        functions=table.words("functions"),
        trajectories=trajectories,
    )
    table.finish()
    return made
