# SPDX-License-Identifier: Apache-2.0
"""Both scenes in DART: its body and integrator, the wrench as external force and torque."""

import dartpy
import numpy as np
from two_scenes import GRAVITY, SAMPLE, Memory, Scene, show


def free_body(world: dartpy.simulation.World, scene: Scene) -> dartpy.dynamics.BodyNode:
    """The body of a scene, placed and moving, in a world of its own."""
    skeleton = dartpy.dynamics.Skeleton()
    joint, body = skeleton.createFreeJointAndBodyNodePair()
    body.setInertia(dartpy.dynamics.Inertia(scene.mass, np.zeros(3), np.diag(scene.inertia)))
    start = dartpy.math.Isometry3()
    start.set_rotation(scene.X_WA[:3, :3])
    start.set_translation(scene.X_WA[:3, 3])
    joint.setPositions(dartpy.dynamics.FreeJoint.convertToPositions(start))
    late = np.r_[0.0, 0.0, 0.0, 0.5 * world.getTimeStep() * GRAVITY]
    joint.setVelocities(
        scene.V_WA - late
    )  # Euler's rule is leapfrog with speeds of half a step ago
    world.addSkeleton(skeleton)
    return body


def run(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Times [s], shape (n,), and poses, shape (n, 4, 4); DART steps by semi-implicit Euler."""
    world = dartpy.simulation.World()
    world.setGravity(GRAVITY)
    world.setTimeStep(step := scene.step)
    body, memory = free_body(world, scene), Memory(scene.contact)
    times, poses = [], []
    every = round(SAMPLE / step)
    for i in range(round(scene.duration / step) + 1):
        X_WA = body.getWorldTransform().matrix()
        V_WA = np.concatenate([body.getAngularVelocity(), body.getLinearVelocity()])
        if i % every == 0:
            times.append(i * step)
            poses.append(X_WA)
        report = memory.report(i * step, X_WA, V_WA)
        memory.keep(i * step, report)  # every step is accepted
        body.addExtForce(report.force_on_A, np.zeros(3), False, True)
        body.addExtTorque(report.torque_on_A, False)
        world.step()
    return np.array(times), np.array(poses)


if __name__ == "__main__":
    show(run)
