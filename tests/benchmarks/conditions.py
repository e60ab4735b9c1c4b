# SPDX-License-Identifier: Apache-2.0
"""What the benchmarks were run on: processor, versions, date. Called by ./run benchmark."""

from __future__ import annotations

import argparse
import csv
import datetime
import importlib.metadata
import os
import platform
import subprocess
from collections.abc import Iterator
from pathlib import Path

import volcontact_timing

ROOT = Path(__file__).parents[2]
PACKAGES = ("volcontact", "mujoco", "drake", "manifold3d", "numpy")


def processor() -> str:
    """Its name, with family and model where the name is a general one."""
    path = Path("/proc/cpuinfo")
    if not path.exists():
        return platform.machine()
    lines = (line.partition(":") for line in path.read_text(encoding="utf-8").splitlines())
    about: dict[str, str] = {}
    for key, _, value in lines:
        about.setdefault(key.strip(), value.strip())
    family = f"family {about['cpu family']}, model {about['model']}" if "model" in about else ""
    return f"{about.get('model name', platform.machine())} ({family})"


def first_line(*command: str) -> str:
    """Of what a program prints; nothing when it fails."""
    try:
        ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return (ran.stdout.splitlines() or [""])[0]


def conditions() -> Iterator[tuple[str, str]]:
    """Name and value. Nothing tells the machine's name or place."""
    yield "date", datetime.date.today().isoformat()
    yield "processor", processor()
    yield "processors", str(os.cpu_count())
    yield "instruction set used", volcontact_timing.simd_path()
    busy = os.getloadavg()[0]
    yield "runnable processes before the run", f"{busy:.1f}"
    yield "system", f"{platform.system()} {platform.machine()}"
    yield "compiler", first_line(os.environ.get("CXX", "c++"), "--version")
    yield "Python", platform.python_version()
    for name in PACKAGES:
        try:
            version = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            version = "not installed"
        yield name, version
    yield "commit", first_line("git", "rev-parse", "--short=10", "HEAD")


def main() -> None:
    """Writes them as CSV."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True, help="CSV file to write")
    with parser.parse_args().out.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("name", "value"))
        writer.writerows(conditions())


if __name__ == "__main__":
    main()
