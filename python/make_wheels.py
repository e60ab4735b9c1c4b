# SPDX-License-Identifier: Apache-2.0
"""Builds the wheels of volcontact and tries each in fresh environments. `./run wheels` runs it.

One wheel a Python. Adaptors know no Python: each is compiled once and is in every wheel. What a
wheel was tried with, a box dropped on a floor under each MuJoCo that its Python can have, is a
table: tests/benchmarks/results/wheels.csv.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
import tarfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TABLE = ROOT / "tests" / "benchmarks" / "results" / "wheels.csv"
LIBRARY = "libvolcontact_mujoco-{}.so"

# A cube of 1 kg and 0.2 m at rest sinks into the floor by m g / (k_v A) = 24.525 um.
DROP = """
import json, mujoco, volcontact as vc
from volcontact import _adaptor
model = vc.load('''<mujoco><option timestep="0.001"/><worldbody>
  <geom name="floor" type="plane" size="1 1 1"/>
  <body name="cube" pos="0 0 0.11"><freejoint/>
    <geom name="cube" type="box" size="0.1 0.1 0.1" mass="1"/></body></worldbody>
  <custom><numeric name="volcontact/material/wood/stiffness" data="2e7"/>
    <numeric name="volcontact/material/wood/damping" data="1"/>
    <tuple name="volcontact/material/wood"><element objtype="geom" objname="floor"/>
      <element objtype="geom" objname="cube"/></tuple></custom></mujoco>''')
data = mujoco.MjData(model)
with vc.attach(model) as contact:
    for _ in range(5000):
        mujoco.mj_step(model, data)
    (site,) = contact.sites(data)
print(json.dumps({"depth": site["depth"], "adaptor": str(_adaptor.adaptor().path)}))
"""
DEPTH = 24.525e-6  # [m]
DEPTH_TOLERANCE = 1e-9  # [m]; five seconds after the drop


def main() -> int:
    """Builds and tries; 0 when every wheel works with every MuJoCo it can meet."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "wheels")
    parser.add_argument("--releases", nargs="+", required=True, help="of MuJoCo, in the wheels")
    parser.add_argument("--other", help="a release that is compiled at first use; none: not tried")
    parser.add_argument("--untried", action="store_true", help="build alone, and keep no record")
    parser.add_argument("--pythons", nargs="+", type=Path, required=True)
    arguments = parser.parse_args()
    out: Path = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)

    # The same for every Python, whatever that was compiled with; so all share a compiler cache.
    for name, program in (("CC", "cc"), ("CXX", "c++")):
        os.environ.setdefault(name, shutil.which(program) or program)
    source = make_source(out)
    os.environ["CCACHE_BASEDIR"] = str(source)  # a compiler cache finds what other trees have
    raw = [make_raw_wheel(out, source, python) for python in arguments.pythons]
    package = unpacked(raw[0], out / "unpacked") / "volcontact"
    adaptors = [
        make_adaptor(out, package / "source", release, arguments.pythons)
        for release in arguments.releases
    ]
    shutil.rmtree(out / "dist", ignore_errors=True)
    wheels = [complete(wheel, adaptors, out) for wheel in raw]

    if arguments.untried:
        return 0
    rows = []
    for python, wheel in zip(arguments.pythons, wheels, strict=True):
        for adaptor in adaptors:
            rows += try_wheel(out, python, wheel, release_of(adaptor))
    if arguments.other:
        compiler = {"PATH": os.environ["PATH"]}
        rows += try_wheel(out, arguments.pythons[0], wheels[0], arguments.other, compiler)
    write_table(rows)
    return 0


def run(*command: object, **options: object) -> str:
    """Runs a program and returns what it printed; ends everything when it fails."""
    words = [str(word) for word in command]
    done = subprocess.run(words, text=True, stdout=subprocess.PIPE, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"make_wheels: failed: {' '.join(words)}\n{done.stdout}")
    return done.stdout


def say(text: str) -> None:
    """Where it is."""
    print(f"make_wheels: {text}", flush=True)


def make_source(out: Path) -> Path:
    """The source distribution, unpacked: a wheel is made of what a stranger gets."""
    say("source distribution")
    shutil.rmtree(out / "sdist", ignore_errors=True)
    run("uv", "build", "-q", "--sdist", "--out-dir", out / "sdist", ROOT)
    (archive,) = (out / "sdist").glob("*.tar.gz")
    source = out / "source"
    shutil.rmtree(source, ignore_errors=True)
    with tarfile.open(archive) as tar:
        tar.extractall(out / "sdist", filter="data")
    (out / "sdist" / archive.name.removesuffix(".tar.gz")).rename(source)
    return source


def make_raw_wheel(out: Path, source: Path, python: Path) -> Path:
    """The wheel of one Python, without an adaptor."""
    tag = tag_of(python)
    say(f"wheel for {tag}")
    folder = out / "raw" / tag
    shutil.rmtree(folder, ignore_errors=True)
    command = ["uv", "build", "-q", "--wheel", "--python", python, "--out-dir", folder, source]
    command += ["-C", f"build-dir={source / 'build' / tag}"]
    for define in ("VOLCONTACT_MUJOCO=OFF", "VOLCONTACT_WARNINGS_AS_ERRORS=ON"):
        command += ["-C", f"cmake.define.{define}"]
    run(*command)
    (wheel,) = folder.glob("*.whl")
    return wheel


def tag_of(python: Path) -> str:
    """As cp313."""
    return run(python, "-c", "import sys; print('cp%d%d' % sys.version_info[:2])").strip()


def unpacked(wheel: Path, folder: Path) -> Path:
    """The folder that the wheel is unpacked into."""
    shutil.rmtree(folder, ignore_errors=True)
    run(sys.executable, "-m", "wheel", "unpack", "--dest", folder, wheel)
    (content,) = folder.iterdir()
    return content


def make_adaptor(
    out: Path, source: Path, release: str, pythons: list[Path], machine: str = ""
) -> Path:
    """The adaptor of a release, from the sources in a wheel and the package of that MuJoCo.

    The compiler of another `machine` is what the environment says.
    """
    folder, version = mujoco_package(out, release, pythons, machine)
    tree = out / "adaptors" / version
    say(f"adaptor for MuJoCo {version}")
    configure = ["cmake", "-G", "Ninja", "-S", source / "adaptor", "-B", tree]
    # The path to libmujoco is the one that an installation has, not the one of this build.
    configure += [f"-DMUJOCO_DIR={folder}", "-DCMAKE_BUILD_WITH_INSTALL_RPATH=ON"]
    run(*configure)
    run("cmake", "--build", tree, "--target", "volcontact_mujoco")
    library = tree / "plugin" / LIBRARY.format(version)
    run(f"{machine}-linux-gnu-strip" if machine else "strip", "--strip-unneeded", library)
    return library


def mujoco_package(
    out: Path, release: str, pythons: list[Path], machine: str = ""
) -> tuple[Path, str]:
    """Package folder and version of a release, for the first Python that can have it."""
    requirement = "mujoco" if release == "newest" else f"mujoco=={release}"
    folder = out / "mujoco" / release
    for python in pythons:
        shutil.rmtree(folder, ignore_errors=True)
        command = ["uv", "pip", "install", "-q", "--only-binary", "mujoco", "--target", folder]
        command += ["--python", python, requirement]
        command += ["--python-platform", f"{machine}-manylinux_2_36"] if machine else []
        if subprocess.run([*map(str, command)], stderr=subprocess.DEVNULL).returncode == 0:
            (library,) = (folder / "mujoco").glob("libmujoco.so.*.*.*")
            return folder / "mujoco", library.name.removeprefix("libmujoco.so.")
    sys.exit(f"make_wheels: no Python here can have {requirement}")


def release_of(adaptor: Path) -> str:
    """The release in the name of a library."""
    before, after = LIBRARY.split("{}")
    return adaptor.name.removeprefix(before).removesuffix(after)


def complete(wheel: Path, adaptors: list[Path], out: Path) -> Path:
    """Adds the adaptors and what auditwheel adds, and returns the wheel to give away."""
    content = unpacked(wheel, out / "unpacked")
    for adaptor in adaptors:
        shutil.copy(adaptor, content / "volcontact")
    packed = out / "packed" / wheel.parent.name
    shutil.rmtree(packed, ignore_errors=True)
    packed.mkdir(parents=True)
    run(sys.executable, "-m", "wheel", "pack", "--dest-dir", packed, content)
    before = set((out / "dist").glob("*.whl"))
    # MuJoCo's own library is of the package `mujoco`, always.
    repair = ["auditwheel", "repair", "--exclude", "libmujoco.so.*", "-w", out / "dist"]
    run(*repair, packed / wheel.name, stderr=subprocess.STDOUT)
    (made,) = set((out / "dist").glob("*.whl")) - before
    say(f"{made.name}, {made.stat().st_size / 1e6:.1f} MB")
    return made


def try_wheel(
    out: Path, python: Path, wheel: Path, release: str, compiler: dict[str, str] | None = None
) -> Iterator[dict[str, object]]:
    """Installs the wheel beside a MuJoCo and drops a box; no row where no such MuJoCo is had.

    Without `compiler` there is none to be found: an adaptor not in the wheel is a failure.
    """
    venv = out / "venv"
    shutil.rmtree(venv, ignore_errors=True)
    run("uv", "venv", "-q", "--python", python, venv)
    program = venv / "bin" / "python"
    pip = ["uv", "pip", "install", "-q", "--only-binary", "mujoco", "--python", program]
    found = subprocess.run(
        [*map(str, pip), f"mujoco=={release}"], stderr=subprocess.DEVNULL, check=False
    )
    if found.returncode != 0:
        return
    run(*pip, f"mujoco=={release}", wheel)
    home = out / "home"
    shutil.rmtree(home, ignore_errors=True)
    home.mkdir()
    # Neither PYTHONPATH nor a cache of this machine, and another folder than the checkout's.
    surroundings = {"HOME": str(home), "PATH": str(venv / "bin")} | (compiler or {})
    options = {"cwd": home, "env": surroundings}
    found_there = json.loads(run(program, "-c", DROP, **options))
    if abs(found_there["depth"] - DEPTH) > DEPTH_TOLERANCE:
        sys.exit(f"make_wheels: MuJoCo {release} on {python}: depth {found_there['depth']} m")
    run(venv / "bin" / "volcontact", "doctor", **options)
    run(venv / "bin" / "volcontact", "new", "scene", **options)
    run(venv / "bin" / "volcontact", "run", "scene/scene.xml", "--duration", "0.1", **options)
    inside = Path(found_there["adaptor"]).is_relative_to(venv)
    row = {
        "python": tag_of(python),
        "mujoco": release,
        "adaptor": "in the wheel" if inside else "compiled at first use",
        "platform": wheel.stem.split("-", 4)[4],
        "depth_um": round(1e6 * found_there["depth"], 3),
    }
    say(", ".join(str(value) for value in row.values()))
    yield row


def write_table(rows: list[dict[str, object]]) -> None:
    """Puts them into the record in place of those of the same wheels; others stay."""
    made = {_wheel_of(row) for row in rows}
    with TABLE.open(encoding="utf-8") as file:
        kept = [row for row in csv.DictReader(file) if _wheel_of(row) not in made]
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(sorted([*kept, *rows], key=_wheel_of, reverse=True))


def _wheel_of(row: dict[str, object]) -> tuple[str, int]:
    """Machine and CPython of a row; as ("x86_64", 13)."""
    _, _, _, machine = str(row["platform"]).split("_", 3)  # after manylinux_2_35
    return machine, int(str(row["python"]).removeprefix("cp3"))


if __name__ == "__main__":
    sys.exit(main())
