# SPDX-License-Identifier: Apache-2.0
"""Goes the first ten minutes of a new user and writes them to docs/tutorials/ten_minutes.md.

./run python docs/generate/make_ten_minutes.py WHEEL

The wheel is one of `./run wheels` for CPython 3.11, the Python of the system that this makes:
Debian with Python alone, a fresh account, no compiler, no network. Needs root and mmdebstrap.
"""

from __future__ import annotations

import csv
import datetime
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from parts.ten_minutes_steps import INSTALL, OWN, PRESS, SLIPS, START, Slip, Step

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "tutorials" / "ten_minutes.md"
CURVE = PAGE.with_suffix(".svg")
RECORD = ROOT / "tests" / "benchmarks" / "results" / "install.csv"
FOLDER = ROOT / "build" / "ten-minutes"
TOOLS = ROOT / ".venv" / "tools" / "bin" / "python"  # has pip, by ./run wheels
SUITE, PYTHON = "bookworm", "3.11"
PACKAGES = "python3,python3-venv"
HOME = "/home/newcomer"
MOST = 20.0  # for `pip install` [s]
_FIRST, _LAST = 4, 10  # lines of an output that are shown


class Account:
    """A fresh account of a small system, without network."""

    def __init__(self, system: Path) -> None:
        self._system = system
        shutil.rmtree(self.home, ignore_errors=True)
        self.home.mkdir(parents=True)
        shutil.chown(self.home, 1000, 1000)

    @property
    def home(self) -> Path:
        """Its folder, as seen from here."""
        return self._system / HOME.lstrip("/")

    def types(self, command: str) -> tuple[int, str, float]:
        """Status, what is seen, and the time it takes [s]."""
        words = ["/usr/bin/unshare", "--net", "--mount", "--pid", "--fork"]
        words += [
            f"--mount-proc={self._system / 'proc'}",
            "/usr/sbin/chroot",
            "--userspec=1000:1000",
        ]
        words += [str(self._system), "/bin/bash", "-c", f"cd {HOME} && {command}"]
        path = f"{HOME}/env/bin:/usr/bin:/bin"
        surroundings = {"HOME": HOME, "PATH": path, "LANG": "C.UTF-8", "COLUMNS": "100"}
        begin = time.perf_counter()
        done = subprocess.run(words, env=surroundings, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr, time.perf_counter() - begin

    def writes(self, name: str, text: str) -> None:
        """A file of the user's own."""
        path = self.home / name
        path.write_text(text, encoding="utf-8")
        shutil.chown(path, 1000, 1000)


def main() -> None:
    """Writes the page, its curve and the record of the installation."""
    wheel = Path(sys.argv[1]).resolve()
    account = Account(make_system())
    shutil.copytree(make_index(wheel), account.home / "index")
    begin = time.perf_counter()
    parts = {
        name: list(typed(account, steps))
        for name, steps in (("install", INSTALL), ("start", START), ("own", OWN), ("press", PRESS))
    }
    slips = list(slipped(account))
    took = time.perf_counter() - begin
    keep_record(wheel, parts["install"])
    shutil.copy(next((account.home / "press" / "results" / "figures").glob("*.svg")), CURVE)
    PAGE.write_text(page(parts, slips, took), encoding="utf-8")


def make_system() -> Path:
    """A small system with Python, and neither compiler nor pip outside of an environment."""
    system = FOLDER / "system"
    if not (system / "usr" / "bin" / f"python{PYTHON}").exists():
        shutil.rmtree(system, ignore_errors=True)
        FOLDER.mkdir(parents=True, exist_ok=True)
        subprocess.run(
            ["mmdebstrap", "--quiet", "--mode=root", "--variant=minbase",
             f"--include={PACKAGES}", SUITE, system],
            check=True,
        )  # fmt: skip
    for compiler in ("cc", "gcc", "g++", "c++", "clang"):
        if (system / "usr" / "bin" / compiler).exists():
            sys.exit(f"make_ten_minutes: the system has {compiler}")
    return system


def make_index(wheel: Path) -> Path:
    """A folder with the wheel and all that it and its extras need."""
    index = FOLDER / "index"
    shutil.rmtree(index, ignore_errors=True)
    command = [TOOLS, "-m", "pip", "download", "-q", "--only-binary", ":all:"]
    command += [
        "--python-version",
        PYTHON,
        "--dest",
        index,
        f"volcontact[report,view] @ file://{wheel}",
    ]
    command += [f"--platform=manylinux_2_{minor}_x86_64" for minor in range(17, 37)]
    command += ["--platform=manylinux2014_x86_64"]
    subprocess.run([str(word) for word in command], check=True)
    return index


def typed(account: Account, steps: tuple[Step, ...]) -> Iterator[tuple[Step, str, float]]:
    """Each command, what it said and the time it took; a command that fails ends everything."""
    for step in steps:
        if step.file is not None:
            account.writes(*step.file)
        status, text, took = account.types(step.command)
        print(f"{took:6.1f} s  {status}  {step.command}", flush=True)
        if status != 0:
            sys.exit(f"make_ten_minutes: {step.command!r} ended with status {status}:\n{text}")
        yield step, text, took


def slipped(account: Account) -> Iterator[tuple[Slip, str, float]]:
    """Each slip, its message and the time of what was right."""
    for slip in SLIPS:
        status, text, _ = account.types(slip.wrong)
        print(f"slip, status {status}: {slip.wrong}", flush=True)
        if status == 0 or slip.says not in text or "Traceback" in text:
            sys.exit(f"make_ten_minutes: {slip.wrong!r} ended with status {status}:\n{text}")
        again, said, took = account.types(slip.right)
        if again != 0:
            sys.exit(f"make_ten_minutes: {slip.right!r} ended with status {again}:\n{said}")
        yield slip, text, took


def keep_record(wheel: Path, steps: list[tuple[Step, str, float]]) -> None:
    """The time of `pip install`, which must not be more than it may."""
    (took,) = [took for step, _, took in steps if "pip install" in step.command]
    if took > MOST:
        sys.exit(f"make_ten_minutes: pip install took {took:.1f} s, more than {MOST:g} s")
    row = {"wheel": wheel.name, "python": PYTHON, "install_s": f"{took:.1f}", "allowed_s": MOST}
    with RECORD.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(row), lineterminator="\n")
        writer.writeheader()
        writer.writerow(row)


# ---- The page ------------------------------------------------------------------------------------


def page(
    parts: dict[str, list[tuple[Step, str, float]]],
    slips: list[tuple[Slip, str, float]],
    took: float,
) -> str:
    """The text of the page."""
    day = datetime.date.today()
    errors = "\n".join(
        f"| `{slip.wrong}` | {message_of(text)} | `{slip.right}` | {seconds:.1f} s |"
        for slip, text, seconds in slips
    )
    fill = {name: block(steps) for name, steps in parts.items()}
    fill |= {"day": f"{day.day} {day:%B %Y}", "took": f"{took:.0f}", "errors": errors}
    fill["pusher"] = OWN[0].file[1].rstrip() if OWN[0].file else ""
    fill["read"] = next(s.file[1] for s in PRESS if s.file is not None).rstrip()
    text = TEMPLATE
    for name, value in fill.items():
        text = text.replace(f"<<{name}>>", value)
    return text


def block(steps: list[tuple[Step, str, float]]) -> str:
    """A transcript, with the time at the end of the line of each command."""
    lines = ["```text"]
    for step, text, took in steps:
        lines.append(f"$ {step.command}".ljust(70) + f" {took:.1f} s")
        said = [line.rstrip() for line in text.splitlines() if line.strip()]
        if step.keep:
            said = [line for line in said if any(part in line for part in step.keep)]
        left_out = len(said) - _FIRST - _LAST
        if left_out > 1:
            said = [*said[:_FIRST], f"... {left_out} lines more ...", *said[-_LAST:]]
        lines += said
    return "\n".join([*lines, "```"])


def message_of(text: str) -> str:
    """The line of an error, for a table."""
    (line,) = re.findall(r"^.*error: (.*)$", text, re.MULTILINE) or [text.strip().splitlines()[-1]]
    for sign, written in (("|", "\\|"), ("<", "&lt;"), (">", "&gt;")):
        line = line.replace(sign, written)
    return line


TEMPLATE = """\
# Ten minutes from a wheel

A new user has a folder of wheels, `index`, and nothing else: Debian with Python alone, a fresh account, no compiler, no network. The script
[make_ten_minutes.py](../generate/make_ten_minutes.py) set up that system, typed every line and recorded the answers (<<day>>; two cores with other work on them). The
commands took <<took>> s together; the rest of the ten minutes is for reading.

## Install

<<install>>

## The first scene

<<start>>

## A scene of your own

A pusher and a puck, in `pusher.xml`. Only the last block is not plain MuJoCo: a material for three geoms.

```xml
<<pusher>>
```

<<own>>

## A shaft into a chamfered bore

A shaft of 9.98 mm, a bore of 10.00 mm, so 0.02 mm of clearance; the holder of the shaft is 0.3 mm off centre and compliant. [The tutorial](insertion.md) explains the scene
and the curve.

<<press>>

`read.py` is

```text
<<read>>
```

and the run has drawn the insertion force over the travel of the press:

![Force over depth](ten_minutes.svg)

## What went wrong on the way

Each of these commands failed with an error of one line that names its fix. The third column is the command that the error led to, which worked.

| typed | answer | then | time |
| --- | --- | --- | --- |
<<errors>>

Go on with the [tutorials](index.md) or with [writing a scene](../writing_a_scene.md).
"""  # noqa: E501


if __name__ == "__main__":
    main()
