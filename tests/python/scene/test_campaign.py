# SPDX-License-Identifier: Apache-2.0
"""The campaign's scenes, judges and book-keeping; a sample of what `./run campaign` runs."""

from __future__ import annotations

import csv
import importlib
import json
import sys
from pathlib import Path
from types import ModuleType

import mujoco
import numpy as np
import pytest

import volcontact as vc

CAMPAIGN = Path(__file__).resolve().parents[2] / "campaign"
RESULTS = Path(__file__).resolve().parents[2] / "benchmarks" / "results"


@pytest.fixture
def part(monkeypatch):
    monkeypatch.syspath_prepend(str(CAMPAIGN))

    def load(name: str) -> ModuleType:
        return importlib.import_module(name)

    yield load
    for name in ("campaign", "box_on_plane", "grazing", "generated_scenes", "models_of_others"):
        sys.modules.pop(name, None)


SOFT = {"speed": 1.0, "damping": 0.1, "stiffness": 1e6, "timestep": 1e-3, "gravity": 0.0}


def test_a_box_keeps_its_energy_in_a_soft_contact(part):
    box = part("box_on_plane")
    row = box.examine(SOFT | {"implicit": "auto"})
    assert row["energy"] == pytest.approx(0.5 * box.MASS * 1.0**2)
    assert box.is_sound(row)
    # It comes back, a little slower: the law takes 2/3 a v of the energy or so, never gives.
    assert 0.7 < row["speed_after"] < 1.0


def test_a_box_that_gains_is_told(part):
    # Stiff and explicit: h^2 k/m = 800, the step overshoots by far.
    box = part("box_on_plane")
    case = SOFT | {"stiffness": 1e12, "damping": 0.0, "implicit": "off"}
    row = box.examine(case)
    assert row["motion"] > 10.0
    assert not box.is_sound(row)


def test_every_pair_of_solids_grazes(part):
    grazing = part("grazing")
    for pair in grazing.PAIRS:
        case = dict(zip(grazing.KEYS, (*pair, 100.0, 0.0, 1e8, 1.0, 1e-3, 2.0, 1e-2), strict=True))
        row = grazing.examine(case)
        assert row["energy"] == pytest.approx(0.5 * grazing.LIGHT * 2.0**2)
        assert row["speed_after"] < 1.999 or row["ratio"] > 1.0, pair  # they touched


def test_generated_scenes_have_all_parts_and_are_the_same_again(part):
    scenes = part("generated_scenes")
    seen, integrators, compiled = set(), set(), 0
    for seed in range(60):
        scene = scenes.Scene(seed)
        assert scene.text == scenes.Scene(seed).text
        seen |= set(scene.parts)
        integrators.add(scene.integrator)
        try:
            mujoco.MjModel.from_xml_string(scene.text)
            compiled += 1
        except ValueError:
            continue
    assert compiled > 50
    assert seen >= {"limit", "spring", "frictionloss", "tendon", "equality", "weld", "motor"}
    assert integrators >= {"Euler", "implicit", "RK4"}


def test_the_audit_sees_what_contact_made(part):
    # A soft ball bounces: nothing is made. The same, stiff and explicit: much is.
    scenes = part("generated_scenes")
    text = """
<mujoco><option timestep="1e-3"><flag energy="enable"/></option><worldbody>
<geom type="plane" size="1 1 1"/>
<body pos="0 0 .11"><freejoint/><geom type="sphere" size=".1" density="1000"/></body>
</worldbody></mujoco>"""
    gains = []
    for stiffness, implicit in ((1e6, "auto"), (1e11, "off")):
        model = mujoco.MjModel.from_xml_string(text)
        material = {"stiffness": stiffness, "damping": 0.0}
        with vc.attach(model, material=material, options={"implicit": implicit}) as contact:
            gains.append(scenes.audited(model, mujoco.MjData(model), contact, 0)["gain"])
    assert gains[0] < 1e-2 < 0.1 < gains[1]


# A servo turns the slip round in one step (531, 151, 1003, 1048); limbs are spun up inside of each
# other (415, 808, 976); touches of bodies that turn (737); Runge-Kutta goes on by its law where a
# pair was solved (62, 163, 858, 904, 1008).
@pytest.mark.parametrize("seed", [62, 151, 415, 531, 737, 808, 858, 904, 976, 1003, 1008, 1048])
def test_scenes_that_made_energy_make_none(part, seed):
    scenes = part("generated_scenes")
    row = scenes.examine({"seed": seed})
    assert scenes.is_sound(row), row["gain"]
    assert "refused" not in row
    assert row["speed"] > 0.0


ENDED_WITH_MORE = {
    "a touch that ends within a step of Runge-Kutta": (910, 1121, 4385, 4746),
    "a touch that ends with a debt larger than what still moves": (623, 5691),
    "a body that gives way by turning": (7005,),
    "a lift that cost nothing, or was not counted": (601, 6095, 7301),
    "a book that follows the law though nobody paid": (4350,),
    "explicit friction on a limb that yields more easily than its mass says": (9157,),
    "work that motion explains, and the step made all the same": (5331,),
    "constraints so stiff that the matrix of the step has no inverse": (3624,),
    "the matrix of a free body read before it was made": (1489,),
    "a slow exit whose normal turns within the step": (6675,),
    "forces held through the stages of Runge-Kutta, on limbs that turn": (1188, 2889, 4379),
}


@pytest.mark.skipif(
    not hasattr(mujoco.mjtIntegrator, "mjINT_DISCRETE"), reason="other scenes have these numbers"
)
@pytest.mark.parametrize("seed", [seed for seeds in ENDED_WITH_MORE.values() for seed in seeds])
def test_scenes_that_ended_with_more_end_with_less(part, seed):
    scenes = part("generated_scenes")
    row = scenes.examine({"seed": seed})
    assert scenes.is_sound(row), row["gain"]
    assert row["speed"] > 0.0


# A spring that is too stiff for the step stays still beside everything until the body falls on
# something: native contact has nothing there.
def test_what_mujoco_cannot_step_without_contact_is_told(part):
    scenes = part("generated_scenes")
    if not hasattr(mujoco.mjtIntegrator, "mjINT_DISCRETE"):
        pytest.skip("other scenes have these numbers")
    row = scenes.examine({"seed": 8792})
    assert row["warnings"] > 0 and row["native_warnings"] == 0
    assert row["alone"] == 1 and scenes.is_sound(row)
    assert not scenes.is_sound(row | {"alone": 0})
    assert not scenes.is_sound(row | {"gain": 2e-3})
    # The same with a spring that the step holds does not warn alone.
    tame = scenes.Scene(8792)
    model = mujoco.MjModel.from_xml_string(tame.text)
    model.jnt_stiffness[:] = 0.0
    assert not scenes.warns_alone(model, tame, row)


def test_rows_are_kept_and_not_made_twice(part, tmp_path):
    campaign, box = part("campaign"), part("box_on_plane")
    rows = campaign.run(box, tmp_path, 600, 1)
    path = tmp_path / "box_on_plane.jsonl"
    kept = path.read_text()
    assert len(rows) == len(kept.splitlines()) > 0
    assert campaign.run(box, tmp_path, 600, 1) == rows
    assert all(json.loads(line) in rows for line in kept.splitlines())
    assert path.read_text() == kept


def test_a_part_ends_when_its_time_is_up(part, tmp_path):
    campaign, box = part("campaign"), part("box_on_plane")
    wanted = sum(1 for _ in box.cases(50))
    rows = campaign.run(box, tmp_path, 50, 1, seconds=0.0)
    assert 0 < len(rows) < wanted


def test_a_case_that_throws_is_a_row(part):
    campaign = part("campaign")
    row = campaign.examined("box_on_plane", SOFT | {"timestep": "soon", "implicit": "auto"})
    assert "timestep" in row["error"] or "soon" in row["error"] or "Error" in row["error"]
    assert not campaign.is_sound(part("box_on_plane"), row)


def test_models_are_judged_beside_native_contact(part):
    models = part("models_of_others")
    row = {"ratio": 1.5, "warnings": 0, "native_warnings": 0, "dropped": 0, "refused": ""}
    assert models.is_sound(row)
    assert not models.is_sound(row | {"ratio": 2.5})
    assert not models.is_sound(row | {"warnings": 1})
    assert models.is_sound(row | {"warnings": 1, "native_warnings": 2})
    assert not models.is_sound(row | {"dropped": 1})
    assert models.is_sound({"refused": "in words"})


def test_random_controls_are_the_same_for_both_contacts(part):
    models = part("models_of_others")
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body><joint name="j" type="slide"/><geom size=".1"/></body>'
        '</worldbody><actuator><motor joint="j" ctrllimited="true" ctrlrange="-3 3"/></actuator>'
        "</mujoco>"
    )
    one, two = models.driven(model, 5, None), models.driven(model, 5, None)
    assert one == two and one[0] > 0.0
    assert models.driven(model, 6, None)[0] != one[0]


def test_a_finer_step_sees_the_same_controls_at_the_same_times(part):
    # Under constant forces velocities are exact at any step.
    models = part("models_of_others")
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><option gravity="0 0 0"/><worldbody><body><joint name="j" type="slide"/>'
        '<geom size=".1"/></body></worldbody><actuator><motor joint="j"/></actuator></mujoco>'
    )
    coarse, _, _ = models.driven(model, 5, None)
    model.opt.timestep /= models.FINER
    assert models.driven(model, 5, None, models.FINER)[0] == pytest.approx(coarse, rel=1e-9)


@pytest.mark.parametrize(("fine", "warned", "ratio"), [(4.0, 0, 1.5), (1.0, 0, 3.0), (4.0, 1, 3.0)])
def test_a_fast_model_is_judged_by_a_tenth_of_its_step(part, monkeypatch, fine, warned, ratio):
    models = part("models_of_others")
    text = '<mujoco><worldbody>{0}<body pos="0 0 1"><freejoint/>{0}</body></worldbody></mujoco>'
    model = mujoco.MjModel.from_xml_string(text.format('<geom size=".1"/>'))
    monkeypatch.setattr(models, "original", lambda *_: model)
    models.native.cache_clear()

    def driven(_model, _seed, contact, finer=1):
        if contact is None:
            return 2.0, 0, {}
        return (fine, warned, {}) if finer > 1 else (6.0, 0, {"dropped": 0})

    monkeypatch.setattr(models, "driven", driven)
    row = models.examine({"package": "", "model": "", "stiffness": 1e8, "seed": 0})
    assert row["ratio"] == pytest.approx(ratio)
    assert models.is_sound(row) == (ratio <= 2.0)


@pytest.mark.parametrize(
    "name", ["box_on_plane", "grazing", "generated_scenes", "models_of_others"]
)
def test_recorded_tables_have_every_column(part, name):
    with (RESULTS / f"campaign_{name}.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows and set(rows[0]) - {"state"} == {*part(name).COLUMNS, "error"}
    worst = [row[part(name).WORST] for row in rows if row[part(name).WORST]]
    assert np.all(np.asarray(worst, float) >= 0.0)
