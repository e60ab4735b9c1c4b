# SPDX-License-Identifier: Apache-2.0
"""What `pip install` of the source distribution costs, in a fresh environment.

./run python tests/benchmarks/pip_install.py

pip compiles everything, without a compiler cache. The package must then drop a box to the depth of
the closed form. The table has the processor time of pip and of all programs that it starts, and
what pip downloads.
"""

from __future__ import annotations

import csv
import json
import os
import platform
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

import make_wheels  # noqa: E402

TABLE = ROOT / "tests" / "benchmarks" / "results" / "pip_install.csv"
ALLOWED = 240.0  # [s] of processor time
# What would change the result: caches, settings of ./run, and packages that are not the new ones'.
DROPPED = ("CMAKE_C", "CCACHE_", "PYTHON", "VIRTUAL_ENV", "PIP_FIND_LINKS", "CC", "CXX")


def main() -> None:
    """Installs, tries, and writes the record."""
    surroundings = {
        name: value for name, value in os.environ.items() if not name.startswith(DROPPED)
    }
    surroundings["CCACHE_DISABLE"] = "1"
    # CMake and Ninja of ./run are not what a stranger has.
    places = surroundings["PATH"].split(os.pathsep)
    surroundings["PATH"] = os.pathsep.join(
        place for place in places if not Path(place).is_relative_to(ROOT)
    )
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run("uv", "build", "-q", "--sdist", "--out-dir", folder, ROOT)
        (archive,) = folder.glob("*.tar.gz")
        run("uv", "venv", "-q", "--seed", "--python", sys.executable, folder / "venv")
        python = folder / "venv" / "bin" / "python"
        load, before, begin = os.getloadavg()[0], processor_time(), time.perf_counter()
        install = [python, "-m", "pip", "install", "-v", "--no-cache-dir", archive]
        said = run(*install, cwd=folder, env=surroundings)
        row = {
            "python": platform.python_version(),
            "processor_s": f"{processor_time() - before:.0f}",
            "wall_s": f"{time.perf_counter() - begin:.0f}",
            "allowed_processor_s": f"{ALLOWED:.0f}",
            "load_before": f"{load:.1f}",
            "downloads": " ".join(downloads(said)),
        }
        depth = json.loads(run(python, "-c", make_wheels.DROP, cwd=folder))["depth"]
        if abs(depth - make_wheels.DEPTH) > make_wheels.DEPTH_TOLERANCE:
            sys.exit(f"pip_install: the box rests {depth} m deep")
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(row), lineterminator="\n")
        writer.writeheader()
        writer.writerow(row)
    print(TABLE.read_text(encoding="utf-8"), end="")


def run(*command: object, cwd: Path | None = None, env: dict[str, str] | None = None) -> str:
    """What a program prints, errors as well; ends everything when it fails."""
    words = [str(word) for word in command]
    options = {"text": True, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    done = subprocess.run(words, cwd=cwd, env=env, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"pip_install: failed: {' '.join(words)}\n{done.stdout[-4000:]}")
    return done.stdout


def downloads(said: str) -> list[str]:
    """The packages, by name, that pip fetched to build and to run."""
    files = re.findall(r"Downloading (?:\S*/)?([A-Za-z0-9_.]+)-\d\S*\.(?:whl|tar\.gz)", said)
    return sorted({name.lower().replace("_", "-") for name in files})


def processor_time() -> float:
    """Of the programs that have ended, and of those that they waited for [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()
