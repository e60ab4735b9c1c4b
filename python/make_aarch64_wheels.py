# SPDX-License-Identifier: Apache-2.0
"""Builds the wheels for 64-bit ARM, on another machine, and tries them there in emulation.

`./run wheels --machine=aarch64` runs it. Compilers are GCC's for that machine. The wheel of each
CPython that some Debian has is installed by that machine's own pip, into a system that has neither
compiler nor network; then a box is dropped, and the program writes and runs a scene. qemu does what
the processor would.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import make_wheels as native

ROOT = Path(__file__).resolve().parents[1]
MACHINE = "aarch64"
TOOLCHAIN = ROOT / "python" / "toolchains" / "aarch64-linux-gnu.cmake"
LIBRARIES = Path("/usr/aarch64-linux-gnu/lib")  # of the cross compiler
EMULATOR = Path("/usr/bin/qemu-aarch64-static")
# Of the machine that the wheel is tried on; NumPy and MuJoCo want the library of C++.
SYSTEM = ("python3", "python3-pip", "libstdc++6", "coreutils", "bash")
SUITES = {"cp311": "bookworm", "cp313": "trixie", "cp314": "forky"}  # by the CPython that they have
# What the oldest one's pip takes: of this C library and of older ones.
PLATFORMS = [f"manylinux_2_{minor}_{MACHINE}" for minor in range(17, 37)]
PLATFORMS.append(f"manylinux2014_{MACHINE}")
# A mirror that lags behind a suite that moves has lists that are signed, and out of date.
LAG = "--aptopt=Acquire::Check-Valid-Until false;"
BOOTSTRAP = ("mmdebstrap", "--mode=root", "--variant=extract", "--architectures=arm64", LAG)


def main() -> int:
    """Builds and tries; 0 when the wheels work."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "wheels-aarch64")
    parser.add_argument("--eigen", type=Path, help="folder of Eigen, so that builds share a cache")
    parser.add_argument("--releases", nargs="+", required=True, help="of MuJoCo, in the wheels")
    parser.add_argument("--pythons", nargs="+", type=Path, required=True)
    arguments = parser.parse_args()
    out: Path = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)

    source = native.make_source(out)
    eigen = native.near(source, arguments.eigen)
    os.environ["CMAKE_TOOLCHAIN_FILE"] = str(TOOLCHAIN)
    os.environ["_PYTHON_HOST_PLATFORM"] = f"linux-{MACHINE}"
    os.environ["LD_LIBRARY_PATH"] = str(LIBRARIES)  # where auditwheel finds what it adds
    raw = []
    for python in arguments.pythons:
        tag = native.tag_of(python)
        suffix = f".cpython-{tag.removeprefix('cp')}-{MACHINE}-linux-gnu.so"
        os.environ["SETUPTOOLS_EXT_SUFFIX"] = suffix
        raw.append(native.make_raw_wheel(out, source, python, eigen))
    package = native.unpacked(raw[0], out / "unpacked") / "volcontact"
    adaptors = [
        native.make_adaptor(
            out, package / "source", release, arguments.pythons, eigen, machine=MACHINE
        )
        for release in arguments.releases
    ]
    shutil.rmtree(out / "dist", ignore_errors=True)
    wheels = [native.complete(wheel, adaptors, out) for wheel in raw]
    rows = []
    for wheel in wheels:
        tag = wheel.name.split("-")[2]
        if tag not in SUITES:
            native.say(f"no system for {tag}: built, not tried")
            continue
        system = make_system(out, SUITES[tag])
        rows += [try_wheel(out, system, wheel, native.release_of(each)) for each in adaptors]
    if not rows:
        sys.exit(f"make_aarch64_wheels: none of {', '.join(SUITES)} is among --pythons: none tried")
    native.write_table([row for row in rows if row is not None])
    return 0


def make_system(out: Path, suite: str) -> Path:
    """The root of a small system of that machine, with Python and pip and no compiler."""
    system = out / f"system-{suite}"
    if not (system / "usr" / "bin" / "python3").exists():
        native.say(f"Debian {suite} for {MACHINE}")
        shutil.rmtree(system, ignore_errors=True)
        native.run(*BOOTSTRAP, f"--include={','.join(SYSTEM)}", suite, system)
        for folder in ("bin", "lib"):  # which packages of newer systems leave to the installer
            if not (system / folder).exists():
                (system / folder).symlink_to(f"usr/{folder}")
    shutil.copy(EMULATOR, system / "usr" / "bin")
    return system


def try_wheel(out: Path, system: Path, wheel: Path, release: str) -> dict[str, object] | None:
    """Installs the wheel beside a MuJoCo and uses it; None where no such MuJoCo is had."""
    tag = wheel.name.split("-")[2]
    index = out / "index"
    shutil.rmtree(index, ignore_errors=True)
    shutil.rmtree(system / "home", ignore_errors=True)
    fetch = [sys.executable, "-m", "pip", "download", "-q", "--only-binary", ":all:"]
    fetch += ["--python-version", tag.removeprefix("cp"), "--dest", str(index)]
    fetch += [f"--platform={platform}" for platform in PLATFORMS]
    fetch += [f"mujoco=={release}", str(wheel)]
    found = subprocess.run(fetch, stderr=subprocess.DEVNULL, check=False)
    if found.returncode != 0:
        return None
    shutil.copytree(index, system / "home" / "index")
    begin = time.monotonic()
    install = ["-m", "pip", "install", "-q", "--break-system-packages", "--no-index"]
    install += ["--find-links", "/home/index", f"mujoco=={release}", "volcontact"]
    there(system, *install)
    native.say(f"installed in {time.monotonic() - begin:.0f} s, in emulation")
    depth = json.loads(there(system, "-c", native.DROP))
    if abs(depth["depth"] - native.DEPTH) > native.DEPTH_TOLERANCE:
        sys.exit(f"make_aarch64_wheels: MuJoCo {release}: depth {depth['depth']} m")
    program = ["-m", "volcontact.cli"]
    there(system, *program, "doctor")
    there(system, *program, "new", "/home/scene")
    there(system, *program, "run", "/home/scene/scene.xml", "--duration", "0.1")
    row = {
        "python": tag,
        "mujoco": release,
        "adaptor": "in the wheel",
        "platform": wheel.stem.split("-", 4)[4],
        "depth_um": round(1e6 * depth["depth"], 3),
    }
    native.say(", ".join(str(value) for value in row.values()))
    return row


def there(system: Path, *arguments: object) -> str:
    """What Python prints on that machine."""
    python = ["/usr/sbin/chroot", system, f"/usr/bin/{EMULATOR.name}", "/usr/bin/python3"]
    surroundings = {"HOME": "/home", "PATH": "/usr/local/bin:/usr/bin:/bin", "LANG": "C.UTF-8"}
    surroundings["MUJOCO_GL"] = "disabled"  # what draws starts programs, which are not emulated
    return native.run(*python, *arguments, env=surroundings)


if __name__ == "__main__":
    sys.exit(main())
