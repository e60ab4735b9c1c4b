// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adaptor/geoms/pair_rules.h"
#include "adaptor/mujoco/mujoco_compat.h"
#include "volcontact/base/types.h"

namespace volcontact::adaptor {

/// Sum of the contact forces on every body, and its way into MuJoCo's force arrays. Memory is
/// reused from step to step.
class BodyForces {
 public:
  void reset(const mjModel* m);
  bool empty() const { return loaded_.empty(); }

  /// A force [N] at `point`, a point of the world [m], and a torque [N m], on a body, world frame.
  void add(const mjModel* m, const mjData* d, int body, const Vec3& point, const Vec3& force,
           const Vec3& torque);

  /// The same on body a and, turned round, on body b.
  void add_between(const mjModel* m, const mjData* d, const GeomPair& geoms, const Vec3& point,
                   const Vec3& force, const Vec3& torque) {
    add(m, d, m->geom_bodyid[geoms.a], point, force, torque);
    add(m, d, m->geom_bodyid[geoms.b], point, -force, -torque);
  }

  // Both return the same memory of this object, which the caller may change. Ask for each once at
  // most, and for `generalized` last.

  /// The generalized force J^T f, nv numbers: what mj_applyFT, summed over all forces, would give.
  std::vector<double>& generalized(const mjModel* m, const mjData* d);

  /// Force and torque about each body's centre of mass, 6 nbody numbers as in xfrc_applied.
  std::vector<double>& cartesian(const mjModel* m, const mjData* d);

 private:
  void load(int body);

  std::vector<Wrench> at_tree_com_;  // of each body, about its tree's centre of mass
  std::vector<char> is_loaded_;      // by body
  std::vector<int> loaded_;
  std::vector<double> numbers_;
};

/// Sets what is not a finite number to zero; returns whether there was any.
bool drop_non_finite(std::vector<double>& numbers);

}  // namespace volcontact::adaptor
