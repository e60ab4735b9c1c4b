# SPDX-License-Identifier: Apache-2.0
"""Functional Mock-up Units of contact, for any simulator that imports FMI 2.0 or 3.0."""

from __future__ import annotations

from volcontact.fmu.export import export_fmu
from volcontact.fmu.merge import merge_fmus
from volcontact.fmu.scene_export import export_scene_fmu

__all__ = ["export_fmu", "export_scene_fmu", "merge_fmus"]
