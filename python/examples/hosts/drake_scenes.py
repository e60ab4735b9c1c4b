# SPDX-License-Identifier: Apache-2.0
"""Both scenes in Drake: a LeafSystem whose output is the external force on a MultibodyPlant."""

import weakref

import numpy as np
import pydrake.all as drake
from two_scenes import SAMPLE, Memory, Scene, pose, show, vc


class Contact(drake.LeafSystem):
    """From the plant's state to the force on its body; the context has what the laws keep."""

    def __init__(self, scene: Scene, body: int) -> None:
        super().__init__()
        self.scene, self.body = weakref.proxy(scene), body  # Drake never frees a LeafSystem
        self.DeclareVectorInputPort("state", 13)
        self.memory = self.DeclareAbstractState(drake.Value((0.0, None)))
        kind = drake.Value([drake.ExternallyAppliedSpatialForce()])
        self.DeclareAbstractOutputPort("force", lambda: kind, self._push)
        self.DeclarePerStepUnrestrictedUpdateEvent(self._keep)  # at the start of each accepted step

    def _report(self, context: drake.Context) -> vc.ContactReport:
        x, memory = self.get_input_port().Eval(context), Memory(self.scene.contact)
        memory.time, memory.state = context.get_abstract_state(self.memory).get_value()
        return memory.report(context.get_time(), pose(x[4:7], x[:4]), x[7:])

    def _push(self, context: drake.Context, output: drake.Value) -> None:
        report, applied = self._report(context), drake.ExternallyAppliedSpatialForce()
        applied.body_index = self.body
        applied.F_Bq_W = drake.SpatialForce(tau=report.torque_on_A, f=report.force_on_A)
        output.set_value([applied])

    def _keep(self, context: drake.Context, state: drake.State) -> None:
        kept = (context.get_time(), self._report(context).state)
        state.get_mutable_abstract_state(self.memory).set_value(kept)


def run(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Times [s], shape (n,), and poses, shape (n, 4, 4)."""
    builder, plant = drake.DiagramBuilder(), drake.MultibodyPlant(time_step=0.0)
    unit = drake.UnitInertia(*(scene.inertia / scene.mass))
    body = plant.AddRigidBody("body", drake.SpatialInertia(scene.mass, np.zeros(3), unit)).index()
    plant.Finalize()
    contact, state = builder.AddSystem(Contact(scene, body)), plant.get_state_output_port()
    builder.AddSystem(plant)
    builder.Connect(state, contact.get_input_port())
    builder.Connect(contact.get_output_port(), plant.get_applied_spatial_force_input_port())
    log = drake.LogVectorOutput(state, builder, SAMPLE)
    simulator = drake.Simulator(builder.Build())
    drake.ResetIntegratorFromFlags(simulator, "runge_kutta3", 1e-3).set_target_accuracy(1e-7)
    start = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.SetPositionsAndVelocities(start, np.r_[scene.quaternion, scene.position, scene.V_WA])
    simulator.AdvanceTo(scene.duration)
    found = log.FindLog(simulator.get_context())
    return found.sample_times(), np.array([pose(x[4:7], x[:4]) for x in found.data().T])


if __name__ == "__main__":
    show(run)
