# SPDX-License-Identifier: Apache-2.0
"""Identifies the real cube under several laws and seeds: writes results/cube_tosses.json.

    ./run python tests/benchmarks/field/cube_tosses.py tosses.parquet [VARIANT[:SEED] ...]

takes the whole set of tosses (mjcf_models/identification/cube_tosses/README.md). A fit that was
interrupted goes on; one that is there already is left alone. Then docs/generate/make_cube_tosses.py
writes the page.
"""

from __future__ import annotations

import json
import re
import shutil
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from volcontact.identify.reading import read_settings
from volcontact.identify.run import run

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT / "mjcf_models" / "identification" / "cube_tosses"
RESULT = Path(__file__).parent / "results" / "cube_tosses.json"
BUILD = ROOT / "build" / "cube_tosses"
WIDTH = 0.1048  # nominal [m]
SEEDS = (1, 2, 3)

_SOLIMP = """
[parameter.dmin]
target = ["geom/cube/solimp/0", "geom/board/solimp/0"]
bounds = [0.3, 0.95]

[parameter.solimp_width]
target = ["geom/cube/solimp/2", "geom/board/solimp/2"]
bounds = [1e-4, 1e-2]
scale = "log"
"""
_PAIR = "volcontact/pair/toss"


def _numeric(name: str, value: float) -> str:
    return f'<numeric name="{name}" data="{value:g}"/>'


def _parameter(name: str, bounds: str, target: str = "") -> str:
    return f'\n[parameter.{name}]\ntarget = "{target or f"{_PAIR}/{name}"}"\nbounds = {bounds}\n'


@dataclass(frozen=True)
class Variant:
    """A way to model the cube.

    Attributes:
        text: of it, in a table.
        study: that it begins with.
        without: parameters of it that are held as the scene has them.
        added: parameters beside it.
        scene: what changes in the scene, as pairs of old and new text.
        seeds: that it is fitted with.
    """

    text: str
    study: str = "study.toml"
    without: tuple[str, ...] = ()
    added: str = ""
    scene: tuple[tuple[str, str], ...] = ()
    seeds: tuple[int, ...] = (1,)


_LAW = _numeric(f"{_PAIR}/friction_law/regularized_coulomb", 1)
_SLIP = _numeric(f"{_PAIR}/slip_speed", 0.01)
_DAMPING = _numeric(f"{_PAIR}/damping", 4)
_CENTRED = (
    ('pos="0 0 0.006" mass', 'pos="0 0 0" mass'),
    ("0.00092 0.00092 0.00092", "0.00081 0.00081 0.00081"),
)
_BALANCED = ("centre_of_mass", "inertia")
_ROUNDED = (
    _numeric("volcontact/shape/rounded/rounded_box", 3e-3)
    + '<tuple name="volcontact/shape/rounded"><element objtype="geom" objname="cube"/></tuple>'
)
VARIANTS = {
    "volumetric": Variant("as in study.toml", seeds=SEEDS),
    "native": Variant("as in study_native.toml", "study_native.toml", seeds=SEEDS),
    "native_solimp": Variant(
        "with two numbers of solimp free as well", "study_native.toml", added=_SOLIMP
    ),
    "volumetric_balanced": Variant(
        "centre of mass in the centre, inertia as given", without=_BALANCED, scene=_CENTRED
    ),
    "native_balanced": Variant(
        "centre of mass in the centre, inertia as given",
        "study_native.toml",
        without=_BALANCED,
        scene=_CENTRED,
    ),
    "volumetric_rounded": Variant(
        "edges and corners of a radius that is found",
        added=_parameter("radius", "[2e-4, 0.01]", "volcontact/shape/rounded/rounded_box"),
        scene=((_DAMPING, _DAMPING + _ROUNDED),),
    ),
    "volumetric_restitution": Variant(
        "restitution in place of damping",
        without=("damping",),
        added=_parameter("restitution", "[0.05, 0.9]"),
        scene=((_DAMPING, _numeric(f"{_PAIR}/restitution", 0.3)),),
    ),
    "volumetric_elastic": Variant(
        "friction law elastic_coulomb",
        scene=((_LAW, _numeric(f"{_PAIR}/friction_law/elastic_coulomb", 1)), (_SLIP, "")),
    ),
    "volumetric_bristle": Variant(
        "bristles with viscous friction, which grows with the speed and not with the load",
        added=_parameter("viscous_friction", "[0.0, 1.5]"),
        scene=(
            (
                _LAW,
                _numeric(f"{_PAIR}/friction_law/bristle", 1)
                + _numeric(f"{_PAIR}/bristle_damping", 100)
                + _numeric(f"{_PAIR}/viscous_friction", 0.2),
            ),
            (_SLIP, ""),
        ),
    ),
    "volumetric_no_rolling": Variant(
        "without rolling resistance",
        scene=((_DAMPING, _DAMPING + _numeric(f"{_PAIR}/rolling/off", 1)),),
    ),
}


def write_study(name: str, seed: int) -> Path:
    """The files of a variant, in a folder of its own; returns the path of its study."""
    variant = VARIANTS[name]
    folder = BUILD / f"{name}_{seed}"
    folder.mkdir(parents=True, exist_ok=True)
    scene = (FOLDER / "scene.xml").read_text(encoding="utf-8")
    for old, new in variant.scene:
        assert old in scene, (name, old)
        scene = scene.replace(old, new)
    (folder / "scene.xml").write_text(scene, encoding="utf-8")
    text = (FOLDER / variant.study).read_text(encoding="utf-8")
    for each in variant.without:
        text, count = re.subn(rf"(#[^\n]*\n)*\[parameter\.{each}\]\n([^\n]+\n)*", "", text)
        assert count == 1, (name, each)
    text = text.replace("[estimator]", f"{variant.added}\n[estimator]")
    text = text.replace("seed = 1", f"seed = {seed}")
    (folder / "study.toml").write_text(text, encoding="utf-8")
    return folder / "study.toml"


def fit(name: str, seed: int, tosses: Path) -> dict[str, Any]:
    """Identifies a variant and judges it."""
    study = write_study(name, seed)
    settings = read_settings(study, measurements=[tosses])
    begin = time.perf_counter()
    found = run(settings, study.parent / "results", report=True)
    wall = time.perf_counter() - begin
    sums = {
        word: np.array(found.summary[word]["position"]["by_trial"]) / WIDTH * 100.0
        + np.degrees(found.summary[word]["orientation"]["by_trial"])
        for word in ("fit", "judge")
    }
    return {
        "variant": name,
        "seed": seed,
        "contact": settings.contact,
        "values": {key: float(f"{value:.6g}") for key, value in found.values.items()},
        "intervals": {
            key: [each["low"], each["high"]] for key, each in found.summary["parameters"].items()
        },
        "evaluations": found.summary["evaluations"],
        "converged": found.converged,
        "reason": found.summary["reason"],
        "fit": float(sums["fit"].mean()),
        "judge": float(sums["judge"].mean()),
        "seconds": round(wall, 1),
        "mujoco": mujoco.__version__,
    }


def main(words: list[str]) -> None:
    """Fits what is asked for and not there yet."""
    tosses = Path(words[0])
    found: list[dict[str, Any]] = []
    if RESULT.exists():
        found = json.loads(RESULT.read_text(encoding="utf-8"))
    every = [f"{name}:{seed}" for name, variant in VARIANTS.items() for seed in variant.seeds]
    for word in words[1:] or every:
        name, _, number = word.partition(":")
        seed = int(number or 1)
        if any((each["variant"], each["seed"]) == (name, seed) for each in found):
            continue
        result = fit(name, seed, tosses)
        found.append(result)
        print(name, seed, f"fit {result['fit']:.2f}, judged {result['judge']:.2f}", flush=True)
        order = list(VARIANTS)
        found.sort(key=lambda each: (order.index(each["variant"]), each["seed"]))
        RESULT.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    keep_scenes(found)


def keep_scenes(found: list[dict[str, Any]]) -> None:
    """The scenes of the seeds that fit best, beside the studies."""
    for name, file in (("volumetric", "identified.xml"), ("native", "identified_native.xml")):
        seeds = [each for each in found if each["variant"] == name]
        if seeds:
            best = min(seeds, key=lambda each: float(each["fit"]))
            made = BUILD / f"{name}_{best['seed']}" / "results" / "identified.xml"
            if made.exists():
                shutil.copyfile(made, FOLDER / file)


if __name__ == "__main__":
    main(sys.argv[1:])
