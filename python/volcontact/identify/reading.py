# SPDX-License-Identifier: Apache-2.0
"""Reads an identification file into checked settings."""

from __future__ import annotations

import math
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from volcontact.identify.ranges import DEFAULTS, field_of, reason_against
from volcontact.identify.settings import (
    WIDTHS,
    Estimator,
    Frame,
    Measure,
    Nuisance,
    Parameter,
    Settings,
    Start,
    StudyError,
    Uncertainty,
    Window,
)
from volcontact.identify.units import SIGMA_UNITS, UNITS
from volcontact.messages.spelling import nearest
from volcontact.study.file.table import Table

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

METHODS = ("least_squares", "cma", "optuna")
LOSSES = ("linear", "soft_l1", "huber", "cauchy", "absolute")
_TABLES = (
    "identify",
    "measurements",
    "frame",
    "measure",
    "parameter",
    "start",
    "window",
    "nuisance",
    "estimator",
    "uncertainty",
    "material",
    "options",
)
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def read_settings(
    path: str | os.PathLike[str], *, measurements: Sequence[str | os.PathLike[str]] | None = None
) -> Settings:
    """Reads and checks an identification file, all but what needs scene and measurements.

    Args:
        path: of the file.
        measurements: files instead of those that it names.

    Raises:
        FileNotFoundError: there is no such file.
        StudyError: a line of it is wrong.
    """
    place = Path(path)
    if not place.is_file():
        raise FileNotFoundError(f"no such study: {place}")
    text = place.read_text(encoding="utf-8")
    return parse_settings(text, place.resolve().parent, place.name, measurements)


def parse_settings(
    text: str,
    folder: Path,
    file: str = "study.toml",
    measurements: Sequence[str | os.PathLike[str]] | None = None,
) -> Settings:
    """The settings of the text of a file whose paths begin at a folder.

    Raises:
        StudyError: a line of it is wrong.
    """
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise StudyError(f"{file}: {error}") from error
    top = Table(content, file)
    tables = {name: top.take(name, {}) for name in _TABLES}
    top.finish()

    def table(name: str) -> Table:
        return Table(tables[name], f"{file} [{name}]")

    head = table("identify")
    values: dict[str, Any] = {
        "name": head.word("name", folder.name),
        "text": text,
        "folder": folder,
        "scene": _file(head, "scene", head.word("scene"), folder),
        "contact": head.word("contact", "volumetric", among=("volumetric", "native")),
        "timestep": head.number("timestep", above=0.0) if head.has("timestep") else None,
    }
    head.take("timestep", None)
    head.finish()
    values |= _measurements(table("measurements"), folder, measurements)
    values["frame"] = _frame(table("frame"))
    values["measures"] = _measures(tables["measure"], file)
    values["parameters"] = _parameters(tables["parameter"], file)
    values["start"] = _start(table("start"))
    values["window"] = _window(table("window"))
    values["nuisance"] = _nuisance(table("nuisance"))
    values["estimator"] = _estimator(table("estimator"))
    names = [each.name for each in values["parameters"]]
    values["uncertainty"] = _uncertainty(table("uncertainty"), names)
    values["material"] = dict(_all_of(tables["material"], f"{file} [material]"))
    values["options"] = dict(_all_of(tables["options"], f"{file} [options]"))
    made = Settings(**values)
    _check_together(made, file)
    return made


def _all_of(content: Any, where: str) -> tuple[tuple[str, Any], ...]:
    """A whole table as pairs."""
    return Table({"all": content}, where).pairs("all")


def _file(table: Table, key: str, name: str, folder: Path) -> Path:
    place = (folder / name).resolve()
    if not place.is_file():
        raise table.error(key, name, f"there is no such file in {folder.name}")
    return place


def _measurements(
    table: Table, folder: Path, instead: Sequence[str | os.PathLike[str]] | None
) -> dict[str, Any]:
    given = table.words("files", None) if table.has("files") else (table.word("file"),)
    if instead:
        given = tuple(str(Path(each).resolve()) for each in instead)
    if not given:
        raise table.error("files", list(given), "must name at least one file")
    files = []
    for name in given:
        if "*" in name:
            found = sorted(path for path in folder.glob(name) if path.is_file())
            if not found:
                raise table.error("files", name, f"there is no such file in {folder.name}")
            files += found
        else:
            files.append(_file(table, "files", name, folder))
    for path in files:
        if path.suffix not in (".parquet", ".csv"):
            raise table.error("files", path.name, "must end with .parquet or .csv")
    found_values: dict[str, Any] = {
        "files": tuple(files),
        "trial": table.word("trial", ""),
        "time": table.word("time", "t"),
        "time_scale": _unit(table, "time_unit", "time"),
        "fit": _labels(table, "fit"),
        "judge": _labels(table, "judge"),
    }
    for key in ("file", "files"):
        table.take(key, None)
    table.finish()
    return found_values


def _labels(table: Table, key: str) -> tuple[str, ...] | None:
    if not table.has(key):
        table.take(key, None)
        return None
    given = table.take(key)
    if not isinstance(given, list) or not all(isinstance(each, int | str) for each in given):
        raise table.error(key, given, "must be a list of trials, such as [0, 1, 2]")
    labels = tuple(map(str, given))
    if len(set(labels)) != len(labels):
        twice = next(each for each in labels if labels.count(each) > 1)
        raise table.error(key, twice, "stands there twice")
    if not labels:
        raise table.error(key, given, "must name at least one trial")
    return labels


def _unit(table: Table, key: str, kind: str, units: dict[str, float] | None = None) -> float:
    known = UNITS[kind] if units is None else units
    word = table.word(key, next(iter(known)))
    if word not in known:
        raise table.error(key, word, f"is no unit of {kind}{nearest(word, known)}")
    return known[word]


def _frame(table: Table) -> Frame:
    pos = table.numbers("pos", (0.0, 0.0, 0.0))
    quat = table.numbers("quat", (1.0, 0.0, 0.0, 0.0))
    if len(pos) != 3:
        raise table.error("pos", list(pos), "must be three numbers [m]")
    length = math.hypot(*quat)
    if len(quat) != 4 or abs(length - 1.0) > 1e-3:
        raise table.error("quat", list(quat), "must be four numbers w x y z of length 1")
    table.finish()
    return Frame(pos, tuple(number / length for number in quat))


def _measures(content: Any, file: str) -> tuple[Measure, ...]:
    named = _all_of(content, f"{file} [measure]")
    if not named:
        raise StudyError(
            f"{file}: there is no [measure.NAME]; say what was measured, such as "
            '[measure.position] with kind = "position", of = BODY, columns = ["x", "y", "z"]'
        )
    return tuple(_measure(name, entry, file) for name, entry in named)


def _measure(name: str, content: Any, file: str) -> Measure:
    table = Table(content, f"{file} [measure.{name}]")
    if not _NAME.fullmatch(name):
        raise StudyError(f"{table.where}: a name has letters, digits and _ alone")
    kind = table.word("kind", name if name in WIDTHS else "sensor", among=(*WIDTHS, "sensor"))
    columns = table.words("columns")
    count = WIDTHS[kind][0] if kind in WIDTHS else len(columns)
    if len(columns) != count or not columns:
        wanted = f"{count} columns" if kind in WIDTHS else "at least one column"
        raise table.error("columns", list(columns), f"a {kind} has {wanted}")
    scale = _unit(table, "unit", kind)
    if kind in SIGMA_UNITS:
        sigma_scale = _unit(table, "sigma_unit", kind, SIGMA_UNITS[kind])
    else:
        sigma_scale = scale
    weight = table.number("weight", 1.0, low=0.0)
    made = Measure(
        name=name,
        kind=kind,
        of=table.word("of"),
        columns=columns,
        scale=scale,
        sigma=sigma_scale * table.number("sigma", *(() if weight else (1.0,)), above=0.0),
        weight=weight,
        frame=table.word("frame", "world", among=("world", "body")),
        order=table.word("order", "wxyz", among=("wxyz", "xyzw")),
        bias=sigma_scale * table.number("bias", 0.0, low=0.0),
    )
    if made.frame != "world" and kind not in ("velocity", "angular_velocity"):
        raise table.error("frame", made.frame, "only velocities can be in the body's frame")
    table.finish()
    return made


def _parameters(content: Any, file: str) -> tuple[Parameter, ...]:
    named = _all_of(content, f"{file} [parameter]")
    if not named:
        raise StudyError(
            f"{file}: there is no [parameter.NAME]; say what is looked for, such as "
            '[parameter.k] with target = "volcontact/material/steel/stiffness"'
        )
    made = tuple(_parameter(name, entry, file) for name, entry in named)
    names = [each.name for each in made]
    for each in made:
        if each.times and (each.times not in names or each.times == each.name):
            others = [name for name in names if name != each.name]
            raise StudyError(
                f"{file} [parameter.{each.name}] times = {each.times!r}: is no other parameter"
                + nearest(each.times, others)
            )
        if each.times and next(p for p in made if p.name == each.times).times:
            raise StudyError(
                f"{file} [parameter.{each.name}] times = {each.times!r}: is a multiple itself"
            )
    return made


def _parameter(name: str, content: Any, file: str) -> Parameter:
    table = Table(content, f"{file} [parameter.{name}]")
    if not _NAME.fullmatch(name):
        raise StudyError(f"{table.where}: a name has letters, digits and _ alone")
    if not table.has("target"):
        raise StudyError(f'{table.where}: target is missing, such as "geom/NAME/size/0"')
    targets = table.words("target")
    if not targets:
        raise table.error("target", [], "must name at least one place")
    field = field_of(targets[0])
    mode = table.word("mode", "set", among=("set", "add", "scale"))
    times = table.word("times", "")
    low, high, log = (
        DEFAULTS[field]
        if field in DEFAULTS and mode == "set" and not times
        else (math.nan, math.nan, False)
    )
    if table.has("bounds"):
        bounds = table.numbers("bounds")
        if len(bounds) != 2:
            raise table.error("bounds", list(bounds), "must be [low, high]")
        low, high = bounds
        if not low < high or not (math.isfinite(low) and math.isfinite(high)):
            raise table.error("bounds", list(bounds), "must be two numbers, the smaller one first")
    elif math.isnan(low):
        raise StudyError(
            f"{table.where}: bounds are missing; only fields of materials and pairs have their own"
        )
    table.take("bounds", None)
    log = table.word("scale", "log" if log else "linear", among=("log", "linear")) == "log"
    if log and low <= 0.0:
        raise table.error("bounds", [low, high], "must be above 0 on a logarithmic scale")
    if field and mode == "set" and not times:
        for bound in (low, high):
            reason = reason_against(field, bound)
            if reason:
                raise table.error("bounds", [low, high], reason)
    start = table.number("start", low=low, high=high) if table.has("start") else None
    table.take("start", None)
    prior = None
    if table.has("prior"):
        given = table.numbers("prior")
        if len(given) != 2 or not given[1] > 0.0 or (log and given[0] <= 0.0):
            raise table.error("prior", list(given), "must be [mean, standard deviation above 0]")
        prior = given[0], given[1]
    table.take("prior", None)
    table.finish()
    return Parameter(name, targets, mode, low, high, start, log, prior, times)


def _start(table: Table) -> Start:
    made = Start(
        measured=table.word("from", "measured", among=("measured", "scene")) == "measured",
        samples=table.whole("samples", 5, low=2, high=1000),
        skip=table.whole("skip", 0, low=0, high=10**6),
    )
    table.finish()
    return made


def _window(table: Table) -> Window:
    made = Window(
        duration=table.number("duration", math.inf, above=0.0),
        impacts=table.whole("impacts", 0, low=0, high=10_000),
        acceleration=table.number("acceleration", 50.0, above=0.0),
        gap=table.number("gap", 0.02, low=0.0),
        segment=table.number("segment", 0.0, low=0.0),
    )
    table.finish()
    return made


def _nuisance(table: Table) -> Nuisance:
    keys = ("position", "angle", "velocity", "spin", "clock")
    made = Nuisance(**{key: table.number(key, 0.0, low=0.0) for key in keys})
    table.finish()
    return made


def _estimator(table: Table) -> Estimator:
    method = table.word("method", "least_squares", among=METHODS)
    loss = table.word("loss", "linear" if method == "least_squares" else "absolute", among=LOSSES)
    if method == "least_squares" and loss == "absolute":
        raise table.error("loss", loss, "least squares needs a smooth loss, such as soft_l1")
    made = Estimator(
        method=method,
        starts=table.whole("starts", 3 if method == "least_squares" else 1, low=1, high=1000),
        evaluations=table.whole("evaluations", 200, low=1, high=10**7),
        seed=table.whole("seed", 0, low=0, high=2**31 - 1),
        loss=loss,
        loss_scale=table.number("loss_scale", 1.0, above=0.0),
        tolerance=table.number("tolerance", 1e-8 if method == "least_squares" else 1e-3, above=0.0),
        step=table.number("step", 1e-5, above=0.0, high=0.1),
        population=table.whole("population", 0, low=0, high=10_000),
        spread=table.number("spread", 0.25, above=0.0, high=1.0),
    )
    table.finish()
    return made


def _uncertainty(table: Table, names: list[str]) -> Uncertainty:
    made = Uncertainty(
        level=table.number("level", 0.95, above=0.0, high=0.9999),
        profile=table.words("profile"),
        points=table.whole("points", 4, low=1, high=100),
        bootstrap=table.whole("bootstrap", 0, low=0, high=100_000),
        scale=bool(table.take("scale", True)),
        mcmc=table.whole("mcmc", 0, low=0, high=10**7),
        walkers=table.whole("walkers", 0, low=0, high=10**5),
        burn=table.whole("burn", low=0, high=10**7) if table.has("burn") else None,
    )
    table.take("burn", None)
    if made.burn is not None and made.burn >= made.mcmc:
        raise table.error("burn", made.burn, "must be fewer than the steps of mcmc")
    for name in made.profile:
        if name not in names:
            raise table.error("profile", name, f"is no parameter{nearest(name, names)}")
    table.finish()
    return made


def _check_together(settings: Settings, file: str) -> None:
    if settings.fit and settings.judge:
        both = sorted(set(settings.fit) & set(settings.judge))
        if both:
            raise StudyError(
                f"{file} [measurements] judge: trial {both[0]!r} is fitted to as well; a trial "
                "either serves the fit or judges it"
            )
    if not any(each.weight > 0.0 for each in settings.measures):
        raise StudyError(f"{file} [measure]: every weight is 0; something must count")
    if settings.estimator.method != "least_squares":
        if settings.uncertainty.mcmc:
            raise StudyError(
                f"{file} [uncertainty] mcmc: needs errors with a likelihood; take the estimator "
                '"least_squares"'
            )
        if settings.nuisance != Nuisance() or any(each.bias for each in settings.measures):
            raise StudyError(
                f"{file} [nuisance]: numbers of each trial are found by least squares alone"
            )
        if settings.uncertainty.profile:
            raise StudyError(f"{file} [uncertainty] profile: is for least squares alone")
    if settings.contact == "native" and (settings.material or settings.options):
        raise StudyError(f"{file} [material]: native contact has none of ours")
