// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/mujoco/mujoco_compat.h"
#include "volcontact/step/linear_constraints.h"

namespace volcontact::adaptor {

/// MuJoCo's own constraints in one step: joint and tendon limits, equalities, dry friction of
/// joints, native contacts.
class NativeConstraints final : public LinearConstraints {
 public:
  /// Takes the constraints that are at hand in `d`, which answers for them during the step.
  void read(const mjModel* m, mjData* d);

 private:
  void respond(std::span<const int> rows, std::span<const double> violation) override;

  const mjModel* m_ = nullptr;
  mjData* d_ = nullptr;
};

}  // namespace volcontact::adaptor
