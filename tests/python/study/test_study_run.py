# SPDX-License-Identifier: Apache-2.0
"""Runs of studies: the same bits however they run, every trial exactly once, faults as rows."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from study_files import FUNCTION_STUDY, SCENE_STUDY, bits, function_study, scene_study, start

import volcontact as vc
from volcontact.cli import main
from volcontact.study.child import Batch, Child, end_children, run_batch
from volcontact.study.file.reading import read_study
from volcontact.study.results import Folder


@pytest.fixture(autouse=True)
def _no_children_left():
    yield
    end_children()


def rows_of(study: vc.Study, out: Path, **how):
    study.run(out, **how)
    return study.rows(out)


def test_two_processes_give_the_bits_of_one(tmp_path):
    study = vc.Study(scene_study(tmp_path))
    serial = rows_of(study, tmp_path / "serial", engine="serial")
    both = rows_of(study, tmp_path / "both", engine="processes", workers=2)
    assert serial["trial"].to_pylist() == list(range(12))
    assert bits(serial) == bits(both)
    assert len(set(serial["outcome"].to_pylist())) > 1


def test_fates_are_rows_and_touch_no_other_trial(tmp_path):
    fates = {"none": 0.9, "crash": 0.04, "hang": 0.03, "raise": 0.03}
    (tmp_path / "with").mkdir()
    study = vc.Study(function_study(tmp_path / "with", **fates), trials=60, seed=6)
    rows = rows_of(study, tmp_path / "out", workers=2).to_pylist()
    assert [row["trial"] for row in rows] == list(range(60))
    ends = {"crash": "crashed", "hang": "hung", "raise": "error"}
    for row in rows:
        assert row["outcome"] == ends.get(row["fate"], row["outcome"])
        assert bool(row["reason"]) == (row["fate"] != "none")
    assert {row["fate"] for row in rows} == set(fates)
    reasons = {row["fate"]: row["reason"] for row in rows}
    assert "SIGSEGV" in reasons["crash"]
    assert "time limit of 1 s" in reasons["hang"]
    assert reasons["raise"] == "ValueError: this trial is no good"
    plain = rows_of(
        vc.Study(function_study(tmp_path), trials=60, seed=6), tmp_path / "p", engine="serial"
    )
    # The inputs of a trial come before those of the fate, whatever the others did.
    for row, other in zip(rows, plain.to_pylist(), strict=True):
        if row["fate"] == "none":
            assert row["noise"] == other["noise"]


def test_child_that_somebody_kills_costs_no_trial(tmp_path):
    settings = read_study(function_study(tmp_path))
    values = [{"x": float(i), "y": 1.0, "sleep": 0.02} for i in range(40)]
    import threading

    seen: list[int] = []

    def kill_it() -> None:
        time.sleep(0.3)
        for pid in children_of(os.getpid()):
            seen.append(pid)
            os.kill(pid, signal.SIGKILL)

    child = Child(settings)  # warm, so that the kill falls into the trials
    child.kill()
    run_batch(settings, Batch([0], values[:1]))
    killer = threading.Thread(target=kill_it)
    killer.start()
    rows = run_batch(settings, Batch(list(range(40)), values)).rows
    killer.join()
    assert seen
    assert [row["trial"] for row in rows] == list(range(40))
    assert {row["outcome"] for row in rows} == {"success", "failure"}


def children_of(pid: int) -> list[int]:
    """Processes of a study that are children of a process."""
    found = []
    for folder in Path("/proc").iterdir():
        if folder.name.isdecimal():
            try:
                stat = (folder / "stat").read_text().rpartition(")")[2].split()
                command = (folder / "cmdline").read_bytes()
            except OSError:
                continue
            if int(stat[1]) == pid and b"volcontact.study.child" in command:
                found.append(int(folder.name))
    return found


HELD = """\
import pathlib, time

here = pathlib.Path(__file__).with_name("held")
begun = 0

def trial(values, rng):
    global begun
    begun += 1
    while begun > 30 and here.exists():
        time.sleep(0.01)
    return {"sum": values["x"] + values["y"], "noise": rng.normal()}
"""


def test_driver_that_is_killed_is_resumed_exactly_once(tmp_path):
    """However busy the machine: its trials stop after thirty in each process, until it is dead."""
    path = function_study(tmp_path, FUNCTION_STUDY.replace("time_limit = 1.0", "time_limit = 300"))
    (tmp_path / "functions.py").write_text(HELD)
    (tmp_path / "held").touch()
    out = tmp_path / "out"
    asked = ("--out", str(out), "--trials", "500", "--workers", "2")
    driver = start("study", "run", str(path), *asked)
    try:
        deadline = time.monotonic() + 240.0
        while not Folder(out).parts() and time.monotonic() < deadline:
            time.sleep(0.02)
        with pytest.raises(vc.StudyError, match="another run writes to this folder"):
            Folder(out).lock()
    finally:
        driver.kill()
        driver.join()
    before = Folder(out).done(500)
    assert 0 < before.sum() <= 60
    kept = {part: part.read_bytes() for part in Folder(out).parts()}
    (out / "trials" / "readme").write_text("not a part")
    (tmp_path / "held").unlink()
    assert main(["study", "resume", str(out), "--workers", "2"]) == 0
    for part, content in kept.items():
        assert part.read_bytes() == content
    table = vc.Study.rows(out)
    assert table["trial"].to_pylist() == list(range(500))
    whole = tmp_path / "whole"
    vc.Study(path, trials=500).run(whole, engine="serial")
    assert bits(table) == bits(vc.Study.rows(whole))
    assert not list(out.glob(".volcontact-*"))


def test_rows_reach_the_disk_while_other_trials_take_long(tmp_path):
    """A trial that goes on for minutes keeps no finished row of another in memory."""
    path = function_study(tmp_path, FUNCTION_STUDY.replace("time_limit = 1.0", "time_limit = 300"))
    (tmp_path / "functions.py").write_text(HELD.replace("begun > 30", "values['x'] > 1.0"))
    (tmp_path / "held").touch()
    out = tmp_path / "out"
    driver = start("study", "run", str(path), "--out", str(out), "--workers", "2")
    try:
        deadline = time.monotonic() + 240.0
        while not Folder(out).parts() and time.monotonic() < deadline:
            time.sleep(0.02)
        x = vc.Study.rows(out)["x"].to_numpy()
        assert 0 < len(x) < 40 and (x <= 1.0).all()
        (tmp_path / "held").unlink()
        driver.join(120)
        assert driver.exitcode == 0
    finally:
        driver.kill()
        driver.join()
    assert vc.Study.rows(out)["trial"].to_pylist() == list(range(40))


def test_few_rows_wait_for_the_disk_at_any_rate(tmp_path):
    path = function_study(tmp_path)
    instant = "def trial(values, rng):\n    return {'sum': values['x'], 'noise': 0.0}\n"
    (tmp_path / "functions.py").write_text(instant)
    vc.Study(path, trials=24_000).run(tmp_path / "out", engine="serial")
    parts = [pq.read_metadata(p).num_rows for p in (tmp_path / "out" / "trials").iterdir()]
    assert sum(parts) == 24_000 and max(parts) <= 12_000, parts


def test_serial_driver_that_its_trial_kills_goes_on_behind_it(tmp_path):
    path = function_study(tmp_path, none=0.75, crash=0.25)
    out = tmp_path / "out"
    asked = ("--out", str(out), "--trials", "6", "--seed", "2", "--engine", "serial")
    driver = start("study", "run", str(path), *asked)
    driver.join()
    assert driver.exitcode == -signal.SIGSEGV
    for _ in range(6):
        driver = start("study", "resume", str(out), "--engine", "serial")
        driver.join()
        if driver.exitcode == 0:
            break
    rows = vc.Study.rows(out).to_pylist()
    assert [row["trial"] for row in rows] == list(range(6))
    assert all((row["outcome"] == "crashed") == (row["fate"] == "crash") for row in rows)


def test_full_disk_ends_the_study_in_one_line(tmp_path):
    """A limit on the size of files stands for the disk: the first part does not fit."""
    path = function_study(tmp_path, FUNCTION_STUDY.replace("trials = 40", "trials = 400"))
    out = tmp_path / "out"
    program = (
        "import resource, signal, sys; from volcontact.cli import main;"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000));"
        f"sys.exit(main(['study', 'run', {str(path)!r}, '--out', {str(out)!r}, '--engine',"
        " 'serial']))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 1
    said = " ".join(done.stderr.split())
    assert "File too large" in said and "0 trials are safe" in said
    assert "volcontact study resume" in said and "Traceback" not in said
    assert Folder(out).parts() == []
    assert main(["study", "resume", str(out), "--engine", "serial"]) == 0
    assert vc.Study.rows(out)["trial"].to_pylist() == list(range(400))


FULL = """\
mount -t tmpfs -o size=64k none "$1" || exit 77
"$2" -c "$3" "$1/out"; echo "full: $?"
cp -r "$1/out" "$4.full"
mount -o remount,size=2m "$1"
"$2" -m volcontact.cli study resume "$1/out" --engine serial >/dev/null; echo "resumed: $?"
cp -r "$1/out" "$4"
"""


@pytest.mark.soak
def test_really_full_disk(tmp_path):
    """A file system of 64 KB: some parts fit, the rest once there is room, each trial once.

    `./run test` has test_full_disk_ends_the_study_in_one_line.
    """
    if shutil.which("unshare") is None:
        pytest.skip("needs unshare, of util-linux")
    path = function_study(tmp_path, FUNCTION_STUDY.replace("trials = 40", "trials = 400"))
    (tmp_path / "disk").mkdir()
    program = (
        "import sys; from volcontact.study import driver; from volcontact.cli import main;"
        "driver._FLUSH = driver._SLOWEST_FLUSH = 0.0; driver._MOST_TRIALS = 5;"
        f"sys.exit(main(['study', 'run', {str(path)!r}, '--out', sys.argv[1], '--engine',"
        " 'serial']))"
    )
    arguments = [tmp_path / "disk", sys.executable, program, tmp_path / "out"]
    shell = ["unshare", "-rm", "sh", "-c", FULL, "sh", *map(str, arguments)]
    done = subprocess.run(shell, capture_output=True, text=True)
    if done.returncode == 77 or "unshare" in done.stderr:
        pytest.skip(f"no file system can be mounted here: {done.stderr.strip()[:100]}")
    full, resumed = done.stdout.split("\n")[-3:-1]
    assert full == "full: 1" and resumed == "resumed: 0"
    safe = vc.Study.rows(tmp_path / "out.full")["trial"].to_pylist()
    assert 1 <= len(safe) < 400 and safe == list(range(len(safe)))
    said = " ".join(done.stderr.split())
    assert "No space left on device" in said and "Traceback" not in said
    assert f"{len(safe)} trials are safe" in said
    assert vc.Study.rows(tmp_path / "out")["trial"].to_pylist() == list(range(400))


def test_resume_refuses_what_has_changed(tmp_path):
    path = scene_study(tmp_path)
    out = tmp_path / "out"
    vc.Study(path, trials=2).run(out, engine="serial")
    scene = tmp_path / "scene.xml"
    scene.write_text(scene.read_text().replace('pos="0.3 0 0.05"', 'pos="0.31 0 0.05"'))
    with pytest.raises(vc.StudyError, match="the scene has changed"):
        vc.Study.resume(out)
    with pytest.raises(vc.StudyError, match="has the results of a study; go on with"):
        vc.Study(path).run(out)
    with pytest.raises(vc.StudyError, match="is no folder of a study"):
        vc.Study.resume(tmp_path)


def test_replay_gives_the_same_bits(tmp_path, capsys):
    study = vc.Study(scene_study(tmp_path))
    out = tmp_path / "out"
    study.run(out, engine="processes", workers=1)
    rows = study.rows(out).to_pylist()
    for trial in (0, 7):
        assert study.replay(out, trial) == rows[trial]
    record = tmp_path / "trial7"
    assert main(["study", "replay", str(out), "7", "--record", str(record)]) == 0
    assert "friction" in capsys.readouterr().out
    assert any(record.iterdir())
    # A row that somebody changed is found out.
    for part in Folder(out).parts():
        table = pq.read_table(part)
        place = table.column_names.index("x")
        moved = np.nextafter(table["x"].to_numpy(), 9.0)
        pq.write_table(table.set_column(place, table.field("x"), [moved]), part)
    assert main(["study", "replay", str(out), "7"]) == 3
    assert main(["study", "replay", str(out), "99"]) == 1


def test_a_study_that_moves_with_its_results(tmp_path):
    """It is resumed and replayed at its new place; without the scene it says what is missing."""
    place = tmp_path / "here"
    place.mkdir()
    study = vc.Study(scene_study(place), trials=6)
    study.run(place / "out", engine="serial")
    rows = study.rows(place / "out")
    moved = tmp_path / "there"
    place.rename(moved)
    part = Folder(moved / "out").parts()[-1]
    part.unlink()
    vc.Study.resume(moved / "out", engine="serial")
    assert vc.Study.rows(moved / "out").equals(rows)
    assert study.replay(moved / "out", 3) == rows.to_pylist()[3]
    (moved / "scene.xml").unlink()
    with pytest.raises(vc.StudyError, match=r"scene = 'scene.xml': there is no such file in"):
        vc.Study.resume(moved / "out", engine="serial")


def test_progress_says_rate_and_failures(tmp_path, monkeypatch, capsys):
    """Where there is no terminal, in lines."""
    import volcontact.cli.study as command

    monkeypatch.setattr(command, "_SAY_EVERY", 0.0)
    path = function_study(tmp_path)
    assert (
        main(["study", "run", str(path), "--engine", "serial", "--out", str(tmp_path / "o")]) == 0
    )
    lines = [line for line in capsys.readouterr().err.splitlines() if "of 40 trials" in line]
    bad = 40 - sum(vc.Study(path).rows(tmp_path / "o")["success"].to_pylist())
    assert "trials/s" in lines[-1] and f"{bad} without success (failure {bad})" in lines[-1]


def test_replay_reports_and_shows_a_trial(tmp_path, capsys):
    """The report has the trial's own peak; the playback goes through its states and begins anew."""
    from volcontact.study.replay import compare_trial, play_trial

    study = vc.Study(scene_study(tmp_path), trials=3)
    out = tmp_path / "out"
    study.run(out, engine="serial")
    row = study.rows(out).to_pylist()[2]
    comparison, model = compare_trial(out, 2)
    run = comparison.volumetric
    assert run.time[-1] == pytest.approx(row["time"], abs=1e-9) and run.qpos.shape[1] == model.nq
    assert run.contact_force.max() == pytest.approx(row["peak_force"], rel=1e-6)
    assert run.position[-1, 0, 0] == row["x"]
    assert comparison.native.contact == "native" and len(comparison.native.time) > 100
    assert run.step_microseconds.min() > 0.0
    report = tmp_path / "trial"
    command = ["study", "replay", str(out), "2", "--report", str(report), "--no-frames"]
    assert main(command) == 0
    assert "trial 2" in (report / "report.html").read_text("utf-8")
    with play_trial(out, 2) as stage:
        assert stage.contact == "volumetric" and stage.data.time == 0.0
        stage.step(5)
        assert 0.03 < stage.data.time < 0.06 and len(stage.drawings()) == 1
        while stage.data.time < row["time"] - 0.01:
            stage.advance(0.02)
        assert stage.data.qpos[0] == pytest.approx(row["x"], abs=0.01)
        stage.advance(1.0)
        assert stage.data.time == 0.0
    path = function_study(tmp_path)
    vc.Study(path, trials=2).run(tmp_path / "sums", engine="serial")
    capsys.readouterr()
    assert main(["study", "replay", str(tmp_path / "sums"), "0", "--view"]) == 1
    assert main(["study", "replay", str(tmp_path / "sums"), "0", "--report", str(report)]) == 1
    assert "the study of a function has no scene to show" in capsys.readouterr().err


def test_status_from_the_folder(tmp_path, capsys):
    out = tmp_path / "out"
    study = vc.Study(function_study(tmp_path))
    study.run(out, engine="serial")
    assert main(["study", "status", str(out), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["done"] == said["trials"] == 40 and said["state"] == "finished"
    good = sum(study.rows(out)["success"].to_pylist())
    assert said["outcomes"]["success"] == good and said["success"] == good / 40
    low, high = said["interval"]
    assert low < good / 40 < high


def test_report_is_one_file_that_can_be_quoted(tmp_path, capsys):
    study = vc.Study(scene_study(tmp_path), trials=160)
    out = tmp_path / "out"
    study.run(out, engine="processes", workers=2)
    file = tmp_path / "report.html"
    assert main(["study", "report", str(out), "--out", str(file), "--no-pictures"]) == 0
    page = file.read_text(encoding="utf-8")
    good = sum(study.rows(out)["success"].to_pylist())
    assert f"{good} of 160 trials succeeded" in page and "Wilson" in page
    # Three inputs are three pairs, each with a map; nothing is fetched from elsewhere.
    assert page.count("<svg") >= 3 + 3
    assert "<script" not in page and 'src="http' not in page and "<link" not in page
    assert "The worst trials" not in page
    command = ["study", "report", str(out), "--out", str(file), "--no-pictures"]
    assert main([*command, "--map", "frictoin"]) == 1
    assert "--map 'frictoin': the study has no such input; did you mean" in capsys.readouterr().err
    assert main([*command, "--map", "friction"]) == 0  # with the two others
    assert file.read_text(encoding="utf-8").count("<svg") == page.count("<svg") - 1
    few = tmp_path / "few"
    vc.Study(scene_study(tmp_path), trials=2).run(few, engine="serial")
    assert main(["study", "report", str(few)]) == 0
    drawn = (few / "report.html").read_text(encoding="utf-8")
    assert drawn.count('src="data:image/png;base64,') == 2


def test_map_over_a_word_and_a_number():
    """A cell of the map has the trials of its word: here the share of each is known."""
    from volcontact.study.figures import _Cells, maps

    words = np.array(["dry", "oiled", "dry", "oiled"] * 50)
    numbers = np.repeat([0.0, 1.0], 100)
    figure = maps(words, numbers, (words == "dry") & (numbers > 0.5), None, ["film", "tilt"])
    shares = figure.axes[0].collections[0].get_array()
    assert shares[0].tolist() == [0.0, 0.0] and shares[-1].tolist() == [1.0, 0.0]
    assert [label.get_text() for label in figure.axes[0].get_xticklabels()] == ["dry", "oiled"]
    cells = _Cells.of(np.array([0.0, 0.1, 0.5, 1.0]), 2)
    assert cells.cell.tolist() == [0, 0, 0, 1]  # the edge lies a rounding above the middle


def test_trajectories_of_the_trials_asked_for(tmp_path):
    text = SCENE_STUDY + '[record.trajectories]\noutcomes = ["timed_out"]\nevery = 5\nmost = 7\n'
    study = vc.Study(scene_study(tmp_path, text))
    out = tmp_path / "out"
    study.run(out, engine="serial")
    rows = study.rows(out).to_pylist()
    wanted = [0, 5, 10] + [row["trial"] for row in rows if row["outcome"] == "timed_out"]
    names = [f"trial-{trial:08d}" for trial in dict.fromkeys(wanted)][:7]
    assert sorted(place.name for place in (out / "trajectories").iterdir()) == sorted(names)
    kept = pq.read_table(next((out / "trajectories" / names[0]).glob("*.parquet")))
    assert len(kept) > 0
