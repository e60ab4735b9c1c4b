# SPDX-License-Identifier: Apache-2.0
"""The variables of a unit of a whole scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco

from volcontact.fmu.container import Parameter, of_kind
from volcontact.fmu.units import limits
from volcontact.fmu.variables import FIXED, Group, numbered, quoted

MATERIAL = "volcontact/material/"
# Of the sensors that have one and the same unit in all their numbers.
_SENSOR_UNITS = {
    "TOUCH": "N", "ACCELEROMETER": "m/s^2", "VELOCIMETER": "m/s", "GYRO": "rad/s", "FORCE": "N",
    "TORQUE": "N m", "RANGEFINDER": "m", "BALLANGVEL": "rad/s", "FRAMEPOS": "m",
    "FRAMELINVEL": "m/s", "FRAMEANGVEL": "rad/s", "FRAMELINACC": "m/s^2", "FRAMEANGACC": "rad/s^2",
    "SUBTREECOM": "m", "SUBTREELINVEL": "m/s", "CLOCK": "s", "E_POTENTIAL": "J", "E_KINETIC": "J",
}  # fmt: skip
_CHANNELS = "by channel: normal, roll, slide, spin"


@dataclass(frozen=True)
class Pair:
    """Two things whose contact has values of its own.

    Attributes:
        geoms: of each side.
    """

    names: tuple[str, str]
    geoms: tuple[tuple[int, ...], tuple[int, ...]]


def scene_variables(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    *,
    bodies: Sequence[int],
    pairs: Sequence[Pair],
    laws: Mapping[str, Parameter],
) -> list[Group]:
    """All groups, with their value references.

    Args:
        model: the scene.
        data: at its start.
        bodies: those that have values.
        pairs: likewise.
        laws: what is known of the numbers of a material, by name.
    """
    groups = _ctrl(model, data)
    for body in bodies:
        groups += _body_inputs(model, data, body)
    for sensor in range(model.nsensor):
        groups.append(_sensor(model, sensor))
    for joint in range(model.njnt):
        groups += _joint(model, data, joint)
    for body in bodies:
        groups += _body(model, body)
    groups += _contact("contact", "of all contact", 0)
    for i, pair in enumerate(pairs):
        head = "pair." + ".".join(map(quoted, pair.names))
        groups += _contact(head, f"of the contact of {pair.names[0]} with {pair.names[1]}", i + 1)
    groups += _parameters(model, laws)
    groups.append(Group("time", "time", "time", "s", "independent"))
    _make_names_differ(groups)
    return numbered(groups)


def _name(model: mujoco.MjModel, kind: str, i: int) -> str:
    return quoted(of_kind(model, kind, i))


def _ctrl(model: mujoco.MjModel, data: mujoco.MjData) -> list[Group]:
    groups = []
    for i in range(model.nu):
        low, high = model.actuator_ctrlrange[i] if model.actuator_ctrllimited[i] else (None, None)
        groups.append(Group(
            "ctrl", f"ctrl.{_name(model, 'actuator', i)}",
            f"control of the actuator {of_kind(model, 'actuator', i)}", "-", "input", index=i,
            start=[float(data.ctrl[i])], low=low, high=high,
        ))  # fmt: skip
    return groups


def _body_inputs(model: mujoco.MjModel, data: mujoco.MjData, body: int) -> list[Group]:
    name = of_kind(model, "body", body)
    rest: dict[str, Any] = {"causality": "input", "index": body}
    mocap = int(model.body_mocapid[body])
    if mocap >= 0:
        head = f"mocap.{quoted(name)}"
        return [
            Group("mocap_position", f"{head}.position", f"of the mocap body {name}", "m",
                  start=_floats(data.mocap_pos[mocap]), **rest),
            Group("mocap_quaternion", f"{head}.quaternion",
                  f"of the mocap body {name}, w x y z; of any length but 0",
                  start=_floats(data.mocap_quat[mocap]), **rest),
        ]  # fmt: skip
    if model.body_weldid[body] == 0:
        return []
    head = f"body.{quoted(name)}"
    return [
        Group("applied_force", f"{head}.applied_force",
              f"on {name} at its centre of mass, in the world", "N",
              start=_floats(data.xfrc_applied[body, :3]), **rest),
        Group("applied_torque", f"{head}.applied_torque", f"on {name}, in the world", "N m",
              start=_floats(data.xfrc_applied[body, 3:]), **rest),
    ]  # fmt: skip


def _sensor(model: mujoco.MjModel, i: int) -> Group:
    kind = mujoco.mjtSensor(int(model.sensor_type[i])).name.removeprefix("mjSENS_")
    return Group(
        "sensor", f"sensor.{_name(model, 'sensor', i)}",
        f"what the sensor {of_kind(model, 'sensor', i)} ({kind.lower()}) measures",
        _SENSOR_UNITS.get(kind, "-"), index=i, start=[0.0] * int(model.sensor_dim[i]),
    )  # fmt: skip


def _joint(model: mujoco.MjModel, data: mujoco.MjData, i: int) -> list[Group]:
    kind = int(model.jnt_type[i])
    name, head = of_kind(model, "joint", i), f"joint.{_name(model, 'joint', i)}"
    free, ball, slide = (
        int(mujoco.mjtJoint.mjJNT_FREE),
        int(mujoco.mjtJoint.mjJNT_BALL),
        int(mujoco.mjtJoint.mjJNT_SLIDE),
    )
    numbers, units, more = {
        free: ((7, 6), ("-", "-"), ("x y z [m], quaternion w x y z",
                                    "velocity [m/s], angular velocity in the body [rad/s]")),
        ball: ((4, 3), ("-", "rad/s"), ("quaternion w x y z", "in the body")),
        slide: ((1, 1), ("m", "m/s"), ("", "")),
    }.get(kind, ((1, 1), ("rad", "rad/s"), ("", "")))  # fmt: skip
    return [
        Group(f"joint_{what}", f"{head}.{what}",
              f"of the joint {name}" + (f": {more[k]}" if more[k] else ""), units[k], index=i,
              start=[0.0] * numbers[k])
        for k, what in enumerate(("position", "velocity"))
    ]  # fmt: skip


def _body(model: mujoco.MjModel, body: int) -> list[Group]:
    name = of_kind(model, "body", body)
    head, of = f"body.{quoted(name)}", f"of the frame of {name} in the world"
    three: dict[str, Any] = {"index": body, "start": [0.0] * 3}
    return [
        Group("body_position", f"{head}.position", f"origin {of}", "m", **three),
        Group("body_quaternion", f"{head}.quaternion", f"{of}, w x y z", index=body,
              start=[0.0] * 4),
        Group("body_angular_velocity", f"{head}.angular_velocity", of, "rad/s", **three),
        Group("body_velocity", f"{head}.velocity", f"of the origin {of}", "m/s", **three),
    ]  # fmt: skip


def _contact(head: str, of: str, index: int) -> list[Group]:
    rest: dict[str, Any] = {"index": index}
    least: dict[str, Any] = {"low": 0.0, **rest}
    step: dict[str, Any] = {"variability": "discrete", **rest}
    groups = [
        Group("pair_volume", f"{head}.volume", f"interference volume {of}", "m^3", **least),
        Group("pair_depth", f"{head}.depth", f"the deepest site {of}", "m", **least),
        Group("pair_sites", f"{head}.site_count", f"sites {of}", low=0.0, **step),
        Group("pair_touching", f"{head}.touching", f"whether there is a site {of}", **step),
        Group("pair_normal_force", f"{head}.normal_force", f"sum over the sites {of}", "N", **rest),
        Group("pair_elastic_energy", f"{head}.elastic_energy", f"stored in the sites {of}", "J",
              **least),
    ]  # fmt: skip
    if index > 0:
        groups.append(Group("pair_force", f"{head}.force", f"on the first, in the world, {of}", "N",
                            start=[0.0] * 3, **rest))  # fmt: skip
        return groups
    return [
        *groups,
        Group("contact_power", f"{head}.dissipated_power", _CHANNELS, "W", start=[0.0] * 4),
        Group("contact_dissipated", f"{head}.dissipated_energy", f"{_CHANNELS}; since the start",
              "J", start=[0.0] * 4),
    ]  # fmt: skip


def _parameters(model: mujoco.MjModel, laws: Mapping[str, Parameter]) -> list[Group]:
    rest: dict[str, Any] = {"causality": "parameter"}
    groups = [
        Group("timestep", "timestep", "of MuJoCo; communication steps are multiples of it", "s",
              variability="fixed", start=[float(model.opt.timestep)], **rest),
        Group("gravity", "gravity", "in the world", "m/s^2", variability="tunable",
              start=_floats(model.opt.gravity), **rest),
    ]  # fmt: skip
    for i in range(model.nnumeric):
        name = mujoco.mj_id2name(model, int(mujoco.mjtObj.mjOBJ_NUMERIC), i) or ""
        parts = name.removeprefix(MATERIAL).split("/")
        law = laws.get(parts[-1])
        if not name.startswith(MATERIAL) or len(parts) < 2 or law is None:
            continue
        first, count = int(model.numeric_adr[i]), int(model.numeric_size[i])
        low, high = limits(law.range)
        groups.append(Group(
            "material", "material." + ".".join(map(quoted, parts)), f"of a material; {law.range}",
            law.unit, variability="fixed" if parts[-1] in FIXED else "tunable", index=i,
            start=_floats(model.numeric_data[first : first + count]), low=low, high=high, **rest,
        ))  # fmt: skip
    return groups


def _make_names_differ(groups: Sequence[Group]) -> None:
    """What has no name is called after its number, as something else may be."""
    seen: set[str] = set()
    for group in groups:
        while group.name in seen:
            group.name += "_"
        seen.add(group.name)


def _floats(numbers: Any) -> list[float]:
    return [float(number) for number in numbers]
