# SPDX-License-Identifier: Apache-2.0
"""MuJoCo's own toolbox for identification, mujoco.sysid, finds numbers of volumetric contact.

A ball bounces on a floor; from where it was, stiffness and damping are found again.
"""

import mujoco
import numpy as np

from volcontact.identify.sysid import parameter, toolbox, values, with_volumetric_contact

SCENE = """
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="ball" pos="0 0 0.06">
      <freejoint name="free"/>
      <geom name="ball" type="sphere" size="0.05" mass="0.4"/>
    </body>
  </worldbody>
  <custom>
    <numeric name="volcontact/pair/p/stiffness" data="4e6"/>
    <numeric name="volcontact/pair/p/damping" data="0.5"/>
    <numeric name="volcontact/option/implicit/on" data="1"/>
    <tuple name="volcontact/pair/p">
      <element objtype="geom" objname="ball"/>
      <element objtype="geom" objname="floor"/>
    </tuple>
  </custom>
  <sensor>
    <framepos name="place" objtype="body" objname="ball"/>
  </sensor>
</mujoco>
"""


def main() -> None:
    """Measures a motion, and finds what it was made with."""
    try:
        sysid = toolbox()
    except ModuleNotFoundError as reason:
        print(f"nothing to show: {reason}")
        return
    from mujoco import rollout

    spec = with_volumetric_contact(mujoco.MjSpec.from_string(SCENE))
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[:3] = 0.2, 0.1, -0.3
    start = sysid.create_initial_state(model, data.qpos, data.qvel, data.act)
    times = model.opt.timestep * np.arange(250)
    state, sensors = rollout.rollout(model, data, start, nstep=len(times) - 1)
    measured = sysid.TimeSeries.from_names(state[0, :, 0], sensors[0], model)
    nothing = sysid.TimeSeries(times, np.zeros((len(times), 0)))  # there are no actuators

    params = sysid.ParameterDict()
    for name, guess, low, high in (("stiffness", 8e6, 1e6, 5e7), ("damping", 1.0, 0.1, 5.0)):
        target = f"volcontact/pair/p/{name}"
        params.add(parameter(name, target, guess, low, high, log=True))
    sequences = sysid.ModelSequences("ball", spec, "bounce", start, nothing, measured)
    residual = sysid.build_residual_fn(models_sequences=[sequences], n_threads=1)
    found, _ = sysid.optimize(params, residual, optimizer="mujoco", verbose=False)
    for name, value in values(found).items():
        print(f"{name} = {value:.6g}")


if __name__ == "__main__":
    main()
