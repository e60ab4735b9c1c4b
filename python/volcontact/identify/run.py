# SPDX-License-Identifier: Apache-2.0
"""From a study file to values: reads, fits, judges, says what is known."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from volcontact._files import appearing
from volcontact.identify import scores, words
from volcontact.identify.bench import Values
from volcontact.identify.estimators import least_squares, posterior, uncertainty
from volcontact.identify.estimators.scales import Box
from volcontact.identify.estimators.search import Evaluations, Found, Progress, search, signature
from volcontact.identify.estimators.uncertainty import Known
from volcontact.identify.measurements import Trial, read_trials
from volcontact.identify.pool import Pool
from volcontact.identify.settings import Settings, StudyError
from volcontact.identify.windows import windowed

RESULT, SCENE, REPORT = "identified.json", "identified.xml", "report.html"
_LOG, _STARTS, _CHAIN = "evaluations.jsonl", "starts.json", "chain.npz"


@dataclass(frozen=True)
class Identified:
    """What an identification found.

    Attributes:
        values: of the parameters.
        converged: whether the estimator ended by itself.
        findings: what the data cannot tell, in sentences.
        summary: everything, as in `identified.json`.
        out: folder of the results; None: nothing was written.
    """

    values: Values
    converged: bool
    findings: list[str]
    summary: dict[str, Any]
    out: Path | None


def run(
    settings: Settings,
    out: Path | None = None,
    *,
    workers: int | None = None,
    progress: Progress | None = None,
    report: bool = True,
) -> Identified:
    """Runs an identification.

    Args:
        settings: of the study.
        out: folder for the results, made when missing; an interrupted run goes on in it.
        workers: processes; None takes the cores, 1 needs none.
        progress: called with evaluations done, in all, and a note.
        report: whether `report.html` is written.

    Raises:
        StudyError: scene, study and measurements do not fit, or a parameter moves nothing.
    """
    fit_trials, judge_trials = _trials(settings)
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
    box = Box(settings.parameters)
    cut = windowed(settings, fit_trials)
    with Pool(settings, cut, workers) as pool:
        check_moves(settings, pool, box)
        found, known, starts, moved = _estimate(settings, pool, box, out, progress)
        values = box.values(found.point)
        raw_fit = pool.run("raw", [(values, moved)])[0]
    raw_judge: list[Any] = []
    if judge_trials:
        with Pool(settings, judge_trials, workers) as pool:
            raw_judge = pool.run("raw", [(values, None)])[0]
    findings = words.findings(settings, box, found.point, known)
    summary = _summary(settings, box, found, known, findings)
    summary["starts"] = starts
    summary["fit"] = scores.table(settings, cut, raw_fit)
    if judge_trials:
        summary["judge"] = scores.table(settings, judge_trials, raw_judge)
    if out is not None:
        _write(settings, values, summary, out)
        if report:
            from volcontact.identify.report import write_report

            shown = judge_trials or cut
            write_report(settings, summary, known, box, shown, raw_judge or raw_fit, out / REPORT)
    return Identified(values, found.converged, findings, summary, out)


def check(settings: Settings) -> dict[str, Any]:
    """Checks a study with its scene and measurements, and fits nothing.

    Raises:
        StudyError: they do not fit, or a parameter moves nothing.
    """
    fit_trials, judge_trials = _trials(settings)
    cut = windowed(settings, fit_trials)
    with Pool(settings, cut, 1) as pool:
        check_moves(settings, pool, Box(settings.parameters))
        return {
            "name": settings.name,
            "fit": len(cut),
            "judge": len(judge_trials),
            "samples": sum(len(trial.times) for trial in cut),
            "start": pool.start,
        }


def _trials(settings: Settings) -> tuple[list[Trial], list[Trial]]:
    wanted = None
    if settings.fit is not None:
        wanted = (*settings.fit, *(settings.judge or ()))
    trials = read_trials(settings, wanted)
    if not trials:
        raise StudyError("[measurements]: the files hold no trial")
    judge = set(settings.judge or ())
    missing = judge - {trial.label for trial in trials}
    if missing:
        raise StudyError(f"[measurements] judge: there is no trial {sorted(missing)[0]!r}")
    fit = [trial for trial in trials if trial.label not in judge]
    return fit, [trial for trial in trials if trial.label in judge]


def check_moves(settings: Settings, pool: Pool, box: Box) -> None:
    """Every parameter must change some sample.

    Raises:
        StudyError: one moves nothing.
    """
    first = np.clip(box.point(pool.start), 0.0, 1.0)
    points = [first]
    for place in range(len(first)):
        for share in (0.1, 0.9):
            there = first.copy()
            there[place] = share
            points.append(there)
    results = pool.run("costs", [(box.values(point), None) for point in points])
    for place, each in enumerate(settings.parameters):
        pair = results[1 + 2 * place : 3 + 2 * place]
        if pair[0] == results[0] and pair[1] == results[0]:
            ends = [box.values(points[1 + 2 * place + i])[each.name] for i in (0, 1)]
            raise StudyError(
                f"[parameter.{each.name}] target = {each.targets[0]!r}: moves nothing: from "
                f"{ends[0]:.3g} to {ends[1]:.3g} no trial changes; take it out, or measure a "
                "motion that it acts in"
            )


def _estimate(
    settings: Settings, pool: Pool, box: Box, out: Path | None, progress: Progress | None
) -> tuple[Found, Known, list[dict[str, Any]], np.ndarray | None]:
    if settings.estimator.method != "least_squares":
        log = Evaluations(settings, out / _LOG if out else None)
        found = search(settings, pool, box, log, progress)
        return found, uncertainty.of_search(settings, box, log, found.point), [], None
    fitted = least_squares.fit(settings, pool, box, out / _STARTS if out else None, progress)
    known = uncertainty.of_fit(settings, pool, box, fitted, progress)
    if settings.uncertainty.mcmc:
        file = out / _CHAIN if out else None
        known = posterior.of_chain(settings, pool, box, fitted, known, file, progress)
    moved = least_squares.Residuals(settings, pool, box).moved(fitted.unknowns)
    return fitted.found, known, fitted.starts, moved


def _summary(
    settings: Settings, box: Box, found: Found, known: Known, findings: list[str]
) -> dict[str, Any]:
    values = box.values(found.point)
    told = words.told(settings, box, found.point, known)
    deviations = box.deviations(known.deviations)
    parameters = {}
    for place, each in enumerate(settings.parameters):
        low, high = words.interval(box, place, known)
        sd = float(deviations[place])
        if each.log:
            sd *= values[each.name]
        parameters[each.name] = {
            "value": values[each.name],
            "low": low,
            "high": high,
            "deviation": sd if np.isfinite(sd) else None,
            "told": told[each.name],
            "targets": list(each.targets),
            "mode": each.mode,
            "times": each.times or None,
            "bounds": [each.low, each.high],
        }
    profiles = {
        name: {
            "values": [_value(box, settings, name, p) for p in profile.points],
            "rises": profile.rises.tolist(),
        }
        for name, profile in known.profiles.items()
    }
    from volcontact import __version__

    return {
        "name": settings.name,
        "contact": settings.contact,
        "converged": found.converged,
        "reason": found.reason,
        "cost": found.cost,
        "evaluations": found.evaluations,
        "method": settings.estimator.method,
        "seed": settings.estimator.seed,
        "level": settings.uncertainty.level,
        "parameters": parameters,
        "correlation": np.round(known.correlation, 6).tolist(),
        "uncertainty": known.method,
        "noise": known.noise,
        "profiles": profiles,
        "chain": _chain(settings, known),
        "findings": findings,
        "study_sha256": signature(settings),
        "versions": {"volcontact": __version__, "mujoco": mujoco.__version__},
    }


def _chain(settings: Settings, known: Known) -> dict[str, Any] | None:
    """How long the chain was, in autocorrelation times; None where there was none."""
    chain = known.chain
    if chain is None:
        return None
    times = chain.times[: len(settings.parameters)]
    return {
        "steps": len(chain.samples),
        "burn": chain.burn,
        "walkers": chain.samples.shape[1],
        "accepted": chain.accepted,
        "autocorrelation": {
            each.name: float(time) if np.isfinite(time) else None
            for each, time in zip(settings.parameters, times, strict=True)
        },
        "enough": chain.enough,
    }


def _value(box: Box, settings: Settings, name: str, share: float) -> float:
    point = np.full(len(settings.parameters), 0.5)
    point[[each.name for each in settings.parameters].index(name)] = share
    return box.values(point)[name]


def _write(settings: Settings, values: Values, summary: dict[str, Any], out: Path) -> None:
    from volcontact.identify.writing import write_scene

    lines = [f"{name} = {value:.6g}" for name, value in values.items()]
    note = f"{settings.name}, identified by volcontact: {', '.join(lines)}"
    write_scene(settings, values, out / SCENE, note)
    with appearing(out / RESULT) as made:
        made.write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
