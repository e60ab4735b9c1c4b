# SPDX-License-Identifier: Apache-2.0
"""Files appear whole or not at all: after errors, signals and on a full disk."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from volcontact._files import appearing, appearing_in

SCENE = """
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body pos="0 0 0.06"><freejoint/><geom type="sphere" size="0.05" mass="1"/></body>
  </worldbody>
</mujoco>
"""
PROGRAM = [sys.executable, "-c", "import sys, volcontact_start; sys.exit(volcontact_start.main())"]


@pytest.fixture(autouse=True)
def interruptible():
    """A program started in the background ignores Ctrl-C, and so do those that it starts."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def content(folder):
    """All files below a folder, hidden ones too, with what is in them."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(Path(folder).rglob("*"))
        if path.is_file()
    }


# ---- One file ------------------------------------------------------------------------------------


def test_a_file_takes_the_place_of_the_old_one_at_the_end(tmp_path):
    target = tmp_path / "numbers.csv"
    target.write_text("old")
    with appearing(target) as part:
        part.write_text("new")
        assert target.read_text() == "old" and part.suffix == ".csv"
    assert content(tmp_path) == {"numbers.csv": b"new"}
    (tmp_path / "usual").write_text("")
    assert target.stat().st_mode == (tmp_path / "usual").stat().st_mode


@pytest.mark.parametrize("fault", [ValueError, KeyboardInterrupt])
def test_a_file_that_fails_leaves_the_old_one_and_nothing_else(tmp_path, fault):
    (tmp_path / "numbers.csv").write_text("old")

    def write():
        with appearing(tmp_path / "numbers.csv") as part:
            part.write_text("half")
            raise fault

    with pytest.raises(fault):
        write()
    assert content(tmp_path) == {"numbers.csv": b"old"}


def test_a_place_without_a_folder_is_refused_at_once(tmp_path):
    reached = False
    with pytest.raises(FileNotFoundError), appearing(tmp_path / "nowhere" / "a.png"):
        reached = True
    assert not reached


def test_a_device_is_written_to_not_replaced():
    with appearing("/dev/null") as file:
        assert file == Path("/dev/null")
        file.write_text("x")
    assert not Path("/dev/null").is_file()


# ---- A folder ------------------------------------------------------------------------------------


def old_report(folder):
    folder.mkdir()
    (folder / "frames").mkdir()
    for name in ("report.html", "summary.json", "frames/1.png", "frames/2.png", "notes.txt"):
        (folder / name).write_text(f"old {name}")


def test_files_of_a_folder_change_together(tmp_path):
    out = tmp_path / "out"
    old_report(out)
    with appearing_in(out, ("report.html", "summary.json", "frames/*.png")) as new:
        (new / "frames").mkdir()
        for name in ("report.html", "frames/1.png", "more.csv"):
            (new / name).write_text(f"new {name}")
            assert (out / "report.html").read_text() == "old report.html"
    assert content(out) == {
        "frames/1.png": b"new frames/1.png",
        "more.csv": b"new more.csv",
        "notes.txt": b"old notes.txt",  # not of a report: it stays
        "report.html": b"new report.html",
    }


def test_a_folder_that_fails_stays_as_it_was(tmp_path):
    out = tmp_path / "out"
    old_report(out)
    before = content(out)

    def write():
        with appearing_in(out, ("*.html",)) as new:
            (new / "report.html").write_text("half")
            raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        write()
    assert content(out) == before
    with pytest.raises(ValueError, match="no"), appearing_in(tmp_path / "a" / "b"):
        raise ValueError("no")
    assert not (tmp_path / "a").exists()


def test_a_move_that_fails_is_taken_back(tmp_path):
    """The last of the new files cannot be put in place: a folder has its name."""
    out = tmp_path / "out"
    old_report(out)
    (out / "z.csv").mkdir()
    (out / "z.csv" / "mine").write_text("mine")
    before = content(out)

    def write():
        with appearing_in(out, ("*.html", "frames/*")) as new:
            for name in ("report.html", "summary.json", "z.csv"):
                (new / name).write_text("new")

    with pytest.raises(OSError, match=r"z\.csv"):
        write()
    assert content(out) == before


def test_a_signal_waits_until_all_files_have_moved(tmp_path, monkeypatch):
    out = tmp_path / "out"
    old_report(out)
    replace = Path.replace

    def interrupted(self, target):
        os.kill(os.getpid(), signal.SIGINT)
        return replace(self, target)

    def write():
        with appearing_in(out, ("*.html", "*.json")) as new:
            for name in ("report.html", "summary.json"):
                (new / name).write_text("new")
            monkeypatch.setattr(Path, "replace", interrupted)

    with pytest.raises(KeyboardInterrupt):
        write()
    monkeypatch.undo()
    found = content(out)
    assert found["report.html"] == found["summary.json"] == b"new"
    assert not [name for name in found if name.startswith(".")]


def test_a_folder_may_be_written_from_any_thread(tmp_path):
    def write():
        with appearing_in(tmp_path / "out") as new:
            (new / "a").write_text("a")

    thread = threading.Thread(target=write)
    thread.start()
    thread.join()
    assert content(tmp_path / "out") == {"a": b"a"}


# ---- The program ---------------------------------------------------------------------------------


@pytest.fixture
def scene(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.xml").write_text(SCENE)
    return "scene.xml"


COMMANDS = {"run": ["run"], "compare": ["compare", "--no-frames"]}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("command", COMMANDS)
def test_a_stopped_run_leaves_the_folder_as_it_was(scene, tmp_path, command, number):
    out = tmp_path / "out"
    old_report(out)
    before = content(out)
    arguments = [*COMMANDS[command], scene, "--duration", "500", "--out", str(out)]
    program = subprocess.Popen([*PROGRAM, *arguments], stderr=subprocess.PIPE, text=True)
    end = time.monotonic() + 60.0
    while not list(out.glob(".volcontact-*")) and time.monotonic() < end:
        time.sleep(0.05)
    time.sleep(0.5)
    program.send_signal(number)
    _, errors = program.communicate(timeout=60)
    assert (program.returncode, errors) == (130, "error: interrupted\n")
    assert content(out) == before


@pytest.mark.parametrize(
    ("command", "most"),
    [
        ("run", 100),
        ("compare", 30000),
        pytest.param("run", 30000, marks=pytest.mark.soak),
        pytest.param("compare", 100, marks=pytest.mark.soak),
    ],
)
def test_a_full_disk_leaves_the_folder_as_it_was(scene, tmp_path, command, most):
    """As a full disk: no file may become longer than so many bytes.

    `./run test` has each command and each length once.
    """
    out = tmp_path / "out"
    old_report(out)
    before = content(out)
    limited = "import resource, sys, volcontact_start\n"
    limited += f"resource.setrlimit(resource.RLIMIT_FSIZE, ({most}, {most}))\n"
    limited += "sys.exit(volcontact_start.main())"
    arguments = [command, scene, "--duration", "0.3", "--out", str(out)]
    if command == "compare":
        arguments += ["--width", "64", "--height", "48", "--frame-interval", "0.1"]
    done = subprocess.run(
        [sys.executable, "-c", limited, *arguments], capture_output=True, text=True, check=False
    )
    assert (done.returncode, content(out)) == (1, before), done.stderr
    assert done.stderr.splitlines()[-1].startswith("error: ") and "Traceback" not in done.stderr


@pytest.mark.parametrize("command", ["run", "compare"])
def test_the_place_is_tried_before_the_simulation(scene, tmp_path, command):
    (tmp_path / "file").write_text("")
    for place in ("file", "file/below"):
        done = subprocess.run(
            [*PROGRAM, command, scene, "--duration", "1e4", "--out", str(tmp_path / place)],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert done.returncode == 1
        assert done.stderr.startswith("error: ") and "file" in done.stderr


def test_a_film_that_is_cut_short_is_an_error(tmp_path, monkeypatch):
    """The encoder says nothing when the disk is full; the index of a film is its end."""
    import numpy as np

    from volcontact.report import film, pictures

    picture = np.zeros((48, 64, 3), np.uint8)
    pairs = [pictures.FramePair(0.1 * i, picture, picture, ("", "")) for i in range(3)]
    path = tmp_path / "run.mp4"
    assert pictures.write_movie(pairs, path)
    whole = path.read_bytes()
    for length in (0, 10, len(whole) // 2, len(whole) - 1):
        (tmp_path / "cut.mp4").write_bytes(whole[:length])
        assert not film._is_whole(tmp_path / "cut.mp4")
    assert film._is_whole(path)


@pytest.mark.parametrize("command", [["check"], ["run", "--duration", "0.01"]])
@pytest.mark.parametrize("json_output", [True, False])
def test_output_that_cannot_be_written_is_one_line(scene, command, json_output):
    arguments = [command[0], scene, *command[1:], *(["--json"] if json_output else [])]
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [*PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 1
    assert "No space left on device" in done.stderr and len(done.stderr.splitlines()) == 1


def test_an_error_that_cannot_be_written_either_is_one_line(tmp_path):
    (tmp_path / "bad.xml").write_text("<mujoco><goem/></mujoco>")
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [*PROGRAM, "check", tmp_path / "bad.xml", "--json"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
            cwd=tmp_path,
        )
    assert done.returncode == 1
    assert "goem" in done.stderr and len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_program_may_be_interrupted_while_it_is_loaded(tmp_path, number):
    """A stand-in for MuJoCo gets the signal in the midst of its import."""
    fake = f"import os, time\nos.kill(os.getpid(), {int(number)})\ntime.sleep(60)\n"
    (tmp_path / "mujoco.py").write_text(fake)
    done = subprocess.run(
        [*PROGRAM, "--version"],
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=50,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "error: interrupted\n")


def test_a_run_replaces_the_whole_of_an_earlier_report(scene, tmp_path):
    """Else a report would lie beside a summary that is not its own."""
    from volcontact.cli import main

    out = tmp_path / "out"
    old_report(out)
    assert main(["run", scene, "--duration", "0.01", "--out", str(out)]) == 0
    found = content(out)
    assert "report.html" not in found and found["notes.txt"] == b"old notes.txt"
    assert "volumetric" in json.loads(found["summary.json"])
