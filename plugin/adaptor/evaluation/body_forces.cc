// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/body_forces.h"

#include "adaptor/mujoco/mjgeoms.h"

namespace volcontact::adaptor {

void BodyForces::reset(const mjModel* m) {
  at_tree_com_.assign(static_cast<std::size_t>(m->nbody), Wrench{});
  any_ = false;
}

void BodyForces::add(const mjModel* m, const mjData* d, int body, const Vec3& point,
                     const Vec3& force, const Vec3& torque) {
  if (m->body_weldid[body] == 0) return;  // the world takes any force
  const Vec3 com = vec3_at(d->subtree_com, m->body_rootid[body]);
  at_tree_com_[static_cast<std::size_t>(body)] += Wrench{torque, force}.about(com - point);
  any_ = true;
}

std::vector<double>& BodyForces::generalized(const mjModel* m, const mjData* d) {
  numbers_.assign(static_cast<std::size_t>(m->nv), 0.0);
  if (!any_) return numbers_;
  // A joint carries the forces on all bodies beyond it; parents have lower numbers.
  for (int body = static_cast<int>(m->nbody) - 1; body > 0; --body) {
    const int parent = m->body_parentid[body];
    if (parent == 0) continue;
    at_tree_com_[static_cast<std::size_t>(parent)] += at_tree_com_[static_cast<std::size_t>(body)];
  }
  for (int dof = 0; dof < m->nv; ++dof) {
    const Wrench& load = at_tree_com_[static_cast<std::size_t>(m->dof_bodyid[dof])];
    numbers_[static_cast<std::size_t>(dof)] =
        vec3_at(d->cdof, 2 * dof).dot(load.torque) + vec3_at(d->cdof, 2 * dof + 1).dot(load.force);
  }
  return numbers_;
}

std::vector<double>& BodyForces::cartesian(const mjModel* m, const mjData* d) {
  numbers_.assign(6 * static_cast<std::size_t>(m->nbody), 0.0);
  if (!any_) return numbers_;
  for (int body = 1; body < m->nbody; ++body) {
    const Vec3 com = vec3_at(d->subtree_com, m->body_rootid[body]);
    const Wrench load =
        at_tree_com_[static_cast<std::size_t>(body)].about(vec3_at(d->xipos, body) - com);
    Eigen::Map<Vec3> force(&numbers_[6 * static_cast<std::size_t>(body)]);
    Eigen::Map<Vec3> torque(&numbers_[6 * static_cast<std::size_t>(body) + 3]);
    force = load.force;
    torque = load.torque;
  }
  return numbers_;
}

bool drop_non_finite(std::vector<double>& numbers) {
  bool dropped = false;
  for (double& number : numbers) {
    if (number - number == 0.0) continue;
    number = 0.0;
    dropped = true;
  }
  return dropped;
}

}  // namespace volcontact::adaptor
