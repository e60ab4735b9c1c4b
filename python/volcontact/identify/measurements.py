# SPDX-License-Identifier: Apache-2.0
"""Reads measurements into trials: SI units, the world's frame, every sample with its time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from volcontact.identify import rotations
from volcontact.identify.settings import Frame, Measure, Settings, StudyError
from volcontact.messages.spelling import nearest

_ORDER_SAMPLES = 5  # below these a wrong order of quaternions cannot be told


@dataclass(frozen=True)
class Samples:
    """One measured quantity of a trial.

    Attributes:
        index: of each sample among the times of the trial, shape (n,).
        values: shape (n, numbers) [SI].
    """

    index: np.ndarray
    values: np.ndarray


@dataclass(frozen=True)
class Trial:
    """One measured motion.

    Attributes:
        label: of the trial.
        times: of its samples, from 0 on and rising, shape (n,) [s].
        samples: of each measure, by name.
    """

    label: str
    times: np.ndarray
    samples: dict[str, Samples]


def read_trials(settings: Settings, labels: tuple[str, ...] | None = None) -> list[Trial]:
    """Trials of the files, in their order, or those of some labels.

    Raises:
        StudyError: a column is missing, a number is none, a trial has too few samples.
    """
    found: dict[str, Trial] = {}
    for path in settings.files:
        for label, table in _split(settings, _read(path, settings), path):
            if labels is not None and label not in labels:
                continue
            if label in found:
                raise StudyError(f"{path.name}: trial {label!r} is in another file as well")
            found[label] = _trial(settings, label, table, path)
    if labels is None:
        return list(found.values())
    for label in labels:
        if label not in found:
            known = ", ".join(list(found)[:5]) or "none of those asked for"
            raise StudyError(f"[measurements]: there is no trial {label!r}; there is {known}")
    return [found[label] for label in labels]


def _read(path: Path, settings: Settings) -> pa.Table:
    wanted = {settings.time} | {c for each in settings.measures for c in each.columns}
    if settings.trial:
        wanted.add(settings.trial)
    try:
        if path.suffix == ".parquet":
            import pyarrow.parquet

            table = pyarrow.parquet.read_table(path)
        else:
            import pyarrow.csv

            # Only an empty cell is a missing one: a sensor that says "nan" has failed.
            options = pyarrow.csv.ConvertOptions(null_values=[""], strings_can_be_null=False)
            table = pyarrow.csv.read_csv(path, convert_options=options)
    except (pa.ArrowException, OSError) as error:
        raise StudyError(f"{path.name}: cannot be read: {str(error).splitlines()[0]}") from error
    for column in sorted(wanted):
        if column not in table.column_names:
            hint = nearest(column, table.column_names)
            raise StudyError(f"{path.name}: there is no column {column!r}{hint}")
    return table.select(sorted(wanted))


def _split(settings: Settings, table: pa.Table, path: Path) -> list[tuple[str, pa.Table]]:
    if not settings.trial:
        return [(path.stem, table)]
    coded = table[settings.trial].combine_chunks().dictionary_encode()
    if coded.null_count:
        row = np.flatnonzero(np.asarray(coded.is_null()))[0] + 1
        raise StudyError(f"{path.name} row {row}: the trial, column {settings.trial!r}, is missing")
    codes = np.asarray(coded.indices)
    order = np.argsort(codes, kind="stable")
    table = table.take(order)
    edges = np.searchsorted(codes[order], np.arange(len(coded.dictionary) + 1))
    labels = map(str, coded.dictionary.to_pylist())
    return [
        (label, table.slice(begin, end - begin))
        for label, begin, end in zip(labels, edges[:-1], edges[1:], strict=True)
    ]


def _numbers(table: pa.Table, column: str, label: str, path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Values, and which of them are there."""
    where = f"{path.name} trial {label}: column {column!r}"
    chunk = table[column].combine_chunks()
    if isinstance(chunk, pa.ChunkedArray):  # newer releases keep one with no chunk
        chunk = pa.concat_arrays(chunk.chunks) if chunk.num_chunks else pa.array([], chunk.type)
    if not (pa.types.is_integer(chunk.type) or pa.types.is_floating(chunk.type)):
        if pa.types.is_null(chunk.type):
            return np.full(len(chunk), math.nan), np.zeros(len(chunk), bool)
        raise StudyError(f"{where} holds {chunk.type}: must hold numbers")
    there = ~np.asarray(chunk.is_null())
    values = np.asarray(chunk.cast(pa.float64()).fill_null(0.0), float)
    wrong = np.flatnonzero(~np.isfinite(values) & there)
    if len(wrong):
        raise StudyError(
            f"{where} has {values[wrong[0]]} at sample {wrong[0]}: leave the cell empty where "
            "nothing was measured"
        )
    return values, there


def _trial(settings: Settings, label: str, table: pa.Table, path: Path) -> Trial:
    where = f"{path.name} trial {label}"
    times, there = _numbers(table, settings.time, label, path)
    if not there.all():
        missing = int(np.flatnonzero(~there)[0])
        raise StudyError(f"{where}: sample {missing} has no time, column {settings.time!r}")
    times = times * settings.time_scale
    columns = {
        column: _numbers(table, column, label, path)
        for column in dict.fromkeys(c for each in settings.measures for c in each.columns)
    }
    order = np.argsort(times, kind="stable")[settings.start.skip :]
    times = times[order]
    if len(times) < 2:
        raise StudyError(f"{where}: has {len(times)} samples; a trial needs at least two")
    same = np.flatnonzero(np.diff(times) <= 0.0)
    if len(same):
        raise StudyError(f"{where}: two samples have the time {times[same[0]]:g} s")
    samples = {}
    for measure in settings.measures:
        given = [columns[c] for c in measure.columns]
        present = np.logical_and.reduce([there[order] for _, there in given])
        index = np.flatnonzero(present)
        values = np.stack([values[order][index] for values, _ in given], axis=1)
        samples[measure.name] = Samples(index, _in_si(measure, settings.frame, values, where))
    trial = Trial(label, times - times[0], samples)
    _check_spin(settings, trial, where)
    if not any(len(samples[each.name].index) for each in settings.measures if each.weight):
        raise StudyError(f"{where}: has no sample of any measure that counts")
    return trial


def _in_si(measure: Measure, frame: Frame, values: np.ndarray, where: str) -> np.ndarray:
    pos, quat = np.array(frame.pos), np.array(frame.quat)
    if measure.kind == "orientation":
        if measure.order == "xyzw":
            values = np.roll(values, 1, axis=1)
        length = np.linalg.norm(values, axis=1, keepdims=True)
        wrong = np.flatnonzero(np.abs(length[:, 0] - 1.0) > 0.02)
        if len(wrong):
            raise StudyError(
                f"{where}: [measure.{measure.name}] at sample {wrong[0]} has length "
                f"{length[wrong[0], 0]:.3g}; a quaternion has length 1"
            )
        return rotations.product(quat, values / length)
    values = measure.scale * values
    if measure.kind == "position":
        result: np.ndarray = pos + rotations.rotate(quat, values)
        return result
    if measure.kind in ("velocity", "angular_velocity") and measure.frame == "world":
        return rotations.rotate(quat, values)
    return values


def _check_spin(settings: Settings, trial: Trial, where: str) -> None:
    """Measured spin tells whether quaternions were read in their right order."""
    for turn in settings.measures:
        for spin in settings.measures:
            if turn.kind != "orientation" or spin.kind != "angular_velocity" or turn.of != spin.of:
                continue
            right = _spin_error(trial, turn, spin, lambda q: q)
            wrong = _spin_error(trial, turn, spin, _other_order(turn))
            if right is not None and wrong is not None and right > 3.0 * wrong:
                other = "xyzw" if turn.order == "wxyz" else "wxyz"
                raise StudyError(
                    f'{where}: [measure.{turn.name}] order = "{turn.order}" is unlikely: the '
                    f'measured spin fits "{other}"'
                )


def _other_order(measure: Measure) -> Any:
    shift = -1 if measure.order == "xyzw" else 1
    return lambda q: np.roll(q, shift, axis=-1)


def _spin_error(trial: Trial, turn: Measure, spin: Measure, order: Any) -> float | None:
    q, w = trial.samples[turn.name], trial.samples[spin.name]
    _, at_q, at_w = np.intersect1d(q.index, w.index, return_indices=True)
    if len(at_q) < _ORDER_SAMPLES:
        return None
    turned = order(q.values[at_q])
    rate = w.values[at_w]
    step = np.diff(trial.times[q.index[at_q]])[:, None]
    change = rotations.product(rotations.inverse(turned[:-1]), turned[1:])
    if spin.frame == "world":
        change = rotations.product(turned[1:], rotations.inverse(turned[:-1]))
    seen = rotations.vector(change) / step
    return float(np.median(np.linalg.norm(seen - 0.5 * (rate[:-1] + rate[1:]), axis=1)))
