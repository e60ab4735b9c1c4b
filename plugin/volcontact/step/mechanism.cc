// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/mechanism.h"

namespace volcontact {

Vec3 turning_acceleration(const Mechanism& mechanism, int body, const Vec3& point) {
  const MechanismTrees& trees = *mechanism.trees;
  const int tree = trees.tree_of_body[size(body)];
  if (tree == MechanismTrees::kNone) return Vec3::Zero();
  Vec3 angular = Vec3::Zero(), linear = Vec3::Zero();
  for (int dof = trees.last_dof[size(body)]; dof >= 0; dof = trees.carrier[size(dof)]) {
    angular += mechanism.speeds[dof] * Mechanism::angular(mechanism.motion_rates, dof);
    linear += mechanism.speeds[dof] * Mechanism::linear(mechanism.motion_rates, dof);
  }
  const Vec3 offset = point - mechanism.origin(tree);
  const Vec3 turning = Mechanism::angular(mechanism.twists, body);
  const Vec3 velocity = Mechanism::linear(mechanism.twists, body) + turning.cross(offset);
  return linear + angular.cross(offset) + turning.cross(velocity);
}

}  // namespace volcontact
