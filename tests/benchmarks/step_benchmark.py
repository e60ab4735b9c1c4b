# SPDX-License-Identifier: Apache-2.0
"""Time of one MuJoCo step under volumetric contact, beside native contact and no contact at all.

    ./run python tests/benchmarks/step_benchmark.py [--json]

Compare the columns of one run with each other, not with those of another machine.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import mujoco

import volcontact as vc

ROOT = Path(__file__).parents[2]
STEPS = 200
ROUNDS = 15


def resting_boxes(count: int) -> str:
    """`count` boxes that rest on a floor, each with one site; no two of them near."""
    bodies = "".join(
        f'<body pos="{0.5 * (i % 5)} {0.5 * (i // 5)} .0999"><freejoint/>'
        '<geom type="box" size=".1 .1 .1" mass="1"/></body>'
        for i in range(count)
    )
    return _scene(f'<geom type="plane" size="9 9 1" contype="2" conaffinity="2"/>{bodies}')


def boxes_apart(count: int) -> str:
    """Boxes in free flight: count (count - 1) / 2 pairs, all culled."""
    bodies = "".join(
        f'<body pos="{0.5 * (i % 5)} {0.5 * (i // 5)} 1"><freejoint/>'
        '<geom type="box" size=".1 .1 .1" mass="1"/></body>'
        for i in range(count)
    )
    return _scene(bodies, gravity="0 0 0")


def pile(count: int) -> str:
    """Boxes in stacks of five."""
    bodies = "".join(
        f'<body pos="{0.25 * (i // 5)} 0 {0.0999 + 0.1998 * (i % 5)}"><freejoint/>'
        '<geom type="box" size=".1 .1 .1" mass="1"/></body>'
        for i in range(count)
    )
    return _scene(f'<geom type="plane" size="9 9 1"/>{bodies}')


def _scene(bodies: str, gravity: str = "0 0 -9.81") -> str:
    bodies = bodies.replace('size=".1 .1 .1"', 'size=".1 .1 .1" contype="3" conaffinity="3"')
    return (
        f'<mujoco><size nconmax="2000" njmax="8000"/><option timestep="5e-4" gravity="{gravity}"/>'
        f'<default><geom friction=".1 .005 .0001"/></default><worldbody>{bodies}</worldbody>'
        "</mujoco>"
    )


def seated_battery_box() -> mujoco.MjModel:
    """The battery box at rest in its worksite."""
    model = vc.load(ROOT / "mjcf_models" / "battery_box" / "scene.xml")
    model.qpos0[:] = model.key("seated").qpos
    return model


@contextmanager
def contact_of(kind: str, model: mujoco.MjModel) -> Iterator[vc.Contact | None]:
    """The model under volumetric, native or no contact."""
    if kind == "volumetric":
        with vc.attach(model) as contact:
            yield contact
        return
    flags = model.opt.disableflags
    if kind == "none":
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    yield None
    model.opt.disableflags = flags


def measure(model: mujoco.MjModel) -> dict[str, float]:
    """Microseconds a step, the best of some rounds, and what touched at the end."""
    result: dict[str, float] = {}
    for kind in ("none", "native", "volumetric"):
        data = mujoco.MjData(model)
        best = float("inf")
        with contact_of(kind, model) as contact:
            for _ in range(ROUNDS):
                mujoco.mj_resetData(model, data)
                begin = time.perf_counter_ns()
                mujoco.mj_step(model, data, STEPS)
                best = min(best, 1e-3 * (time.perf_counter_ns() - begin) / STEPS)
            if contact is not None:
                result["pairs"] = len(contact.description["pairs"])
                result["sites"] = len(contact.sites(data))
        result[kind] = round(best, 3)
    return result


def main() -> None:
    """Measures every scene and prints a table, or JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true", help="print JSON")
    as_json = parser.parse_args().json
    scenes = {
        "18 boxes apart": vc.load(boxes_apart(18)),
        "20 boxes on a floor": vc.load(resting_boxes(20)),
        "20 boxes in 4 stacks": vc.load(pile(20)),
        "battery box, seated": seated_battery_box(),
    }
    results = {name: measure(model) for name, model in scenes.items()}
    if as_json:
        print(json.dumps({"mujoco_version": mujoco.__version__, "scenes": results}, indent=2))
        return
    print(f"MuJoCo {mujoco.__version__}, microseconds a step")
    columns = ("pairs", "sites", "none", "native", "volumetric")
    print(f"{'':24}" + "".join(f"{column:>12}" for column in columns))
    for name, result in results.items():
        print(f"{name:24}" + "".join(f"{result[column]:>12}" for column in columns))


if __name__ == "__main__":
    main()
