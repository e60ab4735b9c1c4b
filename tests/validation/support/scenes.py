# SPDX-License-Identifier: Apache-2.0
"""One body over a floor, the scene of many cases."""

from __future__ import annotations


def over_floor(
    geom: str,
    *,
    height: float,
    step: float,
    gravity: float = 0.0,
    speed: float = 0.0,
    surface: str = "",
    **keys: float,
) -> str:
    """MJCF text.

    Args:
        geom: attributes of the body, named `body`.
        height: of its centre [m].
        step: of the Runge-Kutta method [s].
        gravity: downwards [m/s^2].
        speed: downwards, in the keyframe `start` [m/s].
        surface: attributes of both geoms.
        keys: of the pair, with `__` for `/`; a choice is set by 1.
    """
    numbers = "".join(
        f'<numeric name="volcontact/pair/body/{key.replace("__", "/")}" data="{value!r}"/>'
        for key, value in keys.items()
    )
    return f"""
<mujoco>
  <option timestep="{step!r}" integrator="RK4" gravity="0 0 {-gravity!r}"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 1 0.1" {surface}/>
    <body pos="0 0 {height!r}"><freejoint/>
      <geom name="body" {geom} {surface} mass="1"/></body>
  </worldbody>
  <keyframe>
    <key name="start" qpos="0 0 {height!r} 1 0 0 0" qvel="0 0 {-speed!r} 0 0 0"/>
  </keyframe>
  <custom>
    {numbers}
    <tuple name="volcontact/pair/body">
      <element objtype="geom" objname="body"/><element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
</mujoco>"""
