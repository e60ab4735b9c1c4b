# SPDX-License-Identifier: Apache-2.0
"""What docs/faq.md says of MuJoCo's distance fields: the contacts of a pin that is turned."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh

PAGE = Path(__file__).parents[3] / "docs" / "faq.md"
VERSION = tuple(int(number) for number in mujoco.__version__.split("."))
POSES = 72


def scene() -> str:
    """A pin of 20 mm in a hole of 22 mm, 64 chords each."""
    meshes = {
        "hole": trimesh.creation.annulus(r_min=0.011, r_max=0.03, height=0.04, sections=64),
        "pin": trimesh.creation.cylinder(radius=0.010, height=0.06, sections=64),
    }
    assets = ""
    for name, mesh in meshes.items():
        corners, triangles = (" ".join(map(str, a.ravel())) for a in (mesh.vertices, mesh.faces))
        assets += f'<mesh name="{name}" vertex="{corners}" face="{triangles}"/>'
    return f"""<mujoco><option sdf_iterations="40" sdf_initpoints="80"/><asset>{assets}</asset>
      <worldbody><geom type="sdf" mesh="hole"/>
        <body><freejoint/><geom type="sdf" mesh="pin" mass="0.1"/></body></worldbody></mujoco>"""


@pytest.mark.skipif(VERSION < (3, 3, 5), reason="this MuJoCo has no distance fields of meshes")
def test_points_on_a_distance_field_depend_on_how_the_pin_is_turned() -> None:
    model = mujoco.MjModel.from_xml_string(scene())
    data = mujoco.MjData(model)
    counts, depths = [], []
    for angle in np.linspace(0.0, 2.0 * np.pi, POSES, endpoint=False) + 0.01:
        data.qpos[:2] = 0.00105 * np.cos(angle), 0.00105 * np.sin(angle)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_collision(model, data)
        counts.append(data.ncon)
        depths.append(-1e6 * data.contact.dist.min())
    print(min(counts), max(counts), min(depths), max(depths))
    assert max(counts) > 3 * min(counts) and max(depths) > 2 * min(depths)
    if mujoco.__version__ == "4.0.0":  # the release that the page names
        text = " ".join(PAGE.read_text(encoding="utf-8").split())
        assert f"has {min(counts)} to {max(counts)} contacts when it is turned" in text
        assert f"between {min(depths):.0f} and {max(depths):.0f} um" in text
