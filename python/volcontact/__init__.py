# SPDX-License-Identifier: Apache-2.0
"""Volumetric contact for MuJoCo: exact interference volumes, real patches, true forces."""

from volcontact._volcontact import (
    Box,
    ByChannel,
    Capsule,
    ContactModel,
    ContactReport,
    ConvexPolytope,
    Cylinder,
    Ellipsoid,
    Friction,
    Frustum,
    HalfSpace,
    HuntCrossley,
    Interference,
    NormalForce,
    Pair,
    RegularizedCoulomb,
    SiteReport,
    Sphere,
    Torus,
    VolumeMetrics,
    VolumeSpring,
    interference,
)
from volcontact.scene import Contact, attach, load

__version__ = "0.1.0"

__all__ = [
    "Box",
    "ByChannel",
    "Capsule",
    "Contact",
    "ContactModel",
    "ContactReport",
    "ConvexPolytope",
    "Cylinder",
    "Ellipsoid",
    "Friction",
    "Frustum",
    "HalfSpace",
    "HuntCrossley",
    "Interference",
    "NormalForce",
    "Pair",
    "RegularizedCoulomb",
    "SiteReport",
    "Sphere",
    "Torus",
    "VolumeMetrics",
    "VolumeSpring",
    "__version__",
    "attach",
    "interference",
    "load",
]
