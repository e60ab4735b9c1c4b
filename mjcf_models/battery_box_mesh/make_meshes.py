# SPDX-License-Identifier: Apache-2.0
"""Makes one mesh of all geoms of the battery box, and one of all geoms of its worksite.

The unions are manifold3d's (`pip install manifold3d`; the tests have it). Boxes stay exact; the
round parts on top of the box, which nothing here can touch, get 32 chords.

    ./run python mjcf_models/battery_box_mesh/make_meshes.py mjcf_models/battery_box_mesh/meshes
"""

from __future__ import annotations

import argparse
from pathlib import Path

import manifold3d
import mujoco
import numpy as np

SCENE = Path(__file__).parents[1] / "battery_box" / "scene.xml"
CHORDS = 32

Triangles = tuple[np.ndarray, np.ndarray]


def solid_of(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> manifold3d.Manifold:
    """A geom as a closed mesh, in the frame of its top body."""
    size = model.geom_size[geom]
    kind = int(model.geom_type[geom])
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        solid = manifold3d.Manifold.cube(2 * size, center=True)
    elif kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        solid = manifold3d.Manifold.cylinder(
            2 * size[1], size[0], circular_segments=CHORDS, center=True
        )
    elif kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        ball = manifold3d.Manifold.sphere(size[0], circular_segments=CHORDS)
        ends = [ball.translate((0.0, 0.0, z)) for z in (-size[1], size[1])]
        solid = manifold3d.Manifold.batch_hull(ends)
    else:
        raise ValueError(f"geom {geom} is of type {kind}, which this script does not know")
    top = model.body_rootid[model.geom_bodyid[geom]]
    to_world = np.column_stack([data.geom_xmat[geom].reshape(3, 3), data.geom_xpos[geom]])
    X_WT = data.xmat[top].reshape(3, 3)
    in_top = X_WT.T @ to_world
    in_top[:, 3] -= X_WT.T @ data.xpos[top]
    # Faces of parts that touch lie in one plane, to the last bit: else a crack would stay there.
    return solid.transform(in_top).warp_batch(lambda points: np.round(points, 12))


def union(body: str) -> Triangles:
    """All geoms of a body and of what is fixed to it: points [m] and triangles, n x 3."""
    model = mujoco.MjModel.from_xml_path(str(SCENE))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    top = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, body)
    solids = [
        solid_of(model, data, geom)
        for geom in range(model.ngeom)
        if model.geom_bodyid[geom] and model.body_rootid[model.geom_bodyid[geom]] == top
    ]
    whole = manifold3d.Manifold.batch_boolean(solids, manifold3d.OpType.Add)
    mesh = whole.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts).astype(int)


def write_obj(path: Path, triangles: Triangles) -> None:
    """Writes an OBJ file in metres, to a picometre."""
    vertices, faces = triangles
    lines = ["# SPDX-License-Identifier: Apache-2.0", "# Made by make_meshes.py."]
    lines += [f"v {x:.12g} {y:.12g} {z:.12g}" for x, y, z in vertices.round(12) + 0.0]
    lines += [f"f {a} {b} {c}" for a, b, c in faces + 1]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    for body in ("battery_box", "worksite"):
        write_obj(folder / f"{body}.obj", union(body))


if __name__ == "__main__":
    main()
