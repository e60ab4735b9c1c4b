// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/body_forces.h"

#include <algorithm>
#include <functional>

#include "adaptor/mujoco/mjgeoms.h"

namespace volcontact::adaptor {

void BodyForces::reset(const mjModel* m) {
  const auto bodies = static_cast<std::size_t>(m->nbody);
  if (at_tree_com_.size() != bodies) {
    at_tree_com_.assign(bodies, Wrench{});
    is_loaded_.assign(bodies, 0);
    loaded_.clear();
  }
  for (const int body : loaded_) {
    at_tree_com_[static_cast<std::size_t>(body)] = Wrench{};
    is_loaded_[static_cast<std::size_t>(body)] = 0;
  }
  loaded_.clear();
}

void BodyForces::add(const mjModel* m, const mjData* d, int body, const Vec3& point,
                     const Vec3& force, const Vec3& torque) {
  if (m->body_weldid[body] == 0) return;  // the world takes any force
  const Vec3 com = vec3_at(d->subtree_com, m->body_rootid[body]);
  at_tree_com_[static_cast<std::size_t>(body)] += Wrench{torque, force}.about(com - point);
  load(body);
}

void BodyForces::load(int body) {
  char& is_loaded = is_loaded_[static_cast<std::size_t>(body)];
  if (is_loaded) return;
  is_loaded = 1;
  loaded_.push_back(body);
}

std::vector<double>& BodyForces::generalized(const mjModel* m, const mjData* d) {
  numbers_.assign(static_cast<std::size_t>(m->nv), 0.0);
  if (empty()) return numbers_;
  for (std::size_t i = 0; i < loaded_.size(); ++i) {
    const int parent = m->body_parentid[loaded_[i]];
    if (parent != 0) load(parent);
  }
  // A joint carries the forces on all bodies beyond it; parents have lower numbers.
  if (std::is_sorted(loaded_.begin(), loaded_.end())) {  // as a rule
    std::reverse(loaded_.begin(), loaded_.end());
  } else {
    std::sort(loaded_.begin(), loaded_.end(), std::greater<>());
  }
  for (const int body : loaded_) {
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
  for (const int body : loaded_) {
    const Vec3 com = vec3_at(d->subtree_com, m->body_rootid[body]);
    const Wrench load =
        at_tree_com_[static_cast<std::size_t>(body)].about(vec3_at(d->xipos, body) - com);
    double* const numbers = &numbers_[6 * static_cast<std::size_t>(body)];
    load.force.to(numbers);
    load.torque.to(numbers + 3);
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
