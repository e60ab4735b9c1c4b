# SPDX-License-Identifier: Apache-2.0
"""Gymnasium environments with volumetric contact. Importing this registers them.

    import gymnasium
    import volcontact.gym

    env = gymnasium.make("volcontact/ORUInsertion-v0")

Needs the extra `gym`: `pip install "volcontact[gym]"`.
"""

from __future__ import annotations

import gymnasium

from volcontact.gym.oru_insertion import MOST_ACTIONS, OruInsertion
from volcontact.gym.scripted import ForceGuided

__all__ = ["ENV_ID", "ForceGuided", "OruInsertion"]

ENV_ID = "volcontact/ORUInsertion-v0"

if ENV_ID not in gymnasium.registry:
    gymnasium.register(
        ENV_ID, "volcontact.gym.oru_insertion:OruInsertion", max_episode_steps=MOST_ACTIONS
    )
