# SPDX-License-Identifier: Apache-2.0
"""The adaptor compiled at first use, from the package's own sources."""

import json
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import mujoco
import pytest

from volcontact import _adaptor, _adaptor_build

TOOLS = Path(__file__).parents[3] / ".venv" / "tools"
SOURCE = _adaptor._library_folders()[0] / "source"
NAME = f"libvolcontact_mujoco-{mujoco.__version__}.so"

PROGRAM = """
import mujoco, numpy, sys
import volcontact as vc
model = vc.load(sys.argv[1])
data = mujoco.MjData(model)
with vc.attach(model):
    for _ in range(300):
        mujoco.mj_step(model, data)
print(data.qpos.tobytes().hex())
"""


@pytest.fixture(autouse=True)
def surroundings(tmp_path, monkeypatch):
    """A cache of its own, and CMake of the checkout."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("PATH", f"{TOOLS / 'bin'}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("CMAKE_BUILD_TYPE", "None")  # unoptimised: the bits are the same


@pytest.mark.soak
def test_compiles_once_what_steps_to_the_same_bits(tmp_path, monkeypatch, capfd):
    """`./run test` has test_sources_are_whole."""
    if shutil.which("cmake") is None:
        pytest.skip("needs CMake of ./run")
    library = _adaptor_build.build(NAME, SOURCE)
    assert library.is_relative_to(tmp_path / "cache" / "volcontact")
    assert "compiling for MuJoCo" in capfd.readouterr().err
    scene = Path(__file__).parents[3] / "mjcf_models" / "spinning_disc" / "scene.xml"
    states = []
    for own in ({}, {"VOLCONTACT_ADAPTOR": str(library)}):
        command = [sys.executable, "-c", PROGRAM, str(scene)]
        ran = subprocess.run(
            command, env=os.environ | own, capture_output=True, text=True, check=True
        )
        states.append(ran.stdout)
    assert states[0] == states[1]

    monkeypatch.setattr(_adaptor_build, "_compile", None)  # from the cache now
    assert _adaptor_build.build(NAME, SOURCE) == library
    assert capfd.readouterr().err == ""


@pytest.mark.once
def test_sources_are_whole(tmp_path, monkeypatch):
    """They configure, and the compiler reads the first of what it is then told to compile."""
    if shutil.which("cmake") is None:
        pytest.skip("needs CMake of ./run")
    monkeypatch.setenv("CMAKE_EXPORT_COMPILE_COMMANDS", "ON")
    package = Path(mujoco.__file__).parent
    subprocess.run(
        ["cmake", "-G", "Ninja", "-S", SOURCE / "adaptor", "-B", tmp_path,
         f"-DMUJOCO_DIR={package}"],
        check=True, capture_output=True,
    )  # fmt: skip
    commands = json.loads((tmp_path / "compile_commands.json").read_text())
    units = [each for each in commands if "/Unity/" in each["file"]]
    told = {name for each in units for name in Path(each["file"]).read_text().split('"')}
    sources = SOURCE / "adaptor"
    assert {path.relative_to(sources).as_posix() for path in sources.rglob("*.cc")} <= told
    command = [*shlex.split(units[0]["command"]), "-fsyntax-only", "-Wno-error"]
    done = subprocess.run(command, cwd=units[0]["directory"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[:2000]


def test_release_that_is_not_there_is_served_from_the_cache(tmp_path, monkeypatch):
    """What `adaptor` does where the package has no library for the MuJoCo that runs."""
    package = tmp_path / "package"
    shutil.copytree(SOURCE, package / "source")
    asked = []

    def build(name, source):
        asked.append((name, source))
        return package / name

    monkeypatch.setattr(_adaptor, "_library_folders", lambda: [package])
    monkeypatch.setattr(_adaptor_build, "build", build)
    assert _adaptor.library_path() == package / NAME
    assert asked == [(NAME, package / "source")]
    with pytest.raises(RuntimeError, match="nothing was compiled"):
        _adaptor.library_path(may_compile=False)


def test_cache_knows_sources_by_their_content(tmp_path):
    for name in ("a.cc", "b.cc"):
        (tmp_path / name).write_text(name)
    first = _adaptor_build._state_of(tmp_path)
    assert _adaptor_build._state_of(tmp_path) == first
    (tmp_path / "b.cc").write_text("changed")
    assert _adaptor_build._state_of(tmp_path) != first


def test_failure_shows_the_end_of_the_log(monkeypatch):
    if shutil.which("cmake") is None:
        pytest.skip("needs CMake")
    monkeypatch.setenv("CXX", "/bin/false")
    with pytest.raises(RuntimeError, match=r"it needs g\+\+ 11(.|\n)*/bin/false"):
        _adaptor_build.build(NAME, SOURCE)


def test_missing_tools_are_named(monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.delenv("CXX", raising=False)
    # Some library of the environment may have brought the PyPI package.
    monkeypatch.setattr(_adaptor_build.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(RuntimeError, match="there is no cmake: pip install cmake"):
        _adaptor_build.build(NAME, SOURCE)
    monkeypatch.setattr(_adaptor_build, "_program", lambda name, advice: name)
    with pytest.raises(RuntimeError, match=r"no C\+\+ compiler: install g\+\+"):
        _adaptor_build.build(NAME, SOURCE)


def test_installation_without_sources_says_so(tmp_path):
    with pytest.raises(RuntimeError, match="has no sources to compile"):
        _adaptor_build.build(NAME, tmp_path)
