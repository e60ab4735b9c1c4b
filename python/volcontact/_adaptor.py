# SPDX-License-Identifier: Apache-2.0
"""The adaptor library of the MuJoCo that runs, called through ctypes.

One small library per MuJoCo release, `libvolcontact_mujoco-<release>.so`, with the plain C
interface of plugin/adaptor/volcontact_mujoco.h.
"""

from __future__ import annotations

import ctypes
import functools
import importlib.util
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import mujoco  # first: then the process has one copy of libmujoco
import numpy as np

from volcontact import _adaptor_build

# Keys of a material that a program gives; no tuple of a file has this name.
GIVEN_MATERIAL = "volcontact/material/given/"

SITE_DTYPE = np.dtype(
    [
        ("pair", "i8"),
        ("geom_a", "i4"),
        ("geom_b", "i4"),
        ("status", "i4"),
        ("volume", "f8"),
        ("centroid", "f8", (3,)),
        ("normal", "f8", (3,)),
        ("area", "f8"),
        ("depth", "f8"),
        ("force", "f8", (3,)),
        ("torque", "f8", (3,)),
        ("normal_force", "f8"),
        ("slip", "f8"),
        ("spin", "f8"),
        ("elastic_energy", "f8"),
        ("flatness", "f8"),
        ("volume_error", "f8"),
    ],
    align=True,
)

CONTACT_DTYPE = np.dtype(
    [
        ("geom_a", "i4"),
        ("geom_b", "i4"),
        ("is_native", "i4"),
        ("reserved", "i4"),
        ("position", "f8", (3,)),
        ("normal", "f8", (3,)),
        ("force", "f8", (3,)),
        ("torque", "f8", (3,)),
        ("normal_force", "f8"),
    ],
    align=True,
)

_ERROR_VERSION = -2
_ERROR_STATE = -3
_ERROR_INTERNAL = -4
_ERROR_MEMORY = -5
_MESSAGE_SIZE = 4096
_PREFIX, _SUFFIX = "libvolcontact_mujoco-", ".so"


class RawEnergy(ctypes.Structure):
    """`volcontact_energy`."""

    _fields_ = (
        ("elastic", ctypes.c_double),
        ("dissipated", ctypes.c_double * 4),
        ("power", ctypes.c_double * 4),
        ("dropped", ctypes.c_double),
        ("forgotten", ctypes.c_double),
        ("work", ctypes.c_double),
        ("numerical", ctypes.c_double),
        ("unpaid", ctypes.c_double),
        ("driven", ctypes.c_double),
        ("made", ctypes.c_double),
        ("released", ctypes.c_double),
        ("owed", ctypes.c_double),
    )


class RawSurfaceSize(ctypes.Structure):
    """`volcontact_surface_size`."""

    _fields_ = (("columns", ctypes.c_int), ("triangles", ctypes.c_int), ("rim", ctypes.c_int))


class Number(ctypes.Structure):
    """`volcontact_number`: a number of a running scene."""

    _fields_ = (
        ("kind", ctypes.c_int),
        ("index", ctypes.c_int),
        ("place", ctypes.c_double * 4),
    )


class Range(ctypes.Structure):
    """`volcontact_range`: a number and its bounds, both included."""

    _fields_ = (("number", Number), ("low", ctypes.c_double), ("high", ctypes.c_double))


class RawWatch(ctypes.Structure):
    """`volcontact_watch`."""

    _fields_ = (
        ("success", ctypes.POINTER(Range)),
        ("jammed", ctypes.POINTER(Range)),
        ("peak_numbers", ctypes.POINTER(Number)),
        ("place_members", ctypes.c_void_p),
        ("peaks", ctypes.c_void_p),
        ("place_forces", ctypes.c_void_p),
        ("place_peaks", ctypes.c_void_p),
        ("success_count", ctypes.c_int),
        ("jammed_count", ctypes.c_int),
        ("peak_count", ctypes.c_int),
        ("place_count", ctypes.c_int),
        ("has_force", ctypes.c_int),
        ("has_torque", ctypes.c_int),
        ("force_axes", Number * 3),
        ("torque_axes", Number * 3),
        ("force_limit", ctypes.c_double),
        ("torque_limit", ctypes.c_double),
        ("hold", ctypes.c_double),
        ("jam_time", ctypes.c_double),
        ("judged_outside", ctypes.c_int),
        ("outcome", ctypes.c_int),
        ("is_good", ctypes.c_int),
        ("geom_a", ctypes.c_int),
        ("geom_b", ctypes.c_int),
        ("reserved", ctypes.c_int),
        ("sites", ctypes.c_double),
        ("force", ctypes.c_double),
        ("torque", ctypes.c_double),
        ("site_force", ctypes.c_double),
        ("peak_force", ctypes.c_double),
        ("peak_torque", ctypes.c_double),
        ("peak_site_force", ctypes.c_double),
        ("most_sites", ctypes.c_double),
        ("first_touch", ctypes.c_double),
        ("good_since", ctypes.c_double),
        ("jammed_since", ctypes.c_double),
    )


class Key(ctypes.Structure):
    """`volcontact_key`."""

    _fields_ = (
        ("name", ctypes.c_char_p),
        ("numbers", ctypes.POINTER(ctypes.c_double)),
        ("count", ctypes.c_int),
    )


def record_sizes() -> dict[str, int]:
    """How long the records of the C interface are here, by their names there [bytes]."""
    structures = {
        "volcontact_energy": RawEnergy,
        "volcontact_surface_size": RawSurfaceSize,
        "volcontact_key": Key,
        "volcontact_number": Number,
        "volcontact_range": Range,
        "volcontact_watch": RawWatch,
    }
    arrays = {"volcontact_site": SITE_DTYPE, "volcontact_contact": CONTACT_DTYPE}
    sizes = {name: ctypes.sizeof(structure) for name, structure in structures.items()}
    return sizes | {name: dtype.itemsize for name, dtype in arrays.items()}


class _Signature(NamedTuple):
    arguments: tuple[Any, ...]
    has_message: bool = False


_WITH_KEYS = _Signature((ctypes.c_void_p, ctypes.POINTER(Key), ctypes.c_int), has_message=True)
_SIGNATURES = {
    "mujoco_version": _Signature(()),
    "record_size": _Signature((ctypes.c_char_p,)),
    "check_version": _Signature((), has_message=True),
    "userdata_size_with": _WITH_KEYS,
    "reserve_with": _WITH_KEYS,
    "attach_with": _WITH_KEYS,
    "detach": _Signature((ctypes.c_void_p,), has_message=True),
    "is_attached": _Signature((ctypes.c_void_p,)),
    "is_installed": _Signature(()),
    "release": _Signature((ctypes.c_void_p, ctypes.c_void_p)),
    "sites": _Signature((ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int)),
    "contacts": _Signature((ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int)),
    "site_surface": _Signature(
        (
            ctypes.c_void_p,
            ctypes.c_void_p,
            ctypes.c_int,
            ctypes.c_int,
            ctypes.c_void_p,
            ctypes.c_void_p,
            ctypes.c_void_p,
            ctypes.POINTER(RawSurfaceSize),
        )
    ),
    "update_touch": _Signature((ctypes.c_void_p, ctypes.c_void_p)),
    "get_energy": _Signature((ctypes.c_void_p, ctypes.c_void_p, ctypes.POINTER(RawEnergy))),
    "step_watched": _Signature(
        (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int, ctypes.POINTER(RawWatch))
    ),
    "read_numbers": _Signature(
        (
            ctypes.c_void_p,
            ctypes.c_void_p,
            ctypes.POINTER(RawWatch),
            ctypes.POINTER(Number),
            ctypes.c_int,
            ctypes.c_void_p,
        )
    ),
    "describe": _Signature((ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int), has_message=True),
    "pair_text": _Signature(
        (ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_int), has_message=True
    ),
    "live_error": _Signature((ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int)),
}


class Adaptor:
    """The functions of one library; what they report as an error is raised.

    Attributes:
        path: of the library.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._library = ctypes.CDLL(str(path))
        self._functions: dict[str, Callable[..., int]] = {}
        for name, signature in _SIGNATURES.items():
            try:
                function = getattr(self._library, f"volcontact_{name}")
            except AttributeError:
                raise RuntimeError(
                    f"{path} is no library of this volcontact: it lacks volcontact_{name}; "
                    "build it again"
                ) from None
            function.restype = ctypes.c_int
            message = (ctypes.c_char_p, ctypes.c_int) if signature.has_message else ()
            function.argtypes = (*signature.arguments, *message)
            self._functions[name] = function
        self.call("check_version")
        for name, size in record_sizes().items():
            theirs = self.call("record_size", name.encode())
            if theirs != size:
                raise RuntimeError(
                    f"{path} is no library of this volcontact: its {name} has {theirs} bytes and "
                    f"that of the package {size}; build it again"
                )

    @property
    def passive(self) -> Any:
        """The passive callback, as `mujoco.set_mjcb_passive` takes it."""
        return self._library.volcontact_passive

    def function(self, name: str) -> Callable[..., int]:
        """A function without a message; it fails where memory or the right library is missing."""
        native = self._functions[name]

        def checked(*arguments: Any) -> int:
            return _checked(name, native(*arguments), "")

        return checked

    def call(self, name: str, *arguments: Any) -> int:
        """Calls a function and returns its result, at least 0."""
        return self.call_with_message(name, *arguments)[0]

    def call_with_message(self, name: str, *arguments: Any) -> tuple[int, str]:
        """Calls a function and returns its result and its message.

        Raises:
            ValueError: the scene, or the state of the model, does not allow it.
            RuntimeError: the library does not fit, or failed.
            MemoryError: there was too little memory; nothing was changed.
        """
        if not _SIGNATURES[name].has_message:
            result = self._functions[name](*arguments)
            message = ""
        else:
            buffer = ctypes.create_string_buffer(_MESSAGE_SIZE)
            result = self._functions[name](*arguments, buffer, _MESSAGE_SIZE)
            message = buffer.value.decode("utf-8", "replace")
        return _checked(name, result, message), message

    def text(self, name: str, *arguments: Any) -> str:
        """Calls a function that writes a text of any length."""
        length = self.call(name, *arguments, None, 0)
        if length == 0:
            return ""
        buffer = ctypes.create_string_buffer(length + 1)
        self.call(name, *arguments, buffer, length + 1)
        return buffer.value.decode("utf-8", "replace")


def _checked(name: str, result: int, message: str) -> int:
    """The result of a function, unless it is an error."""
    if result >= 0:
        return result
    if result == _ERROR_MEMORY:
        raise MemoryError(f"volcontact: out of memory in {name}; nothing was changed")
    if result in (_ERROR_VERSION, _ERROR_INTERNAL):
        raise RuntimeError(f"volcontact: {message or name + ' failed'}")
    if result == _ERROR_STATE and not message:
        message = "the model is not attached"
    raise ValueError(_in_words_of_python(message))


def _in_words_of_python(message: str) -> str:
    """A message about a key of `material`, which no file has, as Python spells it."""
    message = re.sub(rf"after '{GIVEN_MATERIAL}(\w+)/' comes", r"material['\1'] takes", message)
    message = message.replace(f"after '{GIVEN_MATERIAL}' comes", "material takes")
    message = re.sub(rf"{GIVEN_MATERIAL}(\w+)", r"material['\1']", message)
    return message.replace(GIVEN_MATERIAL.rstrip("/"), "material")


@functools.cache
def adaptor() -> Adaptor:
    """The adaptor for the MuJoCo that was imported.

    The environment variable VOLCONTACT_ADAPTOR names another library in its place: one with laws of
    your own, docs/own_laws.md.

    Raises:
        RuntimeError: the package has none for this release and cannot compile one, or it is broken.
    """
    return Adaptor(library_path())


def library_path(*, may_compile: bool = True) -> Path:
    """The library that serves the MuJoCo that was imported.

    Raises:
        RuntimeError: the package has none, and cannot or may not compile one.
    """
    own = os.environ.get("VOLCONTACT_ADAPTOR")
    if own:
        return Path(own)
    wanted = f"{_PREFIX}{mujoco.__version__}{_SUFFIX}"
    folders = _library_folders()
    for folder in folders:
        if (folder / wanted).is_file():
            return folder / wanted
    reason = "nothing was compiled"
    if may_compile:
        try:
            return _adaptor_build.build(wanted, folders[0] / "source")
        except (RuntimeError, OSError) as error:
            reason = str(error)
    present = sorted(
        path.name.removeprefix(_PREFIX).removesuffix(_SUFFIX)
        for folder in folders
        for path in folder.glob(f"{_PREFIX}*{_SUFFIX}")
    )
    built_for = "MuJoCo " + " and ".join(present) if present else "no MuJoCo at all"
    raise RuntimeError(
        f"volcontact runs with MuJoCo {mujoco.__version__} but was built for {built_for}, and "
        f"cannot be compiled for it now: {reason}"
    )


def register_engine_plugin() -> None:
    """Makes the engine plugin known; MuJoCo 4 calls it when it is imported."""
    try:
        path = library_path(may_compile=False)
    except RuntimeError:
        return  # who asks for volcontact itself is told
    ctypes.CDLL(str(path))


def _library_folders() -> list[Path]:
    """Where the libraries may lie: beside the compiled core, and beside this file."""
    folders = [Path(__file__).parent]
    core = importlib.util.find_spec("volcontact._volcontact")
    if core is not None and core.origin is not None:
        folders.insert(0, Path(core.origin).parent)
    return list(dict.fromkeys(folders))
