# SPDX-License-Identifier: Apache-2.0
"""Both scenes in Drake: a LeafSystem whose output is the external force on a MultibodyPlant."""

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.multibody.tree import SpatialInertia, UnitInertia
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig
from pydrake.systems.framework import Context, DiagramBuilder, LeafSystem, State
from pydrake.systems.primitives import LogVectorOutput
from two_scenes import SAMPLE, Memory, Scene, pose, show

APPLIED = ExternallyAppliedSpatialForce
SOLVER = SimulatorConfig(integration_scheme="runge_kutta3", max_step_size=1e-3, accuracy=1e-8)


class Contact(LeafSystem):
    """From the plant's state to the force on its body; Drake holds what the laws keep."""

    def __init__(self, scene: Scene, body: object) -> None:
        super().__init__()
        self.scene, self.body = scene, body
        self.plant_state = self.DeclareVectorInputPort("state", 13)
        self.memory = self.DeclareAbstractState(Value((0.0, None)))
        self.DeclareAbstractOutputPort("force", lambda: Value([APPLIED()]), self.push)
        self.DeclarePerStepUnrestrictedUpdateEvent(self.keep)  # at the start of each real step

    def report(self, context: Context):
        x = self.plant_state.Eval(context)  # quaternion, position, twist in the world
        memory = Memory(self.scene.contact)
        memory.time, memory.state = context.get_abstract_state(self.memory).get_value()
        return memory.report(context.get_time(), pose(x[4:7], x[:4]), x[7:])

    def push(self, context: Context, output: Value) -> None:
        report, applied = self.report(context), APPLIED()
        applied.body_index = self.body.index()
        applied.F_Bq_W = SpatialForce(tau=report.torque_on_A, f=report.force_on_A)
        output.set_value([applied])

    def keep(self, context: Context, state: State) -> None:
        kept = (context.get_time(), self.report(context).state)
        state.get_mutable_abstract_state(self.memory).set_value(kept)


def run(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Times [s], shape (n,), and poses, shape (n, 4, 4)."""
    builder = DiagramBuilder()
    plant = builder.AddSystem(MultibodyPlant(time_step=0.0))
    unit = UnitInertia(*(scene.inertia / scene.mass))
    body = plant.AddRigidBody("body", SpatialInertia(scene.mass, np.zeros(3), unit))
    plant.Finalize()
    contact = builder.AddSystem(Contact(scene, body))
    builder.Connect(plant.get_state_output_port(), contact.get_input_port())
    builder.Connect(contact.get_output_port(), plant.get_applied_spatial_force_input_port())
    log = LogVectorOutput(plant.get_state_output_port(), builder, SAMPLE)
    simulator = Simulator(builder.Build())
    ApplySimulatorConfig(SOLVER, simulator)
    start = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.SetPositionsAndVelocities(start, np.r_[scene.quaternion, scene.position, scene.V_WA])
    simulator.AdvanceTo(scene.duration)
    found = log.FindLog(simulator.get_context())
    return found.sample_times(), np.array([pose(x[4:7], x[:4]) for x in found.data().T])


if __name__ == "__main__":
    show(run)
