# SPDX-License-Identifier: Apache-2.0
"""What the validation cases share: figures with their expected values, and runs of a scene.

Each file `test_<case>.py` has a function `measure()` that runs its case and returns a `Case`. The
test asks every figure of it to be within its tolerance; `docs/make_validation.py` writes the same
cases into docs/validation.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path

import mujoco
import numpy as np

import volcontact as vc
from volcontact._mujoco_views import dense

MODELS = Path(__file__).parents[2] / "mjcf_models"
GRAVITY = 9.81  # [m/s^2]
CLOSURE = 1e-6  # of the energy turned over: what every run must account for


@dataclass(frozen=True)
class Figure:
    """A number with what it should be.

    Attributes:
        name: what it is.
        unit: SI, "-" for none.
        expected: from a closed form, an independent integration or a published value.
        tolerance: relative to `expected`, or absolute where that is 0.
        measured: under volumetric contact.
        native: the same under MuJoCo's own contact, or why there is no such number.
    """

    name: str
    unit: str
    expected: float
    tolerance: float
    measured: float
    native: float | str

    @property
    def error(self) -> float:
        """Relative, or absolute where the expected value is 0."""
        scale = abs(self.expected) if self.expected else 1.0
        return abs(self.measured - self.expected) / scale

    @property
    def is_met(self) -> bool:
        """Whether the figure is within its tolerance."""
        return self.error <= self.tolerance


@dataclass(frozen=True)
class Bounds:
    """A number that must lie in an interval, ends included; `native` as of a Figure."""

    name: str
    unit: str
    low: float
    high: float
    measured: float
    native: float | str

    @property
    def is_met(self) -> bool:
        """Whether the number is in its interval."""
        return self.low <= self.measured <= self.high


@dataclass(frozen=True)
class Curve:
    """A line of a plot; `style` is matplotlib's."""

    label: str
    x: np.ndarray
    y: np.ndarray
    style: str = "-"


@dataclass(frozen=True)
class Plot:
    """A plot of the page; `marks` are named places on the x axis."""

    name: str
    x_label: str
    y_label: str
    curves: tuple[Curve, ...]
    marks: tuple[tuple[str, float], ...] = ()


@dataclass
class Case:
    """One case: its figures, its plots, and how well its energy was accounted for."""

    title: str
    text: str
    figures: list[Figure | Bounds] = field(default_factory=list)
    plots: list[Plot] = field(default_factory=list)
    closures: list[float] = field(default_factory=list)

    def check(self) -> None:
        """Fails with all figures that are not met."""
        missed = [str(figure) for figure in self.figures if not figure.is_met]
        worst = max(self.closures, default=0.0)
        if worst > CLOSURE:
            missed.append(f"energy closes to {worst:.2g} only")
        assert not missed, "\n".join(missed)


@dataclass
class Run:
    """A run: what was watched, and the balance of energy.

    Attributes:
        rows: what `watch` returned, one row a sample.
        data: the state at the end.
        closure: largest |kinetic + potential + elastic + dissipated - start| over the energy turned
            over: the largest sum of kinetic, elastic and dissipated energy and fall.
        dissipated: by channel (normal, roll, slide, spin) [J]; zeros under native contact.
        unaccounted: the same difference at every sample, over the energy turned over.
    """

    rows: np.ndarray
    data: mujoco.MjData
    closure: float
    dissipated: np.ndarray
    unaccounted: np.ndarray


# Why MuJoCo's own contact has no such number.
NO_STIFFNESS = "no stiffness per volume"
NO_FIELD = "force depends on more than the pose"
NO_ACCOUNT = "no account of energy by channel"
ONE_FRICTION = "one kind of friction"

Watch = Callable[[mujoco.MjModel, mujoco.MjData], tuple[float, ...]]
Setup = Callable[[mujoco.MjModel, mujoco.MjData], None]
Outside = Callable[[mujoco.MjData], tuple[float, float]]


def load(scene: str, **numbers: float) -> mujoco.MjModel:
    """A scene of mjcf_models, with keys `volcontact/...` set to other numbers.

    Args:
        scene: path below mjcf_models, or MJCF text.
        numbers: by the part of the key after `volcontact/`, with `__` for `/`. A choice is set by
            1 and unset by 0.
    """
    model = vc.load(scene if scene.lstrip().startswith("<") else str(MODELS / scene))
    for key, value in numbers.items():
        name = "volcontact/" + key.replace("__", "/")
        index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_NUMERIC, name)
        assert index >= 0, f"{scene} has no numeric {name}"
        model.numeric_data[model.numeric_adr[index]] = value
    return model


def start(model: mujoco.MjModel) -> mujoco.MjData:
    """Data at the scene's keyframe `start`, where it has one."""
    data = mujoco.MjData(model)
    key = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_KEY, "start")
    if key >= 0:
        mujoco.mj_resetDataKeyframe(model, data, key)
    return data


@contextmanager
def contact_of(model: mujoco.MjModel, *, native: bool) -> Iterator[vc.Contact | None]:
    """Volumetric contact, or none at all for a run under MuJoCo's own."""
    with nullcontext() if native else vc.attach(model) as contact:
        yield contact


def simulate(
    model: mujoco.MjModel,
    duration: float,
    watch: Watch,
    *,
    every: int = 1,
    setup: Setup | None = None,
    drive: Setup | None = None,
    native: bool = False,
    outside: Outside | None = None,
) -> Run:
    """Runs a scene and watches it, and its energy, every so many steps.

    Args:
        model: the scene; its energy flag is set.
        duration: [s].
        watch: returns the numbers of a row.
        every: steps from sample to sample.
        setup: changes the state before the first step.
        drive: called before every `every` steps.
        native: under MuJoCo's own contact, without volcontact.
        outside: the work done on the scene from outside since the start [J], and the kinetic energy
            of bodies that count as outside [J].
    """
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    data = start(model)
    if setup is not None:
        setup(model, data)
    rows, sums, turned_over, potentials = [], [], [], []
    dissipated = np.zeros(4)
    with contact_of(model, native=native) as contact:
        for step in range(0, round(duration / model.opt.timestep) + 1, every):
            if step:
                if drive is not None:
                    drive(model, data)
                mujoco.mj_step(model, data, every)
            mujoco.mj_forward(model, data)
            potential, kinetic = (float(e) for e in dense(data.energy))
            stored = 0.0
            if contact is not None:
                energy = contact.energy(data)
                dissipated = np.array(energy.by_channel)
                stored = energy.elastic + energy.dissipated
            work, apart = outside(data) if outside is not None else (0.0, 0.0)
            kinetic -= apart
            rows.append((data.time, *watch(model, data)))
            sums.append(potential + kinetic + stored - work)
            turned_over.append(kinetic + stored)
            potentials.append(potential)
    scale = max(turned_over) + max(potentials) - min(potentials)
    unaccounted = np.abs(np.array(sums) - sums[0]) / (scale if scale > 0.0 else 1.0)
    closure = math.nan if native else float(unaccounted.max())
    return Run(np.array(rows), data, closure, dissipated, unaccounted)


def depth_of_ball(weight: float, radius: float, stiffness: float) -> float:
    """Static depth of a ball in a half-space [m]: the root of k pi h^2 (R - h/3) = weight."""
    low, high = 0.0, radius
    for _ in range(200):
        middle = 0.5 * (low + high)
        force = stiffness * math.pi * middle**2 * (radius - middle / 3.0)
        low, high = (middle, high) if force < weight else (low, middle)
    return 0.5 * (low + high)


def crossings(time: np.ndarray, value: np.ndarray) -> np.ndarray:
    """Times at which `value` changes sign, by linear interpolation."""
    i = np.nonzero(np.sign(value[1:]) != np.sign(value[:-1]))[0]
    return time[i] + (time[i + 1] - time[i]) * value[i] / (value[i] - value[i + 1])


def first(rows: np.ndarray, condition: np.ndarray) -> float:
    """Time of the first row for which the condition holds [s]; nan when there is none."""
    return float(rows[np.argmax(condition), 0]) if condition.any() else math.nan
