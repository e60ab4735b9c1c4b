# SPDX-License-Identifier: Apache-2.0
"""`volcontact check`: what volcontact understands of a scene, without stepping it."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from rich.box import SIMPLE_HEAD
from rich.markup import escape
from rich.table import Table

import volcontact
from volcontact._files import appearing
from volcontact.cli.arguments import add_command, add_keyframe, add_keys, pixels
from volcontact.cli.terminal import Terminal

if TYPE_CHECKING:
    from volcontact.cli.arguments import Subparsers

_EXAMPLES = """\
  volcontact check scene.xml
  volcontact check scene.xml --json
  volcontact check scene.xml --picture start.png
"""
_CONTAINED = 1  # status of a site without a direction
_DEEP = 0.1  # of the smaller solid's size: deeper than this is no touch but a mistake


def add_to(commands: Subparsers) -> None:
    """Adds the command to the program."""
    parser = add_command(
        commands,
        "check",
        "print the solids, pairs, materials and options that a scene has under volcontact",
        _EXAMPLES,
    )
    parser.add_argument(
        "--picture",
        type=Path,
        metavar="FILE",
        help="draw the solids as understood, holes open and materials by colour, with their "
        "contacts at the start: a PNG file",
    )
    parser.add_argument("--camera", metavar="NAME", help="camera of the picture")
    parser.add_argument(
        "--width", type=pixels, default=800, metavar="PX", help="of the picture (default: 800)"
    )
    parser.add_argument(
        "--height", type=pixels, default=600, metavar="PX", help="of the picture (default: 600)"
    )
    add_keyframe(parser)
    add_keys(parser)
    parser.set_defaults(execute=execute)


def execute(arguments: argparse.Namespace, terminal: Terminal) -> int:
    """Runs the command and returns the exit status."""
    from volcontact.hints import hints
    from volcontact.running.driving import to_keyframe

    keys = {"material": dict(arguments.material), "options": dict(arguments.option)}
    model = volcontact.load(arguments.scene, **keys)
    data = mujoco.MjData(model)
    to_keyframe(model, data, arguments.keyframe)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # they are part of the description
        with volcontact.attach(model, **keys) as contact:
            description = contact.description
            mujoco.mj_forward(model, data)
            sites = contact.sites(data)
            if arguments.picture is not None:
                _draw(arguments, contact, data)
        found = list(hints(model, data, description["pairs"]))
    description["userdata"]["line"] = size_line(description["userdata"])
    description["advice"] = _step_advice(model, description)
    description["warnings"] += [*_mistakes(model, sites, description), *found]
    if arguments.picture is not None:
        description["picture"] = str(arguments.picture)
    if terminal.json:
        terminal.result(description)
    else:
        _print(description, terminal)
    return 0


def _stiffest(description: dict[str, Any]) -> tuple[str, float, bool] | None:
    """The stiffest pair: its geoms, its longest explicit step [s], whether implicit ones may be."""
    pairs = [pair for pair in description["pairs"] if pair["explicit_step"]]
    if not pairs:
        return None
    pair = min(pairs, key=lambda pair: pair["explicit_step"])
    names = f"{pair['geom_a']} and {pair['geom_b']}"
    return names, float(pair["explicit_step"]), pair["implicit"] != "off"


def _step_advice(model: mujoco.MjModel, description: dict[str, Any]) -> str:
    step, stiffest = float(model.opt.timestep), _stiffest(description)
    if stiffest is None:
        return ""
    names, longest, implicit = stiffest
    if step <= longest:
        return (
            f"steps of {step:g} s suit all pairs: explicit ones may last {longest:.2g} s for "
            f"the stiffest, {names}"
        )
    if implicit:
        return (
            f"steps of {step:g} s are implicit where contact is stiff; explicit ones would have to "
            f"be shorter than {longest:.2g} s for {names}"
        )
    return ""


def _mistakes(
    model: mujoco.MjModel, sites: np.ndarray, description: dict[str, Any]
) -> Iterator[str]:
    """What is allowed and hardly meant."""
    if not description["pairs"]:
        yield (
            "no two geoms can touch: give a body a joint, and look at contype, conaffinity, "
            "<exclude> and volcontact/option/pairs"
        )
    step, stiffest = float(model.opt.timestep), _stiffest(description)
    if stiffest is not None and step > stiffest[1] and not stiffest[2]:
        yield (
            f"steps of {step:g} s are too long for {stiffest[0]}: write <option "
            f'timestep="{stiffest[1]:.2g}"/>, or let steps be implicit with '
            'volcontact/option/implicit/auto and integrator="Euler"'
        )
    for site in sites:
        a, b = (_geom_name(model, int(site[key])) for key in ("geom_a", "geom_b"))
        if site["status"] == _CONTAINED:
            yield f"{a} and {b}: one is inside the other at the start: move them apart"
        elif site["depth"] > _DEEP * _smaller_size(model, site):
            yield (
                f"{a} and {b} overlap by {1e3 * site['depth']:.3g} mm at the start: move them "
                "apart, or they fly off"
            )


def _smaller_size(model: mujoco.MjModel, site: np.void) -> float:
    """Diameter of the smaller bounding sphere; planes have none [m]."""
    radii = [float(model.geom_rbound[site[key]]) for key in ("geom_a", "geom_b")]
    return 2.0 * min(radius for radius in radii if radius > 0.0)


def _geom_name(model: mujoco.MjModel, geom: int) -> str:
    return mujoco.mj_id2name(model, int(mujoco.mjtObj.mjOBJ_GEOM), geom) or f"geom {geom}"


def _draw(arguments: argparse.Namespace, contact: volcontact.Contact, data: mujoco.MjData) -> None:
    from volcontact.render import camera_id
    from volcontact.report.pictures import png
    from volcontact.report.solids_picture import draw_solids
    from volcontact.running.probes import recorded_sites

    if arguments.camera is not None:
        camera_id(contact.model, arguments.camera)
    picture = draw_solids(
        contact,
        data,
        recorded_sites(contact.sites(data)),
        width=arguments.width,
        height=arguments.height,
        camera=arguments.camera,
    )
    with appearing(arguments.picture) as file:
        file.write_bytes(png(picture))


def _print(description: dict[str, Any], terminal: Terminal) -> None:
    from volcontact.report.description import tables

    shown = {key: value for key, value in description.items() if key not in ("advice", "picture")}
    for part in tables(shown, sources=False):
        terminal.out.print(part.title, style="bold")
        if part.note:
            terminal.out.print(part.note, markup=False)
        if _fits(part.columns, part.rows, terminal.out.width):
            table = Table(*(escape(column) for column in part.columns), box=SIMPLE_HEAD)
            for row in part.rows:
                table.add_row(*(escape(cell) for cell in row))
            terminal.out.print(table)
        else:  # line by line: cells cut to a letter say nothing
            for row in part.rows:
                terminal.out.print()
                for column, cell in zip(part.columns, row, strict=True):
                    if cell:
                        terminal.out.print(f"  {column}: {cell}", markup=False, soft_wrap=True)
            terminal.out.print()
    if description["advice"]:
        terminal.out.print("Time step", style="bold")
        terminal.out.print(description["advice"], markup=False)
    if "picture" in description:
        terminal.out.print(f"picture: {description['picture']}", markup=False)
    for warning in description["warnings"]:
        terminal.warning(str(warning))


def _fits(columns: Sequence[str], rows: Sequence[Sequence[str]], width: int) -> bool:
    """Whether a table of that width shows every word whole."""
    needed = 0
    for cells in zip(columns, *rows, strict=True):
        words = [word for cell in cells for word in cell.split()]
        needed += max(map(len, words), default=0) + 2
    return needed + 2 <= width


def size_line(userdata: dict[str, Any]) -> str:
    """What a program that does not use `volcontact.load` must find in the file.

    Args:
        userdata: `needed` and `present` numbers, of a model that `load` made.

    Returns:
        The MJCF line, or that the file has enough.
    """
    in_file = userdata["present"] - userdata["needed"]
    if in_file >= userdata["needed"]:
        return f'the file has room: nuserdata="{in_file}"'
    return f'<size nuserdata="{userdata["needed"] + in_file}"/>'
