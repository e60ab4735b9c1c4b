# SPDX-License-Identifier: Apache-2.0
"""Contact sites and energies of an evaluation, the same of volumetric and of native contact."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any, Protocol

import mujoco
import numpy as np

from volcontact import scene as volumetric_scene
from volcontact.given_keys import GivenKeys
from volcontact.running.recording import SITE, ContactKind
from volcontact.surface import SiteSurface

_COLUMNS = 12  # across a site; a picture of the whole scene shows no more


class Probe(Protocol):
    """Reads contact sites and contact energy of the last evaluation."""

    description: dict[str, Any]

    def sites(self, data: mujoco.MjData) -> np.ndarray:
        """Structured array of `SITE`."""
        ...

    def contacts(self, data: mujoco.MjData, sites: np.ndarray) -> np.ndarray:
        """All contacts: `geom_a`, `geom_b`, `position`, `force` and `torque` as of `SITE`.

        Args:
            data: whose `sites` these are.
            sites: all contacts where there are no others, which then are not evaluated anew.
        """
        ...

    def surfaces(self, data: mujoco.MjData) -> tuple[SiteSurface, ...]:
        """The shape of each site; none under native contact."""
        ...

    def energy(self, data: mujoco.MjData) -> volumetric_scene.Energy:
        """Stored and dissipated; zeros under native contact."""
        ...

    def update_touch(self, data: mujoco.MjData) -> None:
        """Has touch sensors measure this contact, too."""
        ...

    def dropped(self, data: mujoco.MjData) -> int:
        """Evaluations in which a force was no finite number."""
        ...


@contextlib.contextmanager
def probe(contact: ContactKind, model: mujoco.MjModel, keys: GivenKeys) -> Iterator[Probe]:
    """A probe of the kind of contact, which is the model's within the `with` block."""
    if contact == "native":
        yield probe_of(model, None)
        return
    with volumetric_scene.Contact(model, keys) as attached:
        yield probe_of(model, attached)


def probe_of(model: mujoco.MjModel, contact: volumetric_scene.Contact | None) -> Probe:
    """A probe of a model under its own contact, or under a volumetric one that is open."""
    return _NativeProbe(model) if contact is None else _VolumetricProbe(contact)


class _VolumetricProbe:
    def __init__(self, contact: volumetric_scene.Contact) -> None:
        self._contact = contact
        contact._lookout.end()  # a run has its notes
        self.description: dict[str, Any] = dict(contact.description)
        touch = int(mujoco.mjtSensor.mjSENS_TOUCH)
        self._has_touch = bool((contact.model.sensor_type == touch).any())

    def sites(self, data: mujoco.MjData) -> np.ndarray:
        return recorded_sites(self._contact.sites(data))

    def contacts(self, data: mujoco.MjData, sites: np.ndarray) -> np.ndarray:
        return self._contact.contact_forces(data) if data.ncon else sites

    def surfaces(self, data: mujoco.MjData) -> tuple[SiteSurface, ...]:
        count = len(self._contact.sites(data))
        return tuple(self._contact.surface(data, i, resolution=_COLUMNS) for i in range(count))

    def energy(self, data: mujoco.MjData) -> volumetric_scene.Energy:
        return self._contact.energy(data)

    def update_touch(self, data: mujoco.MjData) -> None:
        if self._has_touch:
            self._contact.update_touch(data)

    def dropped(self, data: mujoco.MjData) -> int:
        return int(self._contact.dropped(data))


class _NativeProbe:
    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self.description: dict[str, Any] = {}

    def sites(self, data: mujoco.MjData) -> np.ndarray:
        return native_sites(self._model, data)

    def contacts(self, data: mujoco.MjData, sites: np.ndarray) -> np.ndarray:
        del data
        return sites

    def surfaces(self, data: mujoco.MjData) -> tuple[SiteSurface, ...]:
        del data
        return ()

    def energy(self, data: mujoco.MjData) -> volumetric_scene.Energy:
        del data
        none = volumetric_scene.Channels(0.0, 0.0, 0.0, 0.0)
        return volumetric_scene.Energy(0.0, 0.0, none, none, 0.0, 0.0, 0.0)

    def update_touch(self, data: mujoco.MjData) -> None:
        """MuJoCo has written them."""

    def dropped(self, data: mujoco.MjData) -> int:
        del data
        return 0


def recorded_sites(found: np.ndarray) -> np.ndarray:
    """What a recording keeps of the sites that `Contact.sites` returns: an array of `SITE`."""
    sites = np.zeros(len(found), SITE)
    for name in ("geom_a", "geom_b", "normal", "force", "torque", "area", "depth", "volume"):
        sites[name] = found[name]
    sites["position"] = found["centroid"]
    return sites


def native_sites(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    """MuJoCo's own contacts that push or overlap, as an array of `SITE`."""
    n = data.ncon
    sites = np.zeros(n, SITE)
    if n == 0:
        return sites
    contact = data.contact
    frames = contact.frame[:n].reshape(n, 3, 3)  # rows are axes; the first is the normal
    wrench = np.zeros(6)
    in_frame, turning = np.zeros((n, 3)), np.zeros((n, 3))
    for i in range(n):
        mujoco.mj_contactForce(model, data, i, wrench)
        in_frame[i], turning[i] = wrench[:3], wrench[3:]
    sites["geom_a"] = contact.geom1[:n]
    sites["geom_b"] = contact.geom2[:n]
    sites["position"] = contact.pos[:n]
    # MuJoCo's normal points from geom 1 to geom 2 and its force is the one on geom 2.
    sites["normal"] = -frames[:, 0]
    sites["force"] = -np.einsum("nij,ni->nj", frames, in_frame)
    sites["torque"] = -np.einsum("nij,ni->nj", frames, turning)
    sites["depth"] = np.maximum(-contact.dist[:n], 0.0)
    # Inside its margin MuJoCo lists a contact that does not push yet: that is no contact.
    return sites[(sites["depth"] > 0.0) | np.any(in_frame != 0.0, axis=1)]
