# SPDX-License-Identifier: Apache-2.0
"""Controllers of a study: that of the Gymnasium environment, or the user's own."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from volcontact.messages.spelling import nearest
from volcontact.study.file.settings import StudyError
from volcontact.study.functions import Functions

POLICIES = ("force_guided",)
Controller = Callable[[mujoco.MjData], None]


def check_control(control: dict[str, Any], gains: set[str], functions: Functions) -> None:
    """Checks the policy and the names of its gains, those of the file and those that vary.

    Raises:
        StudyError: there is no such policy, or it takes no such gain.
    """
    if not control:
        if gains:
            raise StudyError(
                f"target 'control/{min(gains)}': there is no controller; add the table [control]"
            )
        return
    maker = _maker(control["policy"], functions)
    takes = list(inspect.signature(maker).parameters)
    if control["policy"] not in POLICIES:
        takes = takes[1:]  # the model
    for gain in (*control["gains"], *gains):
        if gain not in takes:
            raise StudyError(f"[control] {gain}: is unknown{nearest(gain, takes)}")


def make_controller(
    control: dict[str, Any], gains: dict[str, float], model: mujoco.MjModel, functions: Functions
) -> Controller:
    """The controller of one trial; called once every control period."""
    maker = _maker(control["policy"], functions)
    given = {**control["gains"], **gains}
    if control["policy"] not in POLICIES:
        made: Controller = maker(model, **given)
        return made
    from volcontact.gym.oru_insertion import BOUNDS

    if model.nu != 6 or model.nsensordata < 6:
        raise StudyError(
            "[control] policy = 'force_guided': the scene must have the six actuators and sensors "
            "of mjcf_models/carrier_drive.xml"
        )
    policy = maker(**given)
    speeds = model.actuator_ctrlrange[:, 1].copy()
    bound = BOUNDS["wrench"]

    def control_step(data: mujoco.MjData) -> None:
        wrench = np.clip(data.sensordata[:6], -bound, bound).astype(np.float32)
        data.ctrl[:] = np.clip(policy({"wrench": wrench}), -1.0, 1.0) * speeds

    return control_step


def _maker(name: str, functions: Functions) -> Callable[..., Any]:
    if name in POLICIES:
        from volcontact.gym.scripted import ForceGuided

        return ForceGuided
    return functions.get(name, "[control] policy")
