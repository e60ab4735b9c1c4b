# SPDX-License-Identifier: Apache-2.0
"""The state of a simulation kept and put back: MuJoCo's mjSTATE_INTEGRATION, on every release."""

import mujoco
import numpy as np

# What MuJoCo calls the integration state, by the names of mjData.
FIELDS = (
    "time",
    "qpos",
    "qvel",
    "act",
    "qacc_warmstart",
    "ctrl",
    "qfrc_applied",
    "xfrc_applied",
    "mocap_pos",
    "mocap_quat",
    "userdata",
)


def checkpoint(data):
    """All numbers that a simulation goes on with."""
    return {name: np.array(getattr(data, name), copy=True) for name in FIELDS}


def restore(data, kept):
    """Puts them back, into any data of the model."""
    for name, numbers in kept.items():
        if name == "time":
            data.time = float(numbers)
        else:
            getattr(data, name)[:] = numbers


def state_vector(model, data):
    """The same by MuJoCo's own function, where it has one; else None."""
    if not hasattr(mujoco, "mj_getState"):
        return None
    spec = mujoco.mjtState.mjSTATE_INTEGRATION
    state = np.empty(mujoco.mj_stateSize(model, spec))
    mujoco.mj_getState(model, data, state, spec)
    return state
