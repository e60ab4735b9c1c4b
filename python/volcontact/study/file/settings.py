# SPDX-License-Identifier: Apache-2.0
"""What a study file says, after every check: plain values that travel between processes."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ADAPTIVE = ("optimise", "importance")  # methods whose trials follow from earlier ones


class StudyError(ValueError):
    """A study that cannot be run: one line that says what, where, and how to put it right."""


@dataclass(frozen=True)
class Input:
    """One thing that varies.

    Attributes:
        name: of its column; a rotation has four, `NAME_w` to `NAME_z`.
        kind: `distribution`, `choice`, `table` or `rotation`.
        distribution: name in scipy.stats, or `uniform` and `norm` with arguments of ours.
        arguments: of the distribution.
        choices: values of a choice, numbers or words.
        weights: of the choices; add up to 1.
        table: CSV file that rows are drawn from, the same row for all inputs of a file.
        column: of the table.
        points: of a grid.
        targets: where the value goes; none is for functions of the user.
        mode: `set`, `add` to what the scene says, or `scale` it.
    """

    name: str
    kind: str
    distribution: str = ""
    arguments: tuple[tuple[str, float], ...] = ()
    choices: tuple[Any, ...] = ()
    weights: tuple[float, ...] = ()
    table: Path | None = None
    column: str = ""
    points: int = 0
    targets: tuple[str, ...] = ()
    mode: str = "set"

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of its columns."""
        if self.kind == "rotation":
            return tuple(f"{self.name}_{axis}" for axis in "wxyz")
        return (self.name,)

    @property
    def is_text(self) -> bool:
        """Whether its values are words."""
        return any(isinstance(choice, str) for choice in self.choices)


@dataclass(frozen=True)
class Correlation:
    """Inputs whose normal scores are correlated: a Gaussian copula."""

    inputs: tuple[str, ...]
    matrix: tuple[tuple[float, ...], ...]


@dataclass(frozen=True)
class Sample:
    """How inputs are sampled: the method, how many trials, the seed, and what else it takes."""

    method: str = "monte_carlo"
    trials: int = 100
    seed: int = 0
    options: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Condition:
    """A quantity from `low` to `high`, both included."""

    quantity: str
    low: float
    high: float


@dataclass(frozen=True)
class End:
    """When a trial ends.

    Attributes:
        duration: simulated; then it has timed out [s].
        watch: time between two calls of the user's word on success, and of recorded states; 0 calls
            it after every step. All else is watched after every step [s].
        force_limit, torque_limit: of the watched wrench [N], [N m].
        force, torque: three quantities each, whose norms are watched; none: of the contact sites.
        jammed: conditions that hold together for `jam_time` [s].
    """

    duration: float = 1.0
    watch: float = 0.0
    force_limit: float = float("inf")
    torque_limit: float = float("inf")
    force: tuple[str, ...] = ()
    torque: tuple[str, ...] = ()
    jammed: tuple[Condition, ...] = ()
    jam_time: float = 0.2


@dataclass(frozen=True)
class Record:
    """What is kept of each trial, and of which trials everything is kept."""

    places: tuple[tuple[str, tuple[str, ...]], ...] = ()
    final: tuple[tuple[str, str], ...] = ()
    peak: tuple[tuple[str, str], ...] = ()
    columns: tuple[str, ...] = ()
    functions: tuple[str, ...] = ()
    trajectories: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Settings:
    """A study, checked.

    Attributes:
        text: the study file.
        folder: what its paths begin at.
        pose: body and keyframe or place that the pose error is measured from.
    """

    name: str
    text: str
    folder: Path
    inputs: tuple[Input, ...]
    correlations: tuple[Correlation, ...]
    sample: Sample
    end: End
    record: Record
    success: tuple[Condition, ...] = ()
    hold: float = 0.0
    success_function: str = ""
    scene: Path | None = None
    function: str = ""
    python: Path | None = None
    prepare: str = ""
    contact: str = "volumetric"
    timestep: float | None = None
    keyframe: str | None = None
    material: dict[str, Any] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)
    pose: dict[str, Any] = field(default_factory=dict)
    control: dict[str, Any] = field(default_factory=dict)
    time_limit: float = 60.0

    @property
    def columns(self) -> list[str]:
        """Names of all columns that inputs fill."""
        return [column for each in self.inputs for column in each.columns]
