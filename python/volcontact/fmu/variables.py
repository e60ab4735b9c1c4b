# SPDX-License-Identifier: Apache-2.0
"""The variables of a unit, in the order of its values: what both standards describe."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import Any

from volcontact.fmu.container import Body, Container, Model, Parameter
from volcontact.fmu.units import limits

INTEGERS = ("sites", "forgotten", "extrapolation", "pair_sites")
BOOLEANS = ("touching", "site_active", "pair_touching")
_INTEGRATED = (
    "deflection",
    "twist",
    "dwell",
    "stiffness",
)  # plugin/fmu/contact/contact_unit.cc has the same
_NOMINAL = {"dwell": 1.0, "stiffness": 1e5}  # and 1e-6 of a deflection, as evaluate.cc there
FIXED = ("restitution",)  # a change of these changes what laws keep


@dataclass
class Group:
    """Values in a row with one meaning: an array of FMI 3, scalars of FMI 2.

    Attributes:
        first: value reference.
        needs: bodies whose motion it depends on.
        models: contact models whose states it depends on.
        state: the group that this is the derivative of.
    """

    role: str
    name: str
    description: str
    unit: str = "-"
    causality: str = "output"
    variability: str = "continuous"
    index: int = 0
    first: int = 0
    start: list[float] = field(default_factory=lambda: [0.0])
    key: str = "-"
    low: float | None = None
    high: float | None = None
    nominal: float | None = None
    needs: tuple[int, ...] = ()
    models: tuple[int, ...] = ()
    state: Group | None = None

    @property
    def count(self) -> int:
        """How many values it has."""
        return len(self.start)

    @property
    def kind(self) -> str:
        """real, integer or boolean."""
        return (
            "integer" if self.role in INTEGERS else "boolean" if self.role in BOOLEANS else "real"
        )

    @property
    def is_state(self) -> bool:
        """Whether a solver integrates it."""
        return self.role in ("dissipated", "state")

    @property
    def initial(self) -> str | None:
        """As the standards have it."""
        if self.causality == "independent":
            return None
        return (
            "exact" if self.causality in ("parameter", "input") or self.is_state else "calculated"
        )

    def names(self) -> list[str]:
        """Of the scalars."""
        if self.count == 1:
            return [self.name]
        if self.role == "state_rate" and self.state is not None:
            return [f"der({name})" for name in self.state.names()]
        return [f"{self.name}[{i + 1}]" for i in range(self.count)]


def quoted(name: str) -> str:
    """A name as a part of a structured one."""
    if re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name):
        return name
    return "'" + name.replace("\\", "\\\\").replace("'", "\\'") + "'"


def variables(
    container: Container, *, kind: str, orientation: str, frame: str, slots: int
) -> list[Group]:
    """All groups, with their value references."""
    groups: list[Group] = []
    for i, body in enumerate(container.bodies):
        if body.is_free:
            groups += _inputs(body, i, orientation, frame)
    everywhere = tuple(i for i, body in enumerate(container.bodies) if body.is_free)
    for i, body in enumerate(container.bodies):
        groups += _wrench(container, body, i, frame)
    groups += _sums(everywhere, tuple(range(len(container.models))), kind)
    for m, model in enumerate(container.models):
        for k in range(slots):
            head = (
                f"site[{k + 1}]"
                if len(container.models) == 1
                else f"contact[{m + 1}].site[{k + 1}]"
            )
            groups += _site(container, model, m, m * slots + k, head)
            if kind != "cs":
                groups += _states(container, model, m, m * slots + k, head)
    if kind != "cs":
        groups.append(
            Group(
                "indicator",
                "event_indicators",
                "for each contact model: 1 where bodies touch, else -1; "
                "fastest slip over the speed from which friction slides, less 1",
                causality="local",
                start=[0.0] * (2 * len(container.models)),
                needs=everywhere,
            )
        )
    groups += _parameters(container)
    if kind != "me":
        groups += _step_parameters()
    groups.append(Group("time", "time", "time", "s", "independent"))
    return numbered(groups)


def numbered(groups: list[Group]) -> list[Group]:
    """The groups with their value references: one value after the other."""
    first = 0
    for group in groups:
        group.first, first = first, first + group.count
    return groups


def scalars(groups: list[Group]) -> list[Group]:
    """Groups of one value each, for masters of FMI 3 that know no arrays."""
    parts = {
        group.first: [
            replace(group, name=name, first=group.first + i, start=group.start[i : i + 1])
            for i, name in enumerate(group.names())
        ]
        for group in groups
    }
    for group in groups:
        for i, part in enumerate(parts[group.first]):
            part.state = parts[group.state.first][i] if group.state else None
    return [part for group in groups for part in parts[group.first]]


def scalar_line(fmi: int, *, arrays: bool) -> str:
    """What the binary of FMI 3 reads where its variables are scalars."""
    return "" if arrays or fmi == 2 else "scalars 1\n"


def group_line(group: Group) -> str:
    """A group as the binary reads it, plugin/fmu/unit_file.h."""
    starts = " ".join(repr(float(value)) for value in group.start)
    tunable = int(group.variability == "tunable")
    return (
        f"group {group.role} {group.index} {group.first} {group.count} {tunable} {group.key} "
        f"{starts}"
    )


def _inputs(body: Body, i: int, orientation: str, frame: str) -> list[Group]:
    head, of = quoted(body.name), f"of the frame of {body.name}"
    rest: dict[str, Any] = {"causality": "input", "index": i}
    turn = Group(
        "quaternion",
        f"{head}.quaternion",
        f"{of} in the world, w x y z; of any length but 0",
        start=list(body.quaternion),
        nominal=1.0,
        **rest,
    )
    if orientation == "matrix":
        w, x, y, z = body.quaternion
        turn = Group(
            "rotation",
            f"{head}.rotation",
            f"{of}: its axes in the world are the columns; row by row",
            start=[
                1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
                2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
            ],
            nominal=1.0,
            **rest,
        )  # fmt: skip
    return [
        Group(
            "position", f"{head}.position", f"origin {of} in the world", "m",
            start=list(body.position), **rest,
        ),
        turn,
        Group(
            "angular_velocity", f"{head}.angular_velocity", f"{of}, in the {frame} frame", "rad/s",
            start=_twist(body, frame)[:3], **rest,
        ),
        Group(
            "velocity", f"{head}.velocity", f"of the origin {of}, in the {frame} frame", "m/s",
            start=_twist(body, frame)[3:], **rest,
        ),
    ]  # fmt: skip


def _twist(body: Body, frame: str) -> list[float]:
    """Where the body starts to, in the frame of the inputs."""
    if frame == "world":
        return list(body.twist)
    import mujoco
    import numpy as np

    back, out = np.zeros(4), np.zeros(6)
    mujoco.mju_negQuat(back, np.array(body.quaternion))
    for half in (out[:3], out[3:]):
        part = np.array(body.twist[:3] if half is out[:3] else body.twist[3:])
        turned = np.zeros(3)
        mujoco.mju_rotVecQuat(turned, part, back)
        half[:] = turned
    return [float(number) for number in out]


def _partners(container: Container, i: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
    models = [m for m, model in enumerate(container.models) if i in (model.body_a, model.body_b)]
    sides = {s for m in models for s in (container.models[m].body_a, container.models[m].body_b)}
    return tuple(sorted(s for s in sides if container.bodies[s].is_free)), tuple(models)


def _wrench(container: Container, body: Body, i: int, frame: str) -> list[Group]:
    needs, models = _partners(container, i)
    head = quoted(body.name)
    where = f"in the {frame} frame" if body.is_free else "in the world"
    rest: dict[str, Any] = {"index": i, "needs": needs, "models": models}
    return [
        Group("force", f"{head}.force", f"contact force on {body.name}, {where}", "N",
              start=[0.0] * 3, nominal=10.0, **rest),
        Group("torque", f"{head}.torque",
              f"contact torque on {body.name} about the origin of its frame, {where}", "N m",
              start=[0.0] * 3, **rest),
    ]  # fmt: skip


def _sums(needs: tuple[int, ...], models: tuple[int, ...], kind: str) -> list[Group]:
    rest: dict[str, Any] = {"needs": needs, "models": models}
    whole: dict[str, Any] = {"variability": "discrete", "low": 0.0, **rest}
    channels = "by channel: normal, roll, slide, spin"
    lost = Group("dissipated", "dissipated_energy", f"{channels}; since the start", "J",
                 start=[0.0] * 4, nominal=1e-3)  # fmt: skip
    return [
        Group("volume", "volume", "interference volume of all sites", "m^3", low=0.0,
              nominal=1e-6, **rest),
        Group("depth", "depth", "the deepest of all sites", "m", low=0.0, nominal=1e-3, **rest),
        Group("sites", "site_count", "how many contact sites there are", **whole),
        Group("forgotten", "forgotten_sites", "sites without a slot: export with more", **whole),
        Group("touching", "touching", "whether bodies touch", variability="discrete", **rest),
        Group("elastic_energy", "elastic_energy", "stored in all sites", "J", low=0.0,
              nominal=1e-3, **rest),
        Group("power", "dissipated_power", channels, "W", start=[0.0] * 4,
              state=lost if kind != "cs" else None, **rest),
        lost,
    ]  # fmt: skip


def _site(container: Container, model: Model, m: int, slot: int, head: str) -> list[Group]:
    a = container.bodies[model.body_a].name
    needs = tuple(i for i in (model.body_a, model.body_b) if container.bodies[i].is_free)
    rest: dict[str, Any] = {"index": slot, "needs": needs, "models": (m,)}
    three: dict[str, Any] = {"start": [0.0] * 3, **rest}
    return [
        Group("site_active", f"{head}.active", "whether there is such a site",
              variability="discrete", **rest),
        Group("site_centroid", f"{head}.centroid", "of its volume, in the world", "m", **three),
        Group("site_normal", f"{head}.normal", f"on {a}, in the world", **three),
        Group("site_force", f"{head}.force", f"on {a} at the centroid, in the world", "N", **three),
        Group("site_torque", f"{head}.torque", f"on {a} about the centroid, in the world", "N m",
              **three),
        Group("site_second_moment", f"{head}.second_moment",
              "of the volume about its centroid: xx, yy, zz, xy, xz, yz", "m^5",
              start=[0.0] * 6, nominal=1e-10, **rest),
        Group("site_area", f"{head}.area", "of the patch", "m^2", low=0.0, nominal=1e-4, **rest),
    ]  # fmt: skip


def _states(container: Container, model: Model, m: int, slot: int, head: str) -> list[Group]:
    needs = tuple(i for i in (model.body_a, model.body_b) if container.bodies[i].is_free)
    states, rates = [], []
    for state in model.states:
        if state.name not in _INTEGRATED:
            continue
        nominal = _NOMINAL.get(state.name, 1e-6)
        group = Group("state", f"{head}.{state.name}", "of the bristles, in the world",
                      state.unit, "local", index=slot, start=[0.0] * state.count, key=state.name,
                      nominal=nominal)  # fmt: skip
        states.append(group)
        unit = {"m": "m/s", "-": "1/s", "N/m": "N/m s"}[state.unit]
        rates.append(Group("state_rate", f"der({group.name})", "its time derivative", unit,
                           "local", index=slot, start=[0.0] * state.count, key=state.name,
                           needs=needs, models=(m,), state=group))  # fmt: skip
    return states + rates


def _parameters(container: Container) -> list[Group]:
    groups = []
    for m, model in enumerate(container.models):
        head = "law" if len(container.models) == 1 else f"contact[{m + 1}].law"
        for parameter in model.parameters:
            if parameter.name not in ("share_of_a", "mass"):
                groups.append(_parameter(parameter, m, f"{head}.{parameter.name}"))
    return groups


def _parameter(parameter: Parameter, m: int, name: str) -> Group:
    low, high = limits(parameter.range)
    return Group(
        "parameter", name, f"of the law; {parameter.range}", parameter.unit, "parameter",
        "fixed" if parameter.name in FIXED else "tunable",
        m, start=list(parameter.values), key=parameter.name, low=low, high=high,
    )  # fmt: skip


def _step_parameters() -> list[Group]:
    rest: dict[str, Any] = {"causality": "parameter", "variability": "tunable"}
    return [
        Group("extrapolation", "extrapolation",
              "how bodies go on within a communication step: 0 they stay, 1 with their speed, "
              "2 with their acceleration between the last two points", low=0.0, high=2.0,
              start=[1.0], **rest),
        Group("internal_step", "internal_step",
              "longest step within a communication step; 0: one step", "s", low=0.0, **rest),
    ]  # fmt: skip
