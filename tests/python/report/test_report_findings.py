# SPDX-License-Identifier: Apache-2.0
"""Sentences from data."""

import dataclasses

import numpy as np
import pytest
from reports import comparison, recording, sentence, shifted

from volcontact.report.comparison import (
    Limits,
    first_touch,
    largest_rise,
)
from volcontact.report.figures import curves
from volcontact.report.findings import findings
from volcontact.report.page import page


def test_figures_of_a_run():
    run = recording()
    assert first_touch(run) == pytest.approx(1.0)
    assert first_touch(dataclasses.replace(run, site_count=np.zeros(101, int))) is None
    assert np.abs(run.unbalance()).max() < 1e-12
    assert largest_rise(np.array([5.0, 3.0, 4.5, 1.0, 2.0])) == 1.5
    assert largest_rise(np.array([3.0, 2.0, 1.0])) == 0.0


def test_summary_has_the_documented_keys():
    summary = comparison().summary()
    keys = {
        "steps",
        "dt",
        "microseconds_per_step",
        "max_penetration",
        "final_qpos",
        "energy_initial",
        "energy_final",
        "max_contact_sites",
        "warnings",
    }
    assert keys <= set(summary["volumetric"])
    assert set(summary["volumetric"]) == set(summary["native"])
    assert (summary["mujoco_version"], summary["volcontact_version"]) == ("9.9.9", "1.2.3")
    native = summary["native"]
    assert (native["steps"], native["dt"], native["microseconds_per_step"]) == (100, 0.02, 20.0)
    assert native["final_qpos"] == [0.0, 0.0, 0.2, 1.0, 0.0, 0.0, 0.0]
    assert native["energy_final"] == pytest.approx(20.0)
    assert native["max_contact_sites"] == 2
    assert native["design_pose"]["seated"] is True


def test_findings_say_who_seats():
    made = comparison(native=shifted(recording("native"), (0.0, 0.0, 0.13)))
    first = findings(made)[0]
    assert (first.title, first.verdict) == ("Seating", "good")
    assert "Volumetric contact seats the box: it ends 0 m and 0° from" in first.text
    assert "Native contact does not seat the box: it ends 130 mm and 0° from" in first.text
    assert "within 1 mm and 0.1°, slower than 1 mm/s" in first.text
    failed = comparison(volumetric=shifted(recording(), (0.0, 0.0, 0.13)))
    assert findings(failed)[0].verdict == "bad"


def test_findings_compare_pose_force_depth_places_energy_and_cost():
    native = shifted(recording("native"), (0.003, 0.004, -0.012))
    native = dataclasses.replace(
        native,
        contact_force=10.0 * native.contact_force,
        penetration=4.0 * native.penetration,
        site_count=4 * native.site_count,
        step_microseconds=0.5 * native.step_microseconds,
        kinetic=np.where(native.time > 1.5, 7.0, 0.0),
    )
    made = comparison(native=native)
    pose = sentence(made, "Final pose")
    assert "ends 13.0 mm and 0° apart" in pose  # 3-4-12-13
    assert "12.0 mm lower than under volumetric contact and 5.00 mm to the side" in pose
    force = sentence(made, "Contact force")
    assert "begins at 1.00 s and peaks with 100 N" in force
    assert "1.00 times the weight of 100 N" in force
    assert "The native peak is 10.0 times as large." in force
    depth = sentence(made, "Penetration")
    assert "10.0 µm under volumetric and 40.0 µm under native" in depth
    assert "native 4.00 times as large" in depth
    places = sentence(made, "Contact places")
    assert "At most 2 sites at once under volumetric and 8 contact points" in places
    assert "200 cm²" in places
    energy = sentence(made, "Energy")
    assert "Volumetric contact takes 30.0 J from the motion, and 30.0 J are dissipated" in energy
    assert "(normal 30.0 J). Unaccounted for: " in energy
    assert "Native contact takes 30.0 J from the motion." in energy
    assert "Unaccounted for: 7.00 J at most, 7.00 J at the end. It keeps" in energy  # of motion
    assert "once stood 7.00 J above an earlier value" in energy
    assert "20.0 µs under volumetric and 10.0 µs" in sentence(made, "Cost")
    assert "2.00 times" in sentence(made, "Cost")


def test_findings_say_what_did_not_come_to_rest():
    moving = dataclasses.replace(recording("native"), speed=np.full((101, 1), 0.05))
    text = sentence(comparison(native=moving), "Rest")
    assert "Volumetric contact ends at rest, at 0 m/s, slower than 1 mm/s since 1.00 s." in text
    assert "Native contact ends still moving, at 50.0 mm/s." in text


def test_trouble_comes_first():
    bad = dataclasses.replace(recording("native"), warnings={"BADQACC": 3}, stopped="gone at 1 s")
    lost = dataclasses.replace(recording(), dropped=4)
    assert findings(comparison(volumetric=lost))[0].title == "Forces left out"
    assert "in 4 evaluations" in sentence(comparison(volumetric=lost), "Forces left out")
    titles = [finding.title for finding in findings(comparison(native=bad))]
    assert titles[:2] == ["Stopped", "MuJoCo warnings"]
    assert "BADQACC 3 times" in sentence(comparison(native=bad), "MuJoCo warnings")


def test_runs_that_never_touch_or_have_no_weight_are_described():
    free = dict(
        site_count=np.zeros(101, int),
        contact_force=np.zeros(101),
        largest_site_force=np.zeros(101),
        penetration=np.zeros(101),
        weight=0.0,
        frames=(),
    )
    made = comparison(volumetric=recording(**free), native=recording("native", **free), design=None)
    assert "nothing touches" in sentence(made, "Contact force")
    assert "never" in page(made, [], curves(made))


@pytest.mark.parametrize(
    ("limits", "verdict", "phrase"),
    [
        (Limits(), "plain", "the largest force of one place is 50.0 N, at 1.00 s between"),
        (Limits(force=60.0), "good", "within the limit of 60 N"),
        (Limits(force=40.0), "bad", "above the limit of 40 N"),
        (Limits(force=60.0, torque=1.0), "bad", "above the limit of 1 N m"),
    ],
)
def test_load_of_one_place_is_told_against_its_limit(limits, verdict, phrase):
    made = comparison(limits=limits)
    (finding,) = (f for f in findings(made) if f.title == "Load of one place")
    assert finding.verdict == verdict
    assert phrase in finding.text


@pytest.mark.parametrize(
    ("limit", "verdict", "phrase"),
    [(45.0, "good", "within the limit of 45 N"), (30.0, "bad", "above the limit of 30 N")],
)
def test_sensors_are_told_against_the_limits_of_the_scene(limit, verdict, phrase):
    made = comparison(limits=Limits(sensors={"wrist_force": limit}))
    (finding,) = (f for f in findings(made) if f.title == "Limits of the scene")
    assert finding.verdict == verdict
    assert f"wrist force peaks with 40.0 N at 1.00 s, {phrase}" in finding.text


def test_a_limit_of_no_sensor_names_those_there_are():
    with pytest.raises(ValueError, match=r"sensor 'wrist'; its sensors are: wrist_force"):
        findings(comparison(limits=Limits(sensors={"wrist": 1.0})))


def test_energy_says_what_the_step_made_of_impacts():
    run = recording()
    work = 0.9 * run.work
    short = dataclasses.replace(run, work=work, numerical=-work - run.dissipated[:, 0])
    text = sentence(comparison(volumetric=short), "Energy")
    assert "takes 27.0 J from the motion, and 30.0 J are dissipated" in text
    assert "(normal 30.0 J): 3.00 J too much, which is the error of a finite step" in text
    # The scene lost 30 J, and the forces took 27 of them.
    assert "Unaccounted for: 3.00 J at most, 3.00 J at the end." in text
