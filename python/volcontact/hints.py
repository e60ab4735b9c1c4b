# SPDX-License-Identifier: Apache-2.0
"""What a scene is allowed to be and is hardly meant to be: sinking, creeping, millimetres."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import mujoco
import numpy as np

from volcontact.messages.names import name_of

SINKS = 0.02  # of a body's size: deeper than this at rest is worth a word [-]
_LARGE = 5.0  # the least size of what moves, from which on it looks like millimetres [m]
_AT_REST = 1e-2  # [m/s]

_FREE = int(mujoco.mjtJoint.mjJNT_FREE)
_ROUND = frozenset(
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{kind}")) for kind in ("SPHERE", "ELLIPSOID", "CAPSULE")
)
_BOX, _CYLINDER = int(mujoco.mjtGeom.mjGEOM_BOX), int(mujoco.mjtGeom.mjGEOM_CYLINDER)
_PLANE = int(mujoco.mjtGeom.mjGEOM_PLANE)


def hints(
    model: mujoco.MjModel, data: mujoco.MjData, pairs: Sequence[Mapping[str, Any]]
) -> Iterator[str]:
    """Everything worth a word.

    Args:
        model: of the scene.
        data: at its start, evaluated.
        pairs: of `Contact.description`.
    """
    yield from _sinking(model, data, pairs)
    yield from creeping_grasps(model, pairs)
    yield from _millimetres(model)


def sunk(model: mujoco.MjModel, data: mujoco.MjData, sites: np.ndarray) -> Iterator[str]:
    """Bodies that rest deep in others, measured by the smaller of the two.

    Args:
        model: of the scene.
        data: of the state that the sites are of.
        sites: structured array with `geom_a`, `geom_b` and `depth`.
    """
    deepest: dict[tuple[int, int], float] = {}
    for site in sites:
        key = int(site["geom_a"]), int(site["geom_b"])
        if min(key) >= 0:
            deepest[key] = max(deepest.get(key, 0.0), float(site["depth"]))
    velocity = np.zeros(6)
    for geoms, depth in deepest.items():
        sizes = {geom: size_of(model, geom) for geom in geoms if has_size(model, geom)}
        if not sizes:
            continue
        small = min(sizes, key=lambda geom: sizes[geom])
        speeds = []
        for geom in geoms:
            mujoco.mj_objectVelocity(model, data, int(mujoco.mjtObj.mjOBJ_GEOM), geom, velocity, 0)
            speeds.append(float(np.linalg.norm(velocity[3:])))
        if depth > SINKS * sizes[small] and max(speeds) < _AT_REST:
            a, b = (name_of(model, "geom", geom) for geom in geoms)
            percent = 100 * depth / sizes[small]
            yield (
                f"{a} and {b} rest {1e3 * depth:.3g} mm deep in each other, "
                f"{percent:.{'2g' if percent < 99.5 else '0f'}} % of the size of the smaller one: "
                "give their materials more stiffness if that is not meant"
            )


def size_of(model: mujoco.MjModel, geom: int) -> float:
    """The least extent of a geom [m]: the least edge of a box, the diameter of a sphere."""
    kind, sizes = int(model.geom_type[geom]), model.geom_size[geom]
    if kind == _BOX:
        return 2.0 * float(sizes.min())
    if kind == _CYLINDER:
        return 2.0 * float(sizes[:2].min())
    if kind in _ROUND:
        return 2.0 * float(sizes[sizes > 0.0].min())
    extents = _mesh_extents(model, geom)
    return float(extents.min()) if extents is not None else 2.0 * float(model.geom_rbound[geom])


def has_size(model: mujoco.MjModel, geom: int) -> bool:
    """Whether `size_of` says something of a geom: not of a plane."""
    return int(model.geom_type[geom]) != _PLANE and float(model.geom_rbound[geom]) > 0.0


def _mesh_extents(model: mujoco.MjModel, geom: int) -> np.ndarray | None:
    mesh = int(model.geom_dataid[geom])
    if int(model.geom_type[geom]) != int(mujoco.mjtGeom.mjGEOM_MESH) or mesh < 0:
        return None
    start, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    extents: np.ndarray = np.ptp(model.mesh_vert[start : start + count], axis=0)
    return extents


def _sinking(
    model: mujoco.MjModel, data: mujoco.MjData, pairs: Sequence[Mapping[str, Any]]
) -> Iterator[str]:
    """Free bodies that their own weight would press into what they touch, however they lie.

    Of several geoms of a body that counts which sinks least, on what it sinks in most.
    """
    gravity = float(np.linalg.norm(model.opt.gravity))
    found: dict[int, dict[int, tuple[float, float, Mapping[str, Any]]]] = {}
    for pair in pairs:
        for key in ("id_a", "id_b"):
            geom = _geom_of(model, pair, key)
            root = None if geom is None else _free_root(model, int(model.geom_bodyid[geom]))
            if geom is None or root is None or not has_size(model, geom) or gravity == 0.0:
                continue
            weight = gravity * float(model.body_subtreemass[root])
            depth = _depth(model, data, geom, weight / float(pair["stiffness"]))
            each = depth / size_of(model, geom), depth, pair
            of_root = found.setdefault(root, {})
            of_root[geom] = max(of_root.get(geom, each), each, key=lambda one: one[0])
    for of_root in found.values():
        geom = min(of_root, key=lambda one: of_root[one][0])
        share, depth, pair = of_root[geom]
        if share <= SINKS:
            continue
        # A patch that stays flat sinks by load over stiffness; a round one by its square root.
        power = 2.0 if int(model.geom_type[geom]) in _ROUND else 1.0
        enough = float(pair["stiffness"]) * (share / SINKS) ** power
        yield (
            f"{name_of(model, 'geom', geom)} would sink by about {1e3 * depth:.2g} mm, "
            f"{100 * share:.2g} % of its size, under the weight on {_other(model, pair, geom)}: a "
            f"pair of {enough:.1g} N/m^3 (now {float(pair['stiffness']):.1g}) sinks by "
            f"{100 * SINKS:.0f} %"
        )


def _depth(model: mujoco.MjModel, data: mujoco.MjData, geom: int, volume: float) -> float:
    """How deep a solid of its shape goes into a plane until it displaces a volume [m]."""
    kind, sizes = int(model.geom_type[geom]), model.geom_size[geom]
    down = -model.opt.gravity / np.linalg.norm(model.opt.gravity)
    axes = np.abs(data.geom_xmat[geom].reshape(3, 3).T @ down)  # of the geom along the vertical
    if kind in _ROUND:
        return float(np.sqrt(volume / (np.pi * sizes[sizes > 0.0].min())))
    if kind == _BOX:
        across = int(axes.argmax())
        area = 4.0 * float(np.prod(np.delete(sizes, across)))
    elif kind == _CYLINDER and axes[2] > 0.5:
        area = float(np.pi * sizes[0] ** 2)
    elif kind == _CYLINDER:  # lying: a segment, volume 2 L (4/3) sqrt(2 r) d^(3/2)
        return float((0.375 * volume / (sizes[1] * np.sqrt(2.0 * sizes[0]))) ** (2.0 / 3.0))
    else:
        extents = _mesh_extents(model, geom)
        if extents is None:
            return 0.0
        area = float(np.prod(np.delete(extents, int(axes.argmax()))))  # of the box around it
    return volume / area


def creeping_grasps(model: mujoco.MjModel, pairs: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Grasps that friction without memory holds: it creeps under any load."""
    told: dict[tuple[str, str], float] = {}
    for pair in pairs:
        if pair.get("friction_law") != "regularized_coulomb":
            continue
        geoms = [_geom_of(model, pair, key) for key in ("id_a", "id_b")]
        if None in geoms:
            continue
        bodies = [int(model.geom_bodyid[geom]) for geom in geoms if geom is not None]
        for holder, held in (bodies, bodies[::-1]):
            if _is_actuated(model, holder) and _free_root(model, held) not in (
                None,
                _free_root(model, holder),
            ):
                names = name_of(model, "body", holder), name_of(model, "body", held)
                told[names] = float(pair["slip_speed"])
    for (finger, part), slip in told.items():
        yield (
            f"what {finger} holds of {part} creeps: friction_law regularized_coulomb slides under "
            f"any load, up to slip_speed = {slip:g} m/s; elastic_coulomb and bristle hold"
        )


def _millimetres(model: mujoco.MjModel) -> Iterator[str]:
    moving = [
        2.0 * float(model.geom_rbound[geom])
        for geom in range(model.ngeom)
        if model.body_weldid[model.geom_bodyid[geom]] and has_size(model, geom)
    ]
    if moving and min(moving) >= _LARGE:
        yield (
            f"the smallest geom that moves measures {min(moving):.3g} m: if these are millimetres, "
            'divide them by 1000, meshes by scale="0.001 0.001 0.001"; MuJoCo takes metres'
        )


def _geom_of(model: mujoco.MjModel, pair: Mapping[str, Any], key: str) -> int | None:
    geom = int(pair.get(key, -1))
    return geom if 0 <= geom < model.ngeom else None


def _other(model: mujoco.MjModel, pair: Mapping[str, Any], geom: int) -> str:
    ids = int(pair["id_a"]), int(pair["id_b"])
    return name_of(model, "geom", ids[1] if ids[0] == geom else ids[0])


def _free_root(model: mujoco.MjModel, body: int) -> int | None:
    """The body with a free joint that carries a body, or None."""
    root = int(model.body_rootid[body])
    first = int(model.body_jntadr[root])
    return root if first >= 0 and int(model.jnt_type[first]) == _FREE else None


def _is_actuated(model: mujoco.MjModel, body: int) -> bool:
    """Whether an actuator moves a joint of the body or of one that carries it."""
    kinds = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
    driven = {
        int(model.jnt_bodyid[model.actuator_trnid[i][0]])
        for i in range(model.nu)
        if int(model.actuator_trntype[i]) in kinds
    }
    tendons = int(mujoco.mjtTrn.mjTRN_TENDON)
    for i in range(model.nu):
        if int(model.actuator_trntype[i]) == tendons:
            tendon = int(model.actuator_trnid[i][0])
            start, count = int(model.tendon_adr[tendon]), int(model.tendon_num[tendon])
            for wrap in range(start, start + count):
                if int(model.wrap_type[wrap]) == int(mujoco.mjtWrap.mjWRAP_JOINT):
                    driven.add(int(model.jnt_bodyid[model.wrap_objid[wrap]]))
    while body > 0:
        if body in driven:
            return True
        body = int(model.body_parentid[body])
    return False
