# SPDX-License-Identifier: Apache-2.0
"""The environment `volcontact/ORUInsertion-v0`: a compliant carrier inserts a battery box.

The scene is `mjcf_models/battery_insert_0g`. What an action, an observation and a reward are:
docs/environment.md.
"""

from __future__ import annotations

import warnings
from typing import Any, Literal, cast

import gymnasium
import mujoco
import numpy as np

import volcontact as vc
from volcontact.gym.scene_files import scene_file
from volcontact.render import Renderer
from volcontact.running.probes import native_sites, recorded_sites
from volcontact.running.simulation import warnings_of
from volcontact.running.watched import Kind, Watch, number

SCENE = "battery_insert_0g/scene.xml"
CONTROL_PERIOD = 0.1  # [s]
MOST_ACTIONS = 300  # of an episode
TIMESTEP = 0.005  # of MuJoCo [s]
START = np.array([0.0, 0.0, 0.25, 0.0, 0.0, 0.0])  # of the carrier, when it knows all [m, rad]
SITES = 8  # so many contact sites are observed, those with the largest forces

FORCE_LIMIT = 111.0  # at the grasp [N]
TORQUE_LIMIT = 22.0  # at the grasp [N m]
SEATED_DISTANCE = 1e-3  # [m]
SEATED_ANGLE = 0.1  # [degree]
SEATED_SPEED = 1e-3  # [m/s]
SEATED_PUSH = 30.0  # the carrier pushes with at least this [N]
ARM = 0.3  # turns the angle to the seat into a distance, for the reward [m]

BOUNDS = {  # of the observations
    "pose": np.full(6, 1.0),
    "velocity": np.full(6, 1.0),
    "set_point": np.full(6, 1.0),
    "wrench": np.full(6, 1e4),
    "sites": np.tile([1.0, 1.0, 1.0, 1e6, 1e6, 1e6], (SITES, 1)),
}

Observation = dict[str, np.ndarray]


class OruInsertion(gymnasium.Env[Observation, np.ndarray]):
    """A carrier with six compliant coordinates inserts a battery box, and must not push too hard.

    Where the worksite is the carrier knows only up to an error that is drawn anew in each episode;
    what it feels tells it the rest.

    Args:
        contact: `volumetric`, or MuJoCo's own.
        misalignment: the largest error along each axis [m].
        turning: the largest error about each axis [degree].
        render_mode: `rgb_array` or None.

    Raises:
        ValueError: an argument is out of its range.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012  # declared so in gymnasium.Env
        "render_modes": ["rgb_array"],
        "render_fps": round(1 / CONTROL_PERIOD),
    }

    def __init__(
        self,
        *,
        contact: Literal["volumetric", "native"] = "volumetric",
        misalignment: float = 0.006,
        turning: float = 1.0,
        render_mode: str | None = None,
    ) -> None:
        if contact not in ("volumetric", "native"):
            raise ValueError(f"contact = {contact!r}: must be 'volumetric' or 'native'")
        if not 0.0 <= misalignment <= 0.01:
            raise ValueError(f"misalignment = {misalignment} [m]: must be from 0 to 0.01")
        if not 0.0 <= turning <= 2.0:
            raise ValueError(f"turning = {turning} [degree]: must be from 0 to 2")
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise ValueError(f"render_mode = {render_mode!r}: must be 'rgb_array' or None")
        self.render_mode = render_mode
        path = scene_file(SCENE)
        is_native = contact == "native"
        self._model = mujoco.MjModel.from_xml_path(str(path)) if is_native else vc.load(path)
        self._model.opt.timestep = TIMESTEP
        self._contact = None if is_native else vc.attach(self._model)
        self._data = mujoco.MjData(self._model)
        self._renderer: Renderer | None = None
        turn = np.radians(turning)
        self._spread = np.array([misalignment, misalignment, 0.0, turn, turn, turn])
        self._error = np.zeros(6)
        self._watch = _watch_of_the_grasp()
        self._distance = 0.0
        self._speeds = self._model.actuator_ctrlrange[:, 1].copy()
        self._box = mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_BODY, "battery_box")
        mujoco.mj_kinematics(self._model, self._data)  # all coordinates 0: the seated pose
        self._seat = self._data.xpos[self._box].copy()
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (6,), np.float32)
        boxes: dict[str, gymnasium.Space[Any]] = {
            name: gymnasium.spaces.Box(
                -bound.astype(np.float32), bound.astype(np.float32), dtype=np.float32
            )
            for name, bound in BOUNDS.items()
        }
        self.observation_space = cast(
            "gymnasium.spaces.Space[Observation]", gymnasium.spaces.Dict(boxes)
        )

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Puts the box above its seat, at rest.

        Args:
            seed: of the errors.
            options: `misalignment`, shape (6,): the error itself instead of a drawn one [m, rad].

        Raises:
            ValueError: the misalignment is not six finite numbers.
        """
        super().reset(seed=seed)
        drawn = self.np_random.uniform(-self._spread, self._spread)
        error = np.asarray((options or {}).get("misalignment", drawn), np.float64)
        if error.shape != (6,) or not np.isfinite(error).all():
            raise ValueError(f"misalignment {error!r}: must be six finite numbers [m, rad]")
        self._error = error
        mujoco.mj_resetData(self._model, self._data)
        start = error + START
        self._data.qpos[:] = start
        self._data.act[:] = start
        mujoco.mj_forward(self._model, self._data)
        self._watch = _watch_of_the_grasp()
        self._distance = self._way_left()
        return self._observe(), self._info()

    def step(self, action: np.ndarray) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Moves the set points for one control period."""
        self._data.ctrl[:] = np.clip(action, -1.0, 1.0) * self._speeds
        self._watch.step(self._model, self._data, round(CONTROL_PERIOD / TIMESTEP))
        for name, count in warnings_of(self._data).items():
            warnings.warn(f"MuJoCo warned: {name}, {count} times", RuntimeWarning, stacklevel=2)
        before, self._distance = self._distance, self._way_left()
        info = self._info()
        reward = (before - self._distance) / START[2]
        reward += float(info["is_success"]) - float(info["overload"])
        is_over = info["is_success"] or info["overload"]
        diverged = self._watch.outcome == "diverged"  # MuJoCo has gone back to the start
        return self._observe(), reward, is_over, diverged, info

    def render(self) -> np.ndarray | None:
        """The scene, shape (480, 640, 3), uint8; None without a render mode."""
        if self.render_mode is None:
            return None
        if self._renderer is None:
            self._renderer = Renderer(self._model, width=640, height=480)
        return self._renderer.draw(self._data.qpos, view="overview")

    def close(self) -> None:
        """Frees the picture and gives the model its own contact back. May be called twice."""
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None
        if self._contact is not None:
            self._contact.close()
            self._contact = None

    def _observe(self) -> Observation:
        data = self._data
        seen = {
            "pose": data.qpos - self._error,
            "velocity": data.qvel,
            "set_point": data.act - self._error,
            "wrench": data.sensordata[:6],
            "sites": self._sites(),
        }
        return {
            name: np.clip(value, -BOUNDS[name], BOUNDS[name]).astype(np.float32)
            for name, value in seen.items()
        }

    def _sites(self) -> np.ndarray:
        """Places from the grasp [m] and forces on the box [N], the largest first, (SITES, 6)."""
        if self._contact is None:
            found = native_sites(self._model, self._data)
        else:
            found = recorded_sites(self._contact.sites(self._data))
        is_a = self._model.geom_bodyid[found["geom_a"]] == self._box
        forces = np.where(is_a[:, None], found["force"], -found["force"])
        first = np.argsort(-np.linalg.norm(forces, axis=1), kind="stable")[:SITES]
        grasp = self._data.xpos[self._model.body_parentid[self._box]]
        sites = np.zeros((SITES, 6))
        sites[: len(first)] = np.hstack([found["position"] - grasp, forces])[first]
        return sites

    def _offset(self) -> tuple[float, float]:
        """Of the box from its seat: distance [m] and angle [degree]."""
        distance = np.linalg.norm(self._data.xpos[self._box] - self._seat)
        turn = self._data.xquat[self._box]
        angle = 2.0 * np.arctan2(np.linalg.norm(turn[1:]), abs(turn[0]))
        return float(distance), float(np.degrees(angle))

    def _way_left(self) -> float:
        distance, angle = self._offset()
        return distance + ARM * float(np.radians(angle))

    def _info(self) -> dict[str, Any]:
        distance, angle = self._offset()
        seated = (
            distance < SEATED_DISTANCE
            and angle < SEATED_ANGLE
            and bool(np.abs(self._data.qvel[:3]).max() < SEATED_SPEED)
            and self._data.sensordata[2] < -SEATED_PUSH
        )
        force, torque = self._watch.felt.peak_force, self._watch.felt.peak_torque
        overload = force > FORCE_LIMIT or torque > TORQUE_LIMIT
        return {
            "is_success": bool(seated and not overload),
            "overload": bool(overload),
            "peak_force": force,
            "peak_torque": torque,
            "distance": distance,
            "angle": angle,
        }


def _watch_of_the_grasp() -> Watch:
    sensors = [number(Kind.SENSOR, i) for i in range(6)]
    return Watch(force=sensors[:3], torque=sensors[3:])
