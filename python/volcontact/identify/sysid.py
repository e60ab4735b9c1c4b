# SPDX-License-Identifier: Apache-2.0
"""Our parameters in `mujoco.sysid`, MuJoCo's own toolbox for identification.

    from mujoco import sysid
    from volcontact.identify.sysid import parameter, values, with_volumetric_contact

    spec = with_volumetric_contact(mujoco.MjSpec.from_file("scene.xml"))
    params = sysid.ParameterDict()
    params.add(parameter("k", "volcontact/pair/p/stiffness", 1e7, 1e6, 1e8, log=True))

The contact is MuJoCo's engine plugin, so that models that the toolbox compiles have it by
themselves, in its threads as well.
"""

from __future__ import annotations

import importlib
import math
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from volcontact.identify.reading import read_settings
from volcontact.identify.settings import StudyError

__all__ = ["parameter", "parameters", "values", "with_volumetric_contact"]

_PLUGIN = "volcontact"
# Attributes of MJCF that MjSpec calls otherwise.
_INERTIAL = {"pos": "ipos", "quat": "iquat", "mass": "mass", "diaginertia": "inertia"}


def toolbox() -> Any:
    """The module `mujoco.sysid`.

    Raises:
        ModuleNotFoundError: this MuJoCo has none, or what it needs is not installed.
    """
    try:
        sysid = importlib.import_module("mujoco.sysid")  # its types would ask for those of MuJoCo
    except ImportError as error:
        raise ModuleNotFoundError(
            f"MuJoCo {mujoco.__version__} has no mujoco.sysid: MuJoCo 4 has it; or take "
            "volcontact.identify"
        ) from error
    if not hasattr(sysid, "Parameter"):
        raise ModuleNotFoundError(
            "mujoco.sysid lacks what it needs: pip install 'mujoco[sysid]'", name="mujoco.sysid"
        )
    return sysid


def with_volumetric_contact(spec: Any) -> Any:
    """Adds the engine plugin to an `mujoco.MjSpec` that has none.

    Returns:
        The spec.
    """
    if not any(plugin.plugin_name == _PLUGIN for plugin in spec.plugins):
        spec.activate_plugin(_PLUGIN)
        spec.add_plugin(name="contact", plugin_name=_PLUGIN, active=True)
    return spec


def parameter(
    name: str, target: str, nominal: float, low: float, high: float, *, log: bool = False
) -> Any:
    """A `mujoco.sysid.Parameter` that goes to a place of the scene.

    Args:
        name: of it.
        target: `volcontact/...`, `option/NAME`, `ELEMENT/NAME/ATTRIBUTE` with `/INDEX` where one is
            meant, as in studies; an `inertial` goes by the name of its body.
        nominal: first guess, in the unit of the target.
        low: bound.
        high: bound.
        log: whether the toolbox sees the logarithm, which parameters over decades need; `values`
            gives the number back.

    Raises:
        ModuleNotFoundError: as of `toolbox`.
        StudyError: bounds or target are wrong; of a target that the scene does not have when the
            toolbox compiles.
    """
    if not low < high or not low <= nominal <= high or (log and low <= 0.0):
        raise StudyError(
            f"parameter {name!r}: {low:g} <= {nominal:g} <= {high:g} does not hold"
            if not log or low > 0.0
            else f"parameter {name!r}: low = {low:g} must be above 0 on a logarithmic scale"
        )
    numbers = [math.log(x) if log else x for x in (nominal, low, high)]
    return _made(name, (target,), numbers, log)


def _made(name: str, targets: tuple[str, ...], numbers: list[float], log: bool) -> Any:
    def write(spec: Any, given: Any) -> None:
        x = float(np.ravel(given.value)[0])
        for target in targets:
            _write(spec, target, math.exp(x) if log else x)

    made = toolbox().Parameter(name, *numbers, modifier=write)
    made.is_logarithm = log
    return made


def parameters(path: str | Path) -> Any:
    """All parameters of an identification file, as a `mujoco.sysid.ParameterDict`.

    Raises:
        ModuleNotFoundError: as of `toolbox`.
        FileNotFoundError: there is no such file.
        StudyError: the file is wrong, or a parameter is a multiple of another, or adds or scales.
    """
    found = toolbox().ParameterDict()
    for each in read_settings(path).parameters:
        if each.times or each.mode != "set":
            raise StudyError(f"[parameter.{each.name}]: only mode = 'set' goes to mujoco.sysid")
        middle = math.sqrt(each.low * each.high) if each.log else 0.5 * (each.low + each.high)
        begin = middle if each.start is None else each.start
        numbers = [math.log(x) if each.log else x for x in (begin, each.low, each.high)]
        found.add(_made(each.name, each.targets, numbers, each.log))
    return found


def values(params: Any) -> dict[str, float]:
    """The numbers of a `ParameterDict` by name, in the units of their targets."""
    return {
        name: math.exp(float(each.value[0]))
        if getattr(each, "is_logarithm", False)
        else float(each.value[0])
        for name, each in params.items()
    }


def _write(spec: Any, target: str, value: float) -> None:
    """Writes a number to a spec."""
    parts = target.split("/")
    index = int(parts.pop()) if parts[-1].isdecimal() else None
    name = "/".join(parts)
    if parts[0] == "volcontact":
        found = spec.numeric(name)
        if found is None:
            raise StudyError(f"target {target!r}: the scene has no such number")
        numbers = list(found.data)
        numbers[index or 0] = value
        found.data = numbers
        return
    if parts[0] == "option" and len(parts) == 2:
        _set(spec.option, parts[1], index, value, target)
        return
    if len(parts) != 3:
        raise StudyError(
            f"target {target!r}: must be volcontact/..., option/NAME or ELEMENT/NAME/ATTRIBUTE"
        )
    tag, owner, key = parts
    is_inertial = tag == "inertial"
    find = getattr(spec, "body" if is_inertial else tag, None)
    element = find(owner) if callable(find) else None
    if element is None:
        raise StudyError(f"target {target!r}: the scene has no {tag} {owner!r}")
    _set(element, _INERTIAL.get(key, key) if is_inertial else key, index, value, target)


def _set(element: Any, key: str, index: int | None, value: float, target: str) -> None:
    if not hasattr(element, key):
        raise StudyError(f"target {target!r}: there is no attribute {key!r}")
    if index is None:
        setattr(element, key, value)
    else:
        getattr(element, key)[index] = value
