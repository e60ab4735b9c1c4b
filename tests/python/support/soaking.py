# SPDX-License-Identifier: Apache-2.0
"""How many cases a test tries: few in `./run test`, all in `./run soak`."""

import os

SOAKING = bool(os.environ.get("VOLCONTACT_SOAK"))


def cases(few, *, soak):
    """`few`, or `soak` of them in `./run soak`."""
    return soak if SOAKING else few
