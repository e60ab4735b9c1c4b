# SPDX-License-Identifier: Apache-2.0
"""The live viewer: a scene that steps, with its contact sites drawn, in a window or a browser."""

from volcontact.view.drawing import SiteDrawing, draw_sites
from volcontact.view.stage import Stage

__all__ = ["SiteDrawing", "Stage", "draw_sites"]
