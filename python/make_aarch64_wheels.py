# SPDX-License-Identifier: Apache-2.0
"""Builds the wheels for 64-bit ARM, on another machine, and tries them there in emulation.

`./run wheels --machine=aarch64` runs it. Compilers are GCC's for that machine. The wheel of each
CPython is installed by that machine's own pip, for a user of a system that has neither compiler nor
network; then a box is dropped, and the program writes and runs a scene. qemu does what the
processor would.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
import zipfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
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
# No Debian has these for that machine; a package for programs in Java has them whole.
JAVA_PACKAGE = "org.bytedeco:cpython:{}:jar:linux-arm64"
JAVA_VERSIONS = {"cp310": "3.10.8-1.5.8", "cp312": "3.12.1-1.5.10"}
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
    parser.add_argument("--releases", nargs="+", required=True, help="of MuJoCo, in the wheels")
    parser.add_argument("--pythons", nargs="+", type=Path, required=True)
    arguments = parser.parse_args()
    out: Path = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)

    source = native.make_source(out)
    os.environ["CCACHE_BASEDIR"] = str(source)  # a compiler cache finds what other trees have
    os.environ["CMAKE_TOOLCHAIN_FILE"] = str(TOOLCHAIN)
    os.environ["_PYTHON_HOST_PLATFORM"] = f"linux-{MACHINE}"
    # uv remembers what a Python says of its machine, and would tell every later command.
    os.environ["UV_CACHE_DIR"] = str(out / "uv-cache")
    os.environ["LD_LIBRARY_PATH"] = str(LIBRARIES)  # where auditwheel finds what it adds
    raw = []
    for python in arguments.pythons:
        tag = native.tag_of(python)
        suffix = f".cpython-{tag.removeprefix('cp')}-{MACHINE}-linux-gnu.so"
        os.environ["SETUPTOOLS_EXT_SUFFIX"] = suffix
        raw.append(native.make_raw_wheel(out, source, python))
    package = native.unpacked(raw[0], out / "unpacked") / "volcontact"
    adaptors = [
        native.make_adaptor(out, package / "source", release, arguments.pythons, MACHINE)
        for release in arguments.releases
    ]
    shutil.rmtree(out / "dist", ignore_errors=True)
    wheels = [native.complete(wheel, adaptors, out) for wheel in raw]
    releases = [native.release_of(adaptor) for adaptor in adaptors]
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        tried = pool.map(lambda wheel: try_wheel(out, wheel, releases), wheels)
        native.write_table([row for rows in tried for row in rows])
    return 0


@dataclass(frozen=True)
class System:
    """A small system of that machine: its root here, and there its Python and what that needs."""

    root: Path
    python: str = "/usr/bin/python3"
    libraries: str = ""

    def prints(self, *arguments: object) -> str:
        """What Python prints on that machine."""
        emulated = ["/usr/sbin/chroot", self.root, f"/usr/bin/{EMULATOR.name}", self.python]
        surroundings = {"HOME": "/home", "PATH": "/usr/local/bin:/usr/bin:/bin", "LANG": "C.UTF-8"}
        surroundings["MUJOCO_GL"] = "disabled"  # what draws starts programs, which are not emulated
        surroundings["PIP_BREAK_SYSTEM_PACKAGES"] = "1"
        surroundings["LD_LIBRARY_PATH"] = self.libraries
        return native.run(*emulated, *arguments, env=surroundings)


def make_system(out: Path, tag: str) -> System:
    """A system with that Python and pip, and no compiler."""
    suite = SUITES.get(tag, SUITES["cp311"])
    root = out / f"system-{tag}"
    if not (root / "usr" / "bin" / "python3").exists():
        native.say(f"Debian {suite} for {MACHINE}")
        shutil.rmtree(root, ignore_errors=True)
        native.run(*BOOTSTRAP, f"--include={','.join(SYSTEM)}", suite, root)
        # What packages leave to their installers: links of newer systems, and the one file of
        # certificates, which pip reads even without a network.
        for folder in ("bin", "lib"):
            if not (root / folder).exists():
                (root / folder).symlink_to(f"usr/{folder}")
        authorities = sorted((root / "usr/share/ca-certificates").rglob("*.crt"))
        bundle = root / "etc/ssl/certs/ca-certificates.crt"
        bundle.parent.mkdir(parents=True, exist_ok=True)
        bundle.write_text("".join(path.read_text() for path in authorities))
    shutil.copy(EMULATOR, root / "usr" / "bin")
    return System(root) if tag in SUITES else add_python(out, root, tag)


def add_python(out: Path, root: Path, tag: str) -> System:
    """The same with a CPython that its Debian does not have, and the pip that this brings."""
    name = f"python3.{tag.removeprefix('cp3')}"
    home = Path("/opt") / name
    place = root / home.relative_to("/")
    system = System(root, python=str(home / "bin" / name), libraries=str(home))
    library = place / "lib" / name
    if (library / "site-packages" / "pip").exists():
        return system
    shutil.rmtree(place, ignore_errors=True)
    artifact = JAVA_PACKAGE.format(JAVA_VERSIONS[tag])
    native.say(artifact)
    folder = out / f"java-{tag}"
    shutil.rmtree(folder, ignore_errors=True)
    copy = ["mvn", "-q", "-B", "dependency:copy", f"-Dartifact={artifact}"]
    native.run(*copy, f"-DoutputDirectory={folder}")
    (archive,) = folder.glob("*.jar")
    with zipfile.ZipFile(archive) as file:
        file.extractall(folder)
    shutil.copytree(folder / "org" / "bytedeco" / "cpython" / "linux-arm64", place)
    for program in (place / "bin").iterdir():
        program.chmod(0o755)
    # As `ensurepip` does, but for its second process, which would not be emulated.
    (pip,) = (library / "ensurepip" / "_bundled").glob("pip-*.whl")
    there = f"/{pip.relative_to(root)}"
    system.prints(f"{there}/pip", "install", "-q", "--no-index", there)
    return system


def try_wheel(out: Path, wheel: Path, releases: list[str]) -> list[dict[str, object]]:
    """Installs the wheel beside each of these MuJoCos that its Python can have, and uses it."""
    tag = wheel.name.split("-")[2]
    system = make_system(out, tag)
    rows = []
    for release in releases:
        index = make_index(out, wheel, release)
        if index is None:
            continue
        shutil.rmtree(system.root / "home", ignore_errors=True)  # where the last was installed
        shutil.copytree(index, system.root / "home" / "index")
        begin = time.monotonic()
        # What is imported is compiled to byte code then; all of NumPy would take minutes.
        install = ["-m", "pip", "install", "-q", "--user", "--no-index", "--no-compile"]
        install += ["--no-warn-script-location", "--find-links", "/home/index"]
        install += [f"mujoco=={release}", "volcontact"]
        system.prints(*install)
        installed = time.monotonic() - begin
        depth = json.loads(system.prints("-c", native.DROP))["depth"]
        if abs(depth - native.DEPTH) > native.DEPTH_TOLERANCE:
            sys.exit(f"make_aarch64_wheels: {tag}, MuJoCo {release}: depth {depth} m")
        program = ["-m", "volcontact.cli"]
        system.prints(*program, "doctor")
        system.prints(*program, "new", "/home/scene")
        system.prints(*program, "run", "/home/scene/scene.xml", "--duration", "0.1")
        row = {
            "python": tag,
            "mujoco": release,
            "adaptor": "in the wheel",
            "platform": wheel.stem.split("-", 4)[4],
            "depth_um": round(1e6 * depth, 3),
        }
        rows.append(row)
        said = ", ".join(str(value) for value in row.values())
        native.say(f"{said}; installed in {installed:.0f} s, in emulation")
    return rows


def make_index(out: Path, wheel: Path, release: str) -> Path | None:
    """A folder of the wheel and of all that it needs beside a MuJoCo; None where there is none."""
    tag = wheel.name.split("-")[2]
    index = out / f"index-{tag}"
    shutil.rmtree(index, ignore_errors=True)
    fetch = [sys.executable, "-m", "pip", "download", "-q", "--only-binary", ":all:"]
    fetch += ["--python-version", tag.removeprefix("cp"), "--dest", str(index)]
    fetch += [f"--platform={platform}" for platform in PLATFORMS]
    fetch += [f"mujoco=={release}", str(wheel)]
    found = subprocess.run(fetch, stderr=subprocess.DEVNULL, check=False)
    return index if found.returncode == 0 else None


if __name__ == "__main__":
    sys.exit(main())
