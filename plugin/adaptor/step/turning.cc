// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/turning.h"

#include "adaptor/mujoco/mjgeoms.h"

namespace volcontact::adaptor {

Vec3 turning_acceleration(const mjModel* m, const mjData* d, int body, const Vec3& point) {
  while (body > 0 && m->body_dofnum[body] == 0) body = m->body_parentid[body];
  if (body == 0) return Vec3::Zero();
  Vec3 angular = Vec3::Zero(), linear = Vec3::Zero();
  int dof = m->body_dofadr[body] + m->body_dofnum[body] - 1;
  for (; dof >= 0; dof = m->dof_parentid[dof]) {
    angular += d->qvel[dof] * vec3_at(d->cdof_dot, 2 * dof);
    linear += d->qvel[dof] * vec3_at(d->cdof_dot, 2 * dof + 1);
  }
  const Vec3 offset = point - vec3_at(d->subtree_com, m->body_rootid[body]);
  const Vec3 turning = vec3_at(d->cvel, 2 * body);
  const Vec3 velocity = vec3_at(d->cvel, 2 * body + 1) + turning.cross(offset);
  return linear + angular.cross(offset) + turning.cross(velocity);
}

}  // namespace volcontact::adaptor
