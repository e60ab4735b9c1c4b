# SPDX-License-Identifier: Apache-2.0
"""What the whole run of each scene comes to, whatever engine, threads and release make it.

`./run python tests/validation/support/whole_runs.py [SCENE...]` makes the runs under every engine
that serves their pairs, under two threads, and with masses changed by a rounding, and writes them
to whole_runs.json; with MUJOCO=2.2.2 only those of that release. The octree takes an hour.
"""

from __future__ import annotations

import json
import sys
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from case import Case, load, varied

import volcontact as vc

sys.path.append(str(Path(__file__).parents[1]))  # where the cases are

import test_ball_in_cylinder
import test_bouncing_ball
import test_euler_disc
import test_incline
import test_painleve_rod
import test_spinning_disc
import test_tippe_top
import test_tumbling_box

RESULTS = Path(__file__).with_name("whole_runs.json")
ENGINES = ("closed_form", "clip", "lines", "columns", "octree")
ROUNDING = 1e-14  # of the masses
# Its default, a thousandth of the volume, tilts the normal by 4e-5: down such a slope a ball that
# rolls creeps at 0.3 mm/s, for as long as the run goes on.
OCTREE_TOLERANCES = {"ball_in_cylinder": 5e-5}


@dataclass(frozen=True)
class Outcome:
    """A number that a run comes to.

    Attributes:
        name: what it is.
        unit: SI, "-" for none.
        value: the number.
        tolerance: by how much two runs may differ, relative to it, of its case.
        floor: the same, absolute.
    """

    name: str
    unit: str
    value: float
    tolerance: float = 0.0
    floor: float = 0.0

    @property
    def allowed(self) -> float:
        """By how much another run may differ."""
        return max(self.tolerance * abs(self.value), self.floor)


def ball_in_cylinder() -> list[Outcome]:
    """Until rest in the bore; half the step changes no result by more than a thousandth."""
    run = test_ball_in_cylinder.come_to_rest(step=1e-3)
    roll, slide, spin = run.dissipated[1:]
    return [
        Outcome("slower than 1 mm/s from", "s", test_ball_in_cylinder.rests_from(run), 1e-2),
        Outcome("dissipated by rolling", "J", roll, 1e-2),
        Outcome("dissipated by sliding", "J", slide, 1e-2),
        Outcome("dissipated by spinning", "J", spin, 1e-2),
        Outcome("where along the bore", "m", run.data.qpos[1], 1e-2),
    ]


def bouncing_ball() -> list[Outcome]:
    """Twelve bounces."""
    launches, _ = test_bouncing_ball.bounce(Case("", ""))
    return [
        *(
            Outcome(f"speed after bounce {n}", "m/s", launches[n - 1], 1e-3)
            for n in (1, 2, 4, 8, 12)
        ),
        Outcome("time in the air", "s", test_bouncing_ball.flight_time(launches), 1e-3),
    ]


def euler_disc() -> list[Outcome]:
    """Eight turns of the precession."""
    run = test_euler_disc.roll()
    return [
        Outcome("precession", "rad/s", test_euler_disc.rate(run.rows), 1e-2),
        Outcome("least tilt", "rad", run.rows[:, 2].min(), 1e-2),
        Outcome("largest tilt", "rad", run.rows[:, 2].max(), 1e-2),
    ]


def incline() -> list[Outcome]:
    """A minute at nine tenths of the cone, and a slide."""
    held = test_incline.lean(0.9 * test_incline.KINETIC, ramp=2.0, duration=70.0)
    slide = test_incline.slide()
    return [
        Outcome("creep in 60 s at 0.9 of the cone", "m", test_incline.creep(held, 10), floor=1e-15),
        Outcome("acceleration at 30 degrees", "m/s^2", test_incline.acceleration(slide), 1e-3),
    ]


def painleve_rod() -> list[Outcome]:
    """The jam of the rod."""
    run = test_painleve_rod.slide(5.0 / 3.0)
    return [
        Outcome("elastic energy at the peak", "J", run.elastic.max(), 1e-2),
        Outcome("speed at the end", "m/s", run.rows[-1, 2], 1e-2),
        Outcome("spin at the end", "rad/s", run.rows[-1, 3], 1e-2),
    ]


def spinning_disc() -> list[Outcome]:
    """Until slide and spin end at once."""
    run = test_spinning_disc.slide("quadrature")
    return [
        Outcome("rest", "s", test_spinning_disc.rest(run.rows, spins=True), 3e-3),
        Outcome("way", "m", run.rows[-1, 3], 3e-3),
    ]


def tippe_top() -> list[Outcome]:
    """Up, over, and down."""
    top = test_tippe_top.spin(step=1e-4, duration=5.5)
    return [
        Outcome("upright", "s", top.upright, 1e-2),
        Outcome("stem touches", "s", top.touch, 1e-2),
        Outcome("over 150 degrees", "s", top.beyond_150, 1e-2),
        Outcome("falls", "s", top.falls, 1e-2),
    ]


def tumbling_box() -> list[Outcome]:
    """Three seconds without dissipation."""
    run = test_tumbling_box.tumble(1e-4)
    late = run.rows[run.rows[:, 0] > 2.0]
    return [
        Outcome("height of the centre after 1 s", "m", np.interp(1.0, *run.rows[:, :2].T), 1e-2),
        Outcome("highest after 2 s", "m", late[:, 1].max(), 1e-2),
    ]


SCENES: dict[str, Callable[[], list[Outcome]]] = {
    run.__name__: run
    for run in (
        ball_in_cylinder,
        bouncing_ball,
        euler_disc,
        incline,
        painleve_rod,
        spinning_disc,
        tippe_top,
        tumbling_box,
    )
}


def engines_of(scene: str) -> list[str]:
    """Those that serve a scene's pairs, its own first."""
    found = []
    for engine in (None, *ENGINES):
        with varied(**({} if engine is None else {f"engine__{engine}": 1})):
            model = load(f"{scene}/scene.xml")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # that it does not serve them
            contact = vc.attach(model)
        with contact:
            (serves,) = {pair["engine"] for pair in contact.description["pairs"]}
        if engine in (None, serves) and serves not in found:
            found.append(serves)
    return found


def under(engine: str, scene: str) -> dict[str, float]:
    """What `varied` takes to choose an engine for the whole run of a scene."""
    finer = engine == "octree" and scene in OCTREE_TOLERANCES
    tolerance = {"tolerance": OCTREE_TOLERANCES[scene]} if finer else {}
    return {f"engine__{engine}": 1} | tolerance


def kept(scene: str) -> list[Outcome]:
    """What the scene came to when its runs were last written, under its own engine."""
    record = json.loads(RESULTS.read_text())[scene]
    values = record["runs"][record["engine"]]
    return [Outcome(value=values[name], **about) for name, about in record["outcomes"].items()]


def variations(scene: str) -> dict[str, dict[str, float]]:
    """Names of the runs that this release is to make, and what `varied` takes for them."""
    if int(mujoco.__version__.split(".")[0]) < 3:
        return {f"MuJoCo {mujoco.__version__}": {}}
    own, *others = engines_of(scene)
    runs = {own: {}, "2 threads": {"threads": 2}, "rounding": {"mass": ROUNDING}}
    return runs | {engine: under(engine, scene) for engine in others}


def main() -> None:
    """Writes the results."""
    results = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    for scene in sys.argv[1:] or SCENES:
        record = results.setdefault(scene, {"engine": engines_of(scene)[0], "runs": {}})
        for name, variation in variations(scene).items():
            begin = time.perf_counter()
            with varied(**variation):
                outcomes = SCENES[scene]()
            record["outcomes"] = {
                outcome.name: {
                    "name": outcome.name,
                    "unit": outcome.unit,
                    "tolerance": outcome.tolerance,
                    "floor": outcome.floor,
                }
                for outcome in outcomes
            }
            record["runs"][name] = {outcome.name: float(outcome.value) for outcome in outcomes}
            print(scene, name, f"{time.perf_counter() - begin:.1f} s", record["runs"][name])
            sys.stdout.flush()
            RESULTS.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
