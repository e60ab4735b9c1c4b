# SPDX-License-Identifier: Apache-2.0
"""Files that include each other: refused at once; misspelt names are found behind all of them."""

import subprocess
import sys

import pytest

import volcontact as vc

BODY = '<body><freejoint/><geom name="crate" type="box" size=".1 .1 .1"/></body>'
STEEL = '<tuple name="volcontact/material/steel"><element objtype="geom" objname="{name}"/></tuple>'
# What each file includes; the first is the scene.
RINGS = {
    "itself": {"a.xml": "a.xml"},
    "itself by another name": {"a.xml": "./../{folder}/a.xml"},
    "two that include each other": {"a.xml": "b.xml", "b.xml": "a.xml"},
    "a ring of forty": {f"{i}.xml": f"{(i + 1) % 40}.xml" for i in range(40)},
}


def write(folder, includes, inside=""):
    """Files with one include each; returns the first."""
    for name, other in includes.items():
        include = f'<include file="{other.format(folder=folder.name)}"/>' if other else inside
        (folder / name).write_text(f"<mujoco>{include}</mujoco>", encoding="utf-8")
    return folder / next(iter(includes))


@pytest.mark.parametrize("ring", RINGS)
def test_files_in_a_ring_are_refused_at_once(tmp_path, ring):
    scene = write(tmp_path, RINGS[ring])
    command = [sys.executable, "-m", "volcontact.cli", "check", scene]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1
    assert done.stderr.startswith("error: ")
    assert "included" in done.stderr


def test_a_misspelt_name_is_found_behind_many_includes(tmp_path):
    chain = {f"{i}.xml": f"{i + 1}.xml" for i in range(30)} | {"30.xml": ""}
    inside = f"<worldbody>{BODY}</worldbody><custom>{STEEL.format(name='crat')}</custom>"
    with pytest.raises(ValueError, match=r"there is no geom 'crat' .did you mean 'crate'"):
        vc.load(write(tmp_path, chain, inside))
