# SPDX-License-Identifier: Apache-2.0
"""Bench tests that are simulated give back the parameters of their scenes, to 0.1 %."""

import numpy as np
import pytest
from bench_sheets import FOLDER, kept_sheet, simulations

from volcontact.identify import direct
from volcontact.identify.direct.layouts import LAYOUTS
from volcontact.identify.direct.sheets import parse_sheet

CLOSE = 1e-3


@pytest.fixture(scope="module")
def scenes():
    return simulations()


def check(test, text, true, *names):
    found = direct.read_bench(test, text)
    assert found.converged
    for name in names:
        assert found[name] == pytest.approx(true[name], rel=CLOSE), name
        assert found.values[name].told, name
    return found


def check_kept(test, text):
    """The sheet of the folder is what its scene gives."""
    made, kept = parse_sheet(text, LAYOUTS[test], "made"), kept_sheet(test)
    assert made.labels == kept.labels and made.constants == kept.constants
    for name, column in made.columns.items():
        size = np.nanmax(np.abs(column))
        np.testing.assert_allclose(kept.columns[name], column, atol=1e-5 * size, err_msg=name)


def test_press(scenes):
    text = scenes.press()
    found = check("press", text, scenes.truth("press") | {"offset": 3e-4}, "stiffness", "offset")
    assert found["power"] == pytest.approx(1.0, abs=1e-4)
    assert not found.findings
    check_kept("press", text)


def test_press_in_motion_tells_damping_as_well(scenes):
    text = scenes.press_ramp()
    found = check("press", text, scenes.truth("press"), "stiffness", "damping")
    assert set(found.parameters()) == {"stiffness", "damping"}


def test_drop(scenes):
    text = scenes.drop()
    found = check("drop", text, scenes.truth("drop"), "damping")
    assert found.parameters().keys() == {"damping"}
    check_kept("drop", text)


def test_times_between_bounces(scenes):
    check("drop", scenes.drop_times(), scenes.truth("drop"), "damping")


def test_drop_of_constant_restitution(scenes):
    scene = "scene_restitution.xml"
    text = scenes.drop(count=6, scene=scene)
    names = "restitution", "restitution_speed_floor"
    found = check("drop", text, scenes.truth("drop", scene), *names)
    assert found.parameters().keys() == set(names)


@pytest.mark.soak
def test_tilt(scenes):
    """`./run test` reads the kept sheet: test_bench_noise.py."""
    text = scenes.tilt()
    names = "friction", "static_friction", "dwell_time"
    check("tilt", text, scenes.truth("tilt"), *names)
    check_kept("tilt", text)


@pytest.mark.soak
def test_pull(scenes):
    """`./run test` reads the kept sheet: test_bench_noise.py."""
    text = scenes.pull()
    names = "friction", "static_friction", "dwell_time", "stribeck_speed", "viscous_friction"
    found = check("pull", text, scenes.truth("pull"), *names)
    assert found.choices == ("friction_law/bristle",)
    check_kept("pull", text)


def test_slip(scenes):
    text = scenes.slip()
    found = check("slip", text, scenes.truth("slip"), "bristle_stiffness", "bristle_damping")
    assert not found.findings
    check_kept("slip", text)


def test_mass_on_the_contact_is_found_from_frequencies(scenes):
    text = scenes.slip(frequencies=(5.0, 40.0, 80.0))
    without = text.replace("# mass [kg] = 1\n", "")
    assert without != text
    found = check("slip", without, scenes.truth("slip"), "bristle_stiffness", "bristle_damping")
    assert found["mass"] == pytest.approx(1.0, rel=5e-3)


def test_every_number_of_the_laws_is_found_by_some_test():
    """hunt_crossley and bristle, whatever fields they get."""
    import inspect

    import volcontact as vc

    fields = set()
    for law in (vc.HuntCrossley, vc.Bristle):
        fields |= {name for name, item in inspect.getmembers(law) if isinstance(item, property)}
    source = (FOLDER.parents[1] / "tests/python/identify/test_bench_recovery.py").read_text()
    for field in fields - {"name", "state_size", "coupling"}:
        assert f'"{field}"' in source, field


def test_roll(scenes):
    text = scenes.roll()
    found = check("roll", text, scenes.truth("roll"), "damping")
    assert found.choices == ("rolling/on",)
    # The decay of docs/validation.md, "Rolling resistance".
    assert found["decay"] == pytest.approx(0.018665, rel=CLOSE)
    check_kept("roll", text)


def test_spin(scenes):
    text = scenes.spin()
    found = direct.read_bench("spin", text)
    assert found.choices == ("coupling/quadrature",)
    assert found["lever"] == pytest.approx(0.05 * 2.0 / 3.0, rel=CLOSE)
    assert found["spin_torque"] == pytest.approx(0.3 * 9.81 * 0.1 / 3.0, rel=CLOSE)
    without = text.replace("# friction = 0.3\n", "")
    found = direct.read_bench("spin", without)
    # As for `ellipsoid`, whose lever is R / sqrt(2).
    assert found["friction"] == pytest.approx(0.3 * 2.0 / 3.0 * np.sqrt(2.0), rel=CLOSE)
    assert any("0.3 for quadrature" in line for line in found.findings)
    check_kept("spin", text)
