# SPDX-License-Identifier: Apache-2.0
"""Steps a scene and watches every step: peaks, limits, and conditions that end it.

The watching is native: it costs a small part of a step, whatever is watched.
"""

from __future__ import annotations

import ctypes
import enum
import math
from collections.abc import Sequence

import mujoco
import numpy as np

from volcontact._adaptor import Number, Range, RawWatch, adaptor

__all__ = ["OUTCOMES", "Kind", "Number", "Range", "Reading", "Watch", "number", "read"]

OUTCOMES = ("", "success", "jammed", "force_limit", "torque_limit", "diverged")


class Kind(enum.IntEnum):
    """Kinds of numbers, `VOLCONTACT_...` of plugin/adaptor/volcontact_mujoco.h."""

    TIME = 0
    QPOS = 1
    QVEL = 2
    ACT = 3
    CTRL = 4
    SENSOR = 5
    POSITION = 6
    DISTANCE = 7
    ANGLE = 8
    SPEED = 9
    SPIN = 10
    SITES = 11
    SITE_FORCE = 12


def number(kind: Kind, index: int = 0, place: Sequence[float] | np.ndarray = ()) -> Number:
    """A number of a scene.

    Args:
        kind: what it is.
        index: element of the array of `MjData`, or the body.
        place: of `DISTANCE` a point, shape (3,) [m]; of `ANGLE` a unit quaternion, shape (4,).
    """
    return Number(int(kind), index, (ctypes.c_double * 4)(*(float(x) for x in place)))


class Reading:
    """Reads some numbers of a scene, as often as asked.

    Args:
        numbers: which; those of contact sites are as `watch` felt them, NaN without.
        watch: of the scene.
    """

    def __init__(self, numbers: Sequence[Number], watch: Watch | None = None) -> None:
        self._numbers = (Number * len(numbers))(*numbers)
        self._values = np.empty(len(numbers))
        self._into = len(numbers), self._values.ctypes.data
        self._felt = ctypes.byref(watch.felt) if watch else None
        self._read = adaptor().function("read_numbers")

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData) -> list[float]:
        """The numbers as they are now."""
        self._read(model._address, data._address, self._felt, self._numbers, *self._into)
        values: list[float] = self._values.tolist()
        return values


def read(
    model: mujoco.MjModel, data: mujoco.MjData, numbers: Sequence[Number], watch: Watch | None
) -> np.ndarray:
    """Numbers of a scene as it is now, shape (n,); those of contact sites as `watch` felt them."""
    return np.array(Reading(numbers, watch)(model, data))


class Watch:
    """What ends a run of steps, and what was felt in it.

    Args:
        success: conditions; while all hold, the run is good. None: that ends nothing.
        hold: how long it must be good, then it ends [s].
        judged_outside: being good ends nothing: somebody else has a say.
        jammed: conditions that hold together for `jam_time` [s]; none: it never jams.
        force: three numbers whose norm is watched as the force [N]; none: the sum of the lengths
            of the forces of all contact sites.
        torque: likewise [N m]; of the sites about each one's centroid.
        force_limit, torque_limit: beyond them the run ends.
        peaks: numbers of which the largest is kept.
        places: which geoms are of which place, shape (m, ngeom).

    Attributes:
        felt: what was felt so far: `force`, `torque` [N, N m], `site_force`, `sites` and the geoms
            `geom_a` and `geom_b` of the largest site in the last step; `peak_force`,
            `peak_torque`, `peak_site_force`, `most_sites`, `first_touch` [s], `is_good`.
        peaks: largest of each number of `peaks`, shape (n,).
        place_peaks: largest sum of the contact forces at each place [N], shape (m,).
    """

    def __init__(
        self,
        *,
        success: Sequence[Range] = (),
        hold: float = 0.0,
        judged_outside: bool = False,
        jammed: Sequence[Range] = (),
        jam_time: float = 0.0,
        force: Sequence[Number] = (),
        torque: Sequence[Number] = (),
        force_limit: float = math.inf,
        torque_limit: float = math.inf,
        peaks: Sequence[Number] = (),
        places: np.ndarray | None = None,
    ) -> None:
        members = np.zeros((0, 0), np.uint8) if places is None else places.astype(np.uint8)
        self.peaks = np.full(len(peaks), -np.inf)
        self.place_peaks = np.zeros(len(members))
        # The structure keeps no references of its own to what it points at.
        self._members, self._place_forces = np.ascontiguousarray(members), np.zeros(len(members))
        self._success = (Range * len(success))(*success)
        self._jammed = (Range * len(jammed))(*jammed)
        self._numbers = (Number * len(peaks))(*peaks)
        self.felt = RawWatch(
            success=self._success,
            jammed=self._jammed,
            peak_numbers=self._numbers,
            place_members=self._members.ctypes.data,
            peaks=self.peaks.ctypes.data,
            place_forces=self._place_forces.ctypes.data,
            place_peaks=self.place_peaks.ctypes.data,
            success_count=len(success),
            jammed_count=len(jammed),
            peak_count=len(peaks),
            place_count=len(members),
            has_force=bool(force),
            has_torque=bool(torque),
            force_limit=force_limit,
            torque_limit=torque_limit,
            hold=hold,
            jam_time=jam_time,
            judged_outside=judged_outside,
        )
        for i, each in enumerate(force):
            self.felt.force_axes[i] = each
        for i, each in enumerate(torque):
            self.felt.torque_axes[i] = each
        self.felt.geom_a = self.felt.geom_b = -1
        self.felt.first_touch = math.nan
        self.felt.good_since = self.felt.jammed_since = math.inf
        self._fresh = bytes(self.felt)
        self._step = adaptor().function("step_watched")

    def restart(self) -> None:
        """Forgets what was felt: for another run."""
        ctypes.memmove(ctypes.byref(self.felt), self._fresh, len(self._fresh))
        self.peaks.fill(-np.inf)
        self.place_peaks.fill(0.0)

    @property
    def outcome(self) -> str:
        """Why the run ended, one of `OUTCOMES`; empty while it goes on."""
        return OUTCOMES[self.felt.outcome]

    def step(self, model: mujoco.MjModel, data: mujoco.MjData, steps: int) -> int:
        """Steps at most so many times, less when the run ends; returns how many it did.

        The model may be attached or not. Contact is watched at the state each step began with,
        everything else at the state it led to.

        Raises:
            MemoryError: there was too little memory for a step, which is not made.
        """
        return self._step(model._address, data._address, steps, ctypes.byref(self.felt))
