# SPDX-License-Identifier: Apache-2.0
"""What `pip install` of the source distribution costs, in a fresh environment.

./run python tests/benchmarks/pip_install.py

Everything is compiled, without a compiler cache, and what is installed must then drop a box to the
depth of the closed form. Processor time is that of pip and of all that it starts.
"""

from __future__ import annotations

import csv
import json
import os
import platform
import resource
import shutil
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


def main() -> None:
    """Installs, tries, and writes the record."""
    for name in ("CMAKE_C_COMPILER_LAUNCHER", "CMAKE_CXX_COMPILER_LAUNCHER"):
        os.environ.pop(name, None)
    os.environ["CCACHE_DISABLE"] = "1"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run("uv", "build", "-q", "--sdist", "--out-dir", folder, ROOT)
        (archive,) = folder.glob("*.tar.gz")
        run("uv", "venv", "-q", "--seed", "--python", sys.executable, folder / "venv")
        python = folder / "venv" / "bin" / "python"
        before, begin = processor_time(), time.perf_counter()
        run(python, "-m", "pip", "install", "-q", "--no-cache-dir", archive)
        row = {
            "python": platform.python_version(),
            "processor_s": f"{processor_time() - before:.0f}",
            "wall_s": f"{time.perf_counter() - begin:.0f}",
            "allowed_processor_s": f"{ALLOWED:.0f}",
        }
        said = run(python, "-c", make_wheels.DROP, cwd=folder)
        depth = json.loads(said)["depth"]
        if abs(depth - make_wheels.DEPTH) > make_wheels.DEPTH_TOLERANCE:
            sys.exit(f"pip_install: the box rests {depth} m deep")
        shutil.rmtree(folder / "venv")
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(row), lineterminator="\n")
        writer.writeheader()
        writer.writerow(row)
    print(TABLE.read_text(encoding="utf-8"), end="")


def run(*command: object, cwd: Path | None = None) -> str:
    """What a program prints; ends everything when it fails."""
    words = [str(word) for word in command]
    return subprocess.run(words, cwd=cwd, check=True, text=True, stdout=subprocess.PIPE).stdout


def processor_time() -> float:
    """Of the programs that have ended, and of those that they waited for [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()
