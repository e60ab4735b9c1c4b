# SPDX-License-Identifier: Apache-2.0
"""Runs many episodes of `volcontact/ORUInsertion-v0` and records how each ended.

    ./run python tests/benchmarks/field/oru_insertion.py

A thousand vectorised episodes of the scripted policy, a hundred under native contact, and some of
random actions. Any warning, of Python, Gymnasium or MuJoCo, ends the run. It goes on where it was
stopped: remove the table to start afresh.
"""

from __future__ import annotations

import argparse
import csv
import statistics
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from volcontact.gym import ENV_ID, ForceGuided
from volcontact.gym.oru_insertion import CONTROL_PERIOD

OUT = Path(__file__).parent / "results" / "oru_insertion.csv"
KINDS = (  # contact, policy, seeds
    ("volumetric", "scripted", 1000),
    ("native", "scripted", 100),
    ("volumetric", "random", 20),
)
Policy = Callable[[dict[str, np.ndarray]], np.ndarray]


@dataclass(frozen=True)
class Episode:
    """How one episode ended.

    Attributes:
        contact, policy, seed: what was run.
        end: `seated`, `overload` or `time`.
        steps: of the environment.
        force, torque: largest at the grasp [N], [N m].
    """

    contact: str
    policy: str
    seed: int
    end: str
    steps: int
    force: float
    torque: float


def policy_of(name: str, count: int) -> Policy:
    """A policy for so many environments; the random one knows nothing."""
    if name == "scripted":
        return ForceGuided()
    generator = np.random.default_rng(0)
    return lambda _: generator.uniform(-1.0, 1.0, (count, 6)).astype(np.float32)


def run(contact: str, policy: str, seeds: Sequence[int], count: int) -> Iterator[Episode]:
    """Episodes of these seeds, `count` environments at a time, each as it ends."""
    waiting, left = list(seeds), len(seeds)
    act = policy_of(policy, count)
    envs = gymnasium.make_vec(
        ENV_ID,
        num_envs=count,
        contact=contact,
        vector_kwargs={"autoreset_mode": gymnasium.vector.AutoresetMode.DISABLED},
    )

    def next_seed() -> int | None:
        return waiting.pop(0) if waiting else None

    running = [next_seed() for _ in range(count)]
    observation, _ = envs.reset(seed=running)
    steps = np.zeros(count, int)
    while left:
        observation, _, terminated, truncated, info = envs.step(act(observation))
        steps += 1
        ended = terminated | truncated
        for i in np.flatnonzero(ended):
            seed = running[i]
            if seed is not None:  # others fill the vector until the last one ends
                left -= 1
                yield episode(contact, policy, seed, int(steps[i]), info, i)
            running[i], steps[i] = next_seed(), 0
        if ended.any():
            observation, _ = envs.reset(seed=running, options={"reset_mask": ended})
    envs.close()


def episode(
    contact: str, policy: str, seed: int, steps: int, info: dict[str, Any], i: int
) -> Episode:
    """What the info of environment `i` says of its end."""
    end = "seated" if info["is_success"][i] else "overload" if info["overload"][i] else "time"
    force, torque = (round(float(info[name][i]), 2) for name in ("peak_force", "peak_torque"))
    return Episode(contact, policy, seed, end, steps, force, torque)


def read(path: Path = OUT) -> list[Episode]:
    """The recorded episodes."""
    kinds = {
        field.name: {"int": int, "float": float}.get(field.type, str) for field in fields(Episode)
    }
    with path.open() as file:
        return [Episode(**{k: kinds[k](v) for k, v in row.items()}) for row in csv.DictReader(file)]


def table(episodes: Sequence[Episode]) -> list[str]:
    """The lines of the table in docs/environment.md."""
    lines = [
        "| contact | policy | episodes | seated | overload | out of time | median time | "
        "largest force | largest torque |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for contact, policy, _ in KINDS:
        found = [e for e in episodes if (e.contact, e.policy) == (contact, policy)]
        ends = [sum(e.end == end for e in found) for end in ("seated", "overload", "time")]
        time = CONTROL_PERIOD * statistics.median(e.steps for e in found)
        force, torque = max(e.force for e in found), max(e.torque for e in found)
        cells = (contact, policy, len(found), *ends)
        cells += (f"{time:.1f} s", f"{force:.1f} N", f"{torque:.1f} N m")
        lines.append(f"| {' | '.join(str(cell) for cell in cells)} |")
    return lines


def main() -> None:
    """Runs what is not recorded yet."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, default=OUT, help="where the table goes")
    parser.add_argument("--envs", type=int, default=8, help="at a time")
    arguments = parser.parse_args()
    warnings.simplefilter("error")
    recorded = read(arguments.out) if arguments.out.exists() else []
    known = {(e.contact, e.policy, e.seed) for e in recorded}
    with arguments.out.open("a", newline="") as file:
        writer = csv.DictWriter(file, [f.name for f in fields(Episode)], lineterminator="\n")
        if not recorded:
            writer.writeheader()
        for contact, policy, episodes in KINDS:
            seeds = [seed for seed in range(episodes) if (contact, policy, seed) not in known]
            for ended in run(contact, policy, seeds, arguments.envs):
                writer.writerow(asdict(ended))
                file.flush()
    order = [kind[:2] for kind in KINDS]
    rows = sorted(read(arguments.out), key=lambda e: (order.index((e.contact, e.policy)), e.seed))
    with arguments.out.open("w", newline="") as file:
        writer = csv.DictWriter(file, [f.name for f in fields(Episode)], lineterminator="\n")
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)
    print("\n".join(table(rows)))


if __name__ == "__main__":
    main()
