# SPDX-License-Identifier: Apache-2.0
"""What a run of a scene leaves.

Row i of a recording belongs to one instant: the state, the energies and the contact sites are all
those of `time[i]`, at the beginning of step i. The last row is the state after the last step.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from volcontact.given_keys import Value
from volcontact.running.audit import Audit, worst_step
from volcontact.running.signals import Signal
from volcontact.surface import SiteSurface

ContactKind = Literal["volumetric", "native"]

CHANNELS = ("normal", "roll", "slide", "spin")

SITE = np.dtype(
    [
        ("geom_a", "i4"),
        ("geom_b", "i4"),
        ("position", "f8", (3,)),  # centroid of the patch, or MuJoCo's contact point [m], world
        ("normal", "f8", (3,)),  # on a, from b to a [-]
        ("force", "f8", (3,)),  # total force on a [N], world
        ("torque", "f8", (3,)),  # on a, about the position [N m], world
        ("area", "f8"),  # projected patch [m^2]; 0 for a native contact, which is a point
        ("depth", "f8"),  # penetration along the normal [m]
        ("volume", "f8"),  # interference volume [m^3]; 0 for a native contact
    ]
)
# A site among those of a whole run: `row` is its instant.
SITE_IN_RUN = np.dtype([("row", "i8"), *((name, SITE[name]) for name in SITE.names or ())])


@dataclass(frozen=True)
class Frame:
    """One instant to draw: the full position state and the contact sites.

    Attributes:
        row: index into the arrays of the recording.
        time: [s].
        sites: structured array of `SITE`, one row a contact site.
        surfaces: shape of each site; none under native contact.
    """

    row: int
    time: float
    sites: np.ndarray
    surfaces: tuple[SiteSurface, ...] = ()


@dataclass(frozen=True)
class Origin:
    """What a run was made from, so that it can be shown again.

    Attributes:
        scene: full path of the file; None where it was MJCF text or a model.
        material: that was given besides.
        options: likewise.
        keyframe: name of that it started at; None is that called `start`, if there is one.
    """

    scene: str | None = None
    material: Mapping[str, Value] = field(default_factory=dict)
    options: Mapping[str, Value] = field(default_factory=dict)
    keyframe: str | None = None


@dataclass(frozen=True)
class Recording:
    """What one run left. Arrays have one row per instant, n = steps + 1.

    Attributes:
        contact: "volumetric" or "native".
        timestep: [s].
        bodies: names of the bodies followed: those asked for, and those with a free joint, else all
            that have joints.
        time: [s], shape (n,).
        qpos: shape (n, nq).
        qvel: shape (n, nv).
        position: of the body frames [m], world, shape (n, bodies, 3).
        quaternion: of the body frames (w, x, y, z), shape (n, bodies, 4).
        speed: of the body frames' origins [m/s], shape (n, bodies).
        spin: angular speed of the bodies [rad/s], shape (n, bodies).
        kinetic: [J], shape (n,).
        potential: gravity and springs of the model, as MuJoCo counts them [J], shape (n,).
        elastic: stored in the contact [J], shape (n,); 0 under native contact, which has no such
            quantity.
        dissipated: by the contact since the start [J], shape (n, 4), columns `CHANNELS`.
        work: done on the scene by the contact forces since the start [J], shape (n,).
        numerical: what of -work is neither stored nor dissipated but made by the finite step [J],
            shape (n,).
        driven: work of mocap bodies on the contacts since the start [J], shape (n,).
        outside_work: done since the start by what is neither volumetric contact nor a potential
            [J], shape (n, 4), columns `volcontact.running.outside_work.CHANNELS`: actuators,
            dampers, limits with friction of joints and equalities, contacts of MuJoCo's own.
        made: by the contacts in the step that ended there [J], shape (n,); `audit()` has the worst.
        contact_force: sum over the sites of the magnitude of their force [N], shape (n,).
        largest_site_force: [N], shape (n,).
        site_count: shape (n,).
        penetration: deepest site [m], shape (n,).
        step_microseconds: wall time of each mj_step alone [us], shape (n - 1,).
        warnings: MuJoCo's warning counters that are not 0, by name.
        stopped: why the run ended early, or None.
        dropped: evaluations in which volcontact left out a force that was no finite number.
        frames: the instants to draw.
        sites: all contact sites: structured array of `SITE_IN_RUN`.
        geoms: names of the geoms by id, for the sites.
        sensors: magnitude of each sensor of the scene by name, shape (n,); NAME_x, NAME_y and
            NAME_z are the parts of NAME.
        signals: every number of sensors, actuators and named joints, signed, by name.
        wrench_on: by name of each body that can move and has geoms: the sum of the contact forces
            on these [N] and their torque about the origin of the body frame [N m], world, shape
            (n, 6).
        notes: what was left as it is and hardly meant, as keyframes and actuators not used.
        description: what volcontact understood of the scene; {} under native contact.
        weight: of all that moves [N]; 0 without gravity.
        origin: what the run was made from.
    """

    contact: ContactKind
    timestep: float
    bodies: tuple[str, ...]
    time: np.ndarray
    qpos: np.ndarray
    qvel: np.ndarray
    position: np.ndarray
    quaternion: np.ndarray
    speed: np.ndarray
    spin: np.ndarray
    kinetic: np.ndarray
    potential: np.ndarray
    elastic: np.ndarray
    dissipated: np.ndarray
    work: np.ndarray
    numerical: np.ndarray
    driven: np.ndarray
    made: np.ndarray
    contact_force: np.ndarray
    largest_site_force: np.ndarray
    site_count: np.ndarray
    penetration: np.ndarray
    step_microseconds: np.ndarray
    warnings: dict[str, int]
    stopped: str | None
    dropped: int
    frames: tuple[Frame, ...]
    sites: np.ndarray
    geoms: tuple[str, ...]
    sensors: dict[str, np.ndarray]
    description: dict[str, Any]
    weight: float
    outside_work: np.ndarray
    signals: dict[str, Signal]
    wrench_on: dict[str, np.ndarray]
    notes: tuple[str, ...] = ()
    origin: Origin = Origin()

    @property
    def steps(self) -> int:
        """Number of steps done."""
        return len(self.time) - 1

    @property
    def height(self) -> np.ndarray:
        """World z of the body frames [m], shape (n, bodies)."""
        heights: np.ndarray = self.position[:, :, 2]
        return heights

    @property
    def energy(self) -> np.ndarray:
        """Mechanical energy: kinetic, potential and stored in the contact [J], shape (n,)."""
        energy: np.ndarray = self.kinetic + self.potential + self.elastic
        return energy

    def audit(self) -> Audit:
        """The step in which contact made most energy."""
        return worst_step(
            self.time,
            self.made,
            self.kinetic + self.elastic,
            lambda row: self.sites[self.sites["row"] == row],
            lambda geom: self.geoms[geom],
        )

    def unbalance(self) -> np.ndarray:
        """What changed the energy of the scene and is in no account [J], shape (n,).

        Kinetic and potential energy, less what contacts, actuators, dampers, limits and mocap
        bodies did, less its value at the start: the error of the step, and what MuJoCo has no
        account of (drag before MuJoCo 3, forces that others apply).
        """
        account = self.energy + self.dissipated.sum(axis=1) + self.numerical - self.driven
        account = account - self.outside_work.sum(axis=1)
        change: np.ndarray = account - account[0]
        return change

    @property
    def microseconds_per_step(self) -> float:
        """Median wall time of one mj_step [us]; the median ignores what else the machine did."""
        return float(np.median(self.step_microseconds)) if self.steps else 0.0
