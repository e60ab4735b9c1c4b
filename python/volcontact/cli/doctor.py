# SPDX-License-Identifier: Apache-2.0
"""`volcontact doctor`: what is installed, and whether it works."""

from __future__ import annotations

import argparse
import importlib.util
import os
import platform
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import mujoco
from rich.markup import escape

import volcontact
from volcontact import _adaptor, _volcontact
from volcontact.cli.arguments import plain_command
from volcontact.cli.terminal import Terminal
from volcontact.messages.extras import EXTRAS

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers

_EXAMPLES = """\
  volcontact doctor
  volcontact doctor --json
"""
_BALL = """
<mujoco>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body pos="0 0 0.049"><freejoint/><geom type="sphere" size="0.05" mass="1"/></body>
  </worldbody>
</mujoco>
"""


@dataclass(frozen=True)
class Line:
    """One thing that was looked at.

    Attributes:
        name: of the thing.
        state: "good", "missing" for what some commands need, "bad" for what all need.
        text: what was found, and what to do where it is not good.
    """

    name: str
    state: Literal["good", "missing", "bad"]
    text: str


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = plain_command(
        commands, "doctor", "say what is installed and whether it works", _EXAMPLES
    )
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    del arguments
    lines = list(examine())
    sick = any(line.state == "bad" for line in lines)
    if terminal.json:
        terminal.result({"healthy": not sick, "lines": [asdict(line) for line in lines]})
        return int(sick)
    colors = {"good": "green", "missing": "yellow", "bad": "red"}
    for line in lines:
        color = colors[line.state]
        terminal.out.print(
            f"[{color}]{line.state:<8}[/]{line.name:<18}{escape(line.text)}", soft_wrap=True
        )
    return int(sick)


def examine() -> Iterator[Line]:
    """Looks at one thing after the other."""
    yield Line(
        "volcontact", "good", f"{volcontact.__version__} in {Path(volcontact.__file__).parent}"
    )
    yield Line("Python", "good", f"{platform.python_version()} on {platform.platform()}")
    yield Line("MuJoCo", "good", mujoco.mj_versionString())
    yield _tried("adaptor", "bad", _adaptor_text)
    yield _tried("a scene", "bad", _scene_text)
    yield Line("instruction set", "good", _volcontact.instruction_set())
    yield Line("threads", "good", _threads_text())
    yield _tried("pictures", "missing", _picture_text)
    yield _tried("window", "missing", _window_text)
    yield from map(_extra, dict.fromkeys(EXTRAS.values()))
    yield _cgal()


def _tried(name: str, otherwise: Literal["missing", "bad"], look: Callable[[], str]) -> Line:
    try:
        return Line(name, "good", look())
    except Exception as error:
        return Line(name, otherwise, " ".join(str(error).split()) or type(error).__name__)


def _adaptor_text() -> str:
    path = _adaptor.adaptor().path
    own = " (VOLCONTACT_ADAPTOR)" if os.environ.get("VOLCONTACT_ADAPTOR") else ""
    return f"{path.name}{own}"


def _scene_text() -> str:
    """A ball that is pressed 1 mm into a floor is pushed out again."""
    model = volcontact.load(_BALL)
    data = mujoco.MjData(model)
    with volcontact.attach(model) as contact:
        mujoco.mj_forward(model, data)
        (site,) = contact.sites(data)
        depth = float(site["depth"])
    if abs(depth - 1e-3) > 1e-9:
        raise RuntimeError(f"a ball 1 mm deep in a floor is said to be {1e3 * depth:g} mm deep")
    return "loads, attaches and touches"


def _threads_text() -> str:
    allowed = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    wanted = os.environ.get("OMP_NUM_THREADS")
    return f"{_volcontact.most_threads()} of {allowed} processors" + (
        f" (OMP_NUM_THREADS={wanted})" if wanted else ""
    )


def _picture_text() -> str:
    from volcontact.render import Renderer

    model = mujoco.MjModel.from_xml_string(_BALL)
    with Renderer(model, width=32, height=24) as renderer:
        renderer.draw(mujoco.MjData(model).qpos)
    return f"OpenGL by {os.environ.get('MUJOCO_GL') or 'egl'}"


def _window_text() -> str:
    from volcontact.view.window import why_no_window

    reason = why_no_window()
    if reason:
        raise RuntimeError(reason)
    return "MuJoCo's viewer, for `volcontact view`"


def _extra(name: str) -> Line:
    modules = [module for module, extra in EXTRAS.items() if extra == name]
    missing = [module for module in modules if importlib.util.find_spec(module) is None]
    if missing:
        advice = f'not installed: pip install "volcontact[{name}]"'
        return Line(f"extra {name}", "missing", f"{', '.join(missing)} {advice}")
    return Line(f"extra {name}", "good", ", ".join(modules))


def _cgal() -> Line:
    from volcontact.meshes import cgal

    program = cgal.program()
    if program is None:
        return Line("CGAL program", "missing", cgal.MISSING)
    return Line("CGAL program", "good", program)
