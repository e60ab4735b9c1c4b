# SPDX-License-Identifier: Apache-2.0
"""The compiled scene of trials, with what they need of it."""

from __future__ import annotations

import fnmatch

import mujoco
import numpy as np

from volcontact import scene as volumetric_scene
from volcontact.given_keys import GivenKeys
from volcontact.messages.spelling import nearest
from volcontact.running.simulation import native_model
from volcontact.running.watched import Watch
from volcontact.study.ending import Ending
from volcontact.study.file.settings import Settings, StudyError
from volcontact.study.quantities import Quantities, keyframe_id
from volcontact.study.targets import LiveNumbers, Target


class Scene:
    """A compiled model, attached.

    Args:
        settings: of the study.
        text: of the scene.
        targets: of the inputs.

    Attributes:
        model, data: of all trials that this scene serves.
        contact: volumetric, else None.
        live: what of the inputs is changed in the compiled model.
        quantities: the numbers by name.
        watch: of all trials, one after the other.
        ending: reads the row of a trial that has ended.
        key: keyframe that trials start from; negative: none.
    """

    def __init__(self, settings: Settings, text: str, targets: list[Target]) -> None:
        keys = GivenKeys(settings.material or None, settings.options or None)
        self.contact: volumetric_scene.Contact | None = None
        if settings.contact == "native":
            self.model = native_model(text)
        else:
            self.model = volumetric_scene.load(text, material=keys.material, options=keys.options)
        if settings.timestep is not None:
            self.model.opt.timestep = settings.timestep
        self.live = LiveNumbers(self.model, targets)
        if settings.contact != "native":
            self.contact = volumetric_scene.Contact(self.model, keys)
        self._kept = _Kept(self.model) if settings.prepare else None
        self.data = mujoco.MjData(self.model)
        self.quantities = Quantities(self.model, settings.pose)
        places = _members(self.model, settings.record.places)
        self.watch = _watch(settings, self.quantities, places)
        self.ending = Ending(
            settings,
            self.model,
            self.data,
            attached=self.contact is not None,
            quantities=self.quantities,
            places=places,
            watch=self.watch,
        )
        start = "start" if settings.keyframe is None else settings.keyframe
        key = mujoco.mj_name2id(self.model, int(mujoco.mjtObj.mjOBJ_KEY), start)
        if settings.keyframe is not None:
            key = keyframe_id(self.model, start, "[study]")
        self.key = key

    def restore(self) -> None:
        """Undoes what a function of the user changed in the model."""
        if self._kept is not None:
            self._kept.put_back(self.model)

    def close(self) -> None:
        """Detaches the model."""
        if self.contact is not None:
            self.contact.close()


def _watch(settings: Settings, quantities: Quantities, places: np.ndarray) -> Watch:
    end = settings.end
    return Watch(
        success=[quantities.range(each) for each in settings.success],
        hold=settings.hold,
        judged_outside=bool(settings.success_function),
        jammed=[quantities.range(each) for each in end.jammed],
        jam_time=end.jam_time,
        force=[quantities.number(name) for name in end.force],
        torque=[quantities.number(name) for name in end.torque],
        force_limit=end.force_limit,
        torque_limit=end.torque_limit,
        peaks=[quantities.number(what) for _, what in settings.record.peak],
        places=places,
    )


class _Kept:
    """All numbers of a model, to put back what somebody changes."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._arrays = [(array, array.copy()) for array in _arrays(model) + _arrays(model.opt)]
        names = [name for name in dir(model.opt) if not name.startswith("_")]
        options = {name: getattr(model.opt, name) for name in names}
        self._options = {n: v for n, v in options.items() if isinstance(v, int | float)}

    def put_back(self, model: mujoco.MjModel) -> None:
        for array, kept in self._arrays:
            if array.tobytes() != kept.tobytes():
                array[...] = kept
        for name, value in self._options.items():
            if getattr(model.opt, name) != value:
                setattr(model.opt, name, value)


def _arrays(owner: object) -> list[np.ndarray]:
    names = [name for name in dir(owner) if not name.startswith("_")]
    values = [getattr(owner, name) for name in names]
    return [v for v in values if isinstance(v, np.ndarray) and v.dtype.kind in "fiub" and v.size]


def _members(model: mujoco.MjModel, places: tuple[tuple[str, tuple[str, ...]], ...]) -> np.ndarray:
    geom = int(mujoco.mjtObj.mjOBJ_GEOM)
    geoms = [mujoco.mj_id2name(model, geom, i) or "" for i in range(model.ngeom)]
    members = np.zeros((len(places), model.ngeom), bool)
    for row, (name, patterns) in enumerate(places):
        for pattern in patterns:
            found = [i for i, each in enumerate(geoms) if each and fnmatch.fnmatch(each, pattern)]
            if not found:
                hint = nearest(pattern, [each for each in geoms if each])
                raise StudyError(
                    f"[record] places {name} = {pattern!r}: the scene has no such geom{hint}"
                )
            members[row, found] = True
    return members
