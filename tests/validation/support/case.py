# SPDX-License-Identifier: Apache-2.0
"""What the validation cases share: figures with their expected values, and runs of a scene.

Each file `test_<case>.py` has a function `measure()` that runs its case and returns a `Case`. The
test asks every figure of it to be within its tolerance; `docs/generate/make_validation.py`
writes the same cases into docs/validation.md.
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

MODELS = Path(__file__).parents[3] / "mjcf_models"
GRAVITY = 9.81  # [m/s^2]
# MuJoCo 2 combines the stages of its Runge-Kutta method so that bodies that turn are integrated to
# second order, with any force.
RUNGE_KUTTA_IS_FOURTH = int(mujoco.__version__.split(".")[0]) >= 3
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
    """One case: its figures, its plots, and how well its energy was accounted for.

    Attributes:
        title: of the section.
        text: below it.
        figures: measured, each with what it should be.
        plots: below the figures.
        closures: of the balance of energy, `Run.closure`, of every run.
        works: of that with the work of the contact, `Run.work_closure`.
    """

    title: str
    text: str
    figures: list[Figure | Bounds] = field(default_factory=list)
    plots: list[Plot] = field(default_factory=list)
    closures: list[float] = field(default_factory=list)
    works: list[float] = field(default_factory=list)

    def account(self, *runs: Run) -> None:
        """Takes note of how well the energy of runs is accounted for."""
        self.closures += [run.closure for run in runs]
        self.works += [run.work_closure for run in runs]

    def check(self) -> None:
        """Fails with all figures that are not met."""
        missed = [str(figure) for figure in self.figures if not figure.is_met]
        for name, closures in (("all energy", self.closures), ("work of the contact", self.works)):
            worst = max(closures, default=0.0)
            if not worst <= CLOSURE:
                missed.append(f"{name} closes to {worst:.2g} only")
        assert not missed, "\n".join(missed)


@dataclass
class Run:
    """A run: what was watched, and the balance of energy.

    Attributes:
        rows: what `watch` returned, one row a sample.
        data: the state at the end.
        closure: largest |kinetic + potential + elastic + dissipated - start| over the energy turned
            over: the largest sum of kinetic, elastic and dissipated energy and fall.
        work_closure: the same of kinetic + potential - work of the contact forces.
        dissipated: by channel (normal, roll, slide, spin) [J]; zeros under native contact.
        elastic: stored in the contacts at every sample [J].
        unaccounted: the same difference at every sample, over the energy turned over.
    """

    rows: np.ndarray
    data: mujoco.MjData
    closure: float
    work_closure: float
    dissipated: np.ndarray
    elastic: np.ndarray
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
    model = vc.load(_with_options(scene))
    model.body_mass[:] *= 1.0 + _variation.mass
    for key, value in numbers.items():
        name = "volcontact/" + key.replace("__", "/")
        index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_NUMERIC, name)
        assert index >= 0, f"{scene} has no numeric {name}"
        model.numeric_data[model.numeric_adr[index]] = value
    return model


@dataclass
class _Variation:
    options: dict[str, float] = field(default_factory=dict)
    mass: float = 0.0


_variation = _Variation()


@contextmanager
def varied(*, mass: float = 0.0, **options: float) -> Iterator[None]:
    """Varies all scenes that are loaded in its block.

    Args:
        mass: share by which all masses are larger.
        options: keys after `volcontact/option/`, with `__` for `/`.
    """
    _variation.options, _variation.mass = options, mass
    try:
        yield
    finally:
        _variation.options, _variation.mass = {}, 0.0


def _with_options(scene: str) -> str:
    """The scene's path or text as `vc.load` takes it."""
    is_text = scene.lstrip().startswith("<")
    if not _variation.options:
        return scene if is_text else str(MODELS / scene)
    text = scene if is_text else (MODELS / scene).read_text(encoding="utf-8")
    keys = "".join(
        f'<numeric name="volcontact/option/{key.replace("__", "/")}" data="{value!r}"/>'
        for key, value in _variation.options.items()
    )
    return text[text.index("<mujoco") :].replace("<custom>", "<custom>" + keys)


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
        drive: called before every `every` steps; where it turns gravity, the potential energy that
            the scene gains by that is work from outside.
        native: under MuJoCo's own contact, without volcontact.
        outside: the work done on the scene from outside since the start [J], and the kinetic energy
            of bodies that count as outside [J].
    """
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    data = start(model)
    if setup is not None:
        setup(model, data)
    rows, sums, mechanical, turned_over = [], [], [], []
    potentials, elastics = [], []
    dissipated, driven = np.zeros(4), 0.0
    with contact_of(model, native=native) as contact:
        for step in range(0, round(duration / model.opt.timestep) + 1, every):
            if step:
                if drive is not None:
                    drive(model, data)
                    mujoco.mj_energyPos(model, data)
                    driven += float(data.energy[0]) - potentials[-1]
                mujoco.mj_step(model, data, every)
            mujoco.mj_forward(model, data)
            potential, kinetic = (float(e) for e in dense(data.energy))
            stored, worked, elastic = 0.0, 0.0, 0.0
            if contact is not None:
                energy = contact.energy(data)
                dissipated = np.array(energy.by_channel)
                stored, worked = energy.elastic + energy.dissipated, energy.work
                elastic = energy.elastic
            work, apart = outside(data) if outside is not None else (0.0, 0.0)
            work += driven
            kinetic -= apart
            rows.append((data.time, *watch(model, data)))
            sums.append(potential + kinetic + stored - work)
            mechanical.append(potential + kinetic - worked - work)
            turned_over.append(kinetic + stored)
            potentials.append(potential)
            elastics.append(elastic)
    scale = max(turned_over) + max(potentials) - min(potentials)
    scale = scale if scale > 0.0 else 1.0
    unaccounted = np.abs(np.array(sums) - sums[0]) / scale
    work_closure = float(np.abs(np.array(mechanical) - mechanical[0]).max()) / scale
    closures = (math.nan, math.nan) if native else (float(unaccounted.max()), work_closure)
    return Run(np.array(rows), data, *closures, dissipated, np.array(elastics), unaccounted)


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
