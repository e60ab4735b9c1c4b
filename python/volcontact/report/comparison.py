# SPDX-License-Identifier: Apache-2.0
"""Two runs of one scene, and the figures in which they differ."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np

from volcontact.convergence import Convergence
from volcontact.report.design_pose import DesignPose, angle_between
from volcontact.running.outside_work import CHANNELS as OUTSIDE
from volcontact.running.recording import Recording


@dataclass(frozen=True)
class Limits:
    """What may be carried at most; None where nothing is said.

    Attributes:
        force: of one contact site [N].
        torque: of one contact site, about its place [N m].
        sensors: of sensors of the scene, by name, in the unit of the sensor.
    """

    force: float | None = None
    torque: float | None = None
    sensors: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Comparison:
    """Volumetric and native contact on one scene.

    Attributes:
        scene: what the user called it.
        volumetric: the run under volcontact.
        native: the run under MuJoCo's own contact.
        design: the pose it should end in, or None.
        mujoco_version: of the library that ran.
        volcontact_version: of this package.
        limits: of what contacts and sensors may carry.
        plots: further curves, as `Y` or `Y:X`, columns of the trajectory.
        error_of_step: what the step of the volumetric run costs; None where it was not asked.
    """

    scene: str
    volumetric: Recording
    native: Recording
    design: DesignPose | None
    mujoco_version: str
    volcontact_version: str
    limits: Limits = Limits()
    error_of_step: Convergence | None = None
    plots: tuple[str, ...] = ()

    @property
    def runs(self) -> tuple[Recording, Recording]:
        """Both runs, the volumetric one first."""
        return self.volumetric, self.native

    def summary(self) -> dict[str, Any]:
        """The content of `summary.json`; units are SI, times of a step in microseconds."""
        found = self.error_of_step
        return {
            "volumetric": run_summary(self.volumetric, self.design),
            "native": run_summary(self.native, self.design),
            "mujoco_version": self.mujoco_version,
            "volcontact_version": self.volcontact_version,
            **({} if found is None else {"error_of_step": found.summary()}),
        }


@dataclass(frozen=True)
class Offset:
    """How far a body is from its design pose over a run.

    Attributes:
        distance: [m], shape (n,).
        angle: [degree], shape (n,).
    """

    distance: np.ndarray
    angle: np.ndarray


def offset_from(run: Recording, design: DesignPose) -> Offset:
    """The distance and angle of the design's body from the design pose at every instant.

    Raises:
        ValueError: the scene has no such moving body.
    """
    if design.body not in run.bodies:
        raise ValueError(
            f"the design pose names body {design.body!r}, the moving bodies are: "
            f"{', '.join(run.bodies) or 'none'}"
        )
    body = run.bodies.index(design.body)
    return Offset(
        distance=np.linalg.norm(run.position[:, body] - design.position, axis=1),
        angle=angle_between(run.quaternion[:, body], design.quaternion),
    )


def is_seated(run: Recording, design: DesignPose) -> bool:
    """Whether a run ended in its design pose, at rest, within the tolerances."""
    offset = offset_from(run, design)
    speed = run.speed[-1, run.bodies.index(design.body)]
    return bool(
        run.stopped is None
        and offset.distance[-1] <= design.position_tolerance
        and offset.angle[-1] <= design.angle_tolerance
        and speed <= design.speed_tolerance
    )


def first_touch(run: Recording) -> float | None:
    """Time of the first contact [s]; None if nothing touched."""
    rows = np.flatnonzero(run.site_count)
    return float(run.time[rows[0]]) if len(rows) else None


class Peak(NamedTuple):
    """The largest load that one contact site ever carried.

    Attributes:
        value: [N] or [N m]; 0 without any contact.
        time: when [s].
        geoms: where.
    """

    value: float
    time: float
    geoms: tuple[str, str]


def peak(run: Recording, load: Literal["force", "torque"]) -> Peak:
    """The largest force, or torque about its place, of one contact site."""
    if len(run.sites) == 0:
        return Peak(0.0, 0.0, ("", ""))
    sizes = np.linalg.norm(run.sites[load], axis=1)
    site = run.sites[int(sizes.argmax())]
    names = run.geoms[int(site["geom_a"])], run.geoms[int(site["geom_b"])]
    return Peak(float(sizes.max()), float(run.time[site["row"]]), names)


def largest_rise(energy: np.ndarray) -> float:
    """The most that an energy ever stood above an earlier value of its own [J]."""
    return float(np.max(energy - np.minimum.accumulate(energy)))


def run_summary(run: Recording, design: DesignPose | None) -> dict[str, Any]:
    """One run as plain numbers, ready for JSON."""
    result: dict[str, Any] = {
        "steps": run.steps,
        "dt": run.timestep,
        "microseconds_per_step": run.microseconds_per_step,
        "max_penetration": float(run.penetration.max()),
        "final_qpos": run.qpos[-1].tolist(),
        "energy_initial": float(run.energy[0]),
        "energy_final": float(run.energy[-1]),
        "max_contact_sites": int(run.site_count.max()),
        "warnings": run.warnings,
        "stopped": run.stopped,
        "dropped": run.dropped,
        "final_speed": float(run.speed[-1].max(initial=0.0)),
        "max_contact_force": float(run.contact_force.max()),
        "final_contact_force": float(run.contact_force[-1]),
        "energy_dissipated": dict(
            zip(("normal", "roll", "slide", "spin"), run.dissipated[-1].tolist(), strict=True)
        ),
        "energy_numerical": float(run.numerical[-1]),
        "work_of_contact": float(run.work[-1]),
        "outside_work": dict(zip(OUTSIDE, run.outside_work[-1].tolist(), strict=True)),
        "audit": run.audit().summary(),
        "energy_unbalance": float(np.abs(run.unbalance()).max()),
        "first_touch": first_touch(run),
        "max_site_force": peak(run, "force").value,
        "max_site_torque": peak(run, "torque").value,
        "notes": list(run.notes),
        "max_sensors": {name: float(values.max()) for name, values in run.sensors.items()},
    }
    if design is not None:
        offset = offset_from(run, design)
        result["design_pose"] = {
            "seated": is_seated(run, design),
            "distance": float(offset.distance[-1]),
            "angle_degrees": float(offset.angle[-1]),
        }
    return result
