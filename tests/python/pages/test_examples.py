# SPDX-License-Identifier: Apache-2.0
"""python/examples: each runs and prints what is known of its answer."""

import re
import runpy
from pathlib import Path

import pyarrow.parquet as pq
import pytest

EXAMPLES = Path(__file__).parents[3] / "python" / "examples"
# Stand at the end of a number: m, mm, J and so on may follow.
NUMBER = r"-?\d+\.?\d*(?:e[+-]?\d+)?"


@pytest.fixture
def run(capsys):
    """Runs an example and returns what it printed."""

    def run(name, *arguments):
        main = runpy.run_path(str(EXAMPLES / f"{name}.py"))["main"]
        main(*arguments)
        return capsys.readouterr().out

    return run


def numbers(text):
    return [float(number) for number in re.findall(NUMBER, text)]


def test_drop_a_box(run):
    text = run("drop_a_box")
    (force,) = re.findall(rf"normal force ({NUMBER}) N", text)
    assert float(force) == pytest.approx(9.81, rel=0.01)
    assert "area 320.0 cm^2" in text  # 0.2 m by 0.16 m
    (lost,) = re.findall(rf"dissipated ({NUMBER}) J", text)
    # Steps of 1 ms resolve the impacts to a per cent or so.
    assert float(lost) == pytest.approx(9.81 * (0.3 - 0.05), rel=0.02)


def test_peg_in_hole(run):
    text = run("peg_in_hole")
    assert re.search(r"first touch of the plate after 0\.0\d+ s", text)
    (depth,) = re.findall(rf"stands ({NUMBER}) mm above", text)
    assert float(depth) == pytest.approx(-1e3 * 9.81 / (5e9 * 3.14159 * 0.02**2), abs=2e-4)
    (lean,) = re.findall(rf"leans by ({NUMBER}) degrees", text)
    assert float(lean) < 0.02


def test_compare_with_native(run):
    volumetric, native = run("compare_with_native").splitlines()
    assert abs(numbers(volumetric)[2] - numbers(volumetric)[0]) < 1e-3  # it sticks
    assert numbers(native)[2] - numbers(native)[0] > 0.1  # it creeps [mm]


def test_identify_with_sysid(run):
    from volcontact.identify.sysid import toolbox

    lines = run("identify_with_sysid").splitlines()
    try:
        toolbox()
    except ModuleNotFoundError:
        assert lines[0].startswith("nothing to show: ")
        return
    said = dict(line.split(" = ") for line in lines if " = " in line)
    assert float(said["stiffness"]) == pytest.approx(4e6, rel=1e-4)
    assert float(said["damping"]) == pytest.approx(0.5, rel=1e-4)


def test_sweep_stiffness(run):
    rows = [numbers(line.split(": ")[1]) for line in run("sweep_stiffness").splitlines()]
    assert len(rows) == 5
    for depth, expected in rows:
        assert depth == pytest.approx(expected, rel=1e-4)


def test_record_and_plot(run, tmp_path):
    run("record_and_plot", tmp_path)
    states, sites = (pq.read_table(tmp_path / f"{name}.parquet") for name in ("states", "sites"))
    heights = states["qpos_2"].to_numpy()
    assert len(heights) == 3000 and 0 < len(sites) < len(heights)
    # The second flight rises by e^2 of the drop of 0.2 m; an impact takes some twenty of the steps.
    second = heights[(states["time"].to_numpy() > 0.25) & (states["time"].to_numpy() < 0.5)]
    assert second.max() - 0.05 == pytest.approx(0.64 * 0.2, rel=0.04)
    assert (tmp_path / "bounces.svg").stat().st_size > 1000


def test_draw_patches(run, tmp_path):
    text = run("draw_patches", tmp_path)
    areas = {name: area for name, area, _ in re.findall(r"(\w+): (\S+) mm\^2, (\S+) mm", text)}
    assert float(areas["leg_1"]) == pytest.approx(1e6 * 3.14159 * 0.02**2, rel=1e-3)
    assert float(areas["leg_3"]) == pytest.approx(1e6 * 0.06 * 0.03, rel=1e-3)
    assert (tmp_path / "patches.svg").stat().st_size > 1000


def test_own_law(run):
    forces = [numbers(line.split(": ")[1])[0] for line in run("own_law").splitlines()]
    assert forces[0] == pytest.approx(1e7 * 3.14159 * 0.5e-3**2 * (0.15 - 0.5e-3) / 3, rel=0.02)
    assert forces[1:] == sorted(forces[1:]) and forces[-1] == 20.0


def test_core_without_mujoco(run):
    _, weight = numbers(run("core_without_mujoco"))
    assert weight == pytest.approx(9.81, rel=1e-4)


def test_insert_oru(run):
    ended, felt, left = run("insert_oru").splitlines()
    assert ended.startswith("seated after")
    force, torque = numbers(felt)
    assert 30.0 < force < 111.0 and 0.0 < torque < 22.0
    assert numbers(left)[0] < 1.0  # [mm]


def test_identify_ball(run):
    text = run("identify_ball")
    for name in ("stiffness", "damping", "friction"):
        (found, true) = re.findall(rf"{name}: ({NUMBER}), true ({NUMBER})", text)[0]
        assert float(found) == pytest.approx(float(true), rel=0.05), name


def test_identify_press(run):
    text = run("identify_press")
    found = {name: numbers(rest) for name, rest in re.findall(r"(\w+): (.*) to .*", text)}
    assert found["stiffness"][0] == pytest.approx(5e9, rel=0.01)
    assert found["offset"][0] == pytest.approx(3e-4, rel=0.01)
    assert 'name="volcontact/pair/pad/stiffness"' in text


def test_identify_hertz(run):
    text = run("identify_hertz")
    found = {name: float(n) for name, n in re.findall(rf"same (\w+): ({NUMBER})", text)}
    # (9 F^2 / (16 R E*^2))^(1/3), and k_v pi d^2 (R - d/3) = F.
    depth = (9.0 * 100.0**2 / (16.0 * 0.01 * (210e9 / 0.91 / 2.0) ** 2)) ** (1.0 / 3.0)
    assert found["depth"] == pytest.approx(
        100.0 / (3.14159 * depth**2 * (0.01 - depth / 3)), rel=1e-3
    )
    assert found["patch"] == pytest.approx(4.0 * found["depth"], rel=1e-3)
    assert "volcontact/pair/ball/damping" in text


def test_every_example_is_tested_and_listed():
    names = {path.stem for path in EXAMPLES.glob("*.py")}
    tested = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert names == tested - {"every_example_is_tested_and_listed"}
    page = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    assert names == set(re.findall(r"\((\w+)\.py\)", page))
