# SPDX-License-Identifier: Apache-2.0
"""Volumetric contact in MuJoCo scenes: load a model, attach to it, read sites and energy."""

from __future__ import annotations

import ctypes
import json
import os
import sys
import warnings
from typing import Any, NamedTuple

import mujoco
import numpy as np

from volcontact._adaptor import CONTACT_DTYPE, SITE_DTYPE, RawEnergy, RawSurfaceSize, adaptor
from volcontact._closing import Closing
from volcontact.compiling import compile_scene
from volcontact.given_keys import GivenKeys, Values, refuse
from volcontact.lookout import Lookout
from volcontact.messages.names import name_of
from volcontact.messages.spelling import nearest
from volcontact.surface import SiteSurface
from volcontact.wrenches import wrench_on

_TOLD_OF_CONTACTS = [name for name in CONTACT_DTYPE.names or () if name != "reserved"]


class Wrench(NamedTuple):
    """A force and its torque.

    Attributes:
        force: [N], world frame, shape (3,).
        torque: [N m], world frame, about `point`, shape (3,).
        point: [m], world frame, shape (3,).
    """

    force: np.ndarray
    torque: np.ndarray
    point: np.ndarray


class Channels(NamedTuple):
    """One number for each way in which a contact dissipates."""

    normal: float
    roll: float
    slide: float
    spin: float


class Energy(NamedTuple):
    """Energies of a scene at the last evaluation.

    `work + elastic + dissipated + numerical - driven` keeps the value that `elastic` had at the
    start, and kinetic + potential energy less `work` keeps its value where nothing else does work,
    up to the integrator's error.

    Attributes:
        elastic: stored in the contacts [J].
        dissipated: by the contacts since the start of the simulation [J].
        by_channel: the same, channel by channel [J].
        power: dissipated at that instant, channel by channel [W].
        work: done on the scene by the contact forces, those written to the target array, since
            the start [J].
        numerical: what of -work is neither stored nor dissipated [J]; made by the finite step, it
            vanishes with it. Negative where a step gives energy to the motion, such as what it
            lends a body that comes to rest.
        unpaid: what the laws would hold besides `elastic`, in overlaps that no motion made [J]; no
            body gets it back.
        driven: work that mocap bodies did on the contacts since the start [J].
        made: what the contacts did and stored in the last step, less what mocap bodies did on them,
            what was lent and what was released [J]: the audit of a step. Contact takes energy, so
            it is negative, up to what an explicit step errs by.
        released: to bodies that part slowly, of what had been dissipated, since the start [J]: what
            it takes to bring bodies out of an overlap that no motion made.
        owed: lent by finite steps, as to a body that comes to rest, and not given back yet [J].
    """

    elastic: float
    dissipated: float
    by_channel: Channels
    power: Channels
    work: float
    numerical: float
    unpaid: float
    driven: float = 0.0
    made: float = 0.0
    released: float = 0.0
    owed: float = 0.0


def load(
    path_or_xml_text: str | os.PathLike[str],
    *,
    material: Values | None = None,
    options: Values | None = None,
) -> mujoco.MjModel:
    """Loads a scene with room in `mjData.userdata` for volumetric contact.

    Works on every MuJoCo release; the model steps in plain MuJoCo as well. Room that the file
    itself asks for with `<size nuserdata=.../>` stays the user's, in front of ours.

    Args:
        path_or_xml_text: path of an MJCF (or URDF, or .mjb) file, or MJCF text.
        material: what `attach` will be given; it may take more room.
        options: likewise.

    Raises:
        TypeError: neither path nor text.
        FileNotFoundError: there is no such file.
        ValueError: MuJoCo cannot compile it, or a `volcontact/...` key is wrong; the message names
            the key, the allowed range and the nearest valid spelling.
        RuntimeError: the package has no adaptor for this MuJoCo.
    """
    if not isinstance(path_or_xml_text, (str, os.PathLike)):
        raise TypeError(f"load takes a path or MJCF text, got {type(path_or_xml_text).__name__}")
    keys = GivenKeys(material, options)
    library = adaptor()
    model = compile_scene(os.fspath(path_or_xml_text))
    library.call("reserve_with", model._address, *keys.arguments)
    return model


def attach(
    model: mujoco.MjModel,
    *,
    material: Values | None = None,
    options: Values | None = None,
    **others: Any,
) -> Contact:
    """Makes the contact of a model volumetric, in all its data, until it is closed.

    Turns native contact off and installs the passive callback; a callback that was there before
    keeps being called. Several models may be attached at a time, each until its own `close`.

    Any model will do. One from `load` has room for volcontact's state in `mjData.userdata`. One
    without a `volcontact/...` key and without room has it beside its data, and the target
    `passive`: docs/plugin.md, "Models without room".

    Args:
        model: to attach.
        material: of all geoms that have none by the file, `{"stiffness": 1e9, "friction": 0.4,
            "friction_law": "bristle"}`; docs/writing_a_scene.md, "Materials".
        options: before those of the file, `{"tolerance": 1e-4, "mesh": "hull"}`;
            docs/writing_a_scene.md, "Options".
        **others: refused, with where they belong.

    Returns:
        A context manager that closes at exit.

    The first readings (`sites`, `energy`, `force_on`, ...) warn, once each, of bodies that rest
    deep in each other and of grasps that friction without memory lets creep.

    Raises:
        TypeError: not an MjModel, an argument that there is not, or a value that is neither number
            nor word.
        ValueError: a `volcontact/...` key is wrong, userdata is too small for the keys of the file,
            the model is attached already, or it uses what volumetric contact cannot serve.
        RuntimeError: the package has no adaptor for this MuJoCo.
    """
    if not isinstance(model, mujoco.MjModel):
        raise TypeError(f"attach takes a mujoco.MjModel, got {type(model).__name__}")
    refuse("attach", others)
    return Contact(model, GivenKeys(material, options))


def contact_forces(data: mujoco.MjData) -> np.ndarray:
    """All contacts of data of an attached model, volumetric and MuJoCo's own.

    Returns:
        Structured array as of `Contact.contact_forces`.

    Raises:
        TypeError: not an MjData.
        ValueError: no attached model, or more than one, has data of this size; then ask the
            `Contact` itself.
    """
    if not isinstance(data, mujoco.MjData):
        raise TypeError(f"contact_forces takes a mujoco.MjData, got {type(data).__name__}")
    fitting = [contact for contact in Contact._open.values() if contact._fits(data)]
    if len(fitting) != 1:
        count = "no attached model has" if not fitting else f"{len(fitting)} attached models have"
        raise ValueError(f"{count} data of this size: call contact_forces of what attach returned")
    return fitting[0].contact_forces(data)


class Contact(Closing):
    """Volumetric contact of one model; made by `attach`."""

    # An attached model stays attached, and alive, until `close`, whoever forgets the object.
    _open: dict[int, Contact] = {}  # noqa: RUF012

    def __init__(self, model: mujoco.MjModel, keys: GivenKeys) -> None:
        self._adaptor = adaptor()
        self._model = model
        self._sites = np.empty(64, SITE_DTYPE)
        self._reported = ""
        self._lookout = Lookout(model, lambda: self.description["pairs"])
        _, text = self._adaptor.call_with_message("attach_with", model._address, *keys.arguments)
        Contact._open[model._address] = self
        for warning in text.splitlines():
            warnings.warn(warning, RuntimeWarning, stacklevel=3)

    @property
    def model(self) -> mujoco.MjModel:
        """The attached model."""
        return self._model

    @property
    def is_open(self) -> bool:
        """Whether the model is attached, by this object."""
        return Contact._open.get(self._model._address) is self

    def close(self) -> None:
        """Restores native contact, and the callback when this was the last attached model.

        Data that go on under native contact should be given to `release` first. Closing twice does
        nothing.
        """
        if not self.is_open:
            return
        del Contact._open[self._model._address]
        self._adaptor.call("detach", self._model._address)

    def is_installed(self) -> bool:
        """Whether MuJoCo calls this contact: open, and the passive callback is ours.

        A `mujoco.set_mjcb_passive` after `attach` silently drops ours.
        """
        return self.is_open and bool(self._adaptor.call("is_installed"))

    @property
    def description(self) -> dict[str, Any]:
        """What was understood of the scene.

        `options`, `userdata`, `materials`, `solids`, `pairs` with the values they use and where
        these come from, and `warnings`.
        """
        text = self._adaptor.text("describe", self._require_open()._address)
        description: dict[str, Any] = json.loads(text.rstrip("\0"))
        return description

    def _pair_text(self, pair: int) -> str:
        """The contact model of a pair of the description, in the frames of its geoms."""
        return self._adaptor.text("pair_text", self._require_open()._address, pair)

    def sites(self, data: mujoco.MjData) -> np.ndarray:
        """Contact sites at the state of the last evaluation.

        After `mj_step` that is the state the step began with (under RK4 its last stage); call
        `mj_forward` for the present state.

        Returns:
            Structured array, one row a connected region of overlap, shape (0,) when all is apart.
            Vectors have shape (3,) and are in the world frame. Fields: `pair` (`geom_a * ngeom +
            geom_b`, as in `description["pairs"]`), `geom_a`, `geom_b`, `volume` [m^3], `centroid`
            of the volume [m], `normal` (on a, from b to a), `area` of the patch projected along
            the normal [m^2], `depth` of the volume along the normal [m], `force` on a [N],
            `torque` on a about the centroid [N m], `normal_force` [N], `slip` [m/s], `spin`
            [rad/s], `elastic_energy` [J], `flatness` [-], `volume_error` [m^3], `status` (0 is
            good).
        """
        model = self._require_open()
        self._check(data)
        return self._read_sites(model, data)

    def _read_sites(self, model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
        while True:
            count = self._adaptor.call(
                "sites", model._address, data._address, self._sites.ctypes.data, len(self._sites)
            )
            if count <= len(self._sites):
                return self._sites[:count].copy()
            self._sites = np.empty(2 * count, SITE_DTYPE)

    def surface(self, data: mujoco.MjData, site: int, *, resolution: int = 24) -> SiteSurface:
        """The shape of one contact site at the state of the last evaluation, for pictures.

        Args:
            data: of the attached model.
            site: row of `sites(data)`.
            resolution: columns across the site, from 2 to 256; twice as many take four times as
                long.

        Raises:
            ValueError: there is no such site, or the resolution is out of range.
        """
        model = self._require_open()
        self._check(data)
        count = len(self.sites(data))
        for name, value in (("site", site), ("resolution", resolution)):
            if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
                raise TypeError(
                    f"{name} takes a whole number, got {type(value).__name__} {value!r}"
                )
        if count == 0:
            raise ValueError(f"site = {site}: nothing touches, so there are no sites")
        if not 0 <= site < count:
            raise ValueError(
                f"site = {site} must be from 0 to {count - 1}: there are {count} sites"
            )
        if not 2 <= resolution <= 256:
            raise ValueError(f"resolution = {resolution} must be from 2 to 256")
        nodes = (resolution + 1) ** 2
        columns = np.empty((3 * nodes, 2, 3))
        triangles, rim = np.empty((4 * nodes, 3), np.int32), np.empty((2 * nodes, 2), np.int32)
        size = RawSurfaceSize()
        pointers = (array.ctypes.data for array in (columns, triangles, rim))
        self._adaptor.call(
            "site_surface",
            model._address,
            data._address,
            site,
            resolution,
            *pointers,
            ctypes.byref(size),
        )
        return SiteSurface(
            low=columns[: size.columns, 0].copy(),
            high=columns[: size.columns, 1].copy(),
            triangles=triangles[: size.triangles].copy(),
            rim=rim[: size.rim].copy(),
        )

    def contact_forces(self, data: mujoco.MjData) -> np.ndarray:
        """All contacts at the state of the last evaluation, volumetric and MuJoCo's own.

        The same for every target, and what to read in a mixed scene.

        Returns:
            Structured array, one row a contact. Vectors have shape (3,) and are in the world
            frame. Fields: `geom_a`, `geom_b` (-1 for a flex), `is_native`, `position` [m] (centroid
            of the overlap, or MuJoCo's contact point), `normal` (on a, from b to a), `force` on a
            [N], `torque` on a about the position [N m], `normal_force` [N].
        """
        model = self._require_open()
        self._check(data)
        rows = np.empty(64, CONTACT_DTYPE)
        while True:
            count = self._adaptor.call(
                "contacts", model._address, data._address, rows.ctypes.data, len(rows)
            )
            if count <= len(rows):
                return rows[:count][_TOLD_OF_CONTACTS].copy()
            rows = np.empty(count, CONTACT_DTYPE)

    def force_on(self, data: mujoco.MjData, name: str) -> Wrench:
        """The contact force on a body or a geom at the state of the last evaluation, signed.

        The sum over all contacts, volumetric and MuJoCo's own, of what acts on the geoms of the
        body itself, not on those of its children, or on the geom alone. A box at rest on a floor
        feels (0, 0, m g). The same for every target.

        Args:
            data: of the attached model.
            name: of a body or of a geom (`geom 3` where it has none); where both have it, of the
                body.

        Returns:
            Force [N] and torque [N m] in the world frame, the torque about the centre of mass of
            the body, or the centre of the geom, which is `point`.

        Raises:
            ValueError: there is no body or geom of that name.
        """
        model = self._require_open()
        self._check(data)
        bodies = [name_of(model, "body", i) for i in range(model.nbody)]
        geoms = [name_of(model, "geom", i) for i in range(model.ngeom)]
        if name in bodies:
            body = bodies.index(name)
            members, point = model.geom_bodyid == body, data.xipos[body].copy()
        elif name in geoms:
            geom = geoms.index(name)
            members, point = np.arange(model.ngeom) == geom, data.geom_xpos[geom].copy()
        else:
            known = {*bodies, *geoms}
            raise ValueError(f"the scene has no body or geom {name!r}{nearest(str(name), known)}")
        wrench = wrench_on(self.contact_forces(data), members, point)
        return Wrench(wrench[:3], wrench[3:], point)

    def update_touch(self, data: mujoco.MjData) -> None:
        """Writes what touch sensors measure into `data.sensordata`.

        MuJoCo's touch sensors see native contacts only, under every target. Call this after
        `mj_step` or `mj_forward`, before `sensordata` is read; like all sensors they then belong to
        the state of the last evaluation. The rule is MuJoCo's: normal forces on the body of the
        sensor's site whose ray, outward from the contact, meets the site.
        """
        model = self._require_open()
        self._check(data)
        self._adaptor.call("update_touch", model._address, data._address)

    def energy(self, data: mujoco.MjData) -> Energy:
        """Energies at the last evaluation; the account starts anew when the data is reset."""
        raw = self._raw_energy(data)
        dissipated = Channels(*raw.dissipated)
        power = Channels(*raw.power)
        return Energy(
            raw.elastic,
            sum(dissipated),
            dissipated,
            power,
            raw.work,
            raw.numerical,
            raw.unpaid,
            raw.driven,
            raw.made,
            raw.released,
            raw.owed,
        )

    def dropped(self, data: mujoco.MjData) -> int:
        """How many evaluations had a force that was no finite number; such forces are left out."""
        return int(self._raw_energy(data).dropped)

    def forgotten(self, data: mujoco.MjData) -> int:
        """How many evaluations had more contact sites than userdata keeps.

        The friction of the sites beyond that began anew, as at a first touch.
        """
        return int(self._raw_energy(data).forgotten)

    def release(self, data: mujoco.MjData) -> None:
        """Takes the contact forces out of `data.qfrc_applied` (or `xfrc_applied`).

        What remains is what the user wrote. The next step puts them back in while the model is
        attached; for data that go on under native contact this is the last act before `close`.
        """
        model = self._require_open()
        self._check(data)
        self._adaptor.call("release", model._address, data._address)

    def live_error(self) -> str:
        """Why numbers that were changed in the model are not in force; empty when they are."""
        return self._adaptor.text("live_error", self._require_open()._address)

    def _raw_energy(self, data: mujoco.MjData) -> RawEnergy:
        model = self._require_open()
        self._check(data)
        raw = RawEnergy()
        self._adaptor.call("get_energy", model._address, data._address, ctypes.byref(raw))
        return raw

    def _require_open(self) -> mujoco.MjModel:
        if not self.is_open:
            raise ValueError("this contact is closed")
        return self._model

    def _check(self, data: mujoco.MjData) -> None:
        """The data fit the model; warns when numbers changed in the model are not valid."""
        if not isinstance(data, mujoco.MjData):
            raise TypeError(f"data takes a mujoco.MjData, got {type(data).__name__}")
        if not self._fits(data):
            raise ValueError("the data are not of the attached model")
        if not self._adaptor.call("is_installed"):
            self._report(
                "MuJoCo's passive callback was replaced: volumetric contact no longer acts"
            )
        if self._adaptor.call("live_error", self._model._address, None, 0):
            self._report(f"the last valid numbers stay in force: {self.live_error()}")
        if not self._lookout.is_over and self._lookout.is_time(data):
            for line in self._lookout.look(data, self._read_sites(self._model, data)):
                warnings.warn(line, RuntimeWarning, stacklevel=_out_of_here())

    def _fits(self, data: mujoco.MjData) -> bool:
        model = self._model
        sizes = (data.qpos.size, data.qvel.size, len(data.geom_xpos), data.userdata.size)
        return sizes == (model.nq, model.nv, model.ngeom, model.nuserdata)

    def _report(self, text: str) -> None:
        if text == self._reported:
            return
        self._reported = text
        warnings.warn(text, RuntimeWarning, stacklevel=4)


def _out_of_here() -> int:
    """Which `stacklevel` is the first outside of this file, for who asks."""
    level, frame = 2, sys._getframe(2)
    while frame.f_code.co_filename == __file__ and frame.f_back is not None:
        level, frame = level + 1, frame.f_back
    return level
