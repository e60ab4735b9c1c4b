# SPDX-License-Identifier: Apache-2.0
"""Both scenes in Basilisk: a Python module writes force and torque on a spacecraft each step."""

import numpy as np
from Basilisk.architecture import messaging, sysModel
from Basilisk.simulation import extForceTorque, spacecraft
from Basilisk.utilities import SimulationBaseClass
from two_scenes import GRAVITY, SAMPLE, Memory, Scene, moved, pose, show


class Contact(sysModel.SysModel):
    """Reads the state of the spacecraft, and writes the wrench that acts for a step."""

    def __init__(self, scene: Scene, state: object) -> None:
        super().__init__()
        self.scene, self.state = scene, state.addSubscriber()
        self.memory, self.rows = Memory(scene.contact), []
        self.force, self.torque = messaging.CmdForceInertialMsg(), messaging.CmdTorqueBodyMsg()

    def UpdateState(self, now: int) -> None:  # noqa: D102 (called at every step)
        step, read = self.scene.step, self.state()
        time = max(0.0, now * 1e-9 - step)  # what is read is of a step ago
        s = np.array(read.sigma_BN)
        X = pose(np.array(read.r_BN_N), np.array([1.0 - s @ s, *(2.0 * s)]))
        V = np.concatenate([X[:3, :3] @ read.omega_BN_B, read.v_BN_N])
        self.rows.append((time, X))
        self.memory.keep(time, self.memory.report(time, X, V))
        X = moved(X, V, 0.5 * step)  # the wrench holds for a step: that of its middle
        report = self.memory.report(time + 0.5 * step, X, V)
        force = report.force_on_A + self.scene.mass * GRAVITY
        torque = X[:3, :3].T @ report.torque_on_A
        self.force.write(messaging.CmdForceInertialMsgPayload(forceRequestInertial=force), now)
        self.torque.write(messaging.CmdTorqueBodyMsgPayload(torqueRequestBody=torque), now)


def run(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Times [s], shape (n,), and poses, shape (n, 4, 4); Basilisk steps by Runge-Kutta."""
    sim, body = SimulationBaseClass.SimBaseClass(), spacecraft.Spacecraft()
    sim.CreateNewProcess("process").addTask(sim.CreateNewTask("task", round(scene.step * 1e9)))
    body.hub.mHub, body.hub.IHubPntBc_B = scene.mass, np.diag(scene.inertia)
    body.hub.r_CN_NInit, body.hub.v_CN_NInit = scene.position, scene.V_WA[3:]
    body.hub.sigma_BNInit = scene.quaternion[1:] / (1.0 + scene.quaternion[0])
    body.hub.omega_BN_BInit = scene.X_WA[:3, :3].T @ scene.V_WA[:3]
    push = extForceTorque.ExtForceTorque()
    body.addDynamicEffector(push)
    contact = Contact(scene, body.scStateOutMsg)
    push.cmdForceInertialInMsg.subscribeTo(contact.force)
    push.cmdTorqueInMsg.subscribeTo(contact.torque)
    for priority, module in ((30, contact), (20, push), (10, body)):
        module.ModelTag = f"module{priority}"
        sim.AddModelToTask("task", module, priority)
    sim.InitializeSimulation()
    sim.ConfigureStopTime(round((scene.duration + scene.step) * 1e9))
    sim.ExecuteSimulation()
    times, poses = zip(*contact.rows[1 :: round(SAMPLE / scene.step)], strict=True)
    return np.array(times), np.array(poses)


if __name__ == "__main__":
    show(run)
