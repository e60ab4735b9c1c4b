# SPDX-License-Identifier: Apache-2.0
"""What the data of a bench test cannot tell is named, in words."""

import numpy as np
import pytest
from bench_sheets import kept_sheet, noisy, read

from volcontact.identify import direct
from volcontact.identify.direct.sheets import Sheet


def part(sheet, rows):
    """Some rows of a sheet."""
    columns = {name: column[rows] for name, column in sheet.columns.items()}
    labels = {
        name: [x for x, kept in zip(column, rows, strict=True) if kept]
        for name, column in sheet.labels.items()
    }
    return Sheet(sheet.test, sheet.source, columns, labels, sheet.constants)


def says(found, *words):
    return any(all(word in line for word in words) for line in found.findings)


def test_breakaways_alone_tell_no_stribeck_speed():
    sheet = kept_sheet("pull")
    found = read(part(sheet, np.isfinite(sheet.columns["rest"])))
    assert says(found, "stribeck_speed cannot be told", "slides at several speeds")
    assert says(found, "friction (mu_C) is extrapolated to a rest of 0 s")
    assert "stribeck_speed" not in found.parameters()


def test_slides_alone_tell_no_dwell_time():
    sheet = kept_sheet("pull")
    found = read(part(sheet, np.isfinite(sheet.columns["speed"])))
    assert says(found, "dwell_time cannot be told", "rests")
    assert found["static_friction"] == pytest.approx(0.4, rel=1e-3)


def test_short_rests_tell_no_dwell_time():
    rest = np.array([0.001, 0.0011, 0.0012, 0.0013, 0.0014, 0.0015])
    sheet = Sheet(
        "pull",
        "pull",
        {"rest": rest, "force": 3.0 + 0.01 * np.cos(7.0 * np.arange(6))},
        constants={"normal force": 9.81},
    )
    found = read(sheet)
    assert says(found, "dwell_time cannot be told from these data")
    assert "dwell_time" not in found.parameters()


def test_slow_slides_extrapolate_kinetic_friction():
    sheet = kept_sheet("pull")
    slow = ~(sheet.columns["speed"] > 0.02)
    assert says(read(part(sheet, slow)), "The fastest slide is below 3 times stribeck_speed")


def test_viscous_friction_that_is_not_seen_is_left_away():
    sheet = kept_sheet("pull")
    force = sheet.columns["force"] - 2.0 * np.nan_to_num(sheet.columns["speed"])
    without = Sheet("pull", "pull", sheet.columns | {"force": force}, {}, sheet.constants)
    found = read(noisy(without, {"force": 0.01}, 1))
    assert says(found, "viscous_friction", "0 fits as well")
    assert "viscous_friction" not in found.parameters()


def test_one_angle_tells_no_dwell_time_and_no_kinetic_friction():
    found = direct.read_bench("tilt", "angle [deg]\n21.7\n21.9\n21.8\n")
    assert says(found, "dwell_time cannot be told")
    assert says(found, "friction (mu_C) cannot be told from breakaways alone")
    assert found.parameters().keys() == {"static_friction"}


def test_drops_from_one_height_do_not_tell_the_law():
    text = "drop,height [mm]\n1,500\n1,246\n2,500\n2,247\n3,500\n3,246.5\n"
    assert says(direct.read_bench("drop", text), "cannot be told", "Drop from other heights")


def test_floor_below_the_slowest_impact_is_named():
    heights = [500.0 * 0.49**k for k in range(5)]
    text = "height [mm]\n" + "".join(f"{h + 0.3 * (-1) ** k}\n" for k, h in enumerate(heights))
    found = direct.read_bench("drop", text)
    assert found["restitution"] == pytest.approx(0.7, abs=0.01)
    assert says(found, "restitution_speed_floor cannot be told", "the slowest impact")


def test_too_few_bounces_have_no_interval():
    found = direct.read_bench("drop", "height [mm]\n500\n246\n")
    assert says(found, "no interval can be given")
    assert np.isnan(found.values["damping"].low)


def test_slow_loops_do_not_tell_bristle_damping():
    t = np.linspace(0.0, 400.0, 200)
    x = 2e-6 * np.sin(2.0 * np.pi * 0.01 * t)
    noise = 2e-3 * np.random.default_rng(3).standard_normal(200)
    force = 1e5 * x + 600.0 * np.gradient(x, t) + noise
    columns = {"time": t, "displacement": x, "force": force}
    found = read(Sheet("slip", "slip", columns, constants={"mass": 1.0}))
    assert found["bristle_stiffness"] == pytest.approx(1e5, rel=0.01)
    assert says(found, "bristle_damping cannot be told", "higher frequency")
    assert says(found, "sum of bristle_damping and viscous_friction")
    assert found.parameters().keys() == {"bristle_stiffness"}


def test_loop_that_slides_is_no_ellipse():
    t = np.linspace(0.0, 0.6, 300)
    x = 5e-5 * np.sin(2.0 * np.pi * 5.0 * t)
    force = np.clip(1e5 * x, -3.0, 3.0)
    found = read(Sheet("slip", "slip", {"time": t, "displacement": x, "force": force}))
    assert says(found, "is no ellipse", "leaves pre-sliding")


def test_mass_that_is_not_known_is_named():
    sheet = kept_sheet("slip")
    first = np.array(sheet.labels["loop"]) == "1"
    one = part(sheet, first)
    del one.constants["mass"]
    assert says(read(one), "mass", "one frequency does not tell it")


def test_short_roll_does_not_tell_damping_from_a_constant_resistance():
    found = read(noisy(kept_sheet("roll"), {"rate": 0.05}, 4))
    assert says(found, "falls with the speed", "or is constant")


def test_constant_resistance_is_told_and_is_none_of_the_law():
    sheet = kept_sheet("roll")
    t = np.linspace(0.0, 60.0, 121)
    rate = (20.0 + 0.2 / 0.02) * np.exp(-0.02 * t) - 0.2 / 0.02
    columns = {"time": t, "rate": rate + 0.005 * np.random.default_rng(1).standard_normal(121)}
    found = read(Sheet("roll", "roll", columns, {}, sheet.constants))
    assert says(found, "does not fall with the speed", "The law has none")
    inertia = 0.001 + 0.0494721**2
    assert found["constant_torque"] == pytest.approx(0.2 * inertia, rel=0.02)
    assert found["decay"] == pytest.approx(0.02, rel=0.02)


def test_body_that_does_not_slow_down_rolls_without_resistance():
    sheet = kept_sheet("roll")
    rate = 20.0 + 0.01 * np.random.default_rng(2).standard_normal(50)
    columns = {"time": np.linspace(0.0, 2.0, 50), "rate": rate}
    found = read(Sheet("roll", "roll", columns, {}, sheet.constants))
    assert found.choices == ("rolling/off",)
    assert says(found, "damping cannot be told")
    assert not found.parameters()


def test_noisy_spin_does_not_tell_the_coupling():
    sheet = kept_sheet("spin")
    found = read(noisy(sheet, {"rate": 8.0}, 5))
    assert says(found, "The coupling cannot be told", "ellipsoid")
    assert found.choices == ()
    wrong = Sheet("spin", "spin", sheet.columns, {}, sheet.constants | {"friction": 0.4})
    assert says(read(wrong), "that of no coupling")
