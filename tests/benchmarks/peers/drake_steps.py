# SPDX-License-Identifier: Apache-2.0
"""Drake: the boxes of a MuJoCo scene under hydroelastic contact, one discrete step at a time."""

from __future__ import annotations

import logging

import mujoco
import numpy as np
from pydrake.common.eigen_geometry import Quaternion
from pydrake.geometry import (
    AddRigidHydroelasticProperties,
    Box,
    HalfSpace,
    ProximityProperties,
    SceneGraphConfig,
)
from pydrake.math import RigidTransform
from pydrake.multibody.plant import (
    AddMultibodyPlant,
    ContactModel,
    CoulombFriction,
    MultibodyPlantConfig,
)
from pydrake.multibody.tree import RotationalInertia, SpatialInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

logging.getLogger("drake").setLevel(logging.ERROR)  # it warns of deformable bodies; there are none

BOX, PLANE = int(mujoco.mjtGeom.mjGEOM_BOX), int(mujoco.mjtGeom.mjGEOM_PLANE)


class DrakeScene:
    """Free bodies and the world of a MuJoCo model; its box and plane geoms that can touch.

    Stiffness and damping are Drake's defaults for compliant bodies, friction is the model's.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        builder = DiagramBuilder()
        self.plant, scene_graph = AddMultibodyPlant(
            MultibodyPlantConfig(time_step=model.opt.timestep), builder
        )
        self.plant.set_contact_model(ContactModel.kHydroelasticWithFallback)
        config = SceneGraphConfig()
        config.default_proximity_properties.compliance_type = "compliant"
        scene_graph.set_config(config)
        self.plant.mutable_gravity_field().set_gravity_vector(model.opt.gravity)
        # In MuJoCo's frame of reference at its first pose.
        self.start = mujoco.MjData(model)
        mujoco.mj_kinematics(model, self.start)
        self.bodies = {
            body: self._add_body(model, body)
            for body in range(model.nbody)
            if model.body_dofnum[body] == 6
        }
        for geom in range(model.ngeom):
            if model.geom_contype[geom] or model.geom_conaffinity[geom]:
                self._add_geom(model, geom)
        self.plant.Finalize()
        self.simulator = Simulator(builder.Build())
        root = self.simulator.get_mutable_context()
        self.context = self.plant.GetMyMutableContextFromRoot(root)
        for body, added in self.bodies.items():
            pose = _pose(self.start.xpos[body], self.start.xquat[body])
            self.plant.SetFreeBodyPose(self.context, added, pose)
        self.simulator.Initialize()

    def _add_body(self, model: mujoco.MjModel, body: int) -> object:
        inertia = RotationalInertia(*model.body_inertia[body])
        spatial = SpatialInertia.MakeFromCentralInertia(
            model.body_mass[body], np.array(model.body_ipos[body]), inertia
        )
        return self.plant.AddRigidBody(f"body_{body}", spatial)

    def _add_geom(self, model: mujoco.MjModel, geom: int) -> None:
        body = int(model.geom_bodyid[geom])
        if body in self.bodies:
            owner = self.bodies[body]
            pose = _pose(model.geom_pos[geom], model.geom_quat[geom])
        else:
            owner = self.plant.world_body()
            turn = np.zeros(4)
            data = self.start
            mujoco.mju_mulQuat(turn, data.xquat[body], model.geom_quat[geom])
            place = data.xmat[body].reshape(3, 3) @ model.geom_pos[geom] + data.xpos[body]
            pose = _pose(place, turn)
        kind = int(model.geom_type[geom])
        if kind not in (BOX, PLANE):
            return
        shape = Box(*(2 * model.geom_size[geom])) if kind == BOX else HalfSpace()
        friction = float(model.geom_friction[geom, 0])
        properties = ProximityProperties()
        properties.AddProperty("material", "coulomb_friction", CoulombFriction(friction, friction))
        if kind == PLANE:
            AddRigidHydroelasticProperties(properties)
        self.plant.RegisterCollisionGeometry(owner, pose, shape, f"geom_{geom}", properties)

    def advance(self, seconds: float) -> None:
        """Steps."""
        self.simulator.AdvanceTo(self.simulator.get_context().get_time() + seconds)

    def fastest(self) -> float:
        """Speed of the fastest body [m/s]."""
        velocities = [
            self.plant.EvalBodySpatialVelocityInWorld(self.context, body).translational()
            for body in self.bodies.values()
        ]
        return max(float(np.linalg.norm(v)) for v in velocities)

    def touching(self) -> int:
        """Contact surfaces and points."""
        results = self.plant.get_contact_results_output_port().Eval(self.context)
        return results.num_hydroelastic_contacts() + results.num_point_pair_contacts()


def _pose(position: np.ndarray, quaternion: np.ndarray) -> RigidTransform:
    turn = quaternion / np.linalg.norm(quaternion)
    return RigidTransform(Quaternion(turn), np.array(position))
