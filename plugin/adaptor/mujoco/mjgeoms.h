// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/mujoco/mujoco_compat.h"
#include "volcontact/base/types.h"

namespace volcontact::adaptor {

/// MuJoCo's word for the geom's type: "box", "mesh".
const char* type_name(const mjModel* m, int geom);

inline Vec3 vec3_at(const mjtNum* array, int index) { return Vec3::from(array + 3 * index); }

/// Pose of the geom frame in the world, X_WG.
inline Pose pose_of_geom(const mjData* d, int geom) {
  return {Mat3::from_rows(d->geom_xmat + 9 * geom), vec3_at(d->geom_xpos, geom)};
}

/// Twist of the geom frame in the world: velocity of its origin. MuJoCo keeps a body's velocity at
/// the centre of mass of its kinematic tree.
inline Twist twist_of_geom(const mjModel* m, const mjData* d, int geom) {
  const int body = m->geom_bodyid[geom];
  const Twist at_tree_com{vec3_at(d->cvel, 2 * body), vec3_at(d->cvel, 2 * body + 1)};
  const Vec3 offset = vec3_at(d->geom_xpos, geom) - vec3_at(d->subtree_com, m->body_rootid[body]);
  return {at_tree_com.angular, at_tree_com.at(offset)};
}

}  // namespace volcontact::adaptor
