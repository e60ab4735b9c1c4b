# SPDX-License-Identifier: Apache-2.0
"""What an identification file says, after every check: values that travel between processes."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from volcontact.study.file.settings import Input, StudyError

__all__ = [
    "Estimator",
    "Frame",
    "Measure",
    "Nuisance",
    "Parameter",
    "Settings",
    "Start",
    "StudyError",
    "Uncertainty",
    "Window",
]

# Numbers of a sample of each kind as measured, and of its error.
WIDTHS = {
    "position": (3, 3),
    "orientation": (4, 3),
    "velocity": (3, 3),
    "angular_velocity": (3, 3),
    "joint": (1, 1),
    "joint_velocity": (1, 1),
}


@dataclass(frozen=True)
class Parameter:
    """A number of the scene that is looked for.

    Attributes:
        name: in the results.
        targets: where it goes, as of studies; several are tied together.
        mode: `set`, `add` to what the scene says, or `scale` it.
        low, high: bounds.
        start: first guess; None takes the scene's own where that lies within the bounds.
        log: whether it is looked for on a logarithmic scale.
        prior: mean and standard deviation of what is known beforehand; on a logarithmic scale the
            deviation is relative. None: nothing.
        times: another parameter that it is a multiple of; empty: none.
    """

    name: str
    targets: tuple[str, ...]
    mode: str
    low: float
    high: float
    start: float | None
    log: bool
    prior: tuple[float, float] | None = None
    times: str = ""

    def as_input(self) -> Input:
        """The input of a study that goes to the same places."""
        return Input(self.name, "distribution", targets=self.targets, mode=self.mode)


@dataclass(frozen=True)
class Measure:
    """One measured quantity.

    Attributes:
        name: in results and messages.
        kind: `position`, `orientation`, `velocity`, `angular_velocity` of a body, `joint`,
            `joint_velocity`, or `sensor`.
        of: name of the body, joint or sensor.
        columns: of the measurements.
        scale: from the unit of the columns to SI.
        sigma: standard deviation of a sample [SI].
        weight: of the quantity; 0 is for starts of trials alone.
        frame: `world` or `body`, of velocities.
        order: `wxyz` or `xyzw`, of orientations.
        bias: standard deviation of an offset that lasts for a trial [SI]; 0: none.
    """

    name: str
    kind: str
    of: str
    columns: tuple[str, ...]
    scale: float
    sigma: float
    weight: float = 1.0
    frame: str = "world"
    order: str = "wxyz"
    bias: float = 0.0

    @property
    def width(self) -> int:
        """Numbers of the error of a sample."""
        return WIDTHS[self.kind][1] if self.kind in WIDTHS else len(self.columns)


@dataclass(frozen=True)
class Frame:
    """Where the frame of the measurements lies in the world."""

    pos: tuple[float, ...] = (0.0, 0.0, 0.0)
    quat: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Nuisance:
    """Numbers of each trial that are found beside the parameters: how well each is known before.

    Attributes:
        position, angle, velocity, spin: of the state at the start, of each moving joint [m], [rad],
            [m/s], [rad/s]; 0: exact.
        clock: of the time of all samples [s]; 0: exact.
    """

    position: float = 0.0
    angle: float = 0.0
    velocity: float = 0.0
    spin: float = 0.0
    clock: float = 0.0


@dataclass(frozen=True)
class Start:
    """Where trials start.

    Attributes:
        measured: whether the state comes from the measurements; else from the scene.
        samples: that velocities are taken from where none are measured.
        skip: samples left out at the beginning.
    """

    measured: bool = True
    samples: int = 5
    skip: int = 0


@dataclass(frozen=True)
class Window:
    """How much of each trial counts.

    Attributes:
        duration: from its start [s].
        impacts: it ends before the impact after this many; 0: none ends it.
        acceleration: jumps of the measured velocity above this are impacts [m/s^2].
        gap: impacts closer than this are one [s].
        segment: cut into pieces of this length, each started from the measured state: multiple
            shooting; 0: not [s].
    """

    duration: float = float("inf")
    impacts: int = 0
    acceleration: float = 50.0
    gap: float = 0.02
    segment: float = 0.0


@dataclass(frozen=True)
class Estimator:
    """How parameters are looked for.

    Attributes:
        method: `least_squares`, `cma` or `optuna`.
        starts: first guesses of least squares: the given one and points of the box.
        evaluations: at most, of a start.
        loss: `linear`, `soft_l1`, `huber`, `cauchy`, or `absolute`.
        loss_scale: errors above it count less [sigma].
        tolerance: of the parameters, as a part of their ranges.
        step: of differences, as a part of the range.
        population: of CMA-ES; 0 takes its own.
        spread: of the first CMA-ES population, as a part of the ranges.
    """

    method: str = "least_squares"
    starts: int = 3
    evaluations: int = 200
    seed: int = 0
    loss: str = "linear"
    loss_scale: float = 1.0
    tolerance: float = 1e-8
    step: float = 1e-5
    population: int = 0
    spread: float = 0.25


@dataclass(frozen=True)
class Uncertainty:
    """How the uncertainty is found.

    Attributes:
        level: of intervals.
        profile: parameters with a profile likelihood; least squares alone.
        points: of a profile, to each side.
        bootstrap: samples of the trials; 0: none.
        scale: whether the given sigmas are right up to one common factor only.
        mcmc: steps of a chain; 0: none.
        walkers: of its ensemble; 0: four times the unknowns, at least 32.
        burn: steps of it left out; None: a quarter.
    """

    level: float = 0.95
    profile: tuple[str, ...] = ()
    points: int = 4
    bootstrap: int = 0
    scale: bool = True
    mcmc: int = 0
    walkers: int = 0
    burn: int | None = None


@dataclass(frozen=True)
class Settings:
    """An identification, checked.

    Attributes:
        text: the file.
        folder: what its paths begin at.
        files: of measurements.
        trial: column that tells trials apart; empty: one trial a file.
        time: column of the time.
        time_scale: from its unit to seconds.
        fit, judge: trials to fit to and to judge on, by their labels; None: all, or none.
    """

    name: str
    text: str
    folder: Path
    scene: Path
    contact: str
    timestep: float | None
    files: tuple[Path, ...]
    trial: str
    time: str
    time_scale: float
    measures: tuple[Measure, ...]
    parameters: tuple[Parameter, ...]
    fit: tuple[str, ...] | None = None
    judge: tuple[str, ...] | None = None
    frame: Frame = Frame()
    start: Start = Start()
    window: Window = Window()
    nuisance: Nuisance = Nuisance()
    estimator: Estimator = Estimator()
    uncertainty: Uncertainty = Uncertainty()
    material: dict[str, Any] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)
