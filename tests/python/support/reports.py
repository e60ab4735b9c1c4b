# SPDX-License-Identifier: Apache-2.0
"""Runs and comparisons, made up, for the tests of the report."""

import dataclasses

import numpy as np

from volcontact.report import Comparison
from volcontact.report.design_pose import DesignPose
from volcontact.report.findings import findings
from volcontact.report.pictures import FramePair
from volcontact.running.recording import SITE, SITE_IN_RUN, Frame, Recording
from volcontact.running.signals import Signal

DESIGN = DesignPose(
    body="box",
    position=np.array([0.0, 0.0, 0.2]),
    quaternion=np.array([1.0, 0.0, 0.0, 0.0]),
    position_tolerance=1e-3,
    angle_tolerance=0.1,
    speed_tolerance=1e-3,
)


LARGER = "larger of: volcontact/material/steel, volcontact/material/tin"


def floor_pair(index: int, geom: str, friction: float, source: str = LARGER) -> dict:
    return {
        "pair": index,
        "geom_a": geom,
        "geom_b": "floor",
        "id_a": index,
        "engine": "clip",
        "friction": friction,
        "sources": {"friction": source},
    }


def in_run(sites: np.ndarray, row: int) -> np.ndarray:
    rows = np.zeros(len(sites), SITE_IN_RUN)
    rows["row"] = row
    for name in SITE.names:
        rows[name] = sites[name]
    return rows


def recording(contact: str = "volumetric", **changes) -> Recording:
    """A box that sinks from 0.5 m to 0.2 m in 2 s and then lies still: 101 rows."""
    n = 101
    time = np.linspace(0.0, 2.0, n)
    height = np.maximum(0.5 - 0.3 * time, 0.2)
    position = np.zeros((n, 1, 3))
    position[:, 0, 2] = height
    quaternion = np.tile([1.0, 0.0, 0.0, 0.0], (n, 1, 1))
    touching = height <= 0.2
    sites = np.zeros(2, SITE)
    sites["normal"] = (0.0, 0.0, 1.0)
    sites["force"] = (0.0, 0.0, 50.0)
    sites["area"] = 0.01
    sites["geom_b"] = 1
    sites["torque"] = (0.0, 2.0, 0.0)
    sites["depth"] = 1e-5
    potential = 100.0 * height
    dissipated = np.zeros((n, 4))
    dissipated[:, 0] = potential[0] - potential
    values = dict(
        contact=contact,
        timestep=0.02,
        bodies=("box",),
        time=time,
        qpos=np.hstack([position[:, 0], quaternion[:, 0]]),
        qvel=np.zeros((n, 6)),
        position=position,
        quaternion=quaternion,
        speed=np.where(touching, 0.0, 0.3)[:, None],
        spin=np.zeros((n, 1)),
        kinetic=np.zeros(n),
        potential=potential,
        elastic=np.zeros(n),
        dissipated=dissipated if contact == "volumetric" else np.zeros((n, 4)),
        work=-dissipated[:, 0],
        numerical=np.zeros(n),
        driven=np.zeros(n),
        made=np.zeros(n),
        # Native contact, the last channel, takes what the box loses.
        outside_work=np.zeros((n, 4))
        if contact == "volumetric"
        else np.column_stack([np.zeros((n, 3)), -dissipated[:, 0]]),
        signals={"joint.slide.position": Signal(height - 0.5, "m")},
        wrench_on={"box": np.zeros((n, 6))},
        contact_force=np.where(touching, 100.0, 0.0),
        largest_site_force=np.where(touching, 50.0, 0.0),
        site_count=np.where(touching, 2, 0),
        penetration=np.where(touching, 1e-5, 0.0),
        step_microseconds=np.full(n - 1, 20.0),
        warnings={},
        stopped=None,
        dropped=0,
        sites=np.concatenate([in_run(sites, row) for row in range(n) if touching[row]]),
        sensors={"wrist_force": np.where(touching, 40.0, 5.0)},
        geoms=("floor", "box"),
        frames=(Frame(0, 0.0, sites[:0]), Frame(n - 1, 2.0, sites)),
        description={
            "options": {"tolerance": 1e-3, "engine": "auto"},
            "materials": {
                "steel": {
                    "key": "volcontact/material/steel",
                    "stiffness": 2e8,
                    "damping": 0.5,
                    "geoms": ["foot", "lid"],
                }
            },
            "pairs": [
                *(floor_pair(i, f"foot_{i}", friction=0.1) for i in range(20)),
                floor_pair(20, "lid", friction=0.2, source="of pair lid"),
            ],
            "warnings": ["the handle touches nothing"],
        },
        weight=100.0,
    )
    return Recording(**{**values, **changes})


def comparison(**changes) -> Comparison:
    values = dict(
        scene="models/battery_box/scene.xml",
        volumetric=recording(),
        native=recording("native"),
        design=DESIGN,
        mujoco_version="9.9.9",
        volcontact_version="1.2.3",
    )
    return Comparison(**{**values, **changes})


def shifted(run: Recording, shift: tuple[float, float, float]) -> Recording:
    return dataclasses.replace(run, position=run.position + np.array(shift))


def sentence(made: Comparison, title: str) -> str:
    (text,) = (finding.text for finding in findings(made) if finding.title == title)
    return text


def pair(with_native: bool = True) -> FramePair:
    picture = np.random.default_rng(1).integers(0, 255, (30, 40, 3), dtype=np.uint8)
    return FramePair(0.2, picture, picture if with_native else None, ("2 contacts", "no contact"))
