// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/evaluation/scratch.h"
#include "adaptor/scene/scene_contact.h"

namespace volcontact::adaptor {

/// One contact of a scene, volumetric or MuJoCo's own. World frame.
struct SceneForce {
  int geom_a = -1;  ///< -1: no geom, a flex
  int geom_b = -1;
  bool is_native = false;
  Vec3 position = Vec3::Zero();  ///< centroid of the overlap, or the contact point [m]
  Vec3 normal = Vec3::Zero();    ///< on a, from b to a
  Vec3 force = Vec3::Zero();     ///< on a [N]
  Vec3 torque = Vec3::Zero();    ///< on a about `position` [N m]
  double normal_force = 0.0;     ///< [N]
};

/// All contacts of the last evaluation: our sites, then the contacts that MuJoCo solved.
void list_contacts(const SceneContact& contact, const mjModel* m, const mjData* d,
                   EvaluationScratch& scratch, std::vector<SceneForce>& out);

/// Writes what the touch sensors measure to sensordata, by MuJoCo's rule: the sum of the normal
/// forces on the body of the sensor's site whose outward ray meets the site. MuJoCo sees its own
/// contacts alone.
void update_touch_sensors(const SceneContact& contact, const mjModel* m, mjData* d,
                          EvaluationScratch& scratch);

}  // namespace volcontact::adaptor
